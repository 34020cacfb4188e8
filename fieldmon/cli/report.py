"""`fieldmon report`: a day or a season on paper. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.report_languages import Language, spoken
from fieldmon.cli.season_files import default_date
from fieldmon.cli.times import day, day_on
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.compute.units import Units
    from fieldmon.monitoring import Season
    from fieldmon.reports.content import Report


class PaperSize(StrEnum):
    """Paper to print on."""

    a4 = "a4"
    letter = "letter"


@dataclass(frozen=True)
class ReportOptions:
    """What `fieldmon report` is told."""

    seasons: Annotated[
        list[Path],
        typer.Argument(
            help="The season's file, made by fieldmon init; several with --certification."
        ),
    ]
    output: Annotated[
        Path, typer.Option("--output", "-o", help="File to write, ending in .pdf or .html.")
    ] = Path("report.pdf")
    on: Annotated[
        str | None,
        typer.Option(
            "--date",
            help="Report this day, YYYY-MM-DD, on one page, or on one for each of a team; else the "
            "season.",
        ),
    ] = None
    until: Annotated[
        str | None,
        typer.Option(
            "--until", help="Report the season up to this day; else its last, today at most."
        ),
    ] = None
    paper: Annotated[PaperSize, typer.Option("--paper", help="Paper of a PDF.")] = PaperSize.a4
    certification: Annotated[
        bool,
        typer.Option(
            "--certification",
            help="Write the record for a certifier: treatments as GLOBALG.A.P. asks, inspections, "
            "log.",
        ),
    ] = False
    language: Language = None

    def must_fit(self) -> None:
        """Raise `SettingError` where the options exclude each other."""
        if self.on is not None and self.until is not None:
            raise SettingError(
                "A report must be of one day or of the season, but both --date and --until were "
                "given. Leave one away."
            )
        if self.certification and self.on is not None:
            raise SettingError(
                "A record for a certifier is of seasons, not of --date. Leave it away."
            )
        if not self.certification and len(self.seasons) > 1:
            raise SettingError(
                f"A report is of one season, but {len(self.seasons)} are given. Several go into "
                "one with --certification."
            )


@with_options
def report(options: ReportOptions) -> None:
    """Write a season on four pages, or one of its days on one; the season is not changed.

    With --certification it is the record of one season or several for a certifier. It is written
    in the season's language, or in the one of --language, with dates and areas as usual there.

    Example: fieldmon report season.gpkg -o report.pdf
    Example: fieldmon report season.gpkg -o report.pdf --language he
    """
    options.must_fit()
    from fieldmon.cli.season_files import opened
    from fieldmon.reports.write import checked_ending, write_report

    checked_ending(options.output)
    kept = opened(options.seasons)
    spoken_in, units = spoken(options.language, kept[0].settings.language)
    if options.certification:
        made = _certified(kept, options.until, units)
    else:
        made = _made(kept[0], options.on, options.until, units)
    to = write_report(made.said_in(spoken_in), options.output, options.paper.value)
    typer.echo(f"Report written to {to}")


def _certified(seasons: list[Season], until: str | None, units: Units) -> Report:
    """Return the record of seasons for a certifier."""
    from fieldmon.reports.certification import certification_report

    told = day(until, "--until")
    if told is None:
        for season in seasons:
            default_date(season, None, "--until")
    return certification_report(seasons, units, told)


def _made(season: Season, on: str | None, until: str | None, units: Units) -> Report:
    """Return the report of a day, or of the season."""
    from fieldmon.reports.day import DayFacts, day_of_each
    from fieldmon.reports.season import season_report

    asked = day(on)
    if asked is not None:
        today = day_on(season.plot.field, None)
        return day_of_each(DayFacts.each_of_season(season, asked, today), units)
    return season_report(season, default_date(season, day(until, "--until"), "--until"), units)
