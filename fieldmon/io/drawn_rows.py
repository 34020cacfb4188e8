"""Rows and blocks that are brought with plots: drawn, cut, guessed, or along contours."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np
import shapely
from shapely import LineString, MultiLineString, MultiPolygon

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import FileProblem, PlotError, SettingError
from fieldmon.io.import_report import Imported, doubtful, dropped, guessed, seen
from fieldmon.io.read import read_blocks, read_rows
from fieldmon.plot.block_cutting import blocks_from_outline, cut_blocks
from fieldmon.plot.plot import planting_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.options import Source
    from fieldmon.io.plot_request import PlantingChoices, PlotSources, Role
    from fieldmon.io.rasters.values import RasterOptions
    from fieldmon.io.readers.points_and_lines import DrawnBlocks
    from fieldmon.plot.block import Block
    from fieldmon.plot.field import Field

T = TypeVar("T")
Fields = tuple["Field", ...]

# less of a block than this on a plot, of itself, is drawn beside the plot
_ON_PLOT = 0.01
# more of a plot than this in no block, or of a block in another, is worth a word
_WORTH_A_WORD = 0.01
_NAMED = 5
# rows that rise or fall by less, metres a metre, are as good as level
_LEVEL = 0.03
# a contour may run along the edge of its block
_NEAR_DEG = 1e-7


class Hearing(Protocol):
    """Reads what is brought, and hears what there is to say of it."""

    def read(self, role: Role, source: Source, read: Callable[[], Imported[T]]) -> T:
        """Return what is read, once what it has to say was heard."""

    def say(self, role: Role, source: Source, messages: tuple[ImportMessage, ...]) -> None:
        """Hear what there is to say of a file."""


def with_rows(
    fields: Fields, sources: PlotSources, choices: PlantingChoices, hearing: Hearing
) -> Fields:
    """Return plots with the rows and blocks that were brought with them."""
    many = len(fields) > 1
    if (file := sources.rows) is not None:
        rows = hearing.read("rows", file, partial(read_rows, file, sources.rows_options))
        if many:
            fields = hearing.read("rows", file, partial(rows_of_each, fields, rows))
        else:
            fields = (replace(fields[0], row_lines=rows),)
    fields = _with_blocks(fields, sources, hearing)
    if (raster := sources.contours) is not None:
        fields = _with_contours(fields, raster, (sources, choices), hearing)
    return fields


def rows_of_each(fields: Fields, rows: MultiLineString) -> Imported[Fields]:
    """Return plots with their own of many rows: each is of the plot in which most of it lies."""
    lines = shapely.get_parts(rows)
    tree = shapely.STRtree([field.boundary for field in fields])
    line, plot = tree.query(lines, predicate="intersects")
    inside = shapely.intersection(lines[line], tree.geometries[plot])
    most = shapely.length(inside) > shapely.length(lines[line]) / 2
    line, plot = line[most], plot[most]
    messages = []
    if left := len(lines) - len(np.unique(line)):
        messages.append(
            dropped(
                worded(
                    "{left} {left:row that lies|rows that lie} on no plot {left:was|were} left "
                    "out.",
                    left=left,
                )
            )
        )
    if bare := len(fields) - len(np.unique(plot)):
        messages.append(
            seen(
                worded(
                    "On {bare} of {n} plots no rows were drawn; straight ones are laid.",
                    bare=bare,
                    n=len(fields),
                )
            )
        )
    found = tuple(
        replace(field, row_lines=MultiLineString(list(lines[line[plot == k]])))
        for k, field in enumerate(fields)
    )
    return Imported(found, tuple(messages))


def _with_contours(
    fields: Fields, raster: Source, told: tuple[PlotSources, PlantingChoices], hearing: Hearing
) -> Fields:
    """Return plots with the contours along which their rows run."""
    contour = partial(_with_contour, sources=told[0], choices=told[1])
    many = len(fields) > 1
    found = [
        hearing.read("contours", raster, partial(contour, field, many=many)) for field in fields
    ]
    if all(field.row_lines.is_empty for field in found):  # no plot has one: say why
        hearing.read("contours", raster, partial(contour, fields[0], many=False))
    return tuple(found)


def _with_contour(
    field: Field, sources: PlotSources, choices: PlantingChoices, *, many: bool
) -> Imported[Field]:
    """Return a plot with the contour along which its rows run; of many, one may do without."""
    source = sources.contours
    if source is None:
        return Imported(field)
    options = sources.contours_options
    rows: list[LineString] = []
    messages: list[ImportMessage] = []
    for part in _parts(field):
        spacing_m = planting_of(part, **choices.given()).row_spacing_m
        try:
            read = contour_of(part, source, spacing_m, options)
        except (PlotError, FileProblem) as problem:
            if not many and (not field.blocks or isinstance(problem, FileProblem)):
                raise
            several = "{n} plots or blocks have no contour, and straight rows are laid"
            said = doubtful(
                worded(
                    "{problem} Straight rows are laid.",
                    problem=problem,
                ),
                part.name,
                many=several,
            )
            messages.append(said)
            continue
        rows += read.value.geoms
        about = part.name if many or field.blocks else None
        messages += [replace(message, feature=about) for message in read.messages]
    return Imported(replace(field, row_lines=MultiLineString(rows)), tuple(messages))


def _parts(field: Field) -> Fields:
    """Return the blocks of a plot as plots, or the plot itself if it has none."""
    return tuple(
        replace(
            field,
            name=f"{field.name}, block {block.name or number}",
            boundary=_areas(shapely.intersection(block.area, field.boundary)),
            row_spacing_m=block.row_spacing_m or field.row_spacing_m,
            blocks=(),
        )
        for number, block in enumerate(field.blocks, 1)
    ) or (field,)


def contour_of(
    field: Field, source: Source, row_spacing_m: float, options: RasterOptions | None = None
) -> Imported[MultiLineString]:
    """Return the contour through the middle of a plot, of which its rows are copies.

    And how far these are level: where contours come nearer to each other or part, rows that keep
    their distance leave them.
    """
    from fieldmon.io.rasters.read import read_raster  # noqa: PLC0415 - half a second
    from fieldmon.plot.row_drawing import contour_row, falls_along  # noqa: PLC0415

    read = read_raster(source, options, field)

    def height_m(lonlat: NDArray[np.float64]) -> NDArray[np.float64]:
        return read.value.at(lonlat, "bilinear")

    row = contour_row(field, height_m, row_spacing_m)
    said = seen(
        worded("Rows run along the contour through the middle of the plot, all others beside it.")
    )
    falls = falls_along(field, row, row_spacing_m, height_m)
    inside = shapely.intersection(row, shapely.buffer(field.boundary, _NEAR_DEG))
    longest = max(shapely.get_parts(inside), key=shapely.length)
    return read.having(MultiLineString([longest]), [said, *_about_falls(falls)])


def _about_falls(falls: NDArray[np.float64]) -> list[ImportMessage]:
    """Return what to say of rows that should be level, and fall ``(k,)`` metres a metre."""
    if not len(falls):
        return []
    steep = float(np.mean(falls > _LEVEL))
    if steep <= _WORTH_A_WORD:
        told = worded("They rise or fall by {most:.1%} at most.", most=float(falls.max()))
        return [seen(told)]
    return [
        doubtful(
            worded(
                "Contours come nearer to each other or part, and rows that keep their distance "
                "leave them: {share:.0%} of their length rises or falls by more than {level:.0%}, "
                "{most:.0%} at most. Part the plot by lines: each block follows a contour of its "
                "own.",
                share=steep,
                level=_LEVEL,
                most=float(falls.max()),
            )
        )
    ]


def _with_blocks(fields: Fields, sources: PlotSources, hearing: Hearing) -> Fields:
    """Return plots with their blocks, as drawn, cut or guessed."""
    file, plot = sources.blocks, sources.plot
    if file is not None and sources.guess_blocks:
        raise SettingError(
            worded("Blocks are drawn or guessed: give a file of blocks, or let them be.")
        )
    if file is not None:

        def read() -> Imported[Fields]:
            return parted(fields, read_blocks(file, sources.blocks_options))

        return hearing.read("blocks", file, read)
    if sources.guess_blocks and plot is not None:
        return hearing.read("plot", plot, partial(guess_each, fields))
    return fields


def parted(fields: Fields, drawn: Imported[DrawnBlocks]) -> Imported[Fields]:
    """Return plots with the blocks that were drawn, as areas or as lines that part them."""
    areas, cuts = drawn.value
    made = blocks_of_each(fields, areas) if areas else cut_each(fields, cuts)
    return drawn.having(made.value, made.messages)


def blocks_of_each(fields: Fields, areas: tuple[Block, ...]) -> Imported[Fields]:
    """Return plots with those of many blocks that lie on them."""
    found, messages, used = [], [], 0
    for field in fields:
        blocks, said = blocks_on(field, areas)
        used += len(blocks)
        found.append(replace(field, blocks=blocks) if blocks else field)
        messages += said
    if not used:
        raise PlotError(
            worded(
                "Blocks must lie on a plot, but none of {n} does. Choose the "
                "plot's own blocks, or check the coordinate systems.",
                n=len(areas),
            )
        )
    if len(areas) > used:
        messages.append(
            dropped(
                worded("{n} {n:block lies|blocks lie} on none of the plots.", n=len(areas) - used)
            )
        )
    return Imported(tuple(found), tuple(messages))


def blocks_on(
    field: Field, areas: tuple[Block, ...]
) -> tuple[tuple[Block, ...], list[ImportMessage]]:
    """Return the blocks that lie on a plot, none over another, and what there is to say."""
    frame, left = field.frame(), field.boundary
    blocks: list[Block] = []
    doubled: list[str] = []
    for block in areas:
        here = _areas(shapely.intersection(block.area, field.boundary))
        if here.area <= _ON_PLOT * block.area.area:
            continue
        own = _areas(shapely.intersection(here, left))
        if own.area < (1 - _WORTH_A_WORD) * here.area:
            doubled.append(block.name)
        if own.area <= _ON_PLOT * block.area.area:
            continue
        blocks.append(replace(block, area=own))
        left = _areas(shapely.difference(left, own))
    messages: list[ImportMessage] = []
    if not blocks:
        return (), messages
    names = first_few([block.name for block in blocks], _NAMED)
    said = worded("Rows run in {n} {n:block|blocks} as drawn: {names}.", n=len(blocks), names=names)
    messages.append(seen(said))
    if doubled:
        over = ", ".join(doubled[:_NAMED])
        said = worded("Blocks lie over others: {names}. The first one counts.", names=over)
        messages.append(doubtful(said))
    bare = left.area / field.boundary.area
    if bare > _WORTH_A_WORD:
        bare_m2 = frame.geometry_m(left).area
        messages.append(
            doubtful(
                worded(
                    "{share:.0%} of the plot ({area:.0f} m2) lies in no block, and is left without "
                    "plants.",
                    share=bare,
                    area=bare_m2,
                )
            )
        )
    return tuple(blocks), messages


def _areas(shape: shapely.Geometry) -> MultiPolygon:
    every = shapely.get_parts(shape)
    parts = [part for part in every if part.geom_type == "Polygon" and part.area > 0]
    return MultiPolygon(parts)


def cut_each(fields: Fields, cuts: MultiLineString) -> Imported[Fields]:
    """Return plots parted into blocks by lines."""
    found, n_parted = [], 0
    for field in fields:
        parted = field
        for line in cuts.geoms:
            try:
                parted = replace(parted, blocks=cut_blocks(parted, line))
                n_parted += 1
            except PlotError:
                if len(fields) == len(cuts.geoms) == 1:
                    raise
        found.append(parted)
    if not n_parted:
        raise PlotError(
            worded(
                "A cut must pass through its plot from one side to the other, but "
                "none of {n} lines does. Draw them across the plot.",
                n=len(cuts.geoms),
            )
        )
    return Imported(tuple(found), tuple(_about_cuts(found, n_parted, len(cuts.geoms))))


def _about_cuts(parted: Sequence[Field], n_parted: int, n_lines: int) -> list[ImportMessage]:
    """Return what lines did to plots: of `n_lines`, `n_parted` parted one."""
    blocks = sum(len(field.blocks) for field in parted)
    if len(parted) > 1:
        said = worded(
            "{n} {n:line parts|lines part} plots into {blocks} blocks.", n=n_parted, blocks=blocks
        )
    else:
        said = worded(
            "{n} {n:line parts|lines part} the plot into {blocks} blocks.",
            n=n_parted,
            blocks=blocks,
        )
    messages = [seen(said)]
    if (idle := n_lines - n_parted) > 0:
        messages.append(
            dropped(
                worded(
                    "{idle} {idle:line passes|lines pass} through no plot and "
                    "{idle:parts|part} nothing.",
                    idle=idle,
                )
            )
        )
    return messages


def guess_each(fields: Fields) -> Imported[Fields]:
    """Return plots with blocks guessed from their outlines."""
    found, messages = [], []
    for field in fields:
        if blocks := blocks_from_outline(field):
            field = replace(field, blocks=blocks)  # noqa: PLW2901 - the same plot, in blocks
            said = worded(
                "{n} blocks were guessed from the outline: look at the rows.",
                n=len(blocks),
            )
            messages.append(guessed(said, field.name if len(fields) > 1 else None))
        found.append(field)
    if not messages:
        messages.append(
            seen(worded("The outline asks for no blocks: rows of one direction fill it well."))
        )
    return Imported(tuple(found), tuple(messages))
