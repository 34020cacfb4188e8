"""A log by visits: what a robot or a phone told plant by plant is one line, with counts."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fieldmon.compute.wording import written

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.monitoring.changes.log_entry import LogEntry

# a batch, its source and who inspected
_Visit = tuple[object, object, str]
_COUNTS = "found", "clean", "skipped"


@dataclass(frozen=True)
class LogVisit:
    """Entries that are one line: one of any kind, or all that a visit told.

    Parameters
    ----------
    entry
        The first one; of a visit it counts what all of them saw.
    last
        The last one.
    n
        How many there are, new plans left out.
    replanned
        How often the day was planned anew in between.
    """

    entry: LogEntry
    last: LogEntry
    n: int = 1
    replanned: int = 0

    def sentence(self, until: str) -> str:
        """Return what happened, in words; `until` is when the last entry was written."""
        said = self.entry.sentence()
        if self.n > 1:
            said += f"; in {self.n:,} entries, the last ({self.last.number}) at {until}"
        if self.replanned:
            said += f"; planned anew {self.replanned:,} {written(self.replanned, 'time|times')}"
        return said

    def and_(self, entry: LogEntry, replanned: int) -> LogVisit:
        """Return the visit with one entry more, before which it was planned anew so often."""
        now, more = self.entry.what, entry.what
        counts = {name: now[name] + more.get(name, 0) for name in _COUNTS if name in now}
        told = sorted({*now.get("detects", ()), *more.get("detects", ())})
        what = {**now, **counts, **({"detects": told} if told else {})}
        first = replace(self.entry, what=what, numbers={**self.entry.numbers, **entry.numbers})
        return LogVisit(first, entry, self.n + 1, self.replanned + replanned)


def by_visit(log: Iterable[LogEntry]) -> list[LogVisit]:
    """Return the entries of a log, those in which one visit was told as one.

    They are of one batch and one person, with nothing between but other visits and new plans.
    """
    made = _Visits()
    for entry in log:
        made.take(entry)
    return [one for one in made.lines if one is not None]


@dataclass
class _Visits:
    """Lines so far; of visits that may go on where they stand, and plans made since, by visit."""

    lines: list[LogVisit | None] = field(default_factory=list)
    going_on: dict[_Visit, int] = field(default_factory=dict)
    plans: dict[_Visit, list[int]] = field(default_factory=dict)

    def take(self, entry: LogEntry) -> None:
        visit = entry.what.get("batch"), entry.what.get("source"), entry.who
        if entry.kind == "planned":
            if (of := self._planned_for(entry)) is not None:
                self.plans.setdefault(of, []).append(len(self.lines))
        elif entry.kind != "seen" or entry.what.get("more"):
            self.going_on, self.plans = {}, {}
        elif visit in self.going_on:
            self._go_on(visit, entry)
            return
        else:
            self.going_on[visit] = len(self.lines)
        self.lines.append(LogVisit(entry, entry))

    def _planned_for(self, plan: LogEntry) -> _Visit | None:
        """Return the visit that goes on by a plan; None: the day is planned before any began."""
        days = {one: self._at(one).last.what.get("to") for one in self.going_on}
        of_day = [one for one, to in days.items() if to == plan.what.get("date")]
        own = [one for one in of_day if one[-1] == plan.who]
        return next(iter([*own, *reversed(of_day)]), None)

    def _go_on(self, visit: _Visit, entry: LogEntry) -> None:
        plans = self.plans.pop(visit, [])
        for k in plans:
            self.lines[k] = None
        self.lines[self.going_on[visit]] = self._at(visit).and_(entry, len(plans))

    def _at(self, visit: _Visit) -> LogVisit:
        line = self.lines[self.going_on[visit]]
        assert line is not None  # noqa: S101 - a visit stays where it stands
        return line
