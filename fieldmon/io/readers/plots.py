"""Plots out of a layer: which features, how they are called, and where they lie."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiLineString, MultiPolygon, Polygon

from fieldmon.compute.wording import counted, first_few, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    doubtful,
    dropped,
    gathered,
    guessed,
    seen,
)
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.parse.crs import middle_of, system, transformation_from, utm_zone
from fieldmon.io.parse.geometry import boundaries, boundary, closed_lines, filled, geometry_kinds
from fieldmon.io.parse.georeference import few_unplaceable, place_geometry, written
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.utm_zones import of_another_zone, stated_zone
from fieldmon.io.readers.known_rows import KnownRows, known_rows
from fieldmon.io.readers.walked_outline import (
    MOST_CORNERS,
    goes_round,
    in_order,
    nearly_closed,
    not_in_order,
    outline_of,
)
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.polygons import polygons_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import PlotOptions


def plots_of(layer: Layer, options: PlotOptions) -> Imported[tuple[Field, ...]]:
    """Return the plots of a layer, each valid and in degrees WGS84."""
    if layer.geometry is None:
        return _plot_of_corners(layer, options)
    areas, messages = _areas(layer, options)
    named, said = stated_zone(areas, _middles(_shapes(areas)), options, areas.crs)
    messages += said
    if named is not None:
        areas = replace(areas, crs=named)
    if options.column("block") is not None:
        return _with_blocks(areas, options, (*layer.messages, *messages))
    names, name_messages = plot_names(areas, options.name_column)
    number = _number(names, options.feature)
    chosen = np.arange(len(names)) if number else _chosen(names, options.feature)
    mistyped = _mistyped(_shapes(areas)[chosen], areas.crs, options)
    name_messages += _left_out(mistyped, [names[i] for i in chosen])
    chosen = np.delete(chosen, list(mistyped))
    placed, place_messages = place_geometry(_shapes(areas)[chosen], areas.crs, options)
    place_messages += _in_another_zone(areas, names, chosen, options)
    known, row_messages = known_rows(areas, names)
    fields, shape_messages = _fields(placed, [names[i] for i in chosen], known)
    if number:
        fields, shape_messages = _numbered(fields, shape_messages, number)
    name_messages += _named_by_number(names, options.feature)
    found = (*layer.messages, *messages, *name_messages, *place_messages, *shape_messages)
    return Imported(fields, gathered((*found, *row_messages)))


def _mistyped(
    shapes: NDArray[np.object_], crs: str | None, options: PlotOptions
) -> dict[int, tuple[int, str]]:
    """Return, by area, the number of its first corner that lies nowhere on the earth, and it."""
    xy, of = shapely.get_coordinates(shapes, return_index=True)
    corner = np.arange(len(xy)) - np.searchsorted(of, of)
    # an outline ends where it begins: that corner counts once
    open_end = np.flatnonzero(np.append(of[1:] == of[:-1], False))
    wrong = open_end[few_unplaceable(xy[open_end], crs, options)]
    return {int(of[k]): (int(corner[k]) + 1, written(xy[k])) for k in wrong[::-1].tolist()}


def _left_out(mistyped: dict[int, tuple[int, str]], names: list[str]) -> list[ImportMessage]:
    """Return a message for each plot with a mistyped corner; refuse where no other is left."""
    if mistyped and len(mistyped) == len(names):
        raise _wrong_corner(names[0], *mistyped[0])
    many = "{n} plots have a corner that lies nowhere on the earth, and were left out"
    return [
        dropped(
            worded(
                "Corner {number}, {at}, lies nowhere on the earth: correct it. The plot was left "
                "out.",
                number=number,
                at=at,
            ),
            names[k],
            many=many,
        )
        for k, (number, at) in sorted(mistyped.items())
    ]


def _wrong_corner(name: str, number: int, at: str) -> FileProblem:
    return FileProblem(
        worded(
            "Every corner of {name} must lie on the earth, but corner {number}, {at}, does not. "
            "Correct it.",
            name=name,
            number=number,
            at=at,
        )
    )


def _middles(shapes: NDArray[np.object_]) -> NDArray[np.float64]:
    """Return the middle of the bounds of each shape ``(n, 2)``, as the file writes it."""
    west, south, east, north = shapely.bounds(shapes).T
    return np.stack([west + east, south + north], axis=1) / 2


def _in_another_zone(
    areas: Layer, names: list[str], chosen: NDArray[np.int64], options: PlotOptions
) -> tuple[ImportMessage, ...]:
    """Return a doubt where plots, read in one UTM zone, seem to be written in the next."""
    crs = system(options.crs or areas.crs or "")
    zone, xy = utm_zone(crs), _middles(_shapes(areas))
    if options.swap_axes:
        xy = xy[:, ::-1]
    if zone is None or len(xy) < _TWO:
        return ()
    far = of_another_zone(transformation_from(crs, middle_of(xy)).lonlat(xy), zone)
    some = [] if far is None else [names[k] for k in chosen.tolist() if far.which[k]]
    if far is None or not some:
        return ()
    return (
        doubtful(
            worded(
                "{n} {n:plot lies|plots lie} {away:.0f} km from the others ({names}), but as UTM "
                "zone {zone} {n:it|they} would lie {near:.0f} km from them. If {n:it is|they are} "
                "of that zone, bring all plots into one, or those of each into a file of its own.",
                n=len(some),
                away=far.away_km,
                names=first_few(some),
                zone=far.zone,
                near=far.near_km,
            )
        ),
    )


def _with_blocks(
    areas: Layer, options: PlotOptions, messages: tuple[ImportMessage, ...]
) -> Imported[tuple[Field, ...]]:
    """Return plots of which each feature is a block: those of one name are a plot."""
    names, blocks = _block_names(areas, options)
    # without one of its blocks it is another plot
    for k, wrong in sorted(_mistyped(_shapes(areas), areas.crs, options).items()):
        raise _wrong_corner(f"{names[k]} / {blocks[k]}", *wrong)
    placed, place_messages = place_geometry(_shapes(areas), areas.crs, options)
    place_messages += _in_another_zone(areas, names, np.arange(len(names)), options)
    apart = _told_apart([f"{name} / {block}" for name, block in zip(names, blocks, strict=True)])
    known, row_messages = known_rows(areas, apart)
    parts, shape_messages = _fields(placed, apart, known)
    called = dict(zip(apart, zip(names, blocks, strict=True), strict=True))
    plots: dict[str, list[Block]] = {}
    for part in parts:
        name, block = called[part.name]
        plots.setdefault(name, []).append(_block(part, block))
    fields = [_of_blocks(name, own) for name, own in plots.items()]
    said = seen(
        worded(
            "{n} features are the blocks of {plots} {plots:plot|plots}.",
            n=len(parts),
            plots=len(fields),
        )
    )
    number = _number(list(plots), options.feature)
    if number > len(fields):
        raise _which_plot(list(plots), str(number))
    chosen = [number - 1] if number else _chosen(list(plots), options.feature).tolist()
    found = (*messages, *place_messages, *shape_messages, *row_messages, said)
    return Imported(tuple(fields[k] for k in chosen), gathered(found))


def _block_names(areas: Layer, options: PlotOptions) -> tuple[list[str], list[str]]:
    """Return the plot and the block of each feature; without names all are of one plot."""
    column = options.column("block") or ""
    blocks = [text(value) for value in areas.column(column)]
    others = {name: values for name, values in areas.columns.items() if name != column}
    named = options.name_column or _name_column(replace(areas, columns=others))
    if named is None:
        return [areas.name] * len(areas), blocks
    return [text(value) or areas.name for value in areas.column(named)], blocks


def _block(part: Field, name: str) -> Block:
    stated = part.row_bearing_deg, part.row_spacing_m, part.plant_spacing_m
    return Block(name, part.boundary, *stated)


def _of_blocks(name: str, blocks: list[Block]) -> Field:
    """Return the plot that blocks make up."""
    whole = shapely.union_all([block.area for block in blocks])
    return Field(name, polygons_of(whole), blocks=tuple(blocks))


def blocks_of(layer: Layer, options: PlotOptions) -> Imported[tuple[Block, ...]]:
    """Return the areas of a layer as blocks of a plot."""
    read = plots_of(layer, options)
    return read.having(tuple(_block(field, field.name) for field in read.value))


def _asked(feature: str | int | None) -> tuple[str, int]:
    """Return the plot that is asked for, and its number if that is one, else 0."""
    wanted = "" if feature is None else str(feature).strip()
    return wanted, int(wanted) if re.fullmatch(r"[0-9]{1,9}", wanted) else 0


def _number(names: list[str], feature: str | int | None) -> int:
    """Return the number of the plot that is wanted, 0 where it is named or all are."""
    wanted, number = _asked(feature)
    return 0 if wanted in names else number


def _named_by_number(names: list[str], feature: str | int | None) -> list[ImportMessage]:
    """Return what to say of a plot that was chosen by a name which is another one's number."""
    wanted, number = _asked(feature)
    if wanted not in names or not 0 < number <= len(names) or names[number - 1] == wanted:
        return []
    return [
        seen(
            worded(
                "{wanted} was taken as the plot's name; number {wanted} of the list is {other!r}.",
                wanted=wanted,
                other=names[number - 1],
            )
        )
    ]


def _numbered(
    fields: tuple[Field, ...], messages: list[ImportMessage], number: int
) -> tuple[tuple[Field, ...], list[ImportMessage]]:
    """Return the plot with a number, as `fieldmon plots` counts those that can be used."""
    if number > len(fields):
        raise _which_plot([f.name for f in fields], str(number))
    one = fields[number - 1]
    others = {field.name for field in fields} - {one.name}
    return (one,), [message for message in messages if message.feature not in others]


def named_areas(layer: Layer, options: PlotOptions) -> tuple[Layer, list[str]]:
    """Return the features of a layer that are plots, and the name of each."""
    if layer.geometry is None:
        return layer.take(np.arange(0)), []
    areas, _ = _areas(layer, options)
    if options.column("block") is not None:
        return areas, _block_names(areas, options)[0]
    return areas, plot_names(areas, options.name_column)[0]


def _shapes(layer: Layer) -> NDArray[np.object_]:
    if layer.geometry is None:
        raise FileProblem(
            worded("{file} must hold shapes, but it is a plain table.", file=layer.name)
        )
    return layer.geometry


def plot_names(layer: Layer, column: str | None) -> tuple[list[str], list[ImportMessage]]:
    """Return a different name for every feature, and where the names come from."""
    named = column or _name_column(layer)
    messages: list[ImportMessage] = []
    if named is None:
        base = [layer.plot_name] * len(layer)
        if len(layer) > 1:
            messages.append(
                guessed(worded("No column was recognised as the plots' names; they are numbered."))
            )
    else:
        try:
            cells = layer.column(named)
        except ChoiceNeeded as asked:
            raise ChoiceNeeded(asked.args[0], "name_column", asked.choices) from None
        base = [text(v) or layer.plot_name for v in cells]
        if len(layer) > 1 or column is None:
            messages.append(seen(worded("Plots are named by column {name!r}.", name=named)))
    return _told_apart(base), messages


def _name_column(layer: Layer) -> str | None:
    """Return the column that names plots: the first that says anything, by what it is called."""
    said = [name for name in layer.columns if any(text(v) for v in layer.columns[name])]
    return find("name", said) or next((name for name in said if "name" in plain(name)), None)


def _told_apart(names: list[str]) -> list[str]:
    """Return names that differ: those that repeat are numbered."""
    total, so_far = Counter(names), Counter[str]()
    apart = []
    for name in names:
        so_far[name] += 1
        apart.append(name if total[name] == 1 else f"{name} ({so_far[name]})")
    return apart


def _areas(layer: Layer, options: PlotOptions) -> tuple[Layer, list[ImportMessage]]:
    """Return the features that have an area; offer lines and points for what they can be."""
    messages: list[ImportMessage] = []
    areas, lines, points = geometry_kinds(_shapes(layer))
    if not areas.any() and lines.any():
        layer, messages = _outlines(layer)
        areas, lines, points = geometry_kinds(_shapes(layer))
    if not areas.any() and (outline := _outline(layer, options)) is not None:
        layer, more = outline
        messages = [*messages, *more]
        areas, lines, points = geometry_kinds(_shapes(layer))
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


def _outlines(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer with closed lines as the areas inside them."""
    shapes = _shapes(layer)
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
    shapes = _shapes(layer)
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
    kinds = geometry_kinds(_shapes(layer))
    n_lines, n_points = int(kinds.lines.sum()), int(kinds.points.sum())
    is_line = n_lines == 1 and not n_points
    if not is_line and (n_lines or _are_plants(layer, n_points)):
        return None
    layer = in_order(layer.take(np.flatnonzero(kinds.lines | kinds.points)))
    xy = shapely.get_coordinates(_shapes(layer))
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
    return replace(layer, columns=alike, geometry=area), [_taken(len(xy)), *outline.messages]


def _are_plants(layer: Layer, n_points: int) -> bool:
    """Return whether positions are plants by their numbers: a few corners may be numbered, too.

    The line through many, row up and row down, may cross itself nowhere.
    """
    numbered = any(find(role, layer.columns) for role in ("row", "plant"))
    return numbered and n_points > _MOST_CORNERS_NUMBERED


def _taken(n_points: int) -> ImportMessage:
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


def _chosen(names: list[str], feature: str | int | None) -> NDArray[np.int64]:
    """Return which features are wanted, by name."""
    if feature is None:
        return np.arange(len(names))
    wanted = str(feature).strip()
    if wanted in names:
        return np.array([names.index(wanted)])
    alike = [n for n in names if wanted.casefold() in n.casefold()]
    if len(alike) == 1:
        return np.array([names.index(alike[0])])
    raise _which_plot(names, wanted, alike)


def _which_plot(names: list[str], wanted: str, alike: list[str] | None = None) -> ChoiceNeeded:
    offered = alike or names
    said = {"n": len(names), "wanted": wanted, "names": ", ".join(offered[:20])}
    return ChoiceNeeded(
        worded(
            "There {n:is|are} {n} {n:plot|plots}, but none is called {wanted!r}: several have it "
            "in their names. Choose one of: {names}; or its number from 1, as fieldmon plots lists "
            "it.",
            **said,
        )
        if alike
        else worded(
            "There {n:is|are} {n} {n:plot|plots}, but none is called {wanted!r}. Choose one of: "
            "{names}; or its number from 1, as fieldmon plots lists it.",
            **said,
        ),
        "feature",
        tuple(offered),
    )


def _fields(
    geometry: NDArray[np.object_], names: list[str], known: dict[str, KnownRows]
) -> tuple[tuple[Field, ...], list[ImportMessage]]:
    kept, messages = boundaries(geometry, names)
    fields = []
    is_left = ~shapely.is_empty(kept)
    for i in np.flatnonzero(~is_left).tolist():
        many = "Nothing is left to use of {n} plots"
        messages.append(
            dropped(worded("Nothing of this plot is left to use."), names[i], many=many)
        )
    for i in np.flatnonzero(is_left).tolist():
        rows = known.get(names[i], _UNKNOWN_ROWS)._asdict()
        # what no plot of a file has is one object for all of them, sent and kept but once
        fields.append(
            Field(names[i], kept[i], no_go=_NO_AREA, paths=_NO_LINES, row_lines=_NO_LINES, **rows)
        )
    if not fields:
        said = "; ".join(f.sentence for f in messages[:5])
        raise FileProblem(
            worded("At least one plot must have an area, but none has. {said}", said=said)
        )
    return tuple(fields), [*messages, *_parts(fields), *_duplicates(fields)]


_TWO = 2
# a table of more positions with a number of their row or plant lists plants
_MOST_CORNERS_NUMBERED = 20
# so few positions are corners rather than plants
_FEW_CORNERS = 6
_NO_AREA, _NO_LINES, _UNKNOWN_ROWS = MultiPolygon(), MultiLineString(), KnownRows()


def _parts(fields: list[Field]) -> list[ImportMessage]:
    """Say which plots have several parts, or holes."""
    shapes = [f.boundary for f in fields]
    polygons, plot = shapely.get_parts(shapes, return_index=True)
    n_parts = np.bincount(plot, minlength=len(fields))
    n_holes = np.bincount(plot, shapely.get_num_interior_rings(polygons), len(fields))
    is_around = [n > 1 and k > 0 and _has_island(one)
                 for n, k, one in zip(n_parts, n_holes, shapes, strict=True)]  # fmt: skip
    messages = []
    if (n_parts > 1).any():
        several = _names(fields, n_parts > 1)
        said = worded(
            "{n} {n:plot has|plots have} several parts, which were kept: {names}.",
            n=len(several), names=first_few(several),
        )  # fmt: skip
        own = worded("It has several parts, which were kept.")
        messages.append(replace(seen(said), each=tuple(seen(own, one) for one in several)))
    if n_holes.any():
        holed = _names(fields, n_holes > 0)
        said = worded(
            "{n} {n:plot has|plots have} holes, kept as places without plants: {names}.",
            n=len(holed), names=first_few(holed),
        )  # fmt: skip
        own = worded("It has holes, kept as places without plants.")
        messages.append(replace(seen(said), each=tuple(seen(own, one) for one in holed)))
    if any(is_around):
        around = _names(fields, np.array(is_around))
        said = worded(
            "{n} {n:plot has|plots have} a part in a hole of another, and routes lead "
            "straight across that hole: {names}. Where nobody can, make the part a plot.",
            n=len(around), names=first_few(around),
        )  # fmt: skip
        own = worded(
            "It has a part in a hole of another, and routes lead straight across that hole. Where "
            "nobody can, make the part a plot."
        )
        messages.append(replace(doubtful(said), each=tuple(doubtful(own, one) for one in around)))
    return messages


def _names(fields: list[Field], which: NDArray[np.bool_]) -> list[str]:
    return [fields[i].name for i in np.flatnonzero(which)]


def _has_island(boundary: MultiPolygon) -> bool:
    """Return whether a part of a plot lies in a hole of another."""
    tree = shapely.STRtree(list(boundary.geoms))
    holes = [Polygon(ring) for part in boundary.geoms for ring in part.interiors]
    return bool(tree.query(holes, predicate="contains").size)


def _duplicates(fields: list[Field]) -> list[ImportMessage]:
    bounds = shapely.bounds([field.boundary for field in fields])
    _, same, times = np.unique(bounds, axis=0, return_inverse=True, return_counts=True)
    first: dict[bytes, str] = {}
    messages = []
    for i in np.flatnonzero(times[same.ravel()] > 1).tolist():
        field = fields[i]
        key = shapely.to_wkb(shapely.normalize(field.boundary))
        if key in first:
            said = worded("It has the same outline as {value}.", value=first[key])
            many = "{n} plots have the same outline as another"
            messages.append(doubtful(said, field.name, many=many))
        first.setdefault(key, field.name)
    return messages


def _plot_of_corners(layer: Layer, options: PlotOptions) -> Imported[tuple[Field, ...]]:
    """Return the one plot whose corners a table lists in order."""
    layer = in_order(layer)
    found = located(layer, options)
    points, messages = found.lonlat, found.messages
    if options.where is None and _are_plants(layer, len(points)):
        raise _no_outline(layer, len(points))
    if not 3 <= len(points) <= MOST_CORNERS:
        raise _which_are_corners(layer, len(points))
    if found.unread is not None and found.unread.written:
        record, at = next(iter(found.unread.written.items()))
        raise _wrong_corner(layer.name, record + 1, at)
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
    told = (*layer.messages, *messages, _taken(len(points)), *more)
    return Imported((Field(_name_of_corners(layer, options), kept),), told)


def _name_of_corners(layer: Layer, options: PlotOptions) -> str:
    """Return what the plot is called whose corners were chosen: by what, or else by its file."""
    column, _, value = (options.where or "").partition("=")
    return value if column == _name_column(layer) or find("plot", [column]) else layer.plot_name


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
