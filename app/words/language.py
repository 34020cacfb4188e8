"""Which language the app speaks, and every text in it. No Streamlit in here.

English is `texts` itself. Another language is one file, ``languages/he.po``: a text is found there
by the name of its constant (its context) and by its English words. Numbers in a text are written
as the language writes them, and a text that names a count takes the form that the count asks for.
"""

from __future__ import annotations

import re
import unicodedata
from contextvars import ContextVar
from datetime import date, datetime
from functools import cache, lru_cache
from string import Formatter
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from fieldmon.compute import wording
from fieldmon.compute.wording import KeptText, Worded, counted, estimate, joined, worded
from fieldmon.io.writers.day_file import with_face
from fieldmon.plot.grid import plant_numbers
from fieldmon.reports.language import ENGLISH as ENGLISH_REPORTS
from fieldmon.reports.language import ReportLanguage

from . import blanks
from .blanks import SHARE_APART, filled, number_in, separated
from .kept_sentences import KnownSentences, sentences
from .signs import leading_nowhere, marked_as_english, together
from .translations import catalogue_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from fieldmon.plot.grid import PlantGrid

ENGLISH = blanks.ENGLISH
#: each by its own name
LANGUAGES = wording.LANGUAGES
#: languages whose file is not whole yet, by their own names: only an address (?lang=) asks for
#: them, and what has no words is English
DRAFTS: dict[str, str] = {}
RIGHT_TO_LEFT = frozenset({"he", "ar"})
#: the context of the library's sentences
LIBRARY = "fieldmon"
# so many things, as `counted` says them
_COUNTED = re.compile(r"([\d,]*\d) ([a-z][a-z ]*)")
#: names, signs and files, which are the same in every language
SAME = frozenset({"TITLE", "ARROWS", "MAP_WORDS.picture_name", "MAP_WORDS.film_name"})

# what seasons keep of distances, and of two columns as 1.0 named them
_AWAY = r"\d[\d,]*(?:\.\d+)? k?m"
_BETWEEN, _TWO_NAMES = re.compile(f"({_AWAY}) to ({_AWAY})"), re.compile("('.*') and ('.*')")
_NUMBER = re.compile(r"[+−-]?\d[\d,]*(\.\d+)?( %)?")

_NOW: ContextVar[str | None] = ContextVar("language", default=None)
# who knows what a window chose: this room knows of no window. Told once, and the same for all
_ASKED: list[Callable[[], str]] = []
_DAYS: list[Callable[[date], str]] = []


def ask(chosen: Callable[[], str]) -> None:
    """Let the language be asked for here wherever none is said: in what a click begins."""
    _ASKED[:] = [chosen]


def say_days(by: Callable[[date], str]) -> None:
    """Let days in sentences of the library be said so."""
    _DAYS[:] = [by]


def use(language: str) -> None:
    """Speak this language in this run of the page."""
    _NOW.set(language)


def current() -> str:
    """Return the language of this session."""
    said = _NOW.get()
    if said is None:
        said = _ASKED[0]() if _ASKED else ENGLISH
    return said


def is_spoken(code: str | None) -> bool:
    """Return whether an address may ask for a language: also for one that is a draft."""
    return code in LANGUAGES or code in DRAFTS


def for_seasons() -> str:
    """Return the language that a season keeps, for its reports: none is a draft."""
    return current() if current() in LANGUAGES else ENGLISH


def is_right_to_left() -> bool:
    """Return whether the language is read from the right."""
    return current() in RIGHT_TO_LEFT


# -- texts


class Text(str):  # noqa: SLOT000 - it holds more than words
    """A text in a language; filling its blanks writes numbers as the language does."""

    language: str

    def __new__(cls, words: str, language: str = ENGLISH) -> Self:
        """Return these words of a language."""
        made = super().__new__(cls, words)
        made.language = language
        return made

    def format(self, *args: object, **values: object) -> Text:
        """Return the text with its blanks filled."""
        return Text(filled(self, self.language, args, values), self.language)


class Plural(Text):
    """A text that names a count: its words for one, and for more, which are what it is itself.

    Parameters
    ----------
    one, many
        The words.
    by
        The blank whose number decides.
    """

    one: str
    by: str
    context: str

    def __new__(cls, one: str, many: str, by: str = "n", language: str = ENGLISH) -> Self:
        """Return a text with its words for one and for more."""
        made = super().__new__(cls, many, language)
        made.one, made.by, made.context = one, by, ""
        return made

    def format(self, *args: object, **values: object) -> Text:
        """Return the form that the count asks for, with its blanks filled."""
        return Text(filled(self.form(values[self.by]), self.language, args, values), self.language)

    def form(self, count: object) -> str:
        """Return the words for so many."""
        number = int(count)  # type: ignore[call-overload]
        english = self.one if number == 1 else str(self)
        if self.language == ENGLISH:
            return english
        found = catalogue_of(self.language)
        return found.npgettext(self.context, self.one, str(self), number) or english


class Late(str):  # noqa: SLOT000 - it has one attribute
    """A text that is looked up when it is shown, for what is told its words before any session."""

    look_up: Callable[[], str]

    def __new__(cls, look_up: Callable[[], str]) -> Self:
        """Return the text that `look_up` returns when it is shown."""
        made = super().__new__(cls, "...")
        made.look_up = look_up
        return made

    def __str__(self) -> str:
        return str(self.look_up())


def translated(name: str, value: Any) -> Any:  # noqa: ANN401 - a text, or many in a dict or tuple
    """Return a constant of `texts` in the current language."""
    language = current()
    key = language, name
    if key not in _TRANSLATED:
        _TRANSLATED[key] = _in_language(language, name, value)
    return _TRANSLATED[key]


_TRANSLATED: dict[tuple[str, str], Any] = {}


def _in_language(language: str, context: str, value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, dict):
        return {key: _in_language(language, f"{context}.{key}", one) for key, one in value.items()}
    if isinstance(value, tuple):
        return tuple(
            _in_language(language, f"{context}.{k}", one) for k, one in enumerate(value)
        )  # fmt: skip
    if not isinstance(value, str) or context in SAME or context.split(".", maxsplit=1)[0] in SAME:
        return value
    if language == ENGLISH:
        return Text(value) if type(value) is str else value
    if isinstance(value, Plural):
        made = Plural(value.one, str(value), value.by, language)
        made.context = context
        return made
    return Text(catalogue_of(language).pgettext(context, value) or value, language)


# -- the library's sentences


def plant_in_words(grid: PlantGrid, plant: int, number: int) -> str:
    """Return a plant's number in its row, with the face where it has two."""
    return in_words(with_face(grid, plant, number))


def place_in_words(grid: PlantGrid, plant: int) -> dict[str, str]:
    """Return a plant's row, and its number in it, as texts with `row` and `plant` name them."""
    numbered = plant_numbers(grid, np.array([plant]))
    row = grid.line_signs[int(numbered.line[0])]
    return {"row": row, "plant": plant_in_words(grid, plant, int(numbered.number[0]))}


def in_words(sentence: str) -> str:
    """Return a sentence of the library, or the app's own, in the current language.

    One that nobody has translated stays English, and is marked as such. Names of files and plots
    stand in it, so nothing in it leads anywhere.
    """
    language, sentence = current(), _with_days(sentence)
    if language == ENGLISH or not sentence or isinstance(sentence, Text):  # the app's own has words
        return together(leading_nowhere(str(sentence)))
    said = _said(sentence, language) or _said_again(str(sentence), language)
    if said is not None:
        said = _from_the_right(said)
    else:  # a bare number is of no language
        has_words = any(map(str.isalpha, sentence))
        said = marked_as_english(sentence) if has_words else str(sentence)
    return together(leading_nowhere(said))


def _with_days(sentence: str) -> str:
    """Return a sentence whose dates are said as the page says days; reports say them in digits."""
    if not isinstance(sentence, Worded) or not _DAYS:
        return sentence
    if sentence.parts:
        parts = [_with_days(part) for part in sentence.parts]
        same = all(new is old for new, old in zip(parts, sentence.parts, strict=True))
        return sentence if same else joined(sentence.between, parts)
    values = {name: _day_or(value) for name, value in sentence.values.items()}
    if all(values[name] is value for name, value in sentence.values.items()):
        return sentence
    words = sentence.one if sentence.one and sentence.number == 1 else sentence.words
    made = worded(words, **values)
    made.words, made.one, made.number = sentence.words, sentence.one, sentence.number
    return made


def _day_or(value: Any) -> Any:  # noqa: ANN401 - whatever stands in a blank
    if isinstance(value, date) and not isinstance(value, datetime):
        return _DAYS[0](value)
    return _with_days(value) if isinstance(value, str) else value


def _from_the_right(said: str) -> str:
    """Return a sentence that begins with a Latin name so that it is laid out as its language is."""
    sides = (unicodedata.bidirectional(letter) for letter in said)
    if not is_right_to_left() or next((s for s in sides if s in {"L", "R", "AL"}), "L") != "L":
        return said
    return f"\u200f{said}" if any(s in {"R", "AL"} for s in sides) else said


def listed(parts: Iterable[str]) -> str:
    """Return words side by side, with the comma of the current language.

    Examples
    --------
    >>> listed(["north", "south"])
    'north, south'
    """
    return _marks(", ", current()).join(parts)


def _marks(between: str, language: str) -> str:
    """Return what stands between words with the marks of a language."""
    return between.translate({ord(","): "،", ord(";"): "؛"}) if language == "ar" else between


def of_error(error: BaseException) -> str:
    """Return what an error says, in the current language."""
    return in_words(error.args[0] if error.args else str(error))


def _said(sentence: object, language: str) -> str | None:
    """Return a sentence in a language; None if there are no words for it."""
    if isinstance(sentence, BaseException) and sentence.args:
        sentence = sentence.args[0]
    if not isinstance(sentence, Worded):
        return _said_again(sentence, language) if isinstance(sentence, KeptText) else None
    found = catalogue_of(language)
    if sentence.parts:
        parts = {part: _said(part, language) for part in sentence.parts}
        if all(said is None for said in parts.values()):
            return None
        said = [parts[p] or marked_as_english(p) for p in sentence.parts]
        return _marks(sentence.between, language).join(said)
    if sentence.one:
        form = found.npgettext(LIBRARY, sentence.one, sentence.words, sentence.number)
    else:
        form = found.pgettext(LIBRARY, sentence.words)
    if not form and _is_wordless(sentence.words):
        apart = language in SHARE_APART
        form = sentence.words if apart else sentence.words.replace(" %", "%")
    if not form:
        return None
    if not sentence.values:  # whoever shows it fills its blanks
        return form
    values = {
        name: value if (made := _said(value, language)) is None else made
        for name, value in sentence.values.items()
    }
    return filled(form, language, (), values)


@lru_cache(maxsize=2_000)
def _said_again(text: str, language: str) -> str | None:
    """Return sentences that were kept as plain text in a language; None if one is not known."""
    rest, made = sentences(text), []
    while rest:
        for n in range(len(rest), 0, -1):  # a sentence of the library may be several
            said = _one_again(" ".join(rest[:n]), language)
            if said is not None:
                made.append(said)
                rest = rest[n:]
                break
        else:
            return None
    return " ".join(made)


def _one_again(sentence: str, language: str) -> str | None:
    told = _known(language).told(sentence)
    if told is None:
        return None
    words, blanks = told
    form = catalogue_of(language).pgettext(LIBRARY, words)
    values = {
        name: _one_again(value, language) or _counted_again(value, language)
        for name, value in blanks.items()
    }
    return _AsKept().vformat(form, (), values) if form else None


def _counted_again(value: str, language: str) -> str:
    """Return so many things, "7 zones", or a number, or what it is, in a language."""
    if said := _COUNTED.fullmatch(value):
        thing = said[2] if said[1] == "1" else said[2].removesuffix("s")
        made = _said(counted(int(said[1].replace(",", "")), thing), language)
        if made is not None:
            return made
    if said := _BETWEEN.fullmatch(value):
        nearest, farthest = (_distance_again(one, language) for one in said.groups())
        ends = {"nearest": nearest, "farthest": farthest}
        form = catalogue_of(language).pgettext(LIBRARY, "{nearest} to {farthest}")
        return _AsKept().vformat(form, (), ends) if form else value
    if re.fullmatch(_AWAY, value):
        return _distance_again(value, language)
    if said := _TWO_NAMES.fullmatch(value):
        return ", ".join(said.groups())
    return _number_again(value, language)


def _distance_again(value: str, language: str) -> str:
    """Return a distance, "26 m", in a language."""
    number, unit = value.split(" ")
    form = catalogue_of(language).pgettext(LIBRARY, f"{{value}} {unit}")
    said = _number_again(number, language)
    return together(_AsKept().vformat(form, (), {"value": said})) if form else value


def _number_again(value: str, language: str) -> str:
    if not _NUMBER.fullmatch(value):
        return value
    said = value if language in SHARE_APART else value.replace(" %", "%")
    return together(separated(said, language))


@cache
def _known(language: str) -> KnownSentences:
    return KnownSentences(catalogue_of(language).words_in(LIBRARY))


class _AsKept(Formatter):
    """Fills blanks with what stood there, written already."""

    def convert_field(self, value: Any, conversion: Any) -> Any:  # noqa: ANN401, ARG002
        return value

    def format_field(self, value: Any, format_spec: str) -> str:  # noqa: ANN401
        if "|" in format_spec:  # words chosen by a number
            one, other = format_spec.split("|")
            return one if value == "1" else other
        return str(value)


def _is_wordless(words: str) -> bool:
    """Return whether nothing is to be translated: numbers, signs, and other sentences."""
    return not any(
        letter.isalpha() for literal, *_ in Formatter().parse(words) for letter in literal
    )


@cache
def for_reports(language: str) -> ReportLanguage:
    """Return a language for reports."""
    if language == ENGLISH:
        return ENGLISH_REPORTS
    found = catalogue_of(language)

    def say(sentence: str) -> str:
        return _said(sentence, language) or _said_again(str(sentence), language) or str(sentence)

    letters = "".join(sorted({*"".join(found.words()), *ENGLISH_REPORTS.letters}))
    return ReportLanguage(language, say, language in RIGHT_TO_LEFT, letters)


# -- numbers and dates


def number(value: float, form: str = "") -> str:
    """Return a number as the current language writes it; `form` as Python's `format` takes it.

    Examples
    --------
    >>> number(1234.5, ",.1f")
    '1,234.5'
    """
    return number_in(value, form, current())


def about(value: float) -> str:
    """Return an estimate as precise as it is worth saying: from 10 on as a whole number.

    Examples
    --------
    >>> about(45.93), about(4.593)
    ('46', '4.6')
    """
    return in_words(estimate(value))


def separators() -> tuple[str, str]:
    """Return the signs of fractions and of thousands."""
    return number(0.5, ".1f")[1:2], number(1000, ",")[1:2]


def country(zone: str) -> str:
    """Return the name of the country of a time zone; empty where none is known."""
    from babel import Locale  # noqa: PLC0415
    from babel.core import get_global  # noqa: PLC0415

    names = Locale.parse(current()).territories
    code = get_global("zone_territories").get(zone, "ZZ")
    return "" if code == "ZZ" else str(names.get(code, ""))


def weekday(on: date, *, short: bool = False) -> str:
    """Return the name of a date's day of the week, in full or as short as it is written."""
    language = current()
    if language == ENGLISH:
        return f"{on:%a}" if short else f"{on:%A}"
    from babel.dates import format_date  # noqa: PLC0415

    # Hebrew names Sunday to Friday "day A" to "day F", and a sentence says "on day" itself
    return format_date(on, "EEE" if short else "EEEE", locale=language).removeprefix(
        "יום " if short else ""
    )


def day_and_month(on: date, *, month_first: bool = False) -> str:
    """Return a date by its day and the short name of its month."""
    language = current()
    if language == ENGLISH:
        return f"{on:%b} {on.day}" if month_first else f"{on.day} {on:%b}"
    from babel.dates import format_skeleton  # noqa: PLC0415

    return format_skeleton("MMMd", on, locale=language)
