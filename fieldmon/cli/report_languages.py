"""Languages for paper: those of the app, whose catalogues hold the library's sentences too."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.app_package import app_words
from fieldmon.compute.arguments import must_be_language
from fieldmon.compute.wording import LANGUAGES

if TYPE_CHECKING:
    from fieldmon.compute.units import Units
    from fieldmon.reports.language import ReportLanguage

Language = Annotated[
    str | None,
    typer.Option(help="Language of its reports: en, he, ar or es; what a season keeps, else en."),
]


def checked_language(code: str) -> str:
    """Return a language's code; raise `SettingError` where nobody has translated into it."""
    low = code.strip().lower()
    must_be_language(low)
    return low


def spoken(asked: str | None, kept: str) -> tuple[ReportLanguage, Units]:
    """Return the language that is asked for, else the season's, and how it writes figures."""
    from fieldmon.reports.language import ENGLISH

    # a season may keep a language of a later fieldmon
    known = kept if kept in LANGUAGES else ENGLISH.code
    code = known if asked is None else checked_language(asked)
    language: ReportLanguage = app_words("language").for_reports(code)
    units: Units = app_words("units").usual(code).of_library
    return language, units
