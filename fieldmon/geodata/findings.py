"""What an import saw, repaired, guessed, dropped or doubts, for people and for programs."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable

T = TypeVar("T")
U = TypeVar("U")


class Severity(StrEnum):
    """How much a finding matters, from good to know to look before you use it."""

    SEEN = "seen"
    REPAIRED = "repaired"
    GUESSED = "guessed"
    DROPPED = "dropped"
    DOUBTFUL = "doubtful"

    @property
    def rank(self) -> int:
        """Return 0 for the most harmless, 4 for the gravest."""
        return list(Severity).index(self)


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
    """

    option: str
    value: str
    label: str

    @property
    def flag(self) -> str:
        """Return the option as one writes it on the command line."""
        name = f"--{self.option.replace('_', '-')}"
        if self.value == "yes":
            return name
        return f"{name} {self.value}" if self.value.isalnum() else f'{name} "{self.value}"'


@dataclass(frozen=True)
class Finding:
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
    """

    severity: Severity
    sentence: str
    feature: str | None = None
    remedy: Remedy | None = None

    def __str__(self) -> str:
        place = f"{self.feature}: " if self.feature else ""
        way_out = f" ({self.remedy.label}: {self.remedy.flag})" if self.remedy else ""
        return f"{self.severity}: {place}{self.sentence}{way_out}"


@dataclass(frozen=True)
class Imported(Generic[T]):
    """What came in, and everything there is to say about it.

    Parameters
    ----------
    value
        The data.
    findings
        In the order in which they were made.
    """

    value: T
    findings: tuple[Finding, ...] = ()

    @property
    def worst(self) -> Severity | None:
        """Return the gravest severity, or None where there is nothing to say."""
        return max((f.severity for f in self.findings), key=lambda s: s.rank, default=None)

    def of(self, *severities: Severity) -> tuple[Finding, ...]:
        """Return the findings of the given severities."""
        return tuple(f for f in self.findings if f.severity in severities)

    def having(self, value: U, more: Iterable[Finding] = ()) -> Imported[U]:
        """Return another value with these findings and more."""
        return Imported(value, (*self.findings, *more))


def seen(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> Finding:
    """Return a finding that is good to know."""
    return Finding(Severity.SEEN, sentence, feature, remedy)


def repaired(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> Finding:
    """Return a finding about something put right."""
    return Finding(Severity.REPAIRED, sentence, feature, remedy)


def guessed(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> Finding:
    """Return a finding about something that could have been read otherwise."""
    return Finding(Severity.GUESSED, sentence, feature, remedy)


def dropped(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> Finding:
    """Return a finding about something left out."""
    return Finding(Severity.DROPPED, sentence, feature, remedy)


def doubtful(sentence: str, feature: str | None = None, remedy: Remedy | None = None) -> Finding:
    """Return a finding about something to look at before the data are used."""
    return Finding(Severity.DOUBTFUL, sentence, feature, remedy)
