"""What an import saw, repaired, guessed, dropped or doubts, for people and for programs.

A message with a remedy can be answered. The remedy names an option of reading (`options`) and the
values that can be chosen for it, the likeliest first:

- a page shows a button for each of `remedy.choices` and reads again with
  ``options.choose(remedy.option, choice)``;
- the command line prints ``--plot-option NAME=VALUE`` or ``--record-option NAME=VALUE``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Generic, TypeVar

from fieldmon.compute.wording import worded

if TYPE_CHECKING:
    from collections.abc import Iterable

T = TypeVar("T")
U = TypeVar("U")


class Severity(StrEnum):
    """How much a message matters, from good to know to look before you use it."""

    SEEN = "seen"
    REPAIRED = "repaired"
    GUESSED = "guessed"
    DROPPED = "dropped"
    DOUBTFUL = "doubtful"

    @property
    def rank(self) -> int:
        """Return 0 for the most harmless, 4 for the gravest."""
        return list(Severity).index(self)

    @property
    def is_loss(self) -> bool:
        """Return whether something of a file was left out, or is doubtful."""
        return self in {Severity.DROPPED, Severity.DOUBTFUL}


@dataclass(frozen=True)
class Remedy:
    """What a person can choose instead: an option of the command, a button in the app.

    Parameters
    ----------
    option
        Name of the option, as in the options' dataclass: ``"crs"``, ``"swap_axes"``...
    value
        The value as text; ``options.choose(option, value)`` sets it.
    label
        A few words for a button.
    others
        Further values that could be chosen.
    """

    option: str
    value: str
    label: str
    others: tuple[str, ...] = ()

    @property
    def choices(self) -> tuple[str, ...]:
        """Return every value that can be chosen, the likeliest first."""
        return (self.value, *self.others)

    @property
    def setting(self) -> str:
        """Return the option as one writes it on the command line: ``date_order=mdy``."""
        text = f"{self.option}={self.value}"
        return text if re.fullmatch(r"[\w=:.,+-]+", text) else f'"{text}"'


@dataclass(frozen=True)
class ImportMessage:
    """One thing that an import has to say.

    Parameters
    ----------
    severity
        How much it matters.
    sentence
        Plain words for the person who brought the file.
    feature
        The plot, record or column it is about; None where it is about the whole file.
    remedy
        What to choose if the import got it wrong; None where there is nothing to choose.
    many
        What to say where the same holds for ``{n}`` features; empty where it holds for one only.
    each
        The same of each feature by itself, where it is about several.
    """

    severity: Severity
    sentence: str
    feature: str | None = None
    remedy: Remedy | None = None
    many: str = ""
    each: tuple[ImportMessage, ...] = field(default=(), repr=False, compare=False)

    def __str__(self) -> str:
        return self.line()

    def about(self, feature: str) -> tuple[ImportMessage, ...]:
        """Return what it says of one feature and, unless it is about some, of the whole file."""
        if self.each:
            return tuple(one for one in self.each if one.feature == feature)
        return (self,) if self.feature in {None, feature} else ()

    def line(self, flag: str = "") -> str:
        """Return the message in a line, its remedy behind the `flag` that takes it."""
        place = f"{self.feature}: " if self.feature else ""
        way_out = ""
        if self.remedy is not None:
            way_out = f" ({self.remedy.label}: {f'{flag} {self.remedy.setting}'.strip()})"
        return f"{self.severity}: {place}{self.sentence}{way_out}"


@dataclass(frozen=True)
class WrongRows(ImportMessage):
    """A doubt that a column says of a plot's rows what no rows are.

    Parameters
    ----------
    column, setting
        The file's name for it, and `Planting`'s.
    rule
        What it must be.
    value
        What it is.
    """

    column: str = ""
    setting: str = ""
    rule: str = ""
    value: float = 0.0


@dataclass(frozen=True)
class UnreadDates(ImportMessage):
    """A doubt that inspections say as their date what is none."""


@dataclass(frozen=True)
class DaysToCome(ImportMessage):
    """A doubt that days have not come yet."""


@dataclass(frozen=True)
class UnsureCells(ImportMessage):
    """A guess of what cells say that could say something else: no correction is taken on it."""


def gathered(messages: Iterable[ImportMessage]) -> tuple[ImportMessage, ...]:
    """Return messages with those of one kind, about many features, as one with their number."""
    kinds: dict[object, list[ImportMessage]] = {}
    for number, one in enumerate(messages):
        kinds.setdefault((one.severity, one.many, one.remedy) if one.many else number, []).append(
            one
        )
    return tuple(same[0] if len(same) == 1 else _as_one(same) for same in kinds.values())


def _as_one(same: list[ImportMessage]) -> ImportMessage:
    first = same[0]
    told = worded(
        "{told}; the first is {about}{first}",
        told=worded(first.many, n=len(same)),
        about=f"{first.feature}: " if first.feature else "",
        first=first.sentence,
    )
    return replace(first, sentence=told, feature=None, each=tuple(same))


@dataclass(frozen=True)
class Imported(Generic[T]):
    """What came in, and everything there is to say about it.

    Parameters
    ----------
    value
        The data.
    messages
        In the order in which they were made.
    """

    value: T
    messages: tuple[ImportMessage, ...] = ()

    @property
    def worst(self) -> Severity | None:
        """Return the gravest severity, or None where there is nothing to say."""
        return max((f.severity for f in self.messages), key=lambda s: s.rank, default=None)

    def of(self, *severities: Severity) -> tuple[ImportMessage, ...]:
        """Return the messages of the given severities."""
        return tuple(f for f in self.messages if f.severity in severities)

    def having(self, value: U, more: Iterable[ImportMessage] = ()) -> Imported[U]:
        """Return another value with these messages and more."""
        return Imported(value, (*self.messages, *more))


def seen(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> ImportMessage:
    """Return a message that is good to know."""
    return ImportMessage(Severity.SEEN, sentence, feature, remedy)


def repaired(sentence: str, feature: str | None = None, many: str = "") -> ImportMessage:
    """Return a message about something put right."""
    return ImportMessage(Severity.REPAIRED, sentence, feature, many=many)


def guessed(
    sentence: str, feature: str | None = None, remedy: Remedy | None = None
) -> ImportMessage:
    """Return a message about something that could have been read otherwise."""
    return ImportMessage(Severity.GUESSED, sentence, feature, remedy)


def dropped(
    sentence: str, feature: str | None = None, remedy: Remedy | None = None, many: str = ""
) -> ImportMessage:
    """Return a message about something left out."""
    return ImportMessage(Severity.DROPPED, sentence, feature, remedy, many)


def doubtful(
    sentence: str, feature: str | None = None, remedy: Remedy | None = None, many: str = ""
) -> ImportMessage:
    """Return a message about something to look at before the data are used."""
    return ImportMessage(Severity.DOUBTFUL, sentence, feature, remedy, many)
