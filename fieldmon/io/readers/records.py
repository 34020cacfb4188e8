"""Pest records out of a layer or table: where, when, how many, whether at all."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, ObservationError
from fieldmon.infestation.observations import PRESENT, UNKNOWN, Observations
from fieldmon.infestation.prior_settings import PriorSettings
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
from fieldmon.io.options import ROLES
from fieldmon.io.parse.clock import (
    as_clocks,
    clock_time,
    local_time,
    n_midnights_left_out,
    without_midnights,
    zone_of,
)
from fieldmon.io.parse.columns import (
    find,
    is_average,
    is_confidence,
    is_id,
    is_of_writing,
    is_position,
    recognised,
)
from fieldmon.io.parse.lengths import accuracies
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.result_words import (
    ResultWords,
    about_confidences,
    about_fractions,
    about_mark,
    about_minus,
    are_fractions,
    remedy_of_words,
)
from fieldmon.io.parse.values import (
    counted,
    dates,
    dates_of_parts,
    is_missing,
    mark_of_counts,
    numbers,
    presence,
)
from fieldmon.io.readers.date_doubts import (
    HOW_TO_WRITE,
    broken_times,
    in_future,
    midnights_left_out,
    mixed_dates,
    unread_dates,
)
from fieldmon.io.readers.inspection_file.columns import names_in, own_column
from fieldmon.io.readers.inspection_file.results import results_in_names
from fieldmon.io.readers.other_counts import about_other_counts
from fieldmon.io.readers.placed_twice import placed_twice
from fieldmon.io.readers.species import one_pest
from fieldmon.io.readers.visits import VISIT_S, first_of_visits, same_places, telling
from fieldmon.io.readers.wide_tables import by_day
from fieldmon.plot.local_clock import clock_at
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from fieldmon.io.options import RecordOptions
    from fieldmon.io.parse.positions import LocatedFeatures
    from fieldmon.io.parse.values import DatedColumn
    from fieldmon.io.readers.places import NamedPlaces

_LOOKED_AT, _FEW_WORDS = 200, 12
# roles of columns that say where a record lies
_LIES = frozenset({"lon", "lat", "position", "x", "y", "crs", "accuracy"})


def records_of(
    layer: Layer,
    options: RecordOptions,
    places: NamedPlaces | None = None,
    apart_m: float | None = None,
) -> Imported[Observations]:
    """Return the records of a layer, each with a position; of plants so far apart, if known."""
    return _records_and_plots(layer, options, places, apart_m)[0]


def records_by_plot(
    layer: Layer, options: RecordOptions, places: NamedPlaces
) -> Imported[dict[str, Observations]]:
    """Return the records of a layer that name their plot, and a row and a plant on it, by plot."""
    read, plot = _records_and_plots(layer, options, places)
    named = [] if plot is None else sorted(set(plot.tolist()))
    return read.having({name: read.value.take(plot == name) for name in named})


def _records_and_plots(
    layer: Layer,
    options: RecordOptions,
    places: NamedPlaces | None,
    apart_m: float | None = None,
) -> tuple[Imported[Observations], NDArray[np.str_] | None]:
    """Return the records of a layer, and the plot that each names, if they do."""
    if len(layer) == 0:
        raise ObservationError(
            worded("{name} must hold records, but it holds none.", name=layer.name)
        )
    layer, record, repeated = _once_each(by_day(layer, options))
    found = located(layer, options, places)
    table = _Table(found.layer, options)
    day, at_s, day_messages = _days(table, found.lonlat, record)
    counts = _counts(table)
    species, of_species = _species(table)
    accuracy_m, unread = _accuracy_m(table, found, options)
    twice = placed_twice(found, accuracy_m, options)
    observations = Observations.of(
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
    place = _places(observations)
    half_m = (apart_m or Planting().plant_spacing_m) / 2
    known = ~np.isnat(day) & np.isfinite(found.lonlat).all(axis=1)
    known &= ~(observations.accuracy_m >= half_m) & (found.step_m < half_m)
    visits = _Visits(np.flatnonzero(known), place, at_s)
    first, counted_once = _each_visit_once(observations, table, visits)
    once = observations.take(first)
    more = (*of_species, *counted_once, *_same_visit(once, place[first]))
    messages += (*about_confidences(layer.columns, table.used()),)
    return Imported(once, (*messages, *more)), None if found.plot is None else found.plot[first]


def _species(table: _Table) -> tuple[NDArray[np.str_], list[ImportMessage]]:
    """Return the pest of each record ``(n,)`` in one spelling, and what is said of the others.

    Ask which one is meant where there are several.
    """
    if (name := table.named("species")) is None:
        return np.full(len(table), "", dtype=np.str_), []
    cells = table.cells(name)
    usual, messages = one_pest(name, cells)
    return np.array([usual.get(cell, "") for cell in cells], dtype=np.str_), messages


def _accuracy_m(
    table: _Table, found: LocatedFeatures, options: RecordOptions
) -> tuple[NDArray[np.float64], list[ImportMessage]]:
    """Return how far off the places of records may be ``(n,)``, NaN where that is not known."""
    name = table.named("accuracy")
    if name is None or options.place == "plant":  # what is stated is of their positions
        return found.accuracy_m, []
    stated_m, unread = accuracies(table.layer.column(name), name, options.decimal)
    return np.fmax(stated_m, found.accuracy_m), unread


@dataclass(frozen=True, eq=False)
class _Table:
    """Columns by what they hold."""

    layer: Layer
    options: RecordOptions

    def __len__(self) -> int:
        return len(self.layer)

    def named(self, role: str, taken: frozenset[str] = frozenset()) -> str | None:
        told = self.options.column(role)
        if told == "" and role == "species":  # none says it
            return None
        return told or find(role, self.layer.columns, taken)

    def used(self) -> set[str | None]:
        """Return the columns that play a role."""
        return {self.named(role) for role in ROLES}

    def cells(self, name: str) -> list[str]:
        return [text(v) for v in self.layer.column(name)]

    def numbers(self, role: str) -> NDArray[np.float64]:
        name = self.named(role)
        if name is None:
            return np.full(len(self), np.nan)
        return numbers(self.layer.column(name), self.options.decimal)

    def texts(self, role: str) -> NDArray[np.str_]:
        name = self.named(role)
        if name is None:
            return np.full(len(self), "", dtype=np.str_)
        cells = self.cells(name)
        known = {cell: "" if is_missing(cell) else cell for cell in set(cells)}
        return np.array([known[cell] for cell in cells], dtype=np.str_)


class _Counts(NamedTuple):
    number: NDArray[np.float64]
    present: NDArray[np.int8]
    messages: list[ImportMessage]


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


def _days(table: _Table, lonlat: NDArray[np.float64], record: NDArray[np.int64]) -> _Days:
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
            offer = [doubtful(said, remedy=_offer(table, "date", _are_dates))]
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
    table: _Table, day: NDArray[np.datetime64], name: str | None
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
    messages = []
    if read.is_ambiguous:
        messages.append(
            guessed(
                worded("Every date could be day first or month first; they were read day first."),
                where,
                Remedy("date_order", "mdy", worded("Read month first")),
            )
        )
    messages += mixed_dates(read, where)
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


def _counts(table: _Table) -> _Counts:
    """Return how many, whether, and what was found."""
    count_name = table.named("count")
    present_name = table.named("present", frozenset({count_name} if count_name else ()))
    all_are_finds = table.options.column("present") == ""
    counts = _Counts(np.full(len(table), np.nan), np.full(len(table), UNKNOWN, np.int8), [])
    if count_name is not None:
        counts = _numbers_of(table, count_name)
    if present_name is not None and not all_are_finds:
        counts = _with_presence(table, present_name, counts)
    elif all_are_finds and count_name is None:
        counts.present[:] = PRESENT
        counts.messages.append(seen(worded("Every record was taken as a find, as told.")))
    elif count_name is None:
        counts = _by_names(table)
    others = about_other_counts(
        table.layer, table.options, count_name, table.used(), counts.present
    )
    return counts._replace(messages=[*counts.messages, *others.messages])


def _by_names(table: _Table) -> _Counts:
    """Return what the names of waypoints say; ask what was found where fewer than half say it."""
    name = names_in(table.layer)
    said = [] if name is None else results_in_names(table.layer, name, table.options)
    if not said or 2 * sum(one.is_said for one in said) < len(said):
        raise _what_was_found(table)
    every = Remedy("columns", "present=", worded("Take every record as a find"))
    read = guessed(worded("What was found was read from the names."), name, every)
    number = np.array([one.how_many for one in said], dtype=np.float64)
    return _Counts(number, np.array([one.result for one in said], dtype=np.int8), [read])


def _what_was_found(table: _Table) -> ChoiceNeeded:
    """Return the question which column says what was found, with those that could."""
    words = [*_fitting(table, _are_results), *_fitting(table, _hold_results)]
    numbers = [name for name in _fitting(table, _are_numbers) if _could_count(table, name)]
    could = dict.fromkeys((*(f"present={n}" for n in words), *(f"count={n}" for n in numbers)))
    return ChoiceNeeded(
        worded(
            "{name} must have a column that says what was found (count, "
            "found, result), but none was recognised among: {value}. Say which one it is, or that "
            "every record is a find.",
            name=table.layer.name,
            value=", ".join(table.layer.columns) or "none",
        ),
        "columns",
        (*could, "present="),
    )


def _offer(table: _Table, role: str, fits: Callable[[list[str]], bool]) -> Remedy | None:
    """Return the columns of unknown name that hold what could play a role, if there are any."""
    choices = tuple(f"{role}={name}" for name in _fitting(table, fits))
    if not choices:
        return None
    one = worded(
        "Take the {role} from {other}",
        role=role,
        other=choices[0].partition("=")[2],
    )
    label = (
        one
        if len(choices) == 1
        else worded(
            "Name the column of the {role}",
            role=role,
        )
    )
    return Remedy("columns", choices[0], label, choices[1:])


def _fitting(table: _Table, fits: Callable[[list[str]], bool]) -> list[str]:
    """Return the columns of unknown name whose cells fit."""
    unknown = [name for name in table.layer.columns if not recognised([name])]
    some = {name: [c for c in table.cells(name)[:_LOOKED_AT] if c] for name in unknown}
    return [name for name, cells in some.items() if cells and fits(cells)]


def _are_results(cells: list[str]) -> bool:
    read = [presence(cell) for cell in cells if not is_missing(cell)]
    return bool(read) and all(one != UNKNOWN for one in read) and not _are_numbers(cells)


def _hold_results(cells: list[str]) -> bool:
    """Return whether cells are a few words, one of which says what was found."""
    words = {cell for cell in cells if not is_missing(cell)}
    some = any(presence(word) != UNKNOWN for word in words)
    return len(words) <= _FEW_WORDS and some and not _are_numbers(cells)


def _could_count(table: _Table, name: str) -> bool:
    """Return whether a column of numbers could count pests: no ids, no confidences."""
    cells = table.cells(name)
    if is_id(name, cells) or is_confidence(name):
        return False
    return not are_fractions(counted(cell).number for cell in cells[:_LOOKED_AT])


def _are_dates(cells: list[str]) -> bool:
    column = np.array(cells, dtype=object)
    return not np.isnat(dates(column).day).all()


def _are_numbers(cells: list[str]) -> bool:
    read = [counted(cell) for cell in cells if not is_missing(cell)]
    return bool(read) and all(np.isfinite(one.number) for one in read)


def _some(cells: Iterable[str]) -> str:
    """Return how a sentence shows cells: the first three that differ."""
    return ", ".join(repr(cell) for cell in list(dict.fromkeys(cells))[:3])


def _numbers_of(table: _Table, name: str) -> _Counts:
    cells = table.cells(name)
    mark, messages = _mark(table, name, cells)
    known = {cell: counted(cell, mark) for cell in set(cells)}
    count = np.array([known[cell].number for cell in cells])
    present = np.array([known[cell].present for cell in cells], dtype=np.int8)
    messages.append(seen(worded("Counts are in column {name!r}.", name=name)))
    messages += about_fractions(name, count.tolist(), is_usual=bool(recognised([name])))
    odd = [cell for cell in cells if known[cell].is_rough]
    rough = [cell for cell in odd if known[cell].present != UNKNOWN]
    none = [cell for cell in odd if known[cell].present == UNKNOWN]
    if none:
        messages.append(
            doubtful(
                worded(
                    "{n} {n:count says|counts say} neither how many nor whether any ({shown}); "
                    "left open.",
                    n=len(none),
                    shown=_some(none),
                ),
                name,
            )
        )
    if rough:
        messages.append(
            doubtful(
                worded(
                    "{n} {n:count is|counts are} no plain number ({shown}); read roughly.",
                    n=len(rough),
                    shown=_some(rough),
                ),
                name,
            )
        )
    n_missing = int(np.count_nonzero(present == UNKNOWN)) - len(none)
    if n_missing:
        messages.append(
            seen(
                worded(
                    "{n} {n:record has|records have} no count: not known, not zero.", n=n_missing
                ),
                name,
            )
        )
    return _Counts(count, present, messages)


def _mark(table: _Table, name: str, cells: list[str]) -> tuple[str, list[ImportMessage]]:
    """Return the decimal mark of the counts: 1,234 alone is told by the rest of the table."""
    if table.options.decimal is not None:
        return table.options.decimal, []
    others = (values for column, values in table.layer.columns.items() if column != name)
    looked_at = (text(v) for values in others for v in values[:_LOOKED_AT])
    mark, unsure = mark_of_counts(cells, looked_at, averages=is_average(name))
    return mark, about_mark(unsure, name, mark)


def _with_presence(table: _Table, name: str, counts: _Counts) -> _Counts:
    cells = table.cells(name)
    words = ResultWords(cells, table.options)
    known = {cell: _present(cell, words) for cell in set(cells)}
    stated = np.array([known[cell] for cell in cells], dtype=np.int8)
    at_odds = (stated != UNKNOWN) & (counts.present != UNKNOWN) & (stated != counts.present)
    messages = [*counts.messages, seen(worded("Presence is in column {name!r}.", name=name))]
    if at_odds.any():
        messages.append(
            doubtful(
                worded(
                    "{n} {n:record contradicts its|records contradict their} own count.",
                    n=int(at_odds.sum()),
                ),
                name,
            )
        )
    unread = sorted(cell for cell in known if known[cell] == UNKNOWN and not is_missing(cell))
    if unread:
        said = worded("These words say neither yes nor no: {shown}.", shown=_some(unread))
        messages.append(doubtful(said, name, remedy_of_words(unread, table.options)))
    messages += about_minus(cells, words)
    messages += about_fractions(name, (counted(cell).number for cell in known), is_usual=False)
    present = np.where(stated == UNKNOWN, counts.present, stated).astype(np.int8)
    return _Counts(counts.number, present, messages)


def _present(cell: str, words: ResultWords) -> int:
    said = words[cell]
    return presence(cell) if said is None else said


class _Visits(NamedTuple):
    """Which records can be of one visit with others, ``(k,)``; where and when each is, ``(n,)``."""

    known: NDArray[np.intp]
    place: NDArray[np.intp]
    at_s: NDArray[np.float64]


def _places(observations: Observations) -> NDArray[np.intp]:
    """Return a number for the place of each record ``(n,)``; of those with none their own."""
    place = np.arange(len(observations))
    there = np.flatnonzero(np.isfinite(observations.lonlat).all(axis=1))
    if len(there):
        lonlat = observations.lonlat[there]
        east = np.cos(np.radians(np.median(lonlat[:, 1])))
        xy_m = (lonlat - lonlat[0]) * M_PER_DEGREE * [east, 1.0]
        place[there] = there[same_places(xy_m, observations.accuracy_m[there])]
    return place


def _each_visit_once(
    observations: Observations, table: _Table, visits: _Visits
) -> tuple[NDArray[np.intp], list[ImportMessage]]:
    """Return the first record of each visit, and what there is to say of the others.

    A robot tells of a plant each time that it sees it, and that is one look. Records without a day,
    and of positions that tell no plants apart, stay as they are; so do those of which any other
    column tells that they are of something else.
    """
    some = observations.take(visits.known)
    columns = (visits.place[visits.known], some.day.astype(np.int64), some.present, some.count)
    read = [np.nan_to_num(column.astype(np.float64), nan=-1.0).tolist() for column in columns]
    alike = list(zip(*read, some.species.tolist(), some.stage.tolist(), strict=True))
    often = Counter(alike)
    again = np.flatnonzero([often[one] > 1 for one in alike])
    if not len(again):
        return np.arange(len(observations)), []
    alike, records = [alike[k] for k in again.tolist()], visits.known[again]
    at_s = visits.at_s[records]
    lies = {name for name in table.layer.columns if is_position(name)}
    rest = telling(table.layer, records, lies | {table.named(role) for role in _LIES})
    says = list(zip(alike, *rest.values(), strict=True))
    first = first_of_visits(says, at_s)
    messages: list[ImportMessage] = []
    if n_again := len(records) - len(first):
        said = worded(
            "{n} {n:record repeats|records repeat} what another says of the same place and day, "
            "within {minutes} minutes or with no time: one visit, which counts once.",
            n=n_again,
            minutes=round(VISIT_S / 60),
        )
        messages.append(guessed(said))
    if n_more := len(first) - len({says[k] for k in first.tolist()}):
        said = worded(
            "{n} {n:record tells|records tell} the same of a place and day as another at another "
            "time: each visit counts.",
            n=n_more,
        )
        messages.append(doubtful(said))
    if n_other := len(first) - len(first_of_visits(alike, at_s)):
        said = worded(
            "{n} {n:record differs|records differ} from another of the same place and time only "
            "in {columns}: each counts.",
            n=n_other,
            columns=first_few(_differing(alike, rest), 3),
        )
        messages.append(guessed(said))
    later = np.delete(records, first)
    return np.delete(np.arange(len(observations)), later), messages


def _differing(alike: list[tuple[object, ...]], rest: dict[str, list[str]]) -> list[str]:
    """Return the columns in which records differ that are alike."""
    n = len(set(alike))
    return [
        repr(name) for name, cells in rest.items() if len(set(zip(alike, cells, strict=True))) > n
    ]


def _same_visit(observations: Observations, place: NDArray[np.intp]) -> list[ImportMessage]:
    """Return a doubt about records of one place ``(k,)`` and day that disagree."""
    if len(observations) < 2:
        return []
    day = observations.day.astype(np.int64).astype(np.float64)
    kinds = [
        np.unique(v, return_inverse=True)[1] for v in (observations.species, observations.stage)
    ]
    visit: list[NDArray[np.generic]] = [place, day, *kinds]
    count = np.nan_to_num(observations.count, nan=-1)
    n_visits, n_stated = _n_distinct(visit), _n_distinct([*visit, count, observations.present])
    if n_stated == n_visits:
        return []
    return [
        doubtful(
            worded(
                "{n} {n:record gives|records give} another count for a place and day that "
                "another record "
                "already has.",
                n=n_stated - n_visits,
            )
        )
    ]


def _n_distinct(columns: list[NDArray[np.generic]]) -> int:
    """Return how many different rows columns ``(n,)`` make."""
    order = np.lexsort(columns)
    new = np.zeros(len(order) - 1, dtype=bool)
    for column in columns:
        new |= np.diff(column[order]) != 0
    return int(new.sum()) + 1
