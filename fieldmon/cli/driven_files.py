"""What `fieldmon drive` writes of a day: its tables, and its bag."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.season_files import refuse_unrecorded

if TYPE_CHECKING:
    from collections.abc import Collection
    from datetime import date
    from pathlib import Path

    from fieldmon.cli.drive_options import DriveOptions
    from fieldmon.drive.day import DrivenDay
    from fieldmon.drive.recording import Recording
    from fieldmon.monitoring import Season


def write_bag_of(
    noted: tuple[Recording, DrivenDay], begins: datetime, options: DriveOptions
) -> None:
    """Write the bag, if asked for."""
    if options.bag is None:
        return
    from fieldmon.drive.bag import write_bag

    recording, driven = noted
    recording.end(driven)
    bag, *layouts = write_bag(recording, begins, options.bag)
    beside = " and ".join(path.name for path in layouts)
    typer.echo(f"Bag written to {bag}; layouts beside it: {beside}")


def next_part(options: DriveOptions) -> DriveOptions:
    """Return where what is driven since a day went on is written: beside what was before.

    Tables and bag go by one number.
    """
    to, part = options, 2
    while any(file.exists() for file in (*_tables_of(to), to.bag) if file is not None):
        output, bag = (
            None if path is None else path.with_stem(f"{path.stem}-{part}")
            for path in (options.output, options.bag)
        )
        to, part = replace(options, output=output, bag=bag), part + 1
    return to


def _tables_of(options: DriveOptions) -> tuple[Path, ...]:
    """Return the tables that are written: of the day, and of its stops."""
    from fieldmon.drive.day_tables import stops_path

    return () if options.output is None else (options.output, stops_path(options.output))


def write_tables(
    driven: DrivenDay, on: date, options: DriveOptions, name: str, before: int = 0
) -> None:
    """Say what a day came to, and write its tables; `before` were inspected in an earlier run."""
    from fieldmon.compute.wording import counted
    from fieldmon.drive.day_tables import day_table, in_words, stop_table

    who = f"{name}, {on}" if options.serial == name else f"{on}"
    typer.echo(f"{who}: {in_words(driven)}")
    if before:
        typer.echo(
            f"This is since it went on: {counted(before, 'inspection')} of the day before that "
            "are in the season."
        )
    if options.output is None:
        return
    from fieldmon.io.atomic_write import write_whole

    to, stops = _tables_of(options)
    write_whole(to, day_table(driven, on, name, before))
    write_whole(stops, stop_table(driven))
    typer.echo(f"Written to {to} and {stops}")


def refuse_written_over(season: Season | None, each: Collection[DriveOptions]) -> None:
    """Refuse files that cannot be written, and tables that would replace what was filled in."""
    from fieldmon.drive.bag import require_bag
    from fieldmon.drive.day_tables import is_driven_table
    from fieldmon.io.atomic_write import require_place

    files = [file for one in each for file in _tables_of(one)]
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
