"""When plants were inspected, as a file says it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed
from fieldmon.io.parse.clock import clock_time, is_clock_alone, local_time, zone_of
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.values import dates
from fieldmon.io.readers.date_doubts import in_future, mixed_dates
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

    Where the file has no time of its own, the day is that of the planned arrival, which stands in
    the route files given out; else the day told by hand; else it is left open.
    """
    cells = _time_cells(layer, columns, options)
    read = dates(_object(cells), options.date_order)
    clocks = {cell: clock_time(cell) for cell in set(cells)}
    when = np.full(len(layer), "NaT", dtype="datetime64[s]")
    zone = None if options.zone is None else zone_of(options.zone)
    n_utc = 0
    for i, cell in enumerate(cells):
        clock = clocks[cell]
        if clock is not None and not np.isnat(read.day[i]):
            when[i] = local_time(read.day[i], clock, zone)
            n_utc += clock.offset is not None and zone is None
    day = np.where(np.isnat(when), read.day, when.astype("datetime64[D]"))
    planned = dates(_object(arrivals_in(layer, columns).tolist())).day
    told = np.datetime64("NaT", "D") if options.day is None else options.day
    day = np.where(np.isnat(day), planned, day)
    day = np.where(np.isnat(day), told, day).astype("datetime64[D]")
    about = _about_times(read.n_broken, read.broken, read.is_ambiguous, n_utc)
    return NotedTimes(when, day, [*mixed_dates(read), *in_future(day), *about])


def _about_times(
    n_broken: int,
    broken: tuple[str, ...],
    is_ambiguous: bool,  # noqa: FBT001 - one caller
    n_utc: int,
) -> list[ImportMessage]:
    messages = []
    if n_broken:
        shown = ", ".join(repr(cell) for cell in broken[:3])
        messages.append(
            doubtful(
                worded(
                    "{n_broken} time(s) are none ({shown}); left open.",
                    n_broken=n_broken,
                    shown=shown,
                )
            )
        )
    if is_ambiguous:
        remedy = Remedy("date_order", "mdy", worded("Read month first"))
        messages.append(
            guessed(worded("Dates could be day or month first; read day first."), None, remedy)
        )
    if n_utc:
        remedy = Remedy("zone", "+02:00", worded("Name the plot's time zone"))
        said = worded(
            "{n_utc} time(s) name a time zone of their own; their clock was kept as it is.",
            n_utc=n_utc,
        )
        messages.append(guessed(said, None, remedy))
    return messages


def _object(cells: list[str]) -> NDArray[np.object_]:
    values = np.empty(len(cells), dtype=object)
    values[:] = cells
    return values


def _time_cells(layer: Layer, columns: InspectionColumns, options: InspectionOptions) -> list[str]:
    """Return the text of each record's time, put together from two columns where it is in two."""
    taken = {columns.arrive, columns.result, columns.marks}
    time = own_column("time", layer, taken)
    away = frozenset(name for name in (*taken, time) if name)
    date = options.column("date") or find("date", layer.columns, away)
    clocks = texts_in(layer, time).tolist()
    days = texts_in(layer, date).tolist()
    return [
        f"{day} {clock}".strip() if day and is_clock_alone(clock) else (clock or day)
        for day, clock in zip(days, clocks, strict=True)
    ]
