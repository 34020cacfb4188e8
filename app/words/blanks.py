"""Numbers, and blanks of texts, as a language writes them. No Streamlit in here."""

from __future__ import annotations

import re
from functools import cache
from numbers import Real
from string import Formatter
from typing import Any

from fieldmon.compute.wording import written

from .signs import together

ENGLISH = "en"
#: languages that set the sign of a share apart from its number
SHARE_APART = frozenset({ENGLISH, "es"})
_SHARE = re.compile(r"(?<=\d) (?=%)")


class _BlanksInLanguage(Formatter):
    def __init__(self, language: str) -> None:
        self._language = language

    def format_field(self, value: Any, format_spec: str) -> str:  # noqa: ANN401
        if "|" in format_spec:
            return written(value, format_spec)
        if isinstance(value, Real) and not isinstance(value, bool):
            return number_in(value, format_spec, self._language)
        return format(value, format_spec)


def filled(words: str, language: str, args: Any, values: Any) -> str:  # noqa: ANN401
    """Return words with their blanks filled."""
    if language == ENGLISH and "%}" not in words and "|" not in words:
        said = str.format(words, *args, **values)
    else:
        said = _BlanksInLanguage(language).vformat(str(words), args, values)
    return _SHARE.sub("\u00a0", said)


def number_in(value: Any, form: str, language: str) -> str:  # noqa: ANN401 - any number
    """Return a number as a language writes it; `form` as Python's `format` takes it."""
    said = written(value, form) if language in SHARE_APART else format(value, form)
    return together(separated(said, language))


def separated(written: str, language: str) -> str:
    """Return a number that is written in English with the signs of a language."""
    if language == ENGLISH:
        return written
    return written.translate(_separators(language))


@cache
def _separators(language: str) -> dict[int, str]:
    from babel import Locale  # noqa: PLC0415

    signs = Locale.parse(language).number_symbols["latn"]
    return {ord("."): signs["decimal"], ord(","): signs["group"]}
