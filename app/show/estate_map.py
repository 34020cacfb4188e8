"""All plots on one map, coloured by how long ago they were seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.monitoring.days.estate_day import DUE_DAYS

from ..words import texts
from ..words.language import about, listed
from .map_view import MapContent
from .maps import legends

if TYPE_CHECKING:
    from ..state.estate import PlotState
    from ..state.shared_plots import PlannedTurn
    from .maps.colours import Colour
    from .maps.labels import Label
    from .maps.legends import LegendPart

#: the layer in which a tapped plot is looked up
PLOTS = "plots"
#: the layer of dots: the browser shows those of plots that are too small to be seen, and one with
#: their number for plots that would have the same
MARKS = "plot marks"
_COLOURS: dict[str, Colour] = {
    "fresh": (46, 139, 87), "due": (230, 159, 0), "late": (200, 60, 40), "new": (130, 140, 135),
}  # fmt: skip
_LATE = 7
# the state of several plots under one dot is that of the first of these
_URGENT = ("late", "due", "fresh", "new")
# who works, told apart for the colour-blind too (Okabe and Ito); their names say it as well
_WHO: tuple[Colour, ...] = (
    (0, 114, 178), (213, 94, 0), (0, 158, 115), (204, 121, 167), (86, 180, 233), (230, 159, 0),
)  # fmt: skip


def state_of(plot: PlotState) -> str:
    """Return the name of a plot's state."""
    if plot.expected is None:
        return "new"
    if plot.days_since is None or plot.days_since >= _LATE:
        return "late"
    return "due" if plot.days_since >= DUE_DAYS else "fresh"


def said(plot: PlotState) -> str:
    """Return what is said of a plot that is pointed at."""
    name = texts.isolated(plot.name)
    if plot.expected is None:
        return texts.PLOTS_TIP_NEW.format(name=name)
    days = "begun" if plot.days_since is None and plot.is_begun else plot.days_since
    seen = texts.PLOTS_SEEN.get(days) or texts.PLOTS_SEEN["n"].format(n=days)
    return texts.PLOTS_TIP.format(name=name, expected=about(plot.expected), seen=seen)


def content(plots: list[PlotState], turns: tuple[PlannedTurn, ...] = ()) -> MapContent:
    """Return the map of the plots, with the routes of a day's plan."""
    return MapContent(
        "all plots",
        shapely.total_bounds([plot.outline for plot in plots]).tolist(),
        texts.PLOTS_ALT.format(n=len(plots), names=listed(plot.name for plot in plots)),
        [_areas(plots), *_routes(turns), _marks(plots)],
        legend=_legend(plots, turns),
        labels=_names(plots, turns),
    )


def _areas(plots: list[PlotState]) -> Layer:
    rows = [
        {
            "p": [
                np.round(shapely.get_coordinates(ring), 7).tolist()
                for ring in (part.exterior, *part.interiors)
            ],
            "t": said(plot),
            "n": number,
            "c": [*_COLOURS[state_of(plot)], 200],
        }
        for number, plot in enumerate(plots)
        for part in shapely.get_parts(plot.outline)
    ]
    return Layer(
        "PolygonLayer", rows, id=PLOTS, get_polygon="p", get_fill_color="c", stroked=True,
        get_line_color=[60, 70, 65], line_width_min_pixels=1.5,
    )  # fmt: skip


def _legend(plots: list[PlotState], turns: tuple[PlannedTurn, ...]) -> list[LegendPart]:
    """Return the states that there are, and who has which route."""
    states = dict.fromkeys(map(state_of, plots))
    items = [("square", _COLOURS[name], texts.PLOTS_STATES[name]) for name in states]
    who = {turn.number: turn.who for turn in turns}
    workers = [("line", _WHO[k % len(_WHO)], name) for k, name in sorted(who.items())]
    return [legends.part("", items), *([legends.part("", workers)] if workers else [])]


def _names(plots: list[PlotState], turns: tuple[PlannedTurn, ...]) -> list[Label]:
    """Return the name of each plot in its middle, with who works there when."""
    of_plot = {id(turn.state): turn for turn in turns}
    return [
        {"p": _middle(plot), "t": _named(plot, of_plot.get(id(plot))), "k": "name", "plot": number}
        for number, plot in enumerate(plots)
    ]


def _marks(plots: list[PlotState]) -> Layer:
    rows = [
        {"p": _middle(plot), "t": said(plot), "c": [*_COLOURS[state_of(plot)], 255],
         "around": list(plot.outline.bounds), "urgent": _URGENT.index(state_of(plot))}
        for plot in plots
    ]  # fmt: skip
    return Layer("ScatterplotLayer", rows, id=MARKS, get_position="p", get_fill_color="c",
                 stroked=True, get_line_color=[60, 70, 65], line_width_min_pixels=1.5)  # fmt: skip


def _middle(plot: PlotState) -> list[float]:
    place: list[float] = shapely.get_coordinates(plot.outline.representative_point())[0].round(7)
    return list(map(float, place))


def _named(plot: PlotState, turn: PlannedTurn | None) -> str:
    if turn is None:
        return plot.name
    return texts.PLOTS_LABEL.format(
        name=texts.isolated(plot.name), who=turn.who, start=f"{turn.begins:%H:%M}",
        end=f"{turn.ends:%H:%M}",
    )  # fmt: skip


def _routes(turns: tuple[PlannedTurn, ...]) -> list[Layer]:
    rows = [
        {"path": np.round(turn.route.line_lonlat(), 7).tolist(),
         "c": list(_WHO[turn.number % len(_WHO)])}
        for turn in turns
    ]  # fmt: skip
    if not rows:
        return []
    return [
        Layer("PathLayer", rows, id="casing", get_path="path", get_color=[255, 255, 255, 220],
              get_width=1.6, width_min_pixels=3, width_max_pixels=6, joint_rounded=True),
        Layer("PathLayer", rows, id="route", get_path="path", get_color="c", get_width=0.8,
              width_min_pixels=1.6, width_max_pixels=3, joint_rounded=True),
    ]  # fmt: skip


def plot_tapped(plots: list[PlotState], index: int, layer: str = PLOTS) -> PlotState | None:
    """Return the plot whose part or dot was tapped, by its number in the layer."""
    if layer not in (PLOTS, MARKS):
        return None
    parts = (
        plots
        if layer == MARKS
        else [plot for plot in plots for _ in range(shapely.get_num_geometries(plot.outline))]
    )
    return parts[index] if 0 <= index < len(parts) else None
