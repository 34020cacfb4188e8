"""Plots out of a layer, each valid and in degrees WGS84, alone or made up of blocks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiLineString, MultiPolygon

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import Imported, ImportMessage, dropped, gathered, seen
from fieldmon.io.parse.geometry import boundaries
from fieldmon.io.parse.georeference import place_geometry
from fieldmon.io.parse.utm_zones import stated_zone
from fieldmon.io.readers.chosen_plots import (
    asked_by_name,
    named_by_number,
    number_asked,
    numbered,
    which_plot,
)
from fieldmon.io.readers.known_rows import KnownRows, known_rows
from fieldmon.io.readers.misplaced_plots import (
    in_another_zone,
    middles_of,
    mistyped_corners,
    said_of_mistyped,
    wrong_corner,
)
from fieldmon.io.readers.plot_areas import areas_of, shapes_of
from fieldmon.io.readers.plot_corners import plot_of_corners
from fieldmon.io.readers.plot_names import block_names, plot_names, told_apart
from fieldmon.io.readers.plot_shapes import said_of_shapes
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.polygons import polygons_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import PlotOptions

_NO_AREA, _NO_LINES, _UNKNOWN_ROWS = MultiPolygon(), MultiLineString(), KnownRows()


def plots_of(layer: Layer, options: PlotOptions) -> Imported[tuple[Field, ...]]:
    """Return the plots of a layer, each valid and in degrees WGS84."""
    if layer.geometry is None:
        return plot_of_corners(layer, options)
    areas, messages = areas_of(layer, options)
    areas, said = _in_stated_zone(areas, options)
    messages += said
    if options.column("block") is not None:
        return _with_blocks(areas, options, (*layer.messages, *messages))
    names, name_messages = plot_names(areas, options.name_column)
    number = number_asked(names, options.feature)
    chosen = np.arange(len(names)) if number else asked_by_name(names, options.feature)
    mistyped = mistyped_corners(shapes_of(areas)[chosen], areas.crs, options)
    name_messages += said_of_mistyped(mistyped, [names[i] for i in chosen])
    chosen = np.delete(chosen, list(mistyped))
    placed, place_messages = place_geometry(shapes_of(areas)[chosen], areas.crs, options)
    place_messages += in_another_zone(areas, names, chosen, options)
    known, row_messages = known_rows(areas, names)
    fields, shape_messages = _fields(placed, [names[i] for i in chosen], known)
    if number:
        fields, shape_messages = numbered(fields, shape_messages, number)
    name_messages += named_by_number(names, options.feature)
    found = (*layer.messages, *messages, *name_messages, *place_messages, *shape_messages)
    return Imported(fields, gathered((*found, *row_messages)))


def _in_stated_zone(areas: Layer, options: PlotOptions) -> tuple[Layer, list[ImportMessage]]:
    """Return areas in the UTM zone that the file states, if it does."""
    stated, said = stated_zone(areas, middles_of(shapes_of(areas)), options, areas.crs)
    return (areas if stated is None else replace(areas, crs=stated)), said


def blocks_of(layer: Layer, options: PlotOptions) -> Imported[tuple[Block, ...]]:
    """Return the areas of a layer as blocks of a plot."""
    read = plots_of(layer, options)
    return read.having(tuple(_block(field, field.name) for field in read.value))


def named_areas(layer: Layer, options: PlotOptions) -> tuple[Layer, list[str]]:
    """Return the features of a layer that are plots, and the name of each."""
    if layer.geometry is None:
        return layer.take(np.arange(0)), []
    areas, _ = areas_of(layer, options)
    if options.column("block") is not None:
        return areas, block_names(areas, options)[0]
    return areas, plot_names(areas, options.name_column)[0]


def _with_blocks(
    areas: Layer, options: PlotOptions, messages: tuple[ImportMessage, ...]
) -> Imported[tuple[Field, ...]]:
    """Return plots of which each feature is a block: those of one name are a plot."""
    names, blocks = block_names(areas, options)
    # without one of its blocks it is another plot
    for k, wrong in sorted(mistyped_corners(shapes_of(areas), areas.crs, options).items()):
        raise wrong_corner(f"{names[k]} / {blocks[k]}", *wrong)
    placed, place_messages = place_geometry(shapes_of(areas), areas.crs, options)
    place_messages += in_another_zone(areas, names, np.arange(len(names)), options)
    apart = told_apart([f"{name} / {block}" for name, block in zip(names, blocks, strict=True)])
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
    number = number_asked(list(plots), options.feature)
    if number > len(fields):
        raise which_plot(list(plots), str(number))
    chosen = [number - 1] if number else asked_by_name(list(plots), options.feature).tolist()
    found = (*messages, *place_messages, *shape_messages, *row_messages, said)
    return Imported(tuple(fields[k] for k in chosen), gathered(found))


def _block(part: Field, name: str) -> Block:
    stated = part.row_bearing_deg, part.row_spacing_m, part.plant_spacing_m
    return Block(name, part.boundary, *stated)


def _of_blocks(name: str, blocks: list[Block]) -> Field:
    """Return the plot that blocks make up."""
    whole = shapely.union_all([block.area for block in blocks])
    return Field(name, polygons_of(whole), blocks=tuple(blocks))


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
    return tuple(fields), [*messages, *said_of_shapes(fields)]
