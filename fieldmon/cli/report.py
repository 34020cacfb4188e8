"""`fieldmon report`: a day or a season on paper. Heavy imports wait."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.report_languages import Language, spoken
from fieldmon.cli.times import day, day_on
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.compute.units import Units
    from fieldmon.monitoring import Season
    from fieldmon.reports.content import Report


class Paper(StrEnum):
    """Paper to print on."""

    a4 = "a4"
    letter = "letter"


Output = Annotated[
    Path, typer.Option("--output", "-o", help="File to write, ending in .pdf or .html.")
]
OneDay = Annotated[
    str | None,
    typer.Option("--date", help="Report this day on one page, YYYY-MM-DD; else the season."),
]
Until = Annotated[
    str | None,
    typer.Option("--until", help="Report the season up to this day; else up to its last one."),
]
Seasons = Annotated[
    list[Path],
    typer.Argument(help="The season's file, made by fieldmon init; several with --certification."),
]
ForCertifier = Annotated[
    bool,
    typer.Option(
        "--certification",
        help="Write the record for a certifier: treatments as GLOBALG.A.P. asks, inspections, log.",
    ),
]
OnPaper = Annotated[Paper, typer.Option("--paper", help="Paper of a PDF.")]


def report(  # noqa: PLR0913, PLR0917 - the command's options
    seasons: Seasons,
    output: Output = Path("report.pdf"),
    on: OneDay = None,
    until: Until = None,
    paper: OnPaper = Paper.a4,
    certification: ForCertifier = False,  # noqa: FBT002 - a flag
    language: Language = None,
) -> None:
    """Write a season on four pages, or one of its days on one; the season is not changed.

    With --certification it is the record of one season or several for a certifier. It is written
    in the season's language, or in the one of --language, with dates and areas as usual there.

    Example: fieldmon report season.gpkg -o report.pdf
    Example: fieldmon report season.gpkg -o report.pdf --language he
    """
    if on is not None and until is not None:
        raise SettingError(
            "A report must be of one day or of the season, but both --date and --until were given. "
            "Leave one away."
        )
    if certification and on is not None:
        raise SettingError("A record for a certifier is of seasons, not of --date. Leave it away.")
    if not certification and len(seasons) > 1:
        raise SettingError(
            f"A report is of one season, but {len(seasons)} are given. Several go into one with "
            "--certification."
        )
    from fieldmon.cli.season_files import opened
    from fieldmon.reports.write import checked_ending, write_report

    checked_ending(output)
    kept = opened(seasons)
    spoken_in, units = spoken(language, kept[0].settings.language)
    made = _certified(kept, until, units) if certification else _made(kept[0], on, until, units)
    to = write_report(made.said_in(spoken_in), output, paper.value)
    typer.echo(f"Report written to {to}")


def _certified(seasons: list[Season], until: str | None, units: Units) -> Report:
    """Return the record of seasons for a certifier."""
    from fieldmon.reports.certification import certification_report

    return certification_report(seasons, units, day(until, "--until"))


def _made(season: Season, on: str | None, until: str | None, units: Units) -> Report:
    """Return the report of a day, or of the season."""
    from fieldmon.reports.day import DayFacts, day_report
    from fieldmon.reports.season import season_report

    asked = day(on)
    if asked is not None:
        today = day_on(season.plot.field, None)
        return day_report(DayFacts.of_season(season, asked, today), units)
    told = day(until, "--until")
    return season_report(season, season.last_date() if told is None else told, units)
