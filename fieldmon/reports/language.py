"""The language in which a report is written: whoever knows languages hands one in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.wording import PaperLanguage
from fieldmon.reports import words

if TYPE_CHECKING:
    from collections.abc import Iterable


@dataclass(frozen=True)
class ReportLanguage(PaperLanguage):
    """A language for reports.

    Parameters
    ----------
    letters
        All that it may write.
    """

    letters: str = ""


def _letters_of(texts: Iterable[object]) -> str:
    """Return the letters of texts, and of those in tuples and dicts."""
    said = [
        _letters_of(text.values() if isinstance(text, dict) else text)
        if isinstance(text, tuple | dict)
        else str(text)
        for text in texts
    ]
    return "".join(sorted(set("".join(said))))


ENGLISH = ReportLanguage(letters=_letters_of(words.TEXTS.values()))
