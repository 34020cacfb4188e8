"""Pest records out of a layer or table: where, when, how many, whether at all."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    Remedy,
    doubtful,
    dropped,
    guessed,
    seen,
)
from fieldmon.io.parse.clock import (
    as_clocks,
    clock_time,
    local_time,
    n_midnights_left_out,
    without_midnights,
    zone_of,
)
from fieldmon.io.parse.columns import is_of_writing
from fieldmon.io.parse.dates import dates, dates_of_parts
from fieldmon.io.parse.lengths import accuracies
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.result_words import about_confidences
from fieldmon.io.parse.values import is_missing, numbers
from fieldmon.io.readers.date_doubts import (
    HOW_TO_WRITE,
    broken_times,
    in_future,
    midnights_left_out,
    refuse_mixed,
    unread_dates,
)
from fieldmon.io.readers.inspection_file.columns import faces_named, own_column
from fieldmon.io.readers.placed_twice import placed_twice
from fieldmon.io.readers.species import one_pest
from fieldmon.io.readers.wide_tables import by_day
from fieldmon.plot.local_clock import clock_at
from fieldmon.plot.planting import Planting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import RecordOptions
    from fieldmon.io.parse.dates import DatedColumn
    from fieldmon.io.parse.positions import LocatedFeatures
    from fieldmon.io.readers.places import NamedPlaces
from fieldmon.io.readers.record_columns import RecordColumns
from fieldmon.io.readers.record_counts import counts_of
from fieldmon.io.readers.record_visits import RecordVisits, disagreeing, each_visit_once, places_of


def records_of(
    layer: Layer,
    options: RecordOptions,
    places: NamedPlaces | None = None,
    apart_m: float | None = None,
) -> Imported[Records]:
    """Return the records of a layer, each with a position; of plants so far apart, if known."""
    return _records_and_plots(layer, options, places, apart_m)[0]


def records_by_plot(
    layer: Layer, options: RecordOptions, places: NamedPlaces
) -> Imported[dict[str, Records]]:
    """Return the records of a layer that name their plot, and a row and a plant on it, by plot."""
    read, plot = _records_and_plots(layer, options, places)
    named = [] if plot is None else sorted(set(plot.tolist()))
    return read.having({name: read.value.take(plot == name) for name in named})


def _records_and_plots(
    layer: Layer,
    options: RecordOptions,
    places: NamedPlaces | None,
    apart_m: float | None = None,
) -> tuple[Imported[Records], NDArray[np.str_] | None]:
    """Return the records of a layer, and the plot that each names, if they do."""
    if len(layer) == 0:
        raise ObservationError(
            worded("{name} must hold records, but it holds none.", name=layer.name)
        )
    layer, record, repeated = _once_each(by_day(layer, options))
    found = located(layer, options, places)
    table = RecordColumns(found.layer, options)
    day, at_s, day_messages = _days(table, found.lonlat, record)
    counts = counts_of(table)
    species, of_species = _species(table)
    accuracy_m, unread = _accuracy_m(table, found, options)
    twice = placed_twice(found, accuracy_m, options)
    records = Records.of(
        found.lonlat,
        counts.present,
        day,
        count=counts.number,
        accuracy_m=accuracy_m,
        species=species,
        stage=table.texts("stage"),
        leaves_sampled=table.numbers("leaves"),
    )
    messages = (
        *layer.messages, *repeated, *found.messages, *unread, *twice, *day_messages,
        *counts.messages,
    )  # fmt: skip
    place, of_faces = _by_face(places_of(records), table)
    half_m = (apart_m or Planting().plant_spacing_m) / 2
    known = ~np.isnat(day) & np.isfinite(found.lonlat).all(axis=1)
    known &= ~(records.accuracy_m >= half_m) & (found.step_m < half_m)
    visits = RecordVisits(np.flatnonzero(known), place, at_s)
    first, counted_once = each_visit_once(records, table, visits)
    once = records.take(first)
    more = (*of_species, *of_faces, *counted_once, *disagreeing(once, place[first]))
    messages += (*about_confidences(layer.columns, table.used()),)
    return Imported(once, (*messages, *more)), None if found.plot is None else found.plot[first]


def _species(table: RecordColumns) -> tuple[NDArray[np.str_], list[ImportMessage]]:
    """Return the pest of each record ``(n,)`` in one spelling, and what is said of the others.

    Ask which one is meant where there are several.
    """
    if (name := table.named("species")) is None:
        return np.full(len(table), "", dtype=np.str_), []
    cells = table.cells(name)
    usual, messages = one_pest(name, cells)
    return np.array([usual.get(cell, "") for cell in cells], dtype=np.str_), messages


def _by_face(
    place: NDArray[np.intp], table: RecordColumns
) -> tuple[NDArray[np.intp], list[ImportMessage]]:
    """Return places of records ``(n,)``, one for each face of a plant that is named, and say so."""
    named = faces_named(table.layer)
    if named is None or named[0] in table.used():
        return place, []
    column, face = named
    said = worded(
        "Column {column!r} names faces of plants: it tells records of one plant apart, but each "
        "counts for the whole plant. Only inspections are of a face.",
        column=column,
    )
    return 2 * place + (face == 2), [doubtful(said)]


def _accuracy_m(
    table: RecordColumns, found: LocatedFeatures, options: RecordOptions
) -> tuple[NDArray[np.float64], list[ImportMessage]]:
    """Return how far off the places of records may be ``(n,)``, NaN where that is not known."""
    name = table.named("accuracy")
    if name is None or options.place == "plant":  # what is stated is of their positions
        return found.accuracy_m, []
    stated_m, unread = accuracies(table.layer.column(name), name, options.decimal)
    return np.fmax(stated_m, found.accuracy_m), unread


def _once_each(layer: Layer) -> tuple[Layer, NDArray[np.int64], list[ImportMessage]]:
    """Return the layer without records that repeat another, and the number of each, from 1."""
    columns = [list(values) for values in layer.columns.values()]
    if layer.geometry is not None:
        columns.append([None if g is None else g.wkb for g in layer.geometry])
    first: dict[tuple[object, ...], int] = {}
    for i, row in enumerate(zip(*columns, strict=True)):
        first.setdefault(row, i)
    kept = np.fromiter(first.values(), dtype=np.int64)
    n_again = len(layer) - len(kept)
    if n_again == 0 or len(columns) < 3:
        return layer, np.arange(1, len(layer) + 1), []
    said = worded(
        "{n_again} {n_again:record repeats|records repeat} another in every column and "
        "{n_again:was|were} left out.",
        n_again=n_again,
    )
    return layer.take(kept), kept + 1, [dropped(said)]


class _Days(NamedTuple):
    """Local days ``(n,)``, and times in seconds from anywhere, NaN where unknown, ``(n,)``."""

    day: NDArray[np.datetime64]
    at_s: NDArray[np.float64]
    messages: list[ImportMessage]


def _days(table: RecordColumns, lonlat: NDArray[np.float64], record: NDArray[np.int64]) -> _Days:
    """Return the local days of records ``(n,)`` at positions ``(n, 2)``, and their times."""
    parts = tuple(name for role in ("year", "month", "day") if (name := table.named(role)))
    by_hand = table.options.column("date")
    zoned: list[ImportMessage] = []
    of_midnights: list[ImportMessage] = []
    name = None
    if len(set(parts)) == 3 and by_hand is None:
        read = dates_of_parts(*(numbers(table.layer.column(part)) for part in parts))
        where, quoted = ", ".join(parts), ", ".join(map(repr, parts))
    else:
        name = table.named("date", frozenset(parts) if len(parts) > 1 else frozenset())
        if name is None:
            unknown = np.full(len(table), "NaT", dtype="datetime64[D]")
            said = worded("No column was recognised as the date of the records.")
            offer = [doubtful(said, remedy=table.offer("date", _are_dates))]
            return _Days(unknown, np.full(len(table), np.nan), offer)
        read = dates(table.layer.column(name), table.options.date_order)
        where, quoted = name, repr(name)
    at_s, unread = _times(table, read.day, name)
    if name is not None:
        cells = table.cells(name)
        days = without_midnights(cells)
        of_midnights = midnights_left_out(n_midnights_left_out(cells, days), name)
        day, zoned = _as_local(read.day, days, lonlat)
        read = read._replace(day=day)
    is_guess = name is not None and by_hand is None and is_of_writing(name)
    said = worded("Dates were read from {where}.", where=quoted)
    of_dates = guessed(said) if is_guess else seen(said)
    about = (*_about_dates(read, where, record), *of_midnights, *broken_times(unread))
    return _Days(read.day, at_s, [of_dates, *zoned, *about])


def _times(
    table: RecordColumns, day: NDArray[np.datetime64], name: str | None
) -> tuple[NDArray[np.float64], list[str]]:
    """Return when each record was made, seconds from anywhere, and what times are none.

    NaN where no clock says it. `name` is the column of the date, which may hold the time too.
    """
    other = own_column("time", table.layer, {name})
    at_s = np.full(len(table), np.nan)
    for column in (name, other):
        if column is None:
            continue
        cells = without_midnights(as_clocks(column, table.cells(column)))
        clocks = {cell: clock_time(cell) for cell in set(cells)}
        for k in np.flatnonzero(np.isnan(at_s) & ~np.isnat(day)).tolist():
            if (clock := clocks[cells[k]]) is not None:
                ahead_s = 0.0 if clock.offset is None else clock.offset.total_seconds()
                at_s[k] = int(day[k].astype(np.int64)) * 86_400 + clock.seconds - ahead_s
    if other is None:
        return at_s, []
    open_yet = zip(table.cells(other), np.isnan(at_s).tolist(), strict=True)
    said = [cell for cell, is_open in open_yet if is_open and not is_missing(cell)]
    no_day = np.isnat(dates(np.array(said, dtype=object)).day)
    return at_s, [cell for cell, is_none in zip(said, no_day.tolist(), strict=True) if is_none]


def _as_local(
    day: NDArray[np.datetime64], cells: list[str], lonlat: NDArray[np.float64]
) -> tuple[NDArray[np.datetime64], list[ImportMessage]]:
    """Return days by the clock of the place, where cells name the zone of their time.

    A phone's file says UTC: an afternoon in California is the next day there.
    """
    clocks = ((cell, clock_time(cell)) for cell in set(cells))
    stated = {cell: clock for cell, clock in clocks if clock and clock.offset is not None}
    placed = np.isfinite(lonlat).all(axis=1)
    if not stated or not placed.any():
        return day, []
    place = clock_at(*np.median(lonlat[placed], axis=0).tolist())
    if not place.zone:
        return day, []
    zone, known, local = zone_of(place.zone), {}, day.copy()
    for k, cell in enumerate(cells):
        if cell in stated and not np.isnat(day[k]):
            if cell not in known:
                known[cell] = local_time(day[k], stated[cell], zone).astype("datetime64[D]")
            local[k] = known[cell]
    said = worded("Times name their zone; days are those of {zone}.", zone=place.zone)
    return local, [seen(said)]


def _about_dates(read: DatedColumn, where: str, record: NDArray[np.int64]) -> list[ImportMessage]:
    refuse_mixed(read, where)
    messages = []
    if read.is_ambiguous:
        messages.append(
            guessed(
                worded("Every date could be day first or month first; they were read day first."),
                where,
                Remedy("date_order", "mdy", worded("Read month first")),
            )
        )
    if read.n_serial:
        messages.append(
            guessed(
                worded(
                    "{n} {n:number was|numbers were} read as days counted by Excel.",
                    n=read.n_serial,
                ),
                where,
            )
        )
    if read.unread:
        said = worded(
            "{said} {n:It counts|They count} as {days:g} days old, whatever day is planned. {how}",
            said=unread_dates({int(record[k]): cell for k, cell in read.unread.items()}),
            n=len(read.unread),
            days=PriorSettings().undated_days,
            how=HOW_TO_WRITE,
        )
        messages.append(doubtful(said, where))
    messages += in_future(read.day, where)
    return messages


def _are_dates(cells: list[str]) -> bool:
    column = np.array(cells, dtype=object)
    return not np.isnat(dates(column).day).all()
