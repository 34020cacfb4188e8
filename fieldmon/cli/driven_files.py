"""What `fieldmon drive` writes of a day: its tables, and its bag."""

from __future__ import annotations

from datetime import datetime, time, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.season_files import refuse_unrecorded

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from datetime import date

    from fieldmon.cli.drive_options import DriveOptions
    from fieldmon.drive.day import DrivenDay
    from fieldmon.drive.recording import Recording
    from fieldmon.monitoring import Season


def write_bag_of(
    noted: tuple[Recording, DrivenDay],
    begins: datetime,
    options: DriveOptions,
    *,
    goes_on: bool = False,
) -> None:
    """Write the bag, if asked for: of a day that goes on, beside that of what was driven before."""
    if options.bag is None:
        return
    from fieldmon.drive.bag import write_bag

    to = _next_part(options.bag, Path.exists) if goes_on else options.bag
    recording, driven = noted
    recording.end(driven)
    bag, *layouts = write_bag(recording, begins, to)
    beside = " and ".join(path.name for path in layouts)
    typer.echo(f"Bag written to {bag}; layouts beside it: {beside}")


def _next_part(path: Path, is_there: Callable[[Path], bool]) -> Path:
    """Return where what was driven since a day went on is written: beside what was before."""
    to, part = path, 2
    while is_there(to):
        to, part = path.with_stem(f"{path.stem}-{part}"), part + 1
    return to


def write_tables(
    driven: DrivenDay, on: date, options: DriveOptions, name: str, before: int = 0
) -> None:
    """Say what a day came to, and write its tables; `before` were inspected in an earlier run."""
    from fieldmon.compute.wording import counted
    from fieldmon.drive.day_tables import day_table, in_words, stop_table, stops_path

    who = f"{name}, {on}" if options.serial == name else f"{on}"
    typer.echo(f"{who}: {in_words(driven)}")
    if before:
        typer.echo(
            f"This is since it went on: {counted(before, 'inspection')} of the day before that "
            "are in the season only."
        )
    if options.output is None:
        return
    from fieldmon.io.atomic_write import write_whole

    to = options.output
    if before:
        to = _next_part(to, lambda path: path.exists() or stops_path(path).exists())
    write_whole(to, day_table(driven, on, name, before))
    write_whole(stops_path(to), stop_table(driven))
    typer.echo(f"Written to {to} and {stops_path(to)}")


def refuse_written_over(season: Season | None, each: Collection[DriveOptions]) -> None:
    """Refuse files that cannot be written, and tables that would replace what was filled in."""
    from fieldmon.drive.bag import require_bag
    from fieldmon.drive.day_tables import is_driven_table, stops_path
    from fieldmon.io.atomic_write import require_place

    outputs = [one.output for one in each if one.output is not None]
    files = [file for path in outputs for file in (path, stops_path(path))]
    for file in files:
        require_place(file)
    for one in each:
        if one.bag is not None:
            require_bag(one.bag)
    refuse_unrecorded(season, [file for file in files if not is_driven_table(file)])


def moment_begun(season: Season, on: date, begun_s: float) -> datetime:
    """Return the moment from which the seconds of a day's driving count."""
    from fieldmon.plot.local_clock import local_clock

    begins = datetime.combine(on, time()) + timedelta(seconds=begun_s)
    return local_clock(season.plot.field).moment(begins.date(), begins.time())
