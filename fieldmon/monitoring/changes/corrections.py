"""Corrections, a batch of their own: results that hold in place of others, or another day or time.

Those that other programs make are in `outside_changes` and `copy_corrections`.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, date, datetime, time
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.infestation.inspections import RESULT_CODES, RESULT_NAMES, SKIPPED, Inspections
from fieldmon.monitoring.changes import copy_corrections, outside_changes
from fieldmon.monitoring.changes.outside_changes import OutsideChange
from fieldmon.monitoring.file import rows_that_count
from fieldmon.monitoring.file.geopackage import touch
from fieldmon.monitoring.file.schema import INSPECTED, INSPECTIONS
from fieldmon.monitoring.inspecting import batches, inspection_lots, undone_batches
from fieldmon.monitoring.inspecting.contradictions import Contradictions, corrected_against
from fieldmon.monitoring.inspecting.inspection_table import time_text
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

_OTHERWISE = (
    f"SELECT fid, {INSPECTED} FROM inspections AS old WHERE plant = ? AND date = ? "  # noqa: S608 - ours
    "AND undone = 0 AND result NOT IN (?, ?) ORDER BY fid"
)
# when, and what is said beside it, stays where nobody says otherwise
_BESIDE = ", ".join(f"{one.kept} = coalesce(nullif(?, ''), {one.kept})" for one in BESIDE)
_SAYS = (
    f"UPDATE inspections SET result = ?, count = ?, time = coalesce(?, time), {_BESIDE} "  # noqa: S608 - ours
    "WHERE fid = ?"
)
_WHEN = "UPDATE inspections SET date = coalesce(?, date), time = coalesce(?, time) WHERE fid = ?"
_WAS = f"SELECT {INSPECTED} FROM inspections AS old WHERE fid = ?"  # noqa: S608 - as above


def take(
    db: sqlite3.Connection,
    inspections: Inspections,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    said: tuple[str, str],
) -> tuple[str, ...]:
    """Let results hold in place of those held of their plants and days; say what, one by one.

    Those held stand back, until the corrections are taken back. `said` is where the results come
    from, and whose they are.
    """
    source, who = said
    batch = batches.begin(db, "corrections", source, who)
    taken = []
    for k in range(len(inspections)):
        one = inspections.take(slice(k, k + 1))
        result = RESULT_NAMES[int(one.result[0])]
        key = int(one.plant[0]), str(one.date[0]), result, RESULT_NAMES[SKIPPED]
        (row, was), *others = db.execute(_OTHERWISE, key).fetchall()
        count = None if np.isnan(one.count[0]) else float(one.count[0])
        beside = {each.name: each.to_file(getattr(one, each.name))[0] for each in BESIDE}
        beside["who"] = beside["who"] or who
        told = count, time_text(float(one.second[0])), *beside.values()
        change = _changed(db, (row, was), (_SAYS, (result, *told, row)), plot, (settings, batch))
        taken.append(change)
        for fid, stood in others:
            other = OutsideChange(INSPECTIONS.name, fid, "delete", stood)
            copy_corrections.stand_back(db, other, batch)
            taken.append(other)
    batches.count_inspections(db)
    batches.end(db, batch, len(inspections))
    touch(db, INSPECTIONS.name)
    return tuple(outside_changes.in_words(db, one, plot[0]) for one in taken)


def must_have_come(field: Field, on: date, at: time | None) -> None:
    """Raise `SettingError` if a moment, or a whole day, lies ahead of the plot's clock.

    So it does if that clock never showed it.
    """
    clock = local_clock(field)
    now = clock.now()
    told = datetime.combine(on, at or time())
    if at is not None and clock.at(clock.moment(on, at).astimezone(UTC)) != told:
        raise SettingError(
            worded(
                "An inspection must be of a time that the plot's clock showed, but {day} is "
                "none: clocks were put forward over it.",
                day=f"{told:%Y-%m-%d %H:%M}",
            )
        )
    if (on, at or now.time()) > (now.date(), now.time()):
        raise SettingError(
            worded(
                "An inspection must be of a moment that has come, but {day} has not: on the "
                "plot it is {now}.",
                day=str(on) if at is None or on > now.date() else f"{on} {at:%H:%M}",
                now=f"{now:%Y-%m-%d %H:%M}",
            )
        )


def made(db: sqlite3.Connection, row: int) -> tuple[date, time | None]:
    """Return when one inspection that counts was made, by the clock; None: no time is known."""
    undone_batches.counting(db, row)
    wanted = "SELECT date, time FROM inspections WHERE fid = ?"
    day, at = db.execute(wanted, (row,)).fetchone()
    return date.fromisoformat(day[:10]), None if at is None else time.fromisoformat(at)


def retime(
    db: sqlite3.Connection,
    row: int,
    when: tuple[date | None, float | None],
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    who: str,
) -> tuple[str, ...]:
    """Give one inspection that counts another day, or another time of its day; say so.

    `when` are the day and the seconds since its midnight; None: as it is.
    """
    day, second = when
    (was,) = db.execute(_WAS, (row,)).fetchone()
    batch = batches.begin(db, "corrections", "", who)
    on, at = day and day.isoformat(), None if second is None else time_text(second)
    says = _WHEN, (on, at, row)
    change = _changed(db, (row, was), says, plot, (settings, batch))
    batches.end(db, batch, 1)
    touch(db, INSPECTIONS.name)
    return (outside_changes.in_words(db, change, plot[0]),)


def contradicting(db: sqlite3.Connection) -> Contradictions:
    """Return what the last batch, of corrections, made contradict what else counts."""
    (batch,) = db.execute("SELECT max(fid) FROM batches").fetchone()
    told = "SELECT before FROM outside_changes WHERE batch = ? AND before NOTNULL"
    kept = (rows_that_count.as_it_was(before) for (before,) in db.execute(told, (batch,)))
    said = "SELECT plant, date, result, time FROM inspections WHERE undone = 0 AND batch"
    now = db.execute(f"{said} = ?", (batch,)).fetchall()
    others = f"{said} <> ? AND plant IN (SELECT plant FROM inspections WHERE batch = ?)"  # noqa: S608
    rest = db.execute(others, (batch, batch)).fetchall()
    before = [
        tuple(one.get(name) for name in ("plant", "date", "result", "time"))
        for one in kept
        if one["digest"] is not None and one.get("undone") == rows_that_count.COUNTS
    ]
    return corrected_against(_inspections(rest + now), _inspections(rest + before))


def _inspections(rows: list[tuple[Any, ...]]) -> Inspections:
    """Return inspections of plants, days, results and times as the file has them."""
    return Inspections.of(
        np.array([plant for plant, *_ in rows], np.int32),
        np.array([RESULT_CODES[result] for _, _, result, _ in rows], np.int8),
        np.array([day[:10] for _, day, *_ in rows], "datetime64[D]"),
        second=np.array([inspection_lots.second_of(at) for *_, at in rows]),
    )


def _changed(
    db: sqlite3.Connection,
    stood: tuple[int, str],
    says: tuple[str, tuple[object, ...]],
    plot: tuple[PlantGrid, PlantNumbers],
    taken: tuple[MonitoringSettings, int],
) -> OutsideChange:
    """Let a row say something else, for a batch of corrections; what it said is kept."""
    row, was = stood
    change = OutsideChange(INSPECTIONS.name, row, "update", was)
    change = replace(change, before=copy_corrections.as_it_is(db, row))
    db.execute(*says)
    now = outside_changes.take_row(db, change, plot, *taken)
    outside_changes.keep_before(db, change, plot[0])
    copy_corrections.note(db, change, taken[1], now)
    return change
