"""Sentences that can be said in another language too, and how numbers of things are said."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from datetime import date
from string import Formatter
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence


#: into which sentences are translated, each by its own name
LANGUAGES = {"en": "English", "he": "עברית", "ar": "العربية", "es": "Español"}


@dataclass(frozen=True)
class PaperLanguage:
    """A language for paper; whoever knows languages hands one in.

    Parameters
    ----------
    code
        Its code, as ``"he"``.
    say
        Returns a sentence in it, see `Worded`.
    right_to_left
        Whether it is read from the right.
    """

    code: str = "en"
    say: Callable[[str], str] = str
    right_to_left: bool = False


PAPER_IN_ENGLISH = PaperLanguage()


class Worded(str):  # noqa: SLOT000 - it holds what it was made of
    """A finished English sentence that remembers its words and what stands in their blanks.

    It is the sentence wherever one is printed or compared. Who speaks another language finds its
    words by the English ones (see the app's `language`), and fills the same blanks.

    Attributes
    ----------
    words
        The sentence with its blanks, ``"{n:,} plants"``.
    values
        What stands in the blanks: numbers, names, other `Worded`.
    one
        The words for one thing, where they differ; ``number`` decides.
    parts, between
        Sentences that it joins, and by what.
    """

    words: str
    values: dict[str, Any]
    one: str
    number: int
    parts: tuple[str, ...]
    between: str

    def __new__(cls, sentence: str) -> Self:
        """Return a sentence, which does not remember anything yet."""
        made = super().__new__(cls, sentence)
        made.words, made.values, made.one, made.number = sentence, {}, "", 0
        made.parts, made.between = (), ""
        return made


class KeptText(str):
    """Sentences that were kept as plain English, as in a log, among those that are said now.

    Who speaks another language knows them again by their words.
    """

    __slots__ = ()


def written(value: Any, form: str) -> str:  # noqa: ANN401 - whatever can be written
    """Return a value as `format` writes it, but a share as all texts here have it.

    A form with a bar chooses words by a number: those for one, or those for any other.

    Examples
    --------
    >>> written(0.845, ".1%"), written(0.845, ".2f")
    ('84.5 %', '0.84')
    >>> written(1, "record lies|records lie"), written(3, "record lies|records lie")
    ('record lies', 'records lie')
    """
    if "|" in form:  # what is said of one, and of any other number
        return str(form.split("|")[int(value != 1)])  # of a number of numpy, too
    said = format(value, form)
    return f"{said[:-1]} %" if form.endswith("%") else said


class _Blanks(Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:  # noqa: ANN401
        return written(value, format_spec)


def filled(words: str, values: Mapping[str, Any]) -> str:
    """Return words with their blanks filled, as `written` writes what stands in them."""
    # others are many times as fast
    if "%}" in words or "|" in words:
        return _Blanks().vformat(words, (), values)
    return words.format_map(values)


def worded(words: str, **values: Any) -> Worded:  # noqa: ANN401 - whatever can be written
    """Return a sentence from its words and what stands in their blanks.

    Examples
    --------
    >>> worded("in rows {low} to {high}", low=3, high=17)
    'in rows 3 to 17'
    """
    made = Worded(filled(words, values))
    made.words, made.values = words, values
    return made


def figure(value: float, form: str = ",", after: str = "") -> Worded:
    """Return a number as words without words: whoever speaks a language writes its digits so.

    Examples
    --------
    >>> figure(1234.5, ",.1f", " %")
    '1,234.5 %'
    """
    return worded(f"{{n:{form}}}{after}", n=value)


def digits_of_estimate(value: float) -> int:
    """Return how many digits behind the point an estimate is worth: none from 10 on, else one.

    Examples
    --------
    >>> digits_of_estimate(9.96), digits_of_estimate(4.593)
    (0, 1)
    """
    return 0 if round(abs(value), 1) >= 10 else 1


def estimate(value: float) -> Worded:
    """Return an estimate as precise as it is worth saying: from 10 on as a whole number.

    Examples
    --------
    >>> estimate(1645.93), estimate(9.96), estimate(4.593)
    ('1,646', '10', '4.6')
    """
    return figure(value, f",.{digits_of_estimate(value)}f")


def share_figure(share: float) -> Worded:
    """Return a share as whole percents; a small one in as many digits as say anything.

    Examples
    --------
    >>> share_figure(0.156), share_figure(0.00234), share_figure(0), share_figure(0.9999)
    ('16 %', '0.23 %', '0 %', 'over 99 %')
    """
    return figure(100 * share, ".2g", " %") if 0 < share < 0.01 else chance_figure(share)


def chance_figure(chance: float, digits: int = 0, *, drawn: bool = False) -> Worded:
    """Return a chance in percent; none that is not exactly so is said to be 0 or 100 %.

    Parameters
    ----------
    chance
        Between 0 and 1.
    digits
        How many digits behind the point it is worth.
    drawn
        Whether it is a share of fields that were drawn: then it is never exactly so.

    Examples
    --------
    >>> chance_figure(0.843), chance_figure(0.9999), chance_figure(0.0002), chance_figure(1)
    ('84 %', 'over 99 %', 'under 1 %', '100 %')
    >>> chance_figure(0.0002, 1), chance_figure(1, drawn=True)
    ('under 0.1 %', 'over 99 %')
    """
    form, least = f".{digits}%", 10.0 ** -(digits + 2)
    rounded = round(chance, digits + 2)
    if rounded <= 0.0 and (drawn or chance > 0.0):
        return worded("under {share}", share=figure(least, form))
    if rounded >= 1.0 and (drawn or chance < 1.0):
        return worded("over {share}", share=figure(1.0 - least, form))
    return figure(chance, form)


def hours_figure(value_h: float) -> Worded:
    """Return hours to the tenth, whole ones without; what takes time takes a tenth or more.

    Examples
    --------
    >>> hours_figure(11.98), hours_figure(3.46), hours_figure(0.01), hours_figure(0)
    ('12', '3.5', '0.1', '0')
    """
    return figure(max(round(value_h, 1), 0.1) if value_h > 0 else round(value_h, 1), "g")


def joined(between: str, parts: Iterable[str]) -> Worded:
    """Return sentences, or parts of one, joined."""
    kept = tuple(parts)
    made = Worded(between.join(kept))
    made.parts, made.between = kept, between
    return made


def first_few(names: Sequence[str], most: int = 5) -> str:
    """Return the names that a sentence has room for, and a sign where there are more.

    Examples
    --------
    >>> first_few(["north", "south", "hill"], 2)
    'north, south, ...'
    """
    return ", ".join(names[:most]) + (", ..." if len(names) > most else "")


def day_said(text: object) -> date | str:
    """Return a day that a file has as text, so that a page says it as it says days.

    Examples
    --------
    >>> day_said("2026-11-16"), day_said("16/11")
    (datetime.date(2026, 11, 16), '16/11')
    """
    with suppress(ValueError):
        return date.fromisoformat(str(text))
    return str(text)


def runs(numbers: Iterable[int]) -> str:
    """Return numbers with those in a row put together: ``"1, 4–6, 9"``."""
    ends: list[list[int]] = []
    for number in sorted({*numbers}):
        if ends and number == ends[-1][1] + 1:
            ends[-1][1] = number
        else:
            ends.append([number, number])
    return ", ".join(f"{a}" if a == b else f"{a}–{b}" for a, b in ends)


def counted(number: int, thing: str) -> Worded:
    """Return so many things in words: "1 plant", "1,320 plants"."""
    one, many = f"{{n:,}} {thing}", f"{{n:,}} {thing}s"
    made = worded(one if number == 1 else many, n=number)
    made.words, made.one, made.number = many, one, int(number)
    return made
