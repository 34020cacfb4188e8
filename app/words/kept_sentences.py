"""Sentences of the library that were kept as plain text: told by their words, and said again.

A season keeps what its import said as English sentences, which other programs read too. Which one
it was is told by the words around its blanks; what stood in these is filled in again.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from string import Formatter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

# fewer letters than this are no sentence, but what may stand in a blank by chance
_LEAST = 12
_ENDS = re.compile(r"(?<=[.!?]) (?=\S)")


@dataclass(frozen=True)
class KeptWords:
    """The words of a sentence with blanks, as they are looked for in a finished one."""

    words: str

    @cached_property
    def literals(self) -> tuple[str, ...]:
        """Return what stands around the blanks."""
        return tuple(literal for literal, *_ in Formatter().parse(self.words) if literal)

    @cached_property
    def letters(self) -> int:
        """Return how many letters stand around the blanks, those chosen by a number among them."""
        chosen = (form for _, _, form, _ in Formatter().parse(self.words) if form and "|" in form)
        said = (*self.literals, *(min(form.split("|"), key=len) for form in chosen))
        return sum(letter.isalpha() for literal in said for letter in literal)

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        made, known = "", set()
        for literal, name, form, _ in Formatter().parse(self.words):
            made += re.escape(literal)
            if form and "|" in form:  # words chosen by a number
                made += f"(?:{'|'.join(map(re.escape, (*form.split('|'), _for_any(form))))})"
            elif name in known:
                made += f"(?P={name})"
            elif name is not None:
                known.add(name)
                made += f"(?P<{name}>.+?)"
        return re.compile(made, re.DOTALL)

    @cached_property
    def longest(self) -> str:
        """Return the most that stands between two blanks: of other sentences, few hold it."""
        return max(self.literals, key=len, default="")

    def blanks(self, sentence: str) -> dict[str, str] | None:
        """Return what stands in the blanks of a sentence; None if these are not its words."""
        if not all(literal in sentence for literal in self.literals):
            return None
        found = self._pattern.fullmatch(sentence)
        if found is None:
            return None
        told = found.groupdict()
        # what begins with a blank must not take the sentence before for it
        begins = next(iter(told.values()), "") if self.words.startswith("{") else ""
        return None if _ENDS.search(begins) else told


def _for_any(form: str) -> str:
    """Return words chosen by a number as seasons before 0.2.0 keep them.

    Examples
    --------
    >>> _for_any("record lies|records lie")
    'record(s) lie'
    """
    noun = form.partition("|")[0].partition(" ")[0]
    many = form.partition("|")[2]
    return many.replace(f"{noun}s", f"{noun}(s)", 1)


class KnownSentences:
    """All words with blanks that a finished sentence may have been made of."""

    def __init__(self, words: Iterable[str]) -> None:
        kept = [KeptWords(one) for one in words]
        many = [one for one in kept if one.letters >= _LEAST]
        most_letters_first = sorted(many, key=lambda one: -one.letters)
        self._by_longest = [(one.longest, one) for one in most_letters_first]

    def told(self, sentence: str) -> tuple[str, dict[str, str]] | None:
        """Return the words of a sentence and what stands in their blanks; None: not known."""
        for longest, one in self._by_longest:
            if longest in sentence and (blanks := one.blanks(sentence)) is not None:
                return one.words, blanks
        return None


def sentences(text: str) -> list[str]:
    """Return the sentences of a text, one after the other.

    Examples
    --------
    >>> sentences("Rows run north. They are 4.5 m apart.")
    ['Rows run north.', 'They are 4.5 m apart.']
    """
    return _ENDS.split(text)
