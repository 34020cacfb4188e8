"""When plants were inspected, as a file says it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import (
    ImportMessage,
    Remedy,
    Severity,
    UnsureCells,
    doubtful,
    guessed,
)
from fieldmon.io.parse.clock import (
    DAY_END_S,
    are_days,
    as_clocks,
    clock_time,
    is_clock_alone,
    is_skipped,
    local_time,
    n_midnights_left_out,
    without_midnights,
    zone_of,
)
from fieldmon.io.parse.columns import find, is_of_work, is_of_writing, plain
from fieldmon.io.parse.dates import dates, is_written_as_day
from fieldmon.io.parse.values import is_missing, numbers
from fieldmon.io.readers.date_doubts import (
    amid_past,
    broken_times,
    in_future,
    midnights_left_out,
    read_day_first,
    refuse_mixed,
    unread_days,
)
from fieldmon.io.readers.inspection_file.columns import arrivals_in, own_column, texts_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.readers.inspection_file.columns import InspectionColumns
    from fieldmon.io.readers.inspection_options import InspectionOptions


class NotedTimes(NamedTuple):
    """Local times datetime64[s] and days datetime64[D], ``(n,)`` each; NaT where unknown."""

    when: NDArray[np.datetime64]
    day: NDArray[np.datetime64]
    messages: list[ImportMessage]


def times_in(layer: Layer, columns: InspectionColumns, options: InspectionOptions) -> NotedTimes:
    """Return local times and days.

    A record that says no day is of the day of its planned arrival, which stands in the route files
    given out, or, with no time either, of the day on which that route begins; else of the day told
    by hand, or of the day of the work where no record says one; else its day is left open. One that
    says a day that is none (30 February) is left open too: nothing is put in its place. Midnights
    are days without a time where `are_days` says so.
    """
    date, time = _columns(layer, columns, options)
    written = _cells(layer, date, time)
    days, clocks = map(without_midnights, written)
    n_days = sum(map(n_midnights_left_out, written, (days, clocks)))
    own = dates(_object(clocks), options.date_order).day
    # what says the day: the cell of the time, where it holds one, else that of the date
    on = [
        clock if not np.isnat(day) else said or ("" if _no_day(clock) else clock)
        for said, clock, day in zip(days, clocks, own, strict=True)
    ]
    read = dates(_object(on), options.date_order)
    refuse_mixed(read, layer.name)
    at = [clock or said for said, clock in zip(days, clocks, strict=True)]
    read_clocks = {cell: clock_time(cell) for cell in set(at)}
    timed = np.array([read_clocks[cell] is not None for cell in at], bool)
    planned = _planned_days(layer, columns, timed)
    unsaid = np.array([is_missing(cell) for cell in on], bool)
    otherwise = _days_otherwise(planned, options, is_any_said=not unsaid.all())
    day = np.where(unsaid, otherwise, read.day).astype("datetime64[D]")
    when = np.full(len(layer), "NaT", dtype="datetime64[s]")
    zone = None if options.zone is None else zone_of(options.zone)
    n_utc, broken, skipped = 0, [], []
    zoned, ends = np.zeros((2, len(layer)), bool)
    undated = {}
    for i, cell in enumerate(at):
        clock = read_clocks[cell]
        if not unsaid[i] and np.isnat(read.day[i]):
            undated[i + 1] = f"{on[i]} {clocks[i]}" if days[i] and clocks[i] else on[i]
        elif clock is None and (":" in cell or (clocks[i] and np.isnat(own[i]))):
            broken.append(cell)
        elif clock is not None and not np.isnat(day[i]):
            when[i] = local_time(day[i], clock, zone)
            n_utc += clock.offset is not None and zone is None
            zoned[i], ends[i] = clock.offset is not None, clock.seconds == DAY_END_S
            if zone is not None and not zoned[i] and is_skipped(when[i], zone):
                skipped.append(str(when[i]))
    day = np.where(np.isnat(when), day, when.astype("datetime64[D]")).astype("datetime64[D]")
    n_days += _leave_out_midnights(when, day, zoned, ends)
    of_days = midnights_left_out(n_days)
    about = unread_days(undated) + _about_times(broken, read.is_ambiguous, n_utc)
    about += [*_about_ends(int(ends.sum())), *_about_skipped(skipped)]
    idle = _of_told_day(options.day, day, needed=unsaid & np.isnat(planned))
    idle += _of_writing(date, options)
    # where others have come each that has not is left out, and said, unless they are taken
    ahead = in_future(day) if options.take_doubtful or not amid_past(day) else []
    return NotedTimes(when, day, [*ahead, *idle, *of_days, *about])


def _days_otherwise(
    planned: NDArray[np.datetime64], options: InspectionOptions, *, is_any_said: bool
) -> NDArray[np.datetime64]:
    """Return the days of records that say none: planned, told, or of the work if none is said."""
    told = options.day
    if told is None and not is_any_said and np.isnat(planned).all():
        told = options.work_day
    told = np.datetime64("NaT", "D") if told is None else told
    return np.where(np.isnat(planned), told, planned)


def _leave_out_midnights(
    when: NDArray[np.datetime64],
    day: NDArray[np.datetime64],
    zoned: NDArray[np.bool_],
    ends: NDArray[np.bool_],
) -> int:
    """Take midnights that are days without a time out of `when`; return how many to say.

    `zoned`: written with a zone; `ends`: written as 24:00. Where all times are midnights, nothing
    is said.
    """
    midnights = (when == day) & ~ends  # of here, written in UTC
    n_times, n = int((~np.isnat(when)).sum()), 0
    if midnights.sum() < n_times:
        midnights &= zoned
        n_here = int(midnights.sum())
        n = n_here if are_days(n_here, n_times) else 0
    if are_days(int(midnights.sum()), n_times):
        when[midnights] = "NaT"
    return n


def _of_told_day(
    told: np.datetime64 | None, day: NDArray[np.datetime64], *, needed: NDArray[np.bool_]
) -> list[ImportMessage]:
    """Return a doubt where a day was told by hand, but lines are all of other days."""
    if told is None or needed.any() or np.isnat(day).any() or (day == told).all():
        return []
    said = worded(
        "The day that was told, {told}, counts for no line: each is of a day of its own.", told=told
    )
    return [doubtful(said)]


def _planned_days(
    layer: Layer, columns: InspectionColumns, timed: NDArray[np.bool_]
) -> NDArray[np.datetime64]:
    """Return the days of planned arrivals; of records that are not timed, those of the begin."""
    arrivals = arrivals_in(layer, columns).tolist()
    days = dates(_object(arrivals)).day
    gone = next((name for name in layer.columns if plain(name) == plain("arrive_s")), None)
    if gone is None:
        return days
    gone_s = np.nan_to_num(numbers(layer.column(gone)))
    for i in np.flatnonzero(~timed & ~np.isnat(days)):
        if (clock := clock_time(arrivals[i])) is not None:
            begun = local_time(days[i], clock, None) - np.timedelta64(round(gone_s[i]), "s")
            days[i] = begun.astype("datetime64[D]")
    return days


def _about_times(
    broken: list[str],
    is_ambiguous: bool,  # noqa: FBT001 - one caller
    n_utc: int,
) -> list[ImportMessage]:
    messages = broken_times(broken)
    if is_ambiguous:
        messages.append(read_day_first())
    if n_utc:
        remedy = Remedy("zone", "+02:00", worded("Name the plot's time zone"))
        said = worded(
            "{n_utc} {n_utc:time has|times have} a time zone of "
            "{n_utc:its own; it was|their own; they were} kept as the clock said.",
            n_utc=n_utc,
        )
        messages.append(guessed(said, None, remedy))
    return messages


def _about_ends(n: int) -> list[ImportMessage]:
    """Return what was guessed of times written as 24:00."""
    if not n:
        return []
    said = worded(
        "{n} {n:time is|times are} 24:00, taken as 00:00 of the next day. Write 23:59 for the day "
        "that ends.",
        n=n,
    )
    return [UnsureCells(Severity.GUESSED, said)]


def _about_skipped(times: list[str]) -> list[ImportMessage]:
    """Return a doubt about local times that no clock shows."""
    if not times:
        return []
    said = worded(
        "{n} {n:time is|times are} in an hour that clocks skip at the plot ({time}), and "
        "{n:was|were} taken as written. Look whether {n:it is|they are} of another zone, or wrong.",
        n=len(times),
        time=times[0],
    )
    return [doubtful(said)]


def _object(cells: list[str]) -> NDArray[np.object_]:
    values = np.empty(len(cells), dtype=object)
    values[:] = cells
    return values


def _columns(
    layer: Layer, columns: InspectionColumns, options: InspectionOptions
) -> tuple[str | None, str | None]:
    """Return the columns of days and of times; ask which one where two say different days.

    When a record was written or sent is no day of the work where another column says a day.
    """
    taken = {columns.arrive, columns.result, columns.marks}
    time = own_column("time", layer, taken)
    away = frozenset(name for name in (*taken, time) if name)
    if told := options.column("date"):
        return told, time
    named = find("date", layer.columns, away)
    days = {
        name: _days(layer, name, options)
        for name in layer.columns
        if name not in away and is_of_work(name)
    }
    of_work = [name for name, each in days.items() if not np.isnat(each).all()]
    if len(of_work) > 1 and (n := _n_apart([days[name] for name in of_work])):
        raise ChoiceNeeded(
            worded(
                "A result must be of one day, but columns {names} say different days of {n} of "
                "{total} {total:record|records}. Choose the one of the inspection.",
                names=", ".join(map(repr, of_work)),
                n=n,
                total=len(layer),
            ),
            "columns",
            tuple(f"date={name}" for name in of_work),
        )
    if of_work:
        return (named if named in of_work else of_work[0]), time
    written = (name for name in layer.columns if name not in away and is_of_writing(name))
    tells = time is not None and _has_days(layer, time, options)
    sent = None if tells else next((n for n in written if _has_days(layer, n, options)), None)
    return sent or (None if named and is_of_writing(named) else named), time


def _has_days(layer: Layer, name: str, options: InspectionOptions) -> bool:
    return bool((~np.isnat(_days(layer, name, options))).any())


def _days(layer: Layer, name: str, options: InspectionOptions) -> NDArray[np.datetime64]:
    cells = [cell if is_written_as_day(cell) else "" for cell in texts_in(layer, name).tolist()]
    return dates(_object(cells), options.date_order).day


def _n_apart(days: list[NDArray[np.datetime64]]) -> int:
    """Return how many records are of different days ``(n,)`` in two of several columns."""
    first = days[0]
    apart = np.zeros(len(first), bool)
    for other in days[1:]:
        apart |= ~np.isnat(first) & ~np.isnat(other) & (first != other)
        first = np.where(np.isnat(first), other, first)
    return int(apart.sum())


def _of_writing(date: str | None, options: InspectionOptions) -> list[ImportMessage]:
    """Return a guess where days are only known from when records were written or sent."""
    if date is None or options.column("date") or not is_of_writing(date):
        return []
    said = worded(
        "Days are those of column {date!r}, when a record was written or sent: the only one with "
        "days.",
        date=date,
    )
    return [guessed(said)]


def _cells(layer: Layer, date: str | None, time: str | None) -> tuple[list[str], list[str]]:
    """Return the texts of each record's date and of its time, empty where there is no column."""
    days, clocks = texts_in(layer, date).tolist(), texts_in(layer, time).tolist()
    clocks = clocks if time is None else as_clocks(time, clocks)
    return days, clocks


def _no_day(cell: str) -> bool:
    """Return whether a time says no day, not even one that is none."""
    return is_clock_alone(cell) or not is_written_as_day(cell)
