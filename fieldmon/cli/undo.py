"""`fieldmon undo`: what was recorded is taken back. Heavy imports wait."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.season_files import season_of
from fieldmon.compute.ranges import NUMBER
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.monitoring import Season

UndoChange = Annotated[
    bool, typer.Option("--change", help="Take back the last change of settings instead.")
]


def undo(
    season: SeasonFile,
    batch: Annotated[
        int | None,
        typer.Option(
            help="Number of a batch; see fieldmon status --batches.", callback=within(NUMBER)
        ),
    ] = None,
    inspection: Annotated[
        int | None,
        typer.Option(
            help="Number (fid) of one inspection in the season's file; cannot be redone.",
            callback=within(NUMBER),
        ),
    ] = None,
    redo: Annotated[
        int | None,
        typer.Option(
            help="Number of a batch that was undone: let it count again.", callback=within(NUMBER)
        ),
    ] = None,
    change: UndoChange = False,  # noqa: FBT002 - a flag
    who: Annotated[str, typer.Option(help="Who takes it back.")] = "",
) -> None:
    """Take back the last recording, a batch, one inspection or a change; nothing is deleted.

    Example: fieldmon undo season.gpkg
    """
    from fieldmon.monitoring.season.undoing import undo_with_batches

    if sum(one is not None for one in (batch, inspection, redo)) + change > 1:
        raise SettingError("Give --batch, --inspection, --redo or --change, not two of them.")

    kept = season_of(season)
    if change:
        _undo_change(kept, who)
        return
    if redo is not None:
        typer.echo(kept.redo(redo, who))
        return
    undone = undo_with_batches(kept, batch, inspection, who)
    typer.echo(undone.said)
    if undone.batch is None:
        typer.echo("This cannot be redone. If it was right, record it again.")
    else:
        again = ", and then: ".join(
            shlex.join(["fieldmon", "undo", str(season), "--redo", str(one)])
            for one in (undone.first, undone.batch)
            if one is not None
        )
        typer.echo(f"To let it count again: {again}")


def _undo_change(kept: Season, who: str) -> None:
    """Take back the last change of settings, and say what is believed otherwise for it."""
    from fieldmon.monitoring.changes.earlier_settings import before_change
    from fieldmon.monitoring.estimates.told_anew import telling_anew
    from fieldmon.monitoring.settings.settings_words import taken_back

    settings = kept.settings
    with telling_anew(kept, settings, before_change(kept) or settings, typer.echo):
        typer.echo(taken_back(settings, kept.undo_change(who)))
