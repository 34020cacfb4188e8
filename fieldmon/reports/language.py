"""The language in which a report is written: whoever knows languages hands one in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.reports import words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable


@dataclass(frozen=True)
class ReportLanguage:
    """A language for paper.

    Parameters
    ----------
    code
        Its code, as ``"he"``.
    say
        Returns a sentence of the library (`fieldmon.compute.wording`) in it.
    right_to_left
        Whether it is read from the right.
    letters
        All that it may write.
    """

    code: str = "en"
    say: Callable[[str], str] = str
    right_to_left: bool = False
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
