"""The units and dates that a session wants, from its boxes."""

from __future__ import annotations

from dataclasses import replace

from ..words import language
from ..words.units import UnitsInLanguage, usual
from . import widget_memory

#: the boxes' keys, which are the fields of `UnitsInLanguage`
KEYS = ("length", "area", "date_like")


def units(code: str | None = None) -> UnitsInLanguage:
    """Return how this session wants numbers written; `code` is its language, if not the spoken."""
    chosen = {name: widget_memory.value(name) for name in KEYS}
    said = {name: value for name, value in chosen.items() if value}
    return replace(usual(code or language.current()), **said)


language.say_days(lambda on: units().said_day(on))
