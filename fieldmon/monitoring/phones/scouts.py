"""Who may tell a season's findings from a phone or a robot: people, their keys and their rows.

A key is 144 random bits, shown once. The season's file holds its digest alone, which hangs on the
file's name too: a copy under another name is another season, and a key does not open it.
"""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import worded
from fieldmon.errors import AccessError, SettingError
from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.changes.transactions import glance
from fieldmon.monitoring.file import phone_tables
from fieldmon.monitoring.file.geopackage import insert, touch
from fieldmon.monitoring.phones.people import written_in
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import local_clock, utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from datetime import date
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.monitoring.season.open_season import OpenSeason
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantNumbers
    from fieldmon.plot.local_clock import LocalClock

_KEY_BYTES = 18
_LONGEST_NAME = 60


@dataclass(frozen=True)
class Scout:
    """Somebody who may tell findings.

    Parameters
    ----------
    name
        As the season's findings say it.
    rows
        First and last row of this person's part of the plot, from 1; None: the whole plot.
    made, ended
        When the key was made and taken back, UTC; empty: it holds.
    """

    name: str
    rows: tuple[int, int] | None
    made: str
    ended: str = ""


def let_in(season: OpenSeason, name: str, rows: tuple[int, int] | None = None) -> str:
    """Make a key for somebody and return it; an earlier key of that person ends at once.

    Whoever the season knows already is named as it is written there.

    Raise `SettingError` if there is no name, if the rows are not on the plot, if they are others'
    in part, if somebody beside the season's team has none, or somebody of it has some.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> season = fm.Season.create(Path(mkdtemp()) / "gate.gpkg", plot)
    >>> key = let_in(season, "Ann", rows=(1, 20))
    >>> who(season, key).name
    'Ann'
    """
    name = name.strip()
    if not 0 < len(name) <= _LONGEST_NAME:
        raise SettingError(
            worded(
                "A scout must have a name of 1 to {most} letters, but it has {n}.",
                most=_LONGEST_NAME, n=len(name),
            )
        )  # fmt: skip
    least, lines = int(season.plant_numbers.line.min()), int(season.plant_numbers.line.max())
    if rows is not None:
        _must_be_on_plot(rows, least, lines)
    if rows == (least, lines):
        rows = None
    key = secrets.token_urlsafe(_KEY_BYTES)
    first, last = rows or (None, None)
    with season.store.writing() as db:
        name = written_in(db, name)
        if settings_of(db).named(name) is None:
            _must_be_own(db, name, rows, lines)
        elif rows is not None:
            raise SettingError(
                worded(
                    "Rows must be of somebody beside the team, but {name} is of it: the team's "
                    "plan says where they go. Leave the rows out.",
                    name=name,
                )
            )
        _end(db, name)
        row = (name, _key_digest(season.path, key), utc_text(), None, first, last)
        insert(db, phone_tables.SCOUTS, [row])
        touch(db, phone_tables.SCOUTS.name)
    return key


def _must_be_on_plot(rows: tuple[int, int], least: int, lines: int) -> None:
    """Raise `SettingError` unless a part is rows from `least` to `lines`, the first one first."""
    low, high = rows
    if least <= high < low <= lines:
        raise SettingError(
            worded(
                "The first row of a part must not come after its last one, but it is {low} to "
                "{high}. Exchange them: {high} to {low}.",
                low=low, high=high,
            )
        )  # fmt: skip
    if not least <= low <= high <= lines:
        raise SettingError(
            worded(
                "A part must be rows from {least} to {lines} on this plot, "
                "but it is {low} to {high}.",
                least=least, lines=lines, low=low, high=high,
            )
        )  # fmt: skip


def _must_be_own(
    db: sqlite3.Connection, name: str, rows: tuple[int, int] | None, n_lines: int
) -> None:
    """Refuse somebody beside the team without rows, and rows of which others have some."""
    settings = settings_of(db)
    if settings.team and rows is None:
        raise SettingError(
            worded(
                "{name} must be one of the team ({names}), or have rows of their own, but is "
                "neither. Give a name of the team, or rows.",
                name=name, names=", ".join(one.name for one in settings.team),
            )
        )  # fmt: skip
    new = Scout(name, rows, "")
    for other in overlapping(new, scouts_in(db), settings, n_lines):
        (low, high), (first, last) = (one.rows or (1, n_lines) for one in (new, other))
        raise SettingError(
            worded(
                "Rows must be one's own, or the same as another's to share them, but rows "
                "{low} to {high} overlap with {first} to {last}, which are {name}'s. Give "
                "other rows, or take that code back.",
                low=low, high=high, first=first, last=last, name=other.name,
            )
        )  # fmt: skip


def overlapping(
    scout: Scout, scouts: Iterable[Scout], settings: MonitoringSettings, n_lines: int
) -> list[Scout]:
    """Return others beside the team whose rows are in part somebody's, and in part not."""
    lines = 1, n_lines
    low, high = rows = scout.rows or lines
    if settings.named(scout.name) is not None:
        return []
    return [
        other
        for other in scouts
        if person_key(other.name) != person_key(scout.name) and settings.named(other.name) is None
        and (span := other.rows or lines) != rows and span[0] <= high and low <= span[1]
    ]  # fmt: skip


def overlaps(db: sqlite3.Connection, n_lines: int) -> tuple[str, ...]:
    """Return a sentence for each two codes whose rows overlap, as they may in merged copies."""
    settings, known = settings_of(db), scouts_in(db)
    return tuple(
        worded(
            "{name} has rows {low} to {high}, and {other} rows {first} to {last}: both go to "
            "plants that are in both. Make one of them a code with other rows.",
            name=one.name, low=low, high=high, other=other.name, first=first, last=last,
        )
        for k, one in enumerate(known)
        for other in overlapping(one, known[k + 1 :], settings, n_lines)
        for (low, high), (first, last) in [(one.rows or (1, n_lines), other.rows or (1, n_lines))]
    )  # fmt: skip


def inside(numbered: PlantNumbers, rows: tuple[int, int] | None) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants are in a part."""
    if rows is None:
        return np.ones(len(numbered.line), np.bool_)
    part: NDArray[np.bool_] = (numbered.line >= rows[0]) & (numbered.line <= rows[1])
    return part


def withdraw_key(season: OpenSeason, name: str) -> None:
    """End the key of somebody, at once; raise `SettingError` if nobody of that name has one."""
    with season.store.writing() as db:
        if not _end(db, name):
            raise SettingError(
                worded("{name} must have a key that holds, but has none.", name=name)
            )


def scouts_of(season: OpenSeason) -> tuple[Scout, ...]:
    """Return who has a key that holds, in the order in which the keys were made."""
    with season.store.reading() as db:
        return scouts_in(db)


def scouts_in(db: sqlite3.Connection) -> tuple[Scout, ...]:
    """Return who has a key that holds, as `scouts_of` does, within a transaction.

    Of merged copies somebody may have several keys: what was said with the last one counts.
    """
    rows = db.execute(f"SELECT {_COLUMNS} FROM scouts WHERE ended IS NULL ORDER BY made, fid")  # noqa: S608 - ours
    return _last(map(_scout, rows))


def codes_on(season: OpenSeason, on: date) -> dict[str, tuple[int, int] | None]:
    """Return who has a code for work on the day `on` now, by name, and of which rows."""
    with season.store.reading() as db:
        known = scouts_on(db, local_clock(season.plot.field), on, is_over=False)
    return {one.name: one.rows for one in known}


def scouts_on(
    db: sqlite3.Connection, clock: LocalClock, on: date, *, is_over: bool = True
) -> tuple[Scout, ...]:
    """Return who has a key on a day: what was planned of it stays whatever keys are made after it.

    One that was taken back counts if the day was over by then. Of a day that `is_over` one that was
    made later counts only where a route of the day was given to that person after it.
    """
    rows = db.execute(f"SELECT {_COLUMNS} FROM scouts ORDER BY made, fid")  # noqa: S608 - ours
    had = [one for one in map(_scout, rows) if not one.ended or _date(clock, one.ended) > on]
    if is_over and any(_date(clock, one.made) > on for one in had):
        given = {(person_key(one.who), one.at) for one in logged_days.given_out(db)
                 if one.date == str(on)}  # fmt: skip
        had = [
            one
            for one in had
            if _date(clock, one.made) <= on
            or any(who == person_key(one.name) and at >= one.made for who, at in given)
        ]
    return _last(had)


def _date(clock: LocalClock, moment: str) -> date:
    return clock.at(datetime.fromisoformat(moment)).date()


def _last(scouts: Iterable[Scout]) -> tuple[Scout, ...]:
    """Return the last of each person, given them in order."""
    last = {person_key(one.name): one for one in scouts}
    return tuple(sorted(last.values(), key=lambda one: one.made))


def holds(path: Path, key: str) -> bool:
    """Tell whether a key holds on the season of a file, which is only looked at."""
    return glance(path, f"SELECT 1 {_HELD}", (_key_digest(path, key),)) is not None


def key_owner(season: OpenSeason, key: str) -> Scout:
    """Return whose key it is; raise `AccessError` unless it holds on this season."""
    with season.store.reading() as db:
        return key_owner_in(db, season, key)


def key_owner_in(db: sqlite3.Connection, season: OpenSeason, key: str) -> Scout:
    """Return whose key it is, within a transaction: who is taken back writes nothing more."""
    row = db.execute(
        f"SELECT {_COLUMNS} {_HELD}",
        (_key_digest(season.path, key),),
    ).fetchone()
    if row is None:
        raise AccessError(
            worded(
                "There must be a key that holds for this season, but there is none. Ask whoever "
                "leads the season for a new one."
            )
        )
    named = person_key(row[0])
    return next(one for one in scouts_in(db) if person_key(one.name) == named)


_COLUMNS = "name, first_row, last_row, made, ended"
_HELD = "FROM scouts WHERE key_digest = ? AND ended IS NULL"


def _scout(row: tuple[str, int | None, int | None, str, str | None]) -> Scout:
    name, first, last, made, ended = row
    rows = None if first is None or last is None else (first, last)
    return Scout(name, rows, made, ended or "")


def _end(db: sqlite3.Connection, name: str) -> int:
    holding = db.execute("SELECT DISTINCT name FROM scouts WHERE ended IS NULL").fetchall()
    names = [(utc_text(), one) for (one,) in holding if person_key(one) == person_key(name)]
    ended = "UPDATE scouts SET ended = ? WHERE name = ? AND ended IS NULL"
    return db.executemany(ended, names).rowcount if names else 0


def _key_digest(path: Path, key: str) -> str:
    return digest(path.name, key)
