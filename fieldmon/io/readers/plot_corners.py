"""The one plot whose corners a table lists in their order around it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import shapely
from shapely import MultiPolygon

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import Imported
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.geometry import boundary
from fieldmon.io.parse.positions import located
from fieldmon.io.readers.misplaced_plots import wrong_corner
from fieldmon.io.readers.plot_areas import are_plants, taken_as_corners
from fieldmon.io.readers.plot_names import name_column
from fieldmon.io.readers.walked_outline import MOST_CORNERS, in_order, not_in_order, outline_of
from fieldmon.plot.field import Field

if TYPE_CHECKING:
    from fieldmon.io.options import PlotOptions

# so few positions are corners rather than plants
_FEW_CORNERS = 6


def plot_of_corners(layer: Layer, options: PlotOptions) -> Imported[tuple[Field, ...]]:
    """Return the one plot whose corners a table lists in order."""
    layer = in_order(layer)
    found = located(layer, options)
    points, messages = found.lonlat, found.messages
    if options.where is None and are_plants(layer, len(points)):
        raise _no_outline(layer, len(points))
    if not 3 <= len(points) <= MOST_CORNERS:
        raise _which_are_corners(layer, len(points))
    if found.unread is not None and found.unread.written:
        record, at = next(iter(found.unread.written.items()))
        raise wrong_corner(layer.name, record + 1, at)
    outline = outline_of(points)
    if outline is None and options.where is None and not shapely.Polygon(points).is_valid:
        raise _which_are_corners(layer, len(points))
    ring = shapely.Polygon(points) if outline is None else outline.area
    kept, more = boundary(MultiPolygon([ring]), layer.plot_name)
    more += [] if outline is None else outline.messages
    if kept.is_empty:
        raise FileProblem(
            worded("The corners in {file} must enclose an area, but they do not.", file=layer.name)
        )
    told = (*layer.messages, *messages, taken_as_corners(len(points)), *more)
    return Imported((Field(_name_of_corners(layer, options), kept),), told)


def _name_of_corners(layer: Layer, options: PlotOptions) -> str:
    """Return what the plot is called whose corners were chosen: by what, or else by its file."""
    column, _, value = (options.where or "").partition("=")
    return value if column == name_column(layer) or find("plot", [column]) else layer.plot_name


def _no_outline(layer: Layer, n_points: int) -> ChoiceNeeded | FileProblem:
    """Return what is said of positions that no plot can lie inside: many may be plants."""
    if n_points <= _FEW_CORNERS:
        return not_in_order(layer.name, n_points)
    return ChoiceNeeded(
        worded(
            "A plot must be an area, but {name} lists {n} positions that are not its corners in "
            "their order around it. Take them as plants, or choose a file with the boundary.",
            name=layer.name,
            n=n_points,
        ),
        "kind",
        ("plants",),
    )


def _which_are_corners(layer: Layer, n_points: int) -> ChoiceNeeded | FileProblem:
    """Return the question which records of a table are corners, with the groups it holds."""
    groups = []
    places = {find(role, layer.columns) for role in ("lon", "lat", "x", "y", "position")}
    for name, values in layer.columns.items():
        if name in places:
            continue
        counts = Counter(text(v) for v in values)
        if 2 <= len(counts) <= 20:
            groups += [f"{name}={value}" for value, n in counts.items() if 3 <= n <= 1000]
    if not groups and n_points >= 3:
        return _no_outline(layer, n_points)
    return ChoiceNeeded(
        f"The corners of a plot must be 3 to 1000 positions in their order around it, but "
        f"{layer.name} lists {n_points} that do not enclose an area. Say which are the corners"
        + (f", for instance {', '.join(groups[:6])}." if groups else "."),
        "where",
        tuple(groups),
    )
