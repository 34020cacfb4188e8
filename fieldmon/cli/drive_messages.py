"""What `fieldmon drive` says of a season's day: who else is out, how it goes on, what is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence
    from datetime import date

    from fieldmon.monitoring import Season


def tell_left_out(scouts: list[str]) -> None:
    """Print who of a team does not drive."""
    if scouts:
        typer.echo(
            f"Left out, as scouts go on foot: {', '.join(scouts)}. fieldmon plan writes their "
            "routes.",
            err=True,
        )


def tell_others(season: Season, on: date, left_out: Sequence[tuple[int, int]]) -> None:
    """Print that others are out, and what is left to them."""
    from fieldmon.monitoring.phones.scouts import codes_on

    if not (codes := codes_on(season, on)):
        return
    out = "is out with a route" if len(codes) == 1 else "are out with routes"
    theirs = f"{' and '.join(codes)} {out} of their own"
    if rows := ", ".join(f"{first}-{last}" for first, last in sorted(left_out)):
        theirs += f"; the robot leaves rows {rows} to them"
    said = [f"{theirs}."]
    if None in codes.values():
        said.append("Whoever has a code for the whole plot may be sent to the same plants.")
    typer.echo(" ".join(said), err=True)


def tell_before(season: Season, on: date, name: str, at: int) -> None:
    """Print that other robots were driven on a day, and where this one is taken to stand."""
    drives = {
        one.source.removesuffix(f" {on}")
        for one in season.batches()
        if one.kind == "findings" and not one.undone and one.source.endswith(f" {on}")
    }
    if others := sorted(other for other in drives - {name} if "/" in other):
        where = "the gate" if at < 0 else f"plant {at}, where that ended"
        were = "was" if len(others) == 1 else "were"
        typer.echo(
            f"{' and '.join(others)} {were} driven on {on} before. {name} is taken to stand at "
            f"{where}.",
            err=True,
        )


def tell_plan(*, goes_on: bool) -> None:
    """Print by which plan a day goes on."""
    typer.echo(
        "It follows what is left of the plan given out last."
        if goes_on
        else "Planned anew: the plan given out last is done, or results or hours changed it."
    )


def tell_replanned(n: int) -> None:
    """Print how often a day was planned anew while it was driven."""
    from fieldmon.compute.wording import counted

    if n:
        typer.echo(f"Planned anew {counted(n, 'time')} after finds or delays; each plan is kept.")


def tell_stopped(season: Season, on: date, batch: int | None) -> None:
    """Print what is kept of a day that somebody stopped."""
    from fieldmon.compute.wording import counted

    n = counted(0 if batch is None else season.contents([batch])[batch].n, "result")
    typer.echo(f"{n} of {on} in the season; the same command goes on from there.")


def say(told: str) -> None:
    """Print what is told, beside what a command answers."""
    typer.echo(told, err=True)
