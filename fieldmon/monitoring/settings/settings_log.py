"""What was chosen for a season, choice after choice, and how the last change is taken back.

Nothing is deleted: a change is rows that are added, and so is its taking back, whose rows name the
change that they take back. Whoever goes back by hand has made another change. Earlier versions did
not name it: what they took back is a change like any other, and taking that back makes it anew.
"""

from __future__ import annotations

import json
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert
from fieldmon.monitoring.settings.settings import as_json, from_json
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator

    from fieldmon.monitoring.settings.settings import MonitoringSettings

#: each part of the settings as JSON, by name
Parts = dict[str, str]
#: when each part of the settings was chosen, by name
Marks = dict[str, str]


def now(db: sqlite3.Connection) -> Parts:
    """Return what counts now."""
    return dict(db.execute("SELECT name, value FROM settings ORDER BY fid").fetchall())


# the clock of a computer may be set back: what was chosen later stands below
_UNTIL = (
    " FROM settings WHERE fid <= coalesce((SELECT max(fid) FROM settings WHERE changed <= ?1),"
    " (SELECT max(fid) FROM settings WHERE changed ="
    " (SELECT changed FROM settings ORDER BY fid LIMIT 1))) ORDER BY fid"
)


def settings_of(db: sqlite3.Connection) -> MonitoringSettings:
    """Return what is chosen for a season, as a transaction sees it."""
    return from_json(now(db))


def at(db: sqlite3.Connection, moment: str) -> Parts:
    """Return what counted at a moment (UTC, as `utc_text` has it); before the first, the first."""
    return dict(db.execute("SELECT name, value" + _UNTIL, (moment,)).fetchall())


def marks(db: sqlite3.Connection, moment: str | None = None) -> Marks:
    """Return when what counts now, or counted at a `moment`, was chosen: `of` finds it by that."""
    if moment is not None:
        return dict(db.execute("SELECT name, changed" + _UNTIL, (moment,)).fetchall())
    return dict(db.execute("SELECT name, changed FROM settings ORDER BY fid").fetchall())


def of(db: sqlite3.Connection, chosen: Marks) -> Parts:
    """Return what was chosen then; nothing where a part of it is not in the file."""
    wanted = "SELECT name, value FROM settings WHERE (name, changed) IN (VALUES {}) ORDER BY fid"
    values = ", ".join(["(?, ?)"] * len(chosen))
    said = [text for one in chosen.items() for text in one]
    parts = dict(db.execute(wanted.format(values), said).fetchall()) if chosen else {}
    return parts if parts.keys() == chosen.keys() else {}


def all_moments(db: sqlite3.Connection) -> list[str]:
    """Return when anything was chosen (UTC), the first time first."""
    chosen = db.execute("SELECT changed FROM settings GROUP BY changed ORDER BY min(fid)")
    return [moment for (moment,) in chosen]


def begun(db: sqlite3.Connection) -> str:
    """Return the day (ISO) on which the season began; "" where a file says nothing of it."""
    said: str = json.loads(now(db).get("season", "{}")).get("begins", "")
    return said


def begun_at(db: sqlite3.Connection) -> str:
    """Return the moment (UTC) at which the season was begun; "" where a file says nothing of it.

    Copies share it, however far they went apart; seasons begun apart do not, even on one day.
    """
    row = db.execute("SELECT changed FROM settings ORDER BY fid LIMIT 1").fetchone()
    return "" if row is None else str(row[0] or "")


def pest(db: sqlite3.Connection) -> str:
    """Return the name of the pest that is looked for now; "" where nobody said."""
    return pest_in(now(db).get("pest", "null"))


def pest_in(kept: str) -> str:
    """Return the name of the pest that a setting keeps; "" where it is none."""
    chosen = json.loads(kept)
    return "" if chosen is None else str(chosen["name"])


def write(db: sqlite3.Connection, parts: Parts, undoes: str | None = None) -> list[str]:
    """Keep what differs from what counts now; return the names of what does.

    `undoes` is when the change was made that this takes back; None: it is a change of its own.
    """
    before, at = now(db), utc_text()
    # a part that is no longer chosen, as a pest, is null
    wanted = {**dict.fromkeys(before, "null"), **parts}
    changed = [
        (name, text, at, undoes) for name, text in wanted.items() if before.get(name) != text
    ]
    insert(db, schema.SETTINGS, changed)
    return [name for name, *_ in changed]


def change(db: sqlite3.Connection, settings: MonitoringSettings) -> None:
    """Keep what differs from what counts now; what an earlier version wrote otherwise stays."""
    before = now(db)
    same = as_written_now(before)
    parts = as_json(settings).items()
    write(
        db,
        {name: before.get(name, text) if same.get(name) == text else text for name, text in parts},
    )


def as_written_now(parts: Parts) -> Parts:
    """Return settings as this version writes them: an earlier one took some of it for granted."""
    return {**parts, **_written_now(tuple(parts.items()))} if parts else {}


@lru_cache(maxsize=16)  # a merge asks it of each change of both files
def _written_now(parts: tuple[tuple[str, str], ...]) -> Parts:
    return as_json(from_json(dict(parts)))


def each_difference(before: Parts, after: Parts) -> Iterator[tuple[str, str, str]]:
    """Yield each setting that differs by its path, as ``robot look_s``, with both in short.

    Both are empty where one is too long for a line.

    Examples
    --------
    >>> one, other = '{"hours": 4.0, "look_s": 40.0}', '{"hours": 6.0, "look_s": 40.0}'
    >>> [*each_difference({"robot": one, "pest": "null"}, {"robot": other, "pest": "null"})]
    [('robot hours', '4', '6')]
    """
    for name in {**before, **after}:
        was, now = before.get(name, "null"), after.get(name, "null")
        if was == now:
            continue
        if name == "weather":  # a year of hours is no line
            yield name, "", ""
        else:
            yield from _differing(name, *map(json.loads, (was, now)))


def plain_path(path: str) -> str:
    """Return the path of a setting as it is said where it has no words of its own."""
    return path.replace("_", " ")


def _differing(path: str, was: object, now: object) -> Iterator[tuple[str, str, str]]:
    if isinstance(was, dict) and isinstance(now, dict):
        for key in {**was, **now}:
            if was.get(key) != now.get(key):
                yield from _differing(f"{path} {key}", was.get(key), now.get(key))
        return
    said = [_in_short(one) for one in (was, now)]
    yield (path, "", "") if "" in said else (path, said[0], said[1])


def _in_short(value: object) -> str:
    """Return a value in short; empty: it is none to be said in a line."""
    if isinstance(value, dict):
        return str(value.get("name", ""))
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:g}"
    return "" if isinstance(value, list) else "none" if value is None else str(value)


class _Change(NamedTuple):
    """Parts that were chosen at one moment; `undoes` is the moment of what that took back."""

    at: str
    parts: Parts
    undoes: str | None


def _changes(db: sqlite3.Connection) -> list[_Change]:
    """Return what was chosen, choice after choice; the first is what the season began with."""
    made: list[_Change] = []
    for name, value, at, undoes in db.execute(
        "SELECT name, value, changed, undoes FROM settings ORDER BY fid"
    ):
        if not made or made[-1].at != at:
            made.append(_Change(at, {}, undoes))
        made[-1].parts[name] = value
    return made


def _last_that_counts(db: sqlite3.Connection) -> tuple[str, Parts] | None:
    """Return when the last change was made that was not taken back, and what counted before it.

    Of two copies that were merged one may have chosen otherwise since: what made no difference by
    now is passed over.
    """
    made = _changes(db)
    gone = {one.undoes for one in made}
    counting = [one for one in made[1:] if one.undoes is None and one.at not in gone]
    present = _chosen_in(now(db))
    while made and counting:
        last = counting.pop()
        others = (made[0], *counting)
        before = {name: text for one in others for name, text in one.parts.items()}
        again = {name: before.get(name, "null") for name in last.parts}
        if (parts := _chosen_in(present | again)) != present:
            return last.at, parts
    return None


def _chosen_in(parts: Parts) -> Parts:
    """Return the parts that are chosen: one that is null is as if it had never been."""
    return {name: text for name, text in parts.items() if text != "null"}


def before_now(db: sqlite3.Connection) -> Parts | None:
    """Return what counted before the last change that was not taken back; None: nothing."""
    found = _last_that_counts(db)
    return None if found is None else found[1]


def undo(db: sqlite3.Connection) -> MonitoringSettings:
    """Take the last change back; return what counts again, or raise `SettingError`."""
    found = _last_that_counts(db)
    if found is None:
        raise SettingError(
            worded(
                "There must be a change of settings to take back, but there "
                "is none: they are those that the season began with."
            )
        )
    at, parts = found
    write(db, parts, undoes=at)
    return from_json(parts)
