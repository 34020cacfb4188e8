"""What to say of dates that cannot all be right: in both orders, or not yet come."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import (
    DaysToCome,
    Imported,
    ImportMessage,
    Remedy,
    Severity,
    UnreadDates,
    doubtful,
    dropped,
    guessed,
)
from fieldmon.io.readers.inspection_options import TAKE

if TYPE_CHECKING:
    from collections.abc import Mapping
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.parse.dates import DatedColumn
    from fieldmon.io.readers.inspection_options import InspectionOptions


def read_day_first() -> ImportMessage:
    """Return what is said where dates could be day or month first."""
    said = worded("Dates could be day or month first; read day first.")
    return guessed(said, None, Remedy("date_order", "mdy", worded("Read month first")))


def refuse_mixed(read: DatedColumn, name: str) -> None:
    """Raise `ChoiceNeeded` where dates of `name` are certain in one order, and others in another.

    Those that could be either would be guessed, and the others of one order be lost.
    """
    if len(read.sure) < 2:
        return
    (n_day, day), (n_month, month) = read.sure
    raise ChoiceNeeded(
        worded(
            "Dates must stand in one order, but those of {name!r} do not: {n_day} {n_day:is|are} "
            "day first ({day}), {n_month} month first ({month}), and {n} could be either. Write "
            "them all as 2026-11-18. Or choose one order: what is no date in it counts as unknown.",
            name=name,
            n_day=n_day,
            day=day,
            n_month=n_month,
            month=month,
            n=read.n_mixed,
        ),
        "date_order",
        ("dmy", "mdy"),
    )


def to_come(day: NDArray[np.datetime64], today: date | None = None) -> NDArray[np.bool_]:
    """Return which days ``(n,)`` come after `today`; None: have not come yet, anywhere on earth."""
    latest = np.datetime64(datetime.now(UTC).date(), "D") + 1  # it may be tomorrow elsewhere
    ahead: NDArray[np.bool_] = day > (latest if today is None else np.datetime64(today, "D"))
    return ahead


def amid_past(day: NDArray[np.datetime64], today: date | None = None) -> dict[int, str]:
    """Return why each of days ``(n,)`` is doubtful that have not come, where others have.

    A file of days to come alone may be a rehearsal. `today` as in `to_come`.
    """
    ahead = to_come(day, today)
    if not (~ahead & ~np.isnat(day)).any():
        return {}
    return {
        i: worded("its day, {day}, has not come, but others of the file have", day=day[i])
        for i in np.flatnonzero(ahead).tolist()
    }


def come(
    read: Imported[Inspections], options: InspectionOptions, today: date
) -> Imported[Inspections]:
    """Leave out, and say so, inspections of days after today on the plot, unless they are taken."""
    ahead = to_come(read.value.date, today)
    if options.take_doubtful or not ahead.any():
        return read
    said = worded(
        "{n} {n:result|results} of days that have not come, up to {latest}, {n:was|were} left out: "
        "it is {today} on the plot.",
        n=int(ahead.sum()),
        latest=read.value.date[ahead].max(),
        today=today,
    )
    # of the same days it is not said besides that they lie in the future
    told = [one for one in read.messages if not isinstance(one, DaysToCome)]
    kept = read.value.take(~ahead)
    return Imported(kept, (*told, dropped(said, None, TAKE)))


def since(read: Imported[Inspections], begins: date) -> Imported[Inspections]:
    """Leave out, and say so, inspections of before a season's first day, where others are of it."""
    before = read.value.date < np.datetime64(begins, "D")
    if not before.any() or before.all():
        return read
    said = worded(
        "{n} {n:result|results} of before the season's first day, {begins}, {n:was|were} left out, "
        "the first of {earliest}.",
        n=int(before.sum()),
        begins=begins,
        earliest=read.value.date[before].min().item(),
    )
    return Imported(read.value.take(~before), (*read.messages, dropped(said)))


def in_future(day: NDArray[np.datetime64], where: str | None = None) -> list[ImportMessage]:
    """Return a doubt where days ``(n,)`` have not come yet, anywhere on earth."""
    n_future = int(to_come(day).sum())
    if not n_future:
        return []
    said = worded(
        "{n} {n:record lies|records lie} in the future, the last on {latest}.",
        n=n_future,
        latest=np.nanmax(day),
    )
    return [DaysToCome(Severity.DOUBTFUL, said, where)]


def midnights_left_out(n: int, where: str | None = None) -> list[ImportMessage]:
    """Return the guess that `n` midnights among times are days."""
    if not n:
        return []
    said = worded(
        "{n} {n:date|dates} with the time 00:00 among others {n:was|were} read as "
        "{n:a day|days} without a time.",
        n=n,
    )
    return [guessed(said, where)]


_NAMED = 5
#: how dates are written instead that are none
HOW_TO_WRITE = worded("Write dates as 2026-11-18, 18/11/2026 or 18 November 2026.")


def unread_dates(cells: Mapping[int, str]) -> Worded:
    """Return how many dates are none, and of which records: cells by their numbers from 1."""
    first = [
        worded("record {number}: {cell!r}", number=number, cell=cell)
        for number, cell in list(cells.items())[:_NAMED]
    ]
    return worded(
        "{n} {n:record has|records have} a date that is none ({shown}).",
        n=len(cells),
        shown=joined(", ", [*first, *["..."] * (len(cells) > _NAMED)]),
    )


def unread_days(cells: Mapping[int, str]) -> list[ImportMessage]:
    """Return a doubt about inspections, by their numbers from 1, whose date is none."""
    if not cells:
        return []
    said = worded(
        "{said} A day told by hand counts only for records that say none. {how}",
        said=unread_dates(cells),
        how=HOW_TO_WRITE,
    )
    return [UnreadDates(Severity.DOUBTFUL, said)]


def broken_times(cells: list[str]) -> list[ImportMessage]:
    """Return a doubt about cells for times that hold none."""
    if not cells:
        return []
    shown = ", ".join(repr(cell) for cell in list(dict.fromkeys(cells))[:3])
    return [
        doubtful(
            worded(
                "{n_broken} {n_broken:time is|times are} none ({shown}); left open.",
                n_broken=len(cells),
                shown=shown,
            )
        )
    ]
