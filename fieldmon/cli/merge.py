"""`fieldmon merge`: two copies of a season become one again. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.options import SeasonFile
from fieldmon.cli.status import lines
from fieldmon.errors import SettingError

OtherCopy = Annotated[Path, typer.Argument(help="The other copy of the season; it is not changed.")]


def merge(season: SeasonFile, other: OtherCopy) -> None:
    """Add what another copy of the season holds; everything in either copy is kept once.

    For a folder that is synchronised, or two people who worked apart. What was taken back in one
    copy is taken back. Results that contradict one another are listed; both are kept, and fieldmon
    undo takes out what was wrong. An inspection that both copies corrected counts once: as it was
    corrected last, which is said.

    Example: fieldmon merge season.gpkg "season (conflict).gpkg"
    """
    from fieldmon.compute.wording import counted, joined
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.estimates.last_days import default_date
    from fieldmon.monitoring.season.copies_to_merge import merge_file

    if other.exists() and other.samefile(season):
        raise SettingError(f"{other} must be another copy of the season, but it is the same file.")
    kept = Season(season)
    done, entered = merge_file(kept, other)
    n_gone = done.taken_back
    gone = f", {n_gone} {'was' if n_gone == 1 else 'were'} taken back there" if n_gone else ""
    parts = [counted(done.new, "inspection")]
    more = (done.treatments, "treatment"), (len(done.codes), "scout's code")
    parts += [counted(n, thing) for n, thing in more if n]
    were = "was" if len(parts) == 1 and done.new == 1 else "were"
    noted = f", {done.more}" if done.more else ""
    typer.echo(f"{other.name}: {joined(', ', parts)} {were} new{noted}{gone}")
    if done.of_new.by:
        by = (f"{who or 'nobody named'} {n:,}" for who, n in done.of_new.by)
        typer.echo(f"  by: {', '.join(by)}")
    for treatment in done.treated:
        typer.echo(f"  treatment: {treatment}")
    if done.moved:
        typer.echo(
            "  numbered anew: batches have other numbers now than before; the log shows both"
        )
    if done.chosen:
        typer.echo(f"  taken over: {joined('; ', done.chosen)}")
    for sentence in done.contradictions:
        typer.echo(f"  differs: {sentence}")
    for sentence in entered:
        typer.echo(f"  warning: {sentence}")
    if done.codes:
        typer.echo(
            f"  codes: of {joined(', ', [*dict.fromkeys(done.codes)])}. They read this season and "
            "record into it: take back in the app what you do not know."
        )
    for sentence in done.overlaps:
        typer.echo(f"  codes: {sentence}")
    typer.echo("\n".join(lines(kept, kept.status(default_date(kept)))))
