"""What a file says of plants that were inspected, before they are looked up on a plot.

This half runs in the reading process and knows no plot.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.formats.open_layer import layers_of, open_layer
from fieldmon.io.import_report import Imported, ImportMessage, doubtful, guessed, seen
from fieldmon.io.options import source_name
from fieldmon.io.parse.columns import is_position, plain
from fieldmon.io.parse.result_words import gone_note
from fieldmon.io.parse.values import numbers
from fieldmon.io.readers.inspection_file.columns import (
    columns_of,
    detects_in,
    is_own,
    notes_in,
    plot_column,
    texts_in,
    who_in,
)
from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows, mark_of
from fieldmon.io.readers.inspection_file.plants import named_plants, positions_in, unknown_faces
from fieldmon.io.readers.inspection_file.results import results_in
from fieldmon.io.readers.inspection_file.times import times_in
from fieldmon.io.readers.species import one_pest
from fieldmon.io.readers.visits import telling
from fieldmon.io.readers.wide_tables import by_day, by_plant

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import LayerInfo
    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.columns import InspectionColumns
    from fieldmon.io.readers.inspection_file.results import SeenResults
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.sandbox.workroom import Workroom

# Layers of files given out and of a season's file: what to read where nobody chose
_LAYERS = ("inspections", "stops", "plants", "waypoints")


def rows_of(
    source: Source, options: InspectionOptions, workroom: Workroom
) -> Imported[InspectionRows]:
    """Return what a file says of plants that were inspected.

    Where a file has several layers and nobody chose, the first of `_LAYERS` that reports anything
    is read: QField and QGIS edit a layer of plants, of stops or of inspections in place.
    """
    if options.member is not None or options.layer is not None:
        return rows_in(open_layer(source, options, workroom), options, source_name(source))
    known = _known_layers(layers_of(source, workroom))
    said_nothing: list[Imported[InspectionRows]] = []
    for info in known:
        own = replace(options, member=info.member, layer=info.layer)
        try:
            read = rows_in(open_layer(source, own, workroom), own, source_name(source))
        except (ChoiceNeeded, FileProblem):
            continue  # this one has no columns for inspections
        said = seen(worded("Inspections were read from layer {layer}.", layer=info.layer))
        if len(read.value):
            return Imported(read.value, (said, *read.messages))
        said_nothing.append(Imported(read.value, (said, *read.messages)))
    if said_nothing:
        return said_nothing[0]
    return rows_in(open_layer(source, options, workroom), options, source_name(source))


def _known_layers(infos: tuple[LayerInfo, ...]) -> list[LayerInfo]:
    """Return the layers that files of ours have, likeliest first; none where there is no choice."""
    if len(infos) < 2:
        return []
    ours = [info for info in infos if info.layer.casefold() in _LAYERS]
    return sorted(ours, key=lambda info: _LAYERS.index(info.layer.casefold()))


def rows_in(layer: Layer, options: InspectionOptions, file: str = "") -> Imported[InspectionRows]:
    """Return what one layer or table of a `file` says of plants that were inspected."""
    layer, messages = _each_point(*_without_lines(layer))
    layer = by_plant(by_day(_without_undone(layer), options), options)
    columns = columns_of(layer, options)
    results = results_in(layer, columns, options)
    said, notes, (mark, mark_called) = results.said, _notes(layer, results), _marks(layer)
    erased = (mark != "") & ~(results.said | results.unread)
    messages += _about_erased(erased)
    messages += _about_silence(results, notes, erased, in_names=columns.marks is not None)
    lonlat, accuracy_m, unread, more = positions_in(layer, columns, options)
    named = named_plants(layer, columns, options)
    times = times_in(layer, columns, options)
    whole = InspectionRows(
        plant=named.plant,
        line=named.line,
        number=named.number,
        face=named.face,
        lonlat=lonlat,
        accuracy_m=accuracy_m,
        unread=unread,
        result=results.result,
        count=results.how_many,
        doubt=results.doubt,
        when=times.when,
        day=times.day,
        who=who_in(layer, columns, options),
        notes=notes,
        source_row=np.arange(1, len(layer) + 1),
        block=texts_in(layer, columns.block),
        face_word=unknown_faces(layer, columns),
        leaf=texts_in(layer, columns.leaf),
        row_called=texts_in(layer, columns.line),
        plant_called=texts_in(layer, columns.number or columns.plant),
        rest=_rest(layer, columns, options),
        detects=detects_in(layer, columns, file or layer.name),
        plot_called=texts_in(layer, plot := plot_column(layer, columns, options)),
        plot_column=np.full(len(layer), plot or ""),
        mark=mark,
        mark_called=mark_called,
        lacks=np.full(len(layer), _lacking(layer, columns)),
    )
    kept = whole.take(_in_order(layer, times.when, times.day, said))
    kept = replace(kept, n_silent=len(whole) - len(kept))
    pests = texts_in(layer, columns.species)[said].tolist()
    spelt = one_pest(columns.species, pests)[1] if columns.species else []
    every = (*layer.messages, *messages, *results.messages, *named.messages, *more)
    every = (*every, *times.messages, *spelt)
    return Imported(kept, every)


def _in_order(
    layer: Layer,
    when: NDArray[np.datetime64],
    day: NDArray[np.datetime64],
    said: NDArray[np.bool_],
) -> NDArray[np.intp]:
    """Return which records say a result, ``(m,)``: in the order of stops where none has a time.

    Programs sort the lines of a file given out, and some formats do so themselves.
    """
    kept = np.flatnonzero(said)
    if not np.isnat(when[kept]).all():
        return kept
    for role in ("stop", "arrive_s"):
        name = next((n for n in layer.columns if plain(n) == plain(role)), None)
        stop = None if name is None else numbers(layer.column(name))[kept]
        if stop is not None and np.isfinite(stop).any():
            return kept[np.lexsort((stop, day[kept].astype("datetime64[D]").astype(np.int64)))]
    return kept


def _notes(layer: Layer, results: SeenResults) -> NDArray[np.str_]:
    """Return the notes of records ``(n,)``, with that the plant is gone where a result says so."""
    notes = notes_in(layer)
    if not results.gone.any():
        return notes
    pairs = zip(notes.tolist(), results.gone.tolist(), strict=True)
    return np.array([gone_note(note) if gone else note for note, gone in pairs], np.str_)


def _about_silence(
    results: SeenResults, notes: NDArray[np.str_], erased: NDArray[np.bool_], *, in_names: bool
) -> list[ImportMessage]:
    """Return what to say of records without a result that was not erased.

    `in_names`: names were to tell it.
    """
    messages = []
    noted = int((~(results.said | erased) & (notes != "")).sum())
    if noted and not in_names:
        messages.append(
            doubtful(
                worded(
                    "{noted} {noted:record has|records have} a note, but no result: left unknown.",
                    noted=noted,
                )
            )
        )
    # what is written and cannot be read is said apart
    silent = ~(results.said | results.unread | erased)
    if silent.any():
        what = worded("no result in the name") if in_names else worded("not filled in")
        messages.append(
            seen(
                worded(
                    "{n} of {total} {total:record|records} left unknown: {what}.",
                    n=int(silent.sum()),
                    total=len(silent),
                    what=what,
                )
            )
        )
    return messages


def _about_erased(erased: NDArray[np.bool_]) -> list[ImportMessage]:
    """Return a doubt about inspections exported from a season whose result is gone since."""
    if not (n := int(erased.sum())):
        return []
    said = worded(
        "{n} {n:inspection|inspections} exported from a season {n:has|have} no result any more: "
        "left unknown.",
        n=n,
    )
    return [doubtful(said)]


def _rest(layer: Layer, columns: InspectionColumns, options: InspectionOptions) -> NDArray[np.str_]:
    """Return what columns say that are not read ``(n,)``, where they tell things apart."""
    said = [one.name for one in BESIDE if one.role != "noted"]  # of notes `telling` knows
    read = {name for name in layer.columns
            if is_position(name) or any(is_own(role, name) for role in said)}  # fmt: skip
    read |= {name for name in columns if name} | options.named_columns
    told = telling(layer, np.arange(len(layer)), read)
    cells = ["\0".join(row) for row in zip(*told.values(), strict=True)]
    return np.array(cells or [""] * len(layer), dtype=np.str_)


def _without_lines(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer without the driven line that files given out hold beside the stops."""
    if layer.geometry is None:
        return layer, []
    kinds = shapely.get_type_id(layer.geometry)
    lines = np.isin(kinds, (1, 2, 5))
    if not lines.any() or lines.all():
        return layer, []
    said = seen(
        worded("{n} {n:line|lines} beside the points {n:was|were} passed over.", n=int(lines.sum()))
    )
    return layer.take(np.flatnonzero(~lines)), [said]


def _each_point(layer: Layer, messages: list[ImportMessage]) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer with a record for each point of those that hold several."""
    if layer.geometry is None:
        return layer, messages
    parts = np.where(
        shapely.get_type_id(layer.geometry) == shapely.GeometryType.MULTIPOINT,
        shapely.get_num_geometries(layer.geometry), 1,
    )  # fmt: skip
    many = parts > 1
    if not many.any():
        return layer, messages
    which = np.repeat(np.arange(len(layer)), np.where(many, parts, 1))
    each = layer.geometry[which]
    each[many[which]] = shapely.get_parts(layer.geometry[many])
    said = guessed(
        worded(
            "{n} {n:record holds|records hold} several points: each was taken as a record.",
            n=int(many.sum()),
        )
    )
    return replace(layer.take(which), geometry=each), [*messages, said]


def _marks(layer: Layer) -> tuple[NDArray[np.str_], NDArray[np.str_]]:
    """Return by which digest a season's file knows each record ``(n,)``, and what stands there.

    Empty: it is of none.
    """
    cells = texts_in(layer, _of_season("digest", layer))
    marks = np.array([mark_of(cell) for cell in cells.tolist()], np.str_)
    if _of_season("undone", layer) is None:  # only a table of `fieldmon export` says which it is
        return marks, cells
    return np.where(marks == "", cells, marks), cells


def _lacking(layer: Layer, columns: InspectionColumns) -> str:
    """Return which columns of a season's inspections a layer does not have, between commas."""
    lacks = {one.kept for one in COLUMNS if _of_season(one.kept, layer) is None}
    if columns.line is not None and columns.number is not None:
        lacks.discard("plant")
    return ",".join(sorted(lacks))


def _of_season(column: str, layer: Layer) -> str | None:
    return next((name for name in layer.columns if plain(name) == column), None)


def _without_undone(layer: Layer) -> Layer:
    """Return the layer without what a season's file keeps, but marks as taken back."""
    name = _of_season("undone", layer)
    if name is None:
        return layer
    return layer.take(np.flatnonzero([text(v) in {"", "0", "False"} for v in layer.column(name)]))
