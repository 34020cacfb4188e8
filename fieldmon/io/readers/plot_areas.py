"""The areas of a layer that can be plots: areas, closed lines, or corners in their order."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import counted, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, dropped, guessed
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.geometry import closed_lines, filled, geometry_kinds
from fieldmon.io.readers.walked_outline import goes_round, in_order, nearly_closed, outline_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import PlotOptions

# a table of more positions with a number of their row or plant lists plants
_MOST_CORNERS_NUMBERED = 20


def areas_of(layer: Layer, options: PlotOptions) -> tuple[Layer, list[ImportMessage]]:
    """Return the features that have an area; offer lines and points for what they can be."""
    messages: list[ImportMessage] = []
    areas, lines, points = geometry_kinds(shapes_of(layer))
    if not areas.any() and lines.any():
        layer, messages = _outlines(layer)
        areas, lines, points = geometry_kinds(shapes_of(layer))
    if not areas.any() and (outline := _outline(layer, options)) is not None:
        layer, more = outline
        messages = [*messages, *more]
        areas, lines, points = geometry_kinds(shapes_of(layer))
    if not areas.any():
        _refuse_without_areas(layer, int(lines.sum()), int(points.sum()))
    missing = len(layer) - int((areas | lines | points).sum())
    if missing:
        messages.append(
            dropped(
                worded(
                    "{n} {n:feature|features} without a geometry {n:was|were} left out.", n=missing
                )
            )
        )
    if lines.any():
        said = worded(
            "{n} {n:line was|lines were} left out: import them as rows or paths.",
            n=int(lines.sum()),
        )
        messages.append(dropped(said))
    if points.any():
        said = worded(
            "{n} {n:point was|points were} left out: import them as plants or records.",
            n=int(points.sum()),
        )
        messages.append(dropped(said))
    return layer.take(np.flatnonzero(areas)), messages


def shapes_of(layer: Layer) -> NDArray[np.object_]:
    """Return the shapes of a layer ``(n,)``; raise `FileProblem` if it is a plain table."""
    if layer.geometry is None:
        raise FileProblem(
            worded("{file} must hold shapes, but it is a plain table.", file=layer.name)
        )
    return layer.geometry


def _outlines(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer with closed lines as the areas inside them."""
    shapes = shapes_of(layer)
    closed = closed_lines(shapes)
    if not closed.any():
        return _nearly_closed(layer)
    as_areas = shapes.copy()
    as_areas[closed] = [filled(line) for line in shapes[closed]]
    said = worded(
        "{n} closed {n:line was|lines were} taken as the outlines of plots.", n=int(closed.sum())
    )
    return replace(layer, geometry=as_areas), [guessed(said)]


def _nearly_closed(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer with lines that end near where they begin as the areas inside them."""
    shapes = shapes_of(layer)
    lines = geometry_kinds(shapes).lines
    some = np.flatnonzero(lines).tolist()
    outlines = {k: found for k in some if (found := nearly_closed(shapes[k])) is not None}
    if not outlines:
        return layer, []
    as_areas = shapes.copy()
    for k, outline in outlines.items():
        as_areas[k] = outline.area
    said = worded(
        "{n} {n:line that ends|lines that end} near where {n:it begins was|they begin were} taken "
        "as the outlines of plots, and closed.",
        n=len(outlines),
    )
    more = [one for outline in outlines.values() for one in outline.messages]
    return replace(layer, geometry=as_areas), [guessed(said), *more]


def _outline(layer: Layer, options: PlotOptions) -> tuple[Layer, list[ImportMessage]] | None:
    """Return points, or the only line, as the one area that they go around; ask if they are."""
    kinds = geometry_kinds(shapes_of(layer))
    n_lines, n_points = int(kinds.lines.sum()), int(kinds.points.sum())
    is_line = n_lines == 1 and not n_points
    if not is_line and (n_lines or are_plants(layer, n_points)):
        return None
    layer = in_order(layer.take(np.flatnonzero(kinds.lines | kinds.points)))
    xy = shapely.get_coordinates(shapes_of(layer))
    outline = outline_of(xy)
    if outline is None or not goes_round(outline.area):
        return None
    if not options.outline:
        raise ChoiceNeeded(
            worded(
                "A plot must be an area, but {name} holds {n} positions on a line that does not "
                "close. Are they its corners, in their order around it? If not, import it as rows "
                "or paths.",
                name=layer.name,
                n=len(xy),
            )
            if is_line
            else worded(
                "A plot must be an area, but {name} holds {n} points. Are they its corners, in "
                "their order around it? If not, import them as plants or records.",
                name=layer.name,
                n=len(xy),
            ),
            "outline",
            ("yes",),
        )
    alike = {name: values[:1] for name, values in layer.columns.items()
             if len({text(value) for value in values}) == 1}  # fmt: skip
    area = np.array([outline.area], dtype=object)
    return replace(layer, columns=alike, geometry=area), [
        taken_as_corners(len(xy)),
        *outline.messages,
    ]


def are_plants(layer: Layer, n_points: int) -> bool:
    """Return whether positions are plants by their numbers: a few corners may be numbered, too.

    The line through many, row up and row down, may cross itself nowhere.
    """
    numbered = any(find(role, layer.columns) for role in ("row", "plant"))
    return numbered and n_points > _MOST_CORNERS_NUMBERED


def taken_as_corners(n_points: int) -> ImportMessage:
    """Return what is said of so many positions that were taken as the corners of a plot."""
    return guessed(
        worded("{n} positions were taken as the corners of one plot, in their order.", n=n_points)
    )


def _refuse_without_areas(layer: Layer, n_lines: int, n_points: int) -> None:
    if n_lines or n_points:
        offers = (("lines",) if n_lines else ()) + (("plants",) if n_points else ())
        what = " and ".join(
            counted(n, word) for n, word in ((n_lines, "line"), (n_points, "point")) if n
        )
        raise ChoiceNeeded(
            worded(
                "A plot must be an area, but {name} holds only {what}. Lines "
                "can be imported as rows or paths, points as plants or "
                "records; or choose a file with the boundary.",
                name=layer.name,
                what=what,
            ),
            "kind",
            offers,
        )
    if not len(layer):
        raise FileProblem(
            worded(
                "{file} must hold at least one plot with a boundary, but it is empty. Choose "
                "another file or layer.",
                file=layer.name,
            )
        )
    raise FileProblem(
        worded(
            "{file} must hold at least one plot with a boundary, but it holds {n} "
            "{n:feature|features} without any geometry. Choose another file or layer.",
            file=layer.name,
            n=len(layer),
        )
    )
