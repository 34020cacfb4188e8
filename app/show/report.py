"""A printable page: map, figures, settings and the stops in order. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from markupsafe import Markup

from fieldmon.io.html import page

from ..words import language, texts
from ..words.language import number
from ..words.units import hours
from .maps import colours, legends

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from fieldmon.monitoring import DayFigures
    from fieldmon.planning.route import Route
    from fieldmon.plot.robot import Robot

    from ..state.chosen_day import DayRoute
    from ..words.units import Units

_WIDE = 900.0
_STOPS_A_TABLE = 60
# beside this module, whatever the app is installed as
_TEMPLATE = f"{__package__.replace('.', '/')}/report.html.j2"


@dataclass(frozen=True, eq=False)
class Facts:
    """What a report says beside the route."""

    name: str
    day: str
    units: Units
    chance: NDArray[np.float64]
    state: NDArray[np.int8]
    robot: Robot
    sampler: str
    shown: DayRoute
    results: dict[str, str]
    assumed: str = ""

    @property
    def route(self) -> Route:
        """Return the route as it was worked, or as it is planned."""
        return self.shown.route


def _words(*, worked: bool) -> dict[str, Any]:
    """Return the words of the page, in the language of whoever makes it."""
    return {
        "chance": texts.LEGEND_CHANCE,
        "found": texts.REPORT_FOUND,
        "season": texts.REPORT_SEASON,
        "settings": texts.REPORT_SETTINGS,
        "route": texts.REPORT_WORKED if worked else texts.REPORT_ROUTE,
        "columns": (texts.DATE, texts.VISITED_TODAY, texts.FOUND_TODAY, texts.EXPECTED_LEFT),
        "language": language.current(),
        "direction": "rtl" if language.is_right_to_left() else "ltr",
    }


def html(facts: Facts, stops: pd.DataFrame, days: list[DayFigures]) -> str:
    """Return the whole page."""
    signs = [
        ("find", colours.FOUND, texts.LEGEND_STATES["found"]),
        ("line", colours.ROUTE, texts.LEGEND_ROUTE),
        ("ring", colours.GATE, texts.LEGEND_GATE),
    ]
    worked = facts.shown.worked
    table = (stops if worked else stops.assign(**{texts.REPORT_TICK: "☐"})).reset_index()
    return page(
        _TEMPLATE,
        title=texts.REPORT_TITLE.format(name=texts.isolated(facts.name), day=facts.day),
        words=_words(worked=worked),
        figures=_figures(facts),
        assumed=facts.assumed.removeprefix("\\"),
        drawing=drawing(facts),
        legends=[legends.markup([legends.by_chance()]), legends.markup([legends.part("", signs)])],
        found=facts.results,
        days=[_day(facts, one) for one in days],
        settings=_settings(facts),
        stops=_parts(list(table.itertuples(index=False, name=None))),
        stop_columns=list(table.columns),
    )


def _parts(stops: list[tuple[Any, ...]]) -> list[list[tuple[Any, ...]]]:
    """Return the stops in tables to stand side by side: a route is many pages long otherwise."""
    return [stops[k : k + _STOPS_A_TABLE] for k in range(0, len(stops), _STOPS_A_TABLE)]


def drawing(facts: Facts) -> Markup:
    """Return the plot as an SVG picture, north up: chance by colour, finds as rings, the route."""
    grid, route = facts.route.aisles.grid, facts.route
    lonlat = grid.lonlat()
    outline = shapely.get_rings(shapely.get_parts(grid.frame.geometry_lonlat(grid.drivable_m)))
    low, high = shapely.bounds(shapely.geometrycollections(outline)).reshape(2, 2)
    squeeze = np.cos(np.deg2rad((low[1] + high[1]) / 2))
    span = (high - low) * [squeeze, 1.0]
    per_deg = _WIDE / max(span[0], span[1])

    def at(points: NDArray[np.float64]) -> NDArray[np.float64]:
        across = (points[:, 0] - low[0]) * squeeze * per_deg + 10
        return np.round(np.stack([across, (high[1] - points[:, 1]) * per_deg + 10], axis=1), 1)

    wide, tall = span * per_deg + [20, 60]
    size = max(0.35 * grid.plant_spacing_m * per_deg / 111_320.0, 1.0)
    parts = [_dots(at(lonlat), colours.by_chance(facts.chance), size)]
    parts += [_line(at(shapely.get_coordinates(ring)), "#46504a", 1.5) for ring in outline]
    if len(route):
        parts.append(_line(at(route.line_lonlat()), "#1450c8", 1.4))
    find = Markup('<circle cx="{}" cy="{}" r="{:.1f}" fill="rgb{}" stroke="#140000" '
                  'stroke-width="1.5"/>')  # fmt: skip
    parts += [
        find.format(x, y, size, colours.FOUND) for x, y in at(lonlat[facts.state == 1]).tolist()
    ]
    gate = at(grid.frame.lonlat(route.aisles.gate_m))[0]
    parts.append(
        Markup('<circle cx="{}" cy="{}" r="8" fill="none" stroke="rgb{}" stroke-width="4"/>')
        .format(*gate, colours.GATE)
    )  # fmt: skip
    parts.append(_scale(facts.units, per_deg / 111_320.0, (wide, tall)))
    label = texts.MAP_ALT.format(name=facts.name, plants=len(grid), stops=len(route),
                                 finds=int((facts.state == 1).sum()))  # fmt: skip
    return Markup(
        '<svg class="map" xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{}" '
        'viewBox="0 0 {:.0f} {:.0f}" width="{:.0f}">{}</svg>'
    ).format(label, wide, tall, wide, Markup().join(parts))


def _dots(places: NDArray[np.float64], shade: colours.Shade, size: float) -> Markup:
    """Return one path of little squares for each class: a few strokes instead of many dots."""
    parts = []
    for rank in np.unique(shade.rank):
        own = places[shade.rank == rank]
        colour = tuple(colours.of_chance()[rank])
        # lines as long as they are wide: dots of no length are missing in a PDF
        dots = "".join(f"M{x - size:.1f} {y}h{2 * size:.1f}" for x, y in own.tolist())
        path = Markup('<path d="{}" stroke="rgb{}" stroke-width="{:.1f}"/>')
        parts.append(path.format(dots, colour, 2 * size))
    return Markup().join(parts)


def _scale(units: Units, per_m: float, corner: tuple[float, float]) -> Markup:
    """Return a bar of a round length in the lower left corner and an arrow to the north."""
    (wide, tall), ink = corner, "#222"
    bar_m, text = units.bar_m((wide - 20) / per_m / 4)
    end, y = 10 + bar_m * per_m, tall - 24
    return _line(np.array([[10.0, y], [round(end, 1), y]]), ink, 4) + Markup(
        '<text x="10" y="{:.0f}" font-size="16" fill="{ink}">{}</text>'
        '<path d="M{:.0f} {:.0f}l8 -26l8 26l-8 -7z" fill="{ink}"/>'
        '<text x="{:.0f}" y="{:.0f}" font-size="16" fill="{ink}">N</text>'
    ).format(y + 18, text, wide - 22, tall - 10, wide - 20, tall - 40, ink=ink)


def _line(places: NDArray[np.float64], colour: str, wide: float) -> Markup:
    points = " ".join(f"{x},{y}" for x, y in places.tolist())
    return Markup('<polyline points="{}" fill="none" stroke="{}" stroke-width="{}"/>').format(
        points, colour, wide
    )


def _figures(facts: Facts) -> dict[str, str]:
    """Return what is to be done, or what was."""
    route, worked = facts.route, facts.shown.worked
    found = sum(len(plants.split(", ")) for plants in facts.results.values())
    plants = texts.PLANTS_INSPECTED if worked else texts.PLANTS_TO_INSPECT
    finds = (
        {texts.FOUND_TODAY: number(found, ",")}
        if worked
        else {texts.FINDS: number(route.expected_found, ".1f")}
    )
    return {
        plants: f"{number(len(np.unique(route.plant)), ',')} / {number(len(facts.chance), ',')}",
        texts.TIME: hours(route.end_s / 3600),
        texts.DRIVE: facts.units.metres(route.drive_m),
        **finds,
    }


def _settings(facts: Facts) -> dict[str, str]:
    robot = facts.robot
    return {
        texts.SAMPLER: facts.sampler,
        texts.HOURS: number(robot.hours, "g"),
        texts.INSPECTION_S: number(robot.look_s, "g"),
        texts.SPEED: texts.IN_SPEED.format(value=number(robot.speed_m_s * 3.6, ".1f")),
        texts.DETECTS: number(robot.detects, ".0%"),
    }


def _day(facts: Facts, one: DayFigures) -> tuple[object, ...]:
    left = f"{number(one.expected, '.1f')} ({one.low}-{one.high})"
    return facts.units.day(one.on), one.inspected, one.found, left
