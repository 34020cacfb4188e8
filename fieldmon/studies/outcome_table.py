"""A study's table of outcomes: a store that is a CSV file, with which a stopped study goes on."""

from __future__ import annotations

import csv
import io
from dataclasses import astuple
from math import isfinite
from time import monotonic
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, TypeVar

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem
from fieldmon.io.atomic_write import others_waiting, write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Sequence
    from pathlib import Path
    from types import TracebackType
    from typing import Self

_SAVED_EVERY_S = 15.0
# so much is shown of a line that cannot be read
_SHOWN = 60


class StudyOutcome(Protocol):
    """A row of a study's table: a dataclass of texts, whole numbers and numbers.

    Attributes
    ----------
    columns, kinds
        What its columns are called in files, and what reads their values: `ValueError` for none.
    """

    columns: ClassVar[tuple[str, ...]]
    kinds: ClassVar[tuple[Callable[[str], Any], ...]]

    @property
    def key(self) -> Hashable:
        """Return the chunk that it is of."""
        ...


Row = TypeVar("Row", bound=StudyOutcome)


def finite(cell: str) -> float:
    """Return a number that is one; raise `ValueError` for nan and infinity.

    Examples
    --------
    >>> finite("2.5")
    2.5
    """
    value = float(cell)
    if not isfinite(value):
        raise ValueError(cell)
    return value


class OutcomeTable(Generic[Row]):
    """Outcomes by the keys of their chunks, written now and then, and when it is left.

    What another study wrote into the file meanwhile stays there, as in the folder of
    `fieldmon study run`.

    Parameters
    ----------
    file
        Where they are; what is there already is read.
    order
        Keys in the order in which they are written. Others that the file holds come before them.
    kind
        The class of its rows.
    whole
        Tells whether the rows of a chunk are all that there should be; what lost some is simulated
        again.
    """

    def __init__(
        self,
        file: Path,
        order: Iterable[Hashable],
        kind: type[Row],
        whole: Callable[[list[Row]], bool] = bool,
    ) -> None:
        self.file, self._kind = file, kind
        self._by_key: dict[Hashable, list[Row]] = {}
        self._order = list(order)
        self._whole = whole
        self._saved = monotonic()
        self._take_in()

    def _take_in(self) -> None:
        """Take the chunks of the file that are not known; of those asked for only whole ones."""
        if not self.file.exists():
            return
        text = self.file.read_text(encoding="utf-8", errors="replace")
        written: dict[Hashable, list[Row]] = {}
        for outcome in outcomes_from(text, self.file.name, self._kind):
            written.setdefault(outcome.key, []).append(outcome)
        asked = set(self._order)
        for key, rows in written.items():
            if key not in asked or self._whole(rows):
                self._by_key.setdefault(key, rows)

    def holds(self, key: Hashable) -> bool:
        """Tell whether a chunk is there."""
        return key in self._by_key

    def keep(self, key: Hashable, result: list[Row]) -> None:
        """Take the outcomes of a chunk."""
        self._by_key[key] = result
        if monotonic() > self._saved + _SAVED_EVERY_S:
            self.save()

    def save(self) -> None:
        """Write the file, into a folder that is made where it is not there.

        Raise `FileProblem` where it cannot be read any more, once a file beside it has all chunks.
        """
        self.file.parent.mkdir(parents=True, exist_ok=True)
        with others_waiting(self.file.parent):
            try:
                self._take_in()
            except FileProblem as problem:
                beside = self.file.with_suffix(f".kept{self.file.suffix}")
                rows = [row for each in self._by_key.values() for row in each]
                write_whole(beside, csv_text(rows, self._kind).encode())
                said = worded("What was simulated is in {name}.", name=beside.name)
                raise FileProblem(joined(" ", (problem.args[0], said))) from problem
            asked = set(self._order)
            others = [key for key in self._by_key if key not in asked]
            rows = [row for key in (*others, *self._order) for row in self._by_key.get(key, [])]
            write_whole(self.file, csv_text(rows, self._kind).encode())
        self._saved = monotonic()

    def asked(self) -> list[Row]:
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


def csv_text(outcomes: Sequence[Row], kind: type[Row]) -> str:
    """Return outcomes as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(kind.columns)
    writer.writerows(astuple(outcome) for outcome in outcomes)  # type: ignore[call-overload]
    return text.getvalue()


def outcomes_from(text: str, name: str, kind: type[Row]) -> list[Row]:
    """Read outcomes back from :func:`csv_text`; raise `FileProblem` if it is something else."""
    rows = list(csv.reader(io.StringIO(text)))
    if not rows or rows[0] != list(kind.columns):
        raise FileProblem(
            f"{name} must be a table of this study to go on with, but its columns are others. "
            "Move it away, or name another folder."
        )
    return [
        _outcome(row, f"Line {number} of {name}", kind) for number, row in enumerate(rows[1:], 2)
    ]


def _outcome(row: list[str], line: str, kind: type[Row]) -> Row:
    try:
        return kind(*(read(value) for read, value in zip(kind.kinds, row, strict=True)))
    except ValueError as error:
        raise FileProblem(
            f"{line} must hold {', '.join(kind.columns)} as this study wrote them, but it is "
            f"{','.join(row)[:_SHOWN]!r}. The table was changed or cut: move it away, or name "
            "another folder."
        ) from error
