"""The study's table of outcomes: a store that is a CSV file, with which a stopped study goes on."""

from __future__ import annotations

import csv
import io
from dataclasses import astuple
from time import monotonic
from typing import TYPE_CHECKING, cast

from fieldmon.errors import FileProblem
from fieldmon.io.atomic_write import write_whole
from fieldmon.studies.samplers.seasons import MEASURES, SeasonOutcome

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Sequence
    from pathlib import Path
    from types import TracebackType
    from typing import Self

# the first and third column are a scenario and a contender, named as in the tables made first
_COLUMNS = ["cell", "seed", "who", *MEASURES]
_SAVED_EVERY_S = 15.0


class OutcomeTable:
    """Outcomes by scenario and seed, written now and then, and when it is left.

    Parameters
    ----------
    file
        Where they are; what is there already is read.
    order
        Keys ``(scenario, seed)`` in the order in which they are written. Others that the file
        holds come before them.
    """

    def __init__(self, file: Path, order: Iterable[Hashable]) -> None:
        self.file = file
        self._by_key: dict[tuple[str, int], list[SeasonOutcome]] = {}
        self._order = cast("list[tuple[str, int]]", list(order))
        self._saved = monotonic()
        there = outcomes_from(file.read_text(encoding="utf-8"), file.name) if file.exists() else []
        for outcome in there:
            self._by_key.setdefault((outcome.scenario, outcome.seed), []).append(outcome)

    def holds(self, key: Hashable) -> bool:
        """Tell whether a scenario and seed is there."""
        return key in self._by_key

    def keep(self, key: Hashable, result: list[SeasonOutcome]) -> None:
        """Take the outcomes of a scenario and seed."""
        self._by_key[cast("tuple[str, int]", key)] = result
        if monotonic() > self._saved + _SAVED_EVERY_S:
            self.save()

    def save(self) -> None:
        """Write the file."""
        asked = set(self._order)
        others = [key for key in self._by_key if key not in asked]
        rows = [row for key in (*others, *self._order) for row in self._by_key.get(key, [])]
        write_whole(self.file, csv_text(rows).encode())
        self._saved = monotonic()

    def asked(self) -> list[SeasonOutcome]:
        """Return the outcomes that there are of what was asked for, in its order."""
        return [outcome for key in self._order for outcome in self._by_key.get(key, [])]

    def __enter__(self) -> Self:
        """Begin, or go on."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Write what is there, however it ended."""
        self.save()


def csv_text(outcomes: Sequence[SeasonOutcome]) -> str:
    """Return outcomes as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    writer.writerows(astuple(outcome) for outcome in outcomes)
    return text.getvalue()


def outcomes_from(text: str, name: str) -> list[SeasonOutcome]:
    """Read outcomes back from :func:`csv_text`; raise `FileProblem` if it is something else."""
    rows = list(csv.reader(io.StringIO(text)))
    if not rows or rows[0] != _COLUMNS:
        raise FileProblem(
            f"{name} must be a table of this study to go on with, but its columns are others. "
            "Move it away, or name another folder."
        )
    return [SeasonOutcome(row[0], int(row[1]), row[2], *map(float, row[3:])) for row in rows[1:]]
