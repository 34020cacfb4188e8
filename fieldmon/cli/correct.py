"""`fieldmon correct`: what another program changed is taken as corrections. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.season_files import season_of
from fieldmon.cli.times import clock, day
from fieldmon.compute.ranges import NUMBER
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import ContradictionError, SettingError

if TYPE_CHECKING:
    from fieldmon.monitoring import Season

# corrections that the answer names; the log has all
_MOST_NAMED = 5


@dataclass(frozen=True)
class CorrectedTime:
    """Which inspection was of another day or time, and of which."""

    inspection: Annotated[
        int | None,
        typer.Option(
            help="Number (fid) of one inspection whose --date or --time was wrong.",
            callback=within(NUMBER),
        ),
    ] = None
    at: Annotated[
        str | None, typer.Option("--time", help="Local time of that --inspection, HH:MM.")
    ] = None
    on: Annotated[
        str | None, typer.Option("--date", help="Day of that --inspection, YYYY-MM-DD.")
    ] = None


@dataclass(frozen=True)
class Corrections:
    """What is taken as corrections, and whose they are."""

    who: Annotated[str, typer.Option(help="Whose corrections these are.", show_default=False)]
    file: Annotated[
        Path | None,
        typer.Argument(
            help="Inspections exported from the season (fieldmon export --of inspections; QGIS: "
            "its layer inspections) and changed there; without it, what was changed in the "
            "season's own file is meant.",
        ),
    ] = None
    contradicting: Annotated[
        bool,
        typer.Option(
            "--contradicting",
            help="Also take corrections that contradict what else is recorded of the same plants "
            "and days.",
        ),
    ] = False


@with_options
def correct(season: SeasonFile, asked: Corrections, moved: CorrectedTime) -> None:
    """Accept inspections that QGIS or another program changed, as somebody's corrections.

    Until then the season refuses to go on, and names the rows. A FILE is the layer inspections, or
    the table of fieldmon export, all of it or some, changed: what it says otherwise is corrected,
    and nothing deleted or added. With --inspection and --date or --time the day or time of one is
    corrected instead. Corrections that contradict what else is recorded of the same plants and days
    are listed, and nothing is taken, unless --contradicting is given. fieldmon undo brings back
    what stood there before.

    Example: fieldmon correct season.gpkg --who Ann
    Example: fieldmon correct season.gpkg edited.gpkg --who Ann
    Example: fieldmon correct season.gpkg --who Ann --inspection 12 --date 2026-11-17 --time 08:30
    """
    if not (who := asked.who.strip()):
        raise SettingError("--who must name whose corrections these are, but it is empty.")
    if (moved.inspection is None) != (moved.at is None and moved.on is None):
        raise SettingError(
            "To correct when an inspection was made, --inspection must be given with --date or "
            "--time."
        )
    if moved.inspection is not None and asked.file is not None:
        raise SettingError(
            "Either an --inspection or those of a file are corrected, but both are given. Give one "
            "of them."
        )

    kept = season_of(season)
    try:
        if moved.inspection is not None:
            moment = None if moved.at is None else clock(moved.at, "--time")
            said = kept.correct_time(
                moved.inspection, moment, who, day(moved.on), confirmed=asked.contradicting
            )
            typer.echo(said)
            return
        if asked.file is None:
            n = kept.correct(who, confirmed=asked.contradicting)
        else:
            n = _of_export(kept, asked.file, who, confirmed=asked.contradicting)
    except ContradictionError as error:
        raise ContradictionError(f"{error} Confirm with: --contradicting") from None
    if n:
        typer.echo(f"{n} correction{'s' if n > 1 else ''} taken, by {who}.")
        typer.echo(kept.log()[-1].sentence(_MOST_NAMED))
    else:
        typer.echo("Nothing was changed that inspections say: there is nothing to correct.")


def _of_export(season: Season, file: Path, who: str, *, confirmed: bool) -> int:
    """Take what was changed in a file exported from the season as corrections; return how many."""
    from fieldmon.cli.messages import Terminal
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.monitoring.changes.transactions import is_season
    from fieldmon.monitoring.season.exported_inspections import edited_copy

    if is_season(file):
        raise SettingError(
            f"A file of corrections must hold inspections alone, but {file.name} is a season. What "
            "was changed in a copy comes with: fieldmon record"
        )
    options = InspectionOptions().on(season.plot.field)
    with working_folder() as folder:
        with Terminal().answering():
            edited = edited_copy(season, file, options, Path(folder))
        n = season.take_corrections(edited.path, file.name, who, confirmed=confirmed)
    if edited.of_others:
        typer.echo(f"Left out: {edited.of_others}")
    if edited.n_added:
        s = "s" if edited.n_added > 1 else ""
        typer.echo(f"{edited.n_added} inspection{s} added there can be taken with: fieldmon record")
    if edited.n_notes:
        s = "s" if edited.n_notes > 1 else ""
        typer.echo(f"{edited.n_notes} note{s} changed there can be joined with: fieldmon record")
    if edited.n_seconds:
        s, is_ = ("s", "are") if edited.n_seconds > 1 else ("", "is")
        typer.echo(
            f"{edited.n_seconds} time{s} there {is_} in whole minutes and otherwise the season's: "
            "taken as written without seconds, not as corrected. To correct one: --inspection and "
            "--time"
        )
    return n
