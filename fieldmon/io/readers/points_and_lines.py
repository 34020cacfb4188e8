"""Plants out of points, and rows or paths out of lines."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely import MultiLineString

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    Remedy,
    doubtful,
    dropped,
    guessed,
    seen,
)
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.geometry import closed_lines, geometry_kinds
from fieldmon.io.parse.georeference import place_geometry
from fieldmon.io.parse.positions import located
from fieldmon.io.readers.inspection_file.columns import faces_named
from fieldmon.io.readers.places import Plants
from fieldmon.io.readers.plots import blocks_of
from fieldmon.plot.near_doubles import near_doubles
from fieldmon.plot.plant_columns import plant_columns
from fieldmon.plot.rounding import doubts_of_rounding
from fieldmon.plot.row_detection import SAME_PLANT_M, distinct, frame_around
from fieldmon.plot.row_drawing import rows_from_posts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import PlotOptions, ReadOptions
    from fieldmon.io.parse.positions import LocatedFeatures
    from fieldmon.plot.block import Block


# so far from its third neighbour, and so many times as far as usual, a plant is no neighbour's;
# fewer plants do not tell
_STRAY_M, _STRAY_TIMES, _ENOUGH = 100.0, 20.0, 20
# farther, one plant in more than so many is mistyped and no small plot of its own
_FAR_M, _RARE = 1000.0, 10
# no plot is so wide
_ELSEWHERE_DEG = 1.0
# so many positions may be corners of a plot that holds such a share of the others, and so many
# marks tell them from plants
_LEAST_CORNERS, _MOST_CORNERS, _MOST_MARKS = 3, 20, 20
_HELD = 0.95


class DrawnBlocks(NamedTuple):
    """Blocks as they were drawn: areas, or lines that part a plot into blocks, lon/lat."""

    areas: tuple[Block, ...]
    cuts: MultiLineString

    def __repr__(self) -> str:
        return f"<DrawnBlocks: {len(self.areas)} areas, {len(self.cuts.geoms)} lines>"


def plants_of(layer: Layer, options: ReadOptions) -> Imported[Plants]:
    """Return the plants of a layer of points, or of a table with positions."""
    found = located(layer, options)
    names, columns, said_of_names = _named(found.layer, options)
    block, row, plant = names
    corners, said_of_corners = _corners_among(found.layer, found.lonlat, options)
    gone, said_of_gone = _in_another_part(found.lonlat, plant, corners)
    here = np.flatnonzero(~gone)
    coarse = doubts_of_rounding(found.lonlat[here], found.step_m, row[here], FileProblem)
    kept, said_of_doubles = _one_of_each(found, here, options)
    left_out, said_of_strays = _strays(found.lonlat[kept], plant[kept], options)
    said = [
        *said_of_names,
        *said_of_corners,
        *said_of_gone,
        *map(doubtful, coarse),
        *said_of_doubles,
        *_of_near_doubles(found.lonlat[kept]),
        *said_of_strays,
    ]
    kept = kept[~left_out]
    block, row, plant = (name[kept] for name in names)
    plants = Plants(found.lonlat[kept], row, plant, block if (block != "").any() else None)
    for role, of_role in (("block", block), ("row", row)):
        if role in columns and (of_role == "").any():
            said.append(_of_blanks(of_role, columns[role]))
    return Imported(plants, (*layer.messages, *found.messages, *said))


def _named(
    layer: Layer, options: ReadOptions
) -> tuple[list[NDArray[np.str_]], dict[str, str], list[ImportMessage]]:
    """Return what blocks, rows and plants are called ``(n,)``, by which columns, and say so."""
    cells = cache(lambda name: [text(v) for v in layer.column(name)])
    told = {role: name for role in ("block", "row", "plant") if (name := options.column(role))}
    columns = plant_columns(list(layer.columns), cells, told)
    names = [
        np.array([""] * len(layer) if name is None else cells(name), np.str_)
        for name in (columns.block, columns.row, columns.plant)
    ]
    said = [
        seen(worded("Column {named!r} names the {role}s.", named=named, role=role))
        for role, named in columns.said.items()
    ]
    return names, columns.said, [*said, *map(doubtful, columns.doubts)]


def _in_another_part(
    lonlat: NDArray[np.float64], names: NDArray[np.str_], corners: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which plants ``(n,)`` are `corners` or far off; say so of those far off."""
    gone = _elsewhere(lonlat) & ~corners
    if not gone.any():
        return corners, []
    said = worded(
        "{n} {n:plant lies|plants lie} in another part of the earth than the others and "
        "{n:was|were} left out: {some}.",
        n=int(gone.sum()),
        some=_some(lonlat[gone], names[gone]),
    )
    return gone | corners, [dropped(said)]


def _one_of_each(
    found: LocatedFeatures, here: NDArray[np.intp], options: ReadOptions
) -> tuple[NDArray[np.intp], list[ImportMessage]]:
    """Return which of the plants `here` are kept where several stand in one place.

    Ask whether they are doubles unless that was answered; say what was left out.
    """
    apart_m = options.doubles_m or SAME_PLANT_M
    kept = here[distinct(found.lonlat[here], apart_m)]
    n_doubles = len(here) - len(kept)
    if not n_doubles:
        return kept, []
    if (column := _tells_faces(found, here, kept)) is not None:
        said = worded(
            "Column {column!r} names both faces of {n} {n:plant|plants}, which stand in one place: "
            "one of each was kept. To have both, choose: Inspect both faces of each row "
            "(--both-faces).",
            column=column,
            n=n_doubles,
        )
        return kept, [doubtful(said)]
    if options.doubles is None:
        gone = np.setdiff1d(np.arange(len(found.lonlat)), here)
        raise _about_doubles(found.layer, np.union1d(kept, gone))
    said = worded(
        "{n_doubles} of {n} plants stood within {apart} of another one; left out.",
        n_doubles=n_doubles,
        n=len(here),
        apart=worded("{apart_cm:g} cm", apart_cm=100 * apart_m),
    )
    return kept, [dropped(said)]


def _tells_faces(
    found: LocatedFeatures, here: NDArray[np.intp], kept: NDArray[np.intp]
) -> str | None:
    """Return the column by which the plants `here` that are not `kept` are other faces of those.

    None: there is none, or not each of them is.
    """
    if (named := faces_named(found.layer.take(here))) is None:
        return None
    column, face = named
    xy_m, is_kept = frame_around(found.lonlat[here]).xy_m(found.lonlat[here]), np.isin(here, kept)
    of = np.flatnonzero(is_kept)[cKDTree(xy_m[is_kept]).query(xy_m[~is_kept])[1]]
    other = face[of] != face[~is_kept]
    return column if other.all() and len(np.unique(of)) == len(of) else None


def _of_near_doubles(lonlat: NDArray[np.float64]) -> list[ImportMessage]:
    """Return a doubt about plants that may be one, with the distance that makes them one."""
    doubles = near_doubles(lonlat)
    if doubles is None:
        return []
    remedy = Remedy("doubles", f"{doubles.within_m:g}", worded("Keep one of each"))
    return [doubtful(doubles.sentence, remedy=remedy)]


def _corners_among(
    layer: Layer, lonlat: NDArray[np.float64], options: ReadOptions
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which of the plants ``(n,)`` are corners to leave out, and what to say of them.

    They are a few positions, marked in a column, that go round the others.
    """
    none = np.zeros(len(lonlat), dtype=bool)
    for column, values in layer.columns.items():
        if not _has_few(values):
            continue
        marks = np.array([text(value) for value in values], np.str_)
        known, counts = np.unique(marks, return_counts=True)
        by_number = sorted(zip((-counts).tolist(), known.tolist(), strict=True))
        for less, mark in by_number:
            corners = marks == mark
            others = [f"{column}={other}" for _, other in by_number if other not in {mark, ""}]
            if not others or not _go_round(lonlat[corners], lonlat[~corners]):
                continue
            n, all_, named = -less, len(marks), f"{column}={mark}"
            if options.far == "keep":
                said = worded(
                    "{n} of {all} plants, with {mark}, go round the others, as the corners of a "
                    "plot do. Say which are the plants if they are none.",
                    n=n,
                    all=all_,
                    mark=named,
                )
                remedy = Remedy(
                    "where", others[0], worded("Take the others alone"), tuple(others[1:])
                )
                return none, [doubtful(said, remedy=remedy)]
            said = worded(
                "{n} of {all} plants, with {mark}, go round the others, as the corners of a plot "
                "do, and were left out.",
                n=n,
                all=all_,
                mark=named,
            )
            return corners, [dropped(said, remedy=Remedy("far", "keep", worded("Keep them")))]
    return none, []


def _has_few(values: NDArray[np.object_]) -> bool:
    """Return whether a column holds several values, but few; looks no farther than it must."""
    known = set()
    for value in values.tolist():
        known.add(text(value))
        if len(known) > _MOST_MARKS:
            return False
    return len(known) > 1


def _go_round(corners: NDArray[np.float64], others: NDArray[np.float64]) -> bool:
    """Return whether positions are the corners, in their order, of an area that holds others."""
    if not _LEAST_CORNERS <= len(corners) <= _MOST_CORNERS or len(corners) >= len(others):
        return False
    area = shapely.Polygon(corners)
    return area.is_valid and float(shapely.contains_xy(area, others).mean()) >= _HELD


def _of_blanks(names: NDArray[np.str_], column: str) -> ImportMessage:
    """Return what to say of names that some plants do not have."""
    return doubtful(
        worded(
            "Column {column!r} is empty for {n} of {all} plants: its names do not tell which "
            "plants stand together. Fill it in for all.",
            column=column,
            n=int((names == "").sum()),
            all=len(names),
        )
    )


def _elsewhere(lonlat: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which plants ``(n, 2)`` lie in another part of the earth than most, as at 0, 0."""
    off_deg = lonlat - np.median(lonlat, axis=0)
    off_deg[:, 0] = (off_deg[:, 0] + 180.0) % 360.0 - 180.0
    gone = np.asarray((np.abs(off_deg) > _ELSEWHERE_DEG).any(axis=1), dtype=bool)
    return gone if 2 * np.count_nonzero(gone) < len(gone) else np.zeros_like(gone)


def _strays(
    lonlat: NDArray[np.float64], names: NDArray[np.str_], options: ReadOptions
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which plants ``(n,)`` are left out, and what to say of those far from all others.

    Alone or by twos and threes they are doubted; a few over a kilometre away are left out.
    """
    out = np.zeros(len(lonlat), dtype=bool)
    if len(lonlat) < _ENOUGH:
        return out, []
    xy_m = frame_around(lonlat).xy_m(lonlat)
    far_m = cKDTree(xy_m).query(xy_m, 4)[0][:, -1]
    stray = np.flatnonzero(far_m > max(_STRAY_M, _STRAY_TIMES * float(np.median(far_m))))
    messages = []
    gone = stray[far_m[stray] > _FAR_M]
    if len(gone) and options.far != "keep" and len(gone) * _RARE < len(lonlat):
        out[gone] = True
        said = worded(
            "{n} {n:plant stands|plants stand} {far} and more from the others and {n:was|were} "
            "left out: {some}.",
            n=len(gone),
            far=distance_figure(float(far_m[gone].min())),
            some=_some(lonlat[gone], names[gone]),
        )
        messages.append(dropped(said, remedy=Remedy("far", "keep", worded("Keep them"))))
        stray = np.setdiff1d(stray, gone)
    if len(stray):
        said = worded(
            "{n} {n:plant stands|plants stand} {far} and more from the others: {some}. Leave "
            "{n:it|them} out of the file if {n:it is|they are} mistyped.",
            n=len(stray),
            far=distance_figure(float(far_m[stray].min())),
            some=_some(lonlat[stray], names[stray]),
        )
        messages.append(doubtful(said))
    return out, messages


def _some(lonlat: NDArray[np.float64], names: NDArray[np.str_]) -> str:
    """Return which plants these are; of many the first few."""
    return first_few([_at(*one) for one in zip(lonlat, names, strict=True)])


def _at(place: NDArray[np.float64], name: str) -> str:
    lon, lat = place.tolist()
    return f"{name} ({lon:.5f} / {lat:.5f})" if name else f"{lon:.5f} / {lat:.5f}"


def _about_doubles(layer: Layer, kept: NDArray[np.intp]) -> ChoiceNeeded:
    """Return the question whether one of each is to be kept."""
    again = np.setdiff1d(np.arange(len(layer)), kept)
    called = _called(layer.take(again))
    return ChoiceNeeded(
        worded(
            "No two plants may stand in one place, but {n} of {others_n} are within "
            "5 cm of an earlier one, the first of them {called}. Keep one of "
            "each if they are doubles; if not, mend the file.",
            n=len(again),
            others_n=len(layer),
            called=called,
        ),
        "doubles",
        ("one",),
    )


def _called(layer: Layer) -> str:
    """Return what the first plant is called: by no number with decimals, which is its position."""
    said = (text(column[0]) for column in layer.columns.values() if len(column))
    called = next((one for one in said if one and not re.fullmatch(r"-?\d+[.,]\d+", one)), None)
    return "one without a name" if called is None else repr(called)


def drawn_rows_of(layer: Layer, options: ReadOptions) -> Imported[MultiLineString]:
    """Return the rows of a layer of lines, or of points that are their end posts, lon/lat."""
    column = options.column("row") or find("row", layer.columns)
    has_names = column is not None and any(text(value) for value in layer.column(column))
    lost = [_of_drawn_names(str(column))] if has_names else []
    if layer.geometry is not None and geometry_kinds(layer.geometry)[1].any():
        lines = lines_of(layer, options)
        rows, doubles = _once(lines.value)
        return lines.having(rows, [*doubles, *lost])
    posts = plants_of(layer, options)
    named = None if (posts.value.row == "").any() else posts.value.row
    rows = rows_from_posts(posts.value.lonlat, named)
    how = "by the names of their rows" if named is not None else "as they lie in line"
    said = guessed(
        worded("{n} points are the end posts of rows, paired {how}.", n=len(posts.value), how=how)
    )
    return posts.having(rows, [said, *lost])


def _once(rows: MultiLineString) -> tuple[MultiLineString, list[ImportMessage]]:
    """Return rows without those drawn again, either way, and what to say of these."""
    lines = shapely.get_parts(rows)
    first = np.sort(np.unique(shapely.to_wkb(shapely.normalize(lines)), return_index=True)[1])
    if len(first) == len(lines):
        return rows, []
    said = worded(
        "{n} {n:row is|rows are} in the file twice and {n:counts|count} once.",
        n=len(lines) - len(first),
    )
    return MultiLineString(list(lines[first])), [dropped(said)]


def _of_drawn_names(column: str) -> ImportMessage:
    """Return what to say of drawn rows that have names."""
    return doubtful(
        worded(
            "Rows that are drawn count from 1 here, whatever column {column!r} calls them: the map "
            "shows which is which. Those of a file of plants keep their names.",
            column=column,
        )
    )


def drawn_blocks_of(layer: Layer, options: PlotOptions) -> Imported[DrawnBlocks]:
    """Return the blocks of a layer of areas, or of lines that part a plot into blocks."""
    if layer.geometry is not None:
        areas, lines, _ = geometry_kinds(layer.geometry)
        if lines.any() and not areas.any() and not closed_lines(layer.geometry).any():
            cuts = lines_of(layer, options)
            return cuts.having(DrawnBlocks((), cuts.value))
    blocks = blocks_of(layer, options)
    return blocks.having(DrawnBlocks(blocks.value, MultiLineString()))


def lines_of(layer: Layer, options: ReadOptions) -> Imported[MultiLineString]:
    """Return the lines of a layer, lon/lat."""
    if layer.geometry is None:
        raise FileProblem(
            worded("{name} must hold lines, but it is a plain table.", name=layer.name)
        )
    areas, lines, points = geometry_kinds(layer.geometry)
    if not lines.any():
        raise FileProblem(
            worded(
                "{name} must hold lines, but it holds {n} {n:area|areas} and {others_n} "
                "{others_n:point|points}. Choose another file or layer.",
                name=layer.name,
                n=int(areas.sum()),
                others_n=int(points.sum()),
            )
        )
    messages = []
    others = len(layer) - int(lines.sum())
    if others:
        messages.append(
            dropped(
                worded(
                    "{others} {others:feature|features} that {others:is|are} no "
                    "{others:line was|lines were} left out.",
                    others=others,
                )
            )
        )
    placed, more = place_geometry(layer.geometry[lines], layer.crs, options)
    parts = shapely.get_parts(shapely.get_parts(placed))
    is_line = np.isin(shapely.get_type_id(parts), (1, 2))
    has_length = is_line & (shapely.length(parts) > 0)
    if has_length.sum() < is_line.sum():
        n_points = int(is_line.sum() - has_length.sum())
        messages.append(
            dropped(
                worded(
                    "{n_points} {n_points:line|lines} that {n_points:leads|lead} nowhere "
                    "{n_points:was|were} left out.",
                    n_points=n_points,
                )
            )
        )
    whole = MultiLineString(list(parts[has_length]))
    return Imported(whole, (*layer.messages, *messages, *more))
