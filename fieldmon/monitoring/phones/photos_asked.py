"""Photos that somebody in the office asks for, until one of that plant has come."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import LimitError, ObservationError, SettingError
from fieldmon.monitoring.file import phone_tables
from fieldmon.monitoring.file.geopackage import insert, point_blobs, touch
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.season.season_file import Season

#: letters of a note
LONGEST_NOTE = 200
#: that nobody has taken yet: more than anybody brings home from a day
MOST_OPEN = 500
_COMES = (
    "EXISTS (SELECT 1 FROM photos p JOIN tellings t ON t.id = p.telling "
    "JOIN inspections i ON i.fid = t.inspection "
    "WHERE i.undone = 0 AND i.plant = a.plant AND p.received >= a.at)"
)
_OPEN = f"FROM photos_asked a WHERE a.ended IS NULL AND NOT {_COMES}"


class AskedPhoto(NamedTuple):
    """A photo that somebody asks for: its id, of which plant, why, who, and when (UTC)."""

    id: str
    plant: int
    note: str
    who: str
    at: str


def ask_photo(
    season: Season, plant: int, note: str = "", who: str = "", name: str | None = None
) -> AskedPhoto:
    """Ask for a photo of a plant; it is asked for until one that came later is in the season.

    Parameters
    ----------
    season
        The season.
    plant
        Number in the grid, from 0.
    note
        What is to be seen on it, 200 letters at most.
    who
        Who asks.
    name
        An id of the asker's own: asking again with it changes nothing. None: one is made.

    Raises
    ------
    ObservationError
        If there is no such plant, or if another one was asked for with that id.
    SettingError
        If the note is longer.
    LimitError
        If `MOST_OPEN` are asked for and not taken.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> season = fm.Season.create(Path(mkdtemp()) / "gate.gpkg", plot)
    >>> asked = ask_photo(season, 7, "webs under the leaf?", "Office")
    >>> [(one.plant, one.note) for one in photos_asked(season)]
    [(7, 'webs under the leaf?')]
    """
    note, plants = " ".join(note.split()), len(season.plot.grid)
    if not 0 <= plant < plants:
        raise ObservationError(
            worded("A plant must be 0 to {last}, but it is {plant}.", last=plants - 1, plant=plant)
        )
    if len(note) > LONGEST_NOTE:
        raise SettingError(
            worded(
                "A note must have {most} letters at most, but it has {n}.",
                most=LONGEST_NOTE, n=len(note),
            )
        )  # fmt: skip
    asked = AskedPhoto(name or str(uuid.uuid4()), plant, note, who, utc_text())
    with season.store.writing() as db:
        there = _asked(db, asked.id)
        if there is None:
            _keep(db, season, asked)
    if there is not None and (there.plant, there.note) != (plant, note):
        raise ObservationError(
            worded("What is asked for must have an id of its own, but another one has it.")
        )
    return there or asked


def photos_asked(season: Season) -> tuple[AskedPhoto, ...]:
    """Return the photos that are asked for and not there yet, in the order of asking."""
    with season.store.reading() as db:
        return photos_asked_in(db)


def photos_asked_in(db: sqlite3.Connection) -> tuple[AskedPhoto, ...]:
    """Return the photos that are asked for, as `photos_asked` does, within a transaction."""
    rows = db.execute(f"SELECT a.id, a.plant, a.note, a.who, a.at {_OPEN} ORDER BY a.fid")
    return tuple(AskedPhoto(*row) for row in rows)


def ask_no_more(season: Season, name: str) -> bool:
    """Ask for a photo no more, by its id; return whether it was asked for."""
    with season.store.writing() as db:
        ended = "UPDATE photos_asked SET ended = ? WHERE id = ? AND ended IS NULL"
        changed = db.execute(ended, (utc_text(), name)).rowcount
        touch(db, phone_tables.PHOTOS_ASKED.name)
    return bool(changed)


def _asked(db: sqlite3.Connection, name: str) -> AskedPhoto | None:
    wanted = "SELECT id, plant, note, who, at FROM photos_asked WHERE id = ?"
    row = db.execute(wanted, (name,)).fetchone()
    return None if row is None else AskedPhoto(*row)


def _keep(db: sqlite3.Connection, season: Season, asked: AskedPhoto) -> None:
    if db.execute(f"SELECT count(*) {_OPEN}").fetchone()[0] >= MOST_OPEN:
        raise LimitError(
            worded("{n} photos may be asked for at once. Take some back first.", n=MOST_OPEN)
        )
    plant, grid = asked.plant, season.plot.grid
    place = point_blobs(grid.lonlat(np.array([plant])))[0]
    numbered = int(season.plant_numbers.line[plant]), int(season.plant_numbers.number[plant])
    row = (place, asked.id, plant, *numbered, asked.note, asked.who, asked.at, None)
    insert(db, phone_tables.PHOTOS_ASKED, [row])
    touch(db, phone_tables.PHOTOS_ASKED.name)
