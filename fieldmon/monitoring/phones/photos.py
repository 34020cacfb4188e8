"""Photos from phones, in the season's file byte for byte."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import worded
from fieldmon.errors import LimitError, ObservationError
from fieldmon.io.formats.signatures import picture_type
from fieldmon.monitoring.file import phone_tables
from fieldmon.monitoring.file.geopackage import insert, touch
from fieldmon.monitoring.phones import scouts
from fieldmon.plot.local_clock import utc_now, utc_text

if TYPE_CHECKING:
    import sqlite3
    from datetime import datetime

    from fieldmon.monitoring.season.season_file import Season

#: of one photo; a phone scales it to a tenth of that
MOST_BYTES = 4 * 2**20
#: of one person
MOST_A_DAY = 500


@dataclass(frozen=True)
class Photo:
    """A photo as a phone tells it.

    Parameters
    ----------
    id
        Made on the phone: a UUID.
    finding
        Id of the finding that it belongs to, which may come later.
    data
        The picture: JPEG, PNG or WebP.
    at
        When it was taken, by the phone's clock.
    lonlat, accuracy_m
        Where the phone was, and how well it knew.
    """

    id: str
    finding: str
    data: bytes
    at: datetime
    lonlat: tuple[float, float] | None = None
    accuracy_m: float | None = None


class KeptPhoto(NamedTuple):
    """A photo that is in the file: its id, and of which plant it is."""

    id: str
    plant: int
    on: str
    scout: str


def keep(season: Season, key: str, photo: Photo) -> bool:
    """Keep a photo, once; return whether it is new. It is on the disk then.

    Raises
    ------
    AccessError
        If the key does not hold.
    LimitError
        If it is larger than `MOST_BYTES`, or one more than `MOST_A_DAY`.
    ObservationError
        If it is no picture, or another photo has its id.
    """
    with season.store.writing() as db:
        return keep_of(db, scouts.key_owner_in(db, season, key).name, photo)


def keep_of(db: sqlite3.Connection, who: str, photo: Photo) -> bool:
    """Keep somebody's photo within a transaction, as `keep` does."""
    kind, mark = _kind(photo.data), digest(photo.data, end=b"")
    there = db.execute("SELECT digest FROM photos WHERE photo = ?", (photo.id,)).fetchone()
    if there is not None:
        if there[0] != mark:
            raise ObservationError(
                worded("A photo must have an id of its own, but another one has it.")
            )
        return False
    since = utc_text(utc_now() - timedelta(days=1))
    if phone_tables.n_sent(db, phone_tables.PHOTOS, who, since) >= MOST_A_DAY:
        raise LimitError(worded("One person may send {n} photos a day. Wait a day.", n=MOST_A_DAY))
    lon, lat = photo.lonlat or (None, None)
    named = (photo.id, photo.finding, who, photo.at.isoformat(), utc_text())
    row = (photo.data, kind, *named, lon, lat, photo.accuracy_m, mark)
    insert(db, phone_tables.PHOTOS, [row])
    touch(db, phone_tables.PHOTOS.name)
    return True


def photos_of(season: Season) -> tuple[KeptPhoto, ...]:
    """Return the photos of inspections that count, the last one first."""
    with season.store.reading() as db:
        rows = db.execute(
            "SELECT p.photo, i.plant, i.date, p.scout FROM photos p "
            "JOIN tellings t ON t.id = p.telling JOIN inspections i ON i.fid = t.inspection "
            "WHERE i.undone = 0 ORDER BY p.id DESC"
        )
        return tuple(KeptPhoto(*row) for row in rows)


def picture(season: Season, photo: str) -> tuple[str, bytes] | None:
    """Return the type and the bytes of a photo, or None."""
    with season.store.reading() as db:
        wanted = "SELECT content_type, data FROM photos WHERE photo = ?"
        row = db.execute(wanted, (photo,)).fetchone()
    return None if row is None else (str(row[0]), bytes(row[1]))


def _kind(data: bytes) -> str:
    if len(data) > MOST_BYTES:
        raise LimitError(
            worded("A photo must have {n} MB at most. Scale it down.", n=MOST_BYTES // 2**20)
        )
    if (kind := picture_type(data)) is None:
        raise ObservationError(
            worded("A photo must be a JPEG, PNG or WebP picture, but it is none.")
        )
    return kind
