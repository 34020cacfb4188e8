"""`fieldmon correct`: what another program changed is taken as corrections. Heavy imports wait."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.times import clock, day
from fieldmon.compute.ranges import NUMBER
from fieldmon.errors import ContradictionError, SettingError

# corrections that the answer names; the log has all
_MOST_NAMED = 5


def correct(
    season: SeasonFile,
    who: Annotated[str, typer.Option(help="Whose corrections these are.", show_default=False)],
    inspection: Annotated[
        int | None,
        typer.Option(
            help="Number (fid) of one inspection whose --date or --time was wrong.",
            callback=within(NUMBER),
        ),
    ] = None,
    at: Annotated[
        str | None, typer.Option("--time", help="Local time of that --inspection, HH:MM.")
    ] = None,
    on: Annotated[
        str | None, typer.Option("--date", help="Day of that --inspection, YYYY-MM-DD.")
    ] = None,
    contradicting: Annotated[  # noqa: FBT002 - a flag
        bool,
        typer.Option(
            "--contradicting",
            help="Also take corrections that contradict what else is recorded of the same plants "
            "and days.",
        ),
    ] = False,
) -> None:
    """Accept inspections that QGIS or another program changed, as somebody's corrections.

    Until then the season refuses to go on, and names the rows. With --inspection and --date
    or --time the day or time of one is corrected instead. Corrections that contradict what else is
    recorded of the same plants and days are listed, and nothing is taken, unless --contradicting is
    given. fieldmon undo brings back what stood there before.

    Example: fieldmon correct season.gpkg --who Ann
    Example: fieldmon correct season.gpkg --who Ann --inspection 12 --date 2026-11-17 --time 08:30
    """
    if not who.strip():
        raise SettingError("--who must name whose corrections these are, but it is empty.")
    if (inspection is None) != (at is None and on is None):
        raise SettingError(
            "To correct when an inspection was made, --inspection must be given with --date or "
            "--time."
        )
    from fieldmon.monitoring import Season

    kept = Season(season)
    try:
        if inspection is not None:
            moment = None if at is None else clock(at, "--time")
            said = kept.correct_time(
                inspection, moment, who.strip(), day(on), confirmed=contradicting
            )
            typer.echo(said)
            return
        n = kept.correct(who.strip(), confirmed=contradicting)
    except ContradictionError as error:
        raise ContradictionError(f"{error} Confirm with: --contradicting") from None
    if n:
        typer.echo(f"{n} correction{'s' if n > 1 else ''} taken, by {who.strip()}.")
        typer.echo(kept.log()[-1].sentence(_MOST_NAMED))
    else:
        typer.echo("Nothing was changed that inspections say: there is nothing to correct.")
