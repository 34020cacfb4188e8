"""What several recordings of the same inspection say beside it: kept together, each part once.

Of recordings that say the same one counts; the others stand back (`rows_that_count`), and keep
their own notes and names. What somebody else recorded is kept so whatever it says beside it, once a
person: it counts once that of the first is undone. What counts is read with what those say: what it
leaves open is taken from them, and notes that differ are joined. So it does not matter which of
them counts, and a recording that is taken back takes its notes with it.
"""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.io.parse.joined_notes import in_both, note_of, parts
from fieldmon.io.parse.result_words import GONE
from fieldmon.monitoring.file.geopackage import insert
from fieldmon.monitoring.file.rows_that_count import STANDS_BACK, as_it_was
from fieldmon.monitoring.file.schema import INSPECTIONS
from fieldmon.monitoring.inspecting.inspection_table import (
    IDENTIFIED_BY,
    identity,
    mark_of,
    time_text,
)
from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from fieldmon.infestation.inspection_columns import InspectionColumn
    from fieldmon.infestation.inspections import Inspections

#: what is said beside an inspection, by the names of the season's file
Beside = dict[str, Any]
Row = tuple[object, ...]

_NAMES = tuple(column.kept for column in BESIDE)
_NOTED = tuple(column.kept for column in BESIDE if column.role == "noted")
_FREE = tuple(column.kept for column in BESIDE if column.role != "noted")
_NOTHING = (None, "")
# by an index of their own, as they are few: not by that of all batches, which has the order
_OF_OTHERS = (
    f"SELECT digest, {', '.join(_NAMES)} FROM inspections WHERE undone = {STANDS_BACK} "  # noqa: S608 - ours
    "AND digest NOTNULL ORDER BY +batch, fid"
)


def either(of: InspectionColumn, one: Any, other: Any) -> Any:  # noqa: ANN401 - text or number
    """Return what is said in a column in either of two copies of a row."""
    if of.role == "noted":
        return in_both(one or "", other or "")
    if of.is_text:
        return max(one or "", other or "")
    return max((value for value in (one, other) if value is not None), default=None)


def together(own: Beside, others: Iterable[Beside]) -> Beside:
    """Return what is said beside an inspection that counts, with what others say of the same.

    Of a note by somebody else the name is said with it.
    """
    said = dict(own)
    known = {part for name in _NOTED for part in parts(own[name] or "")}
    for other in others:
        for name in _FREE:
            if said[name] in _NOTHING:
                said[name] = other[name]
        by = _by(str(other["who"] or ""), str(said["who"] or ""))
        for name in _NOTED:
            more = [part for part in parts(other[name] or "") if part not in known]
            known.update(more)
            named = [part if part == GONE else f"{part}{by}" for part in more]
            if more:
                said[name] = note_of([*parts(said[name] or ""), *named])
    return said


def _by(who: str, other: str) -> str:
    """Return what is written behind a note: whose it is, where the inspection is another's."""
    return f" ({who})" if who and person_key(who) != person_key(other) else ""


def _adds(brought: Beside, held: Beside) -> tuple[bool, bool]:
    """Return whether something is noted that is not held, and whether what was open is filled."""
    noted = False
    for name in _NOTED:
        known = parts(held[name] or "")
        for part in parts(brought[name] or ""):
            named = f"{part} ("
            noted |= not any(
                one == part or (one.startswith(named) and one.endswith(")")) for one in known
            )
    fills = any(held[name] in _NOTHING and brought[name] not in _NOTHING for name in _FREE)
    return noted, fills


class Addition(NamedTuple):
    """What an inspection that is brought says beside one that is held.

    Parameters
    ----------
    brought, held
        Their numbers among those.
    is_note
        Whether it is a note.
    fills
        Whether it is what was left open: a name, a chance. Neither: somebody else saw the same.
    """

    brought: int
    held: int
    is_note: bool
    fills: bool = True


def additions(db: sqlite3.Connection, brought: Inspections, held: Inspections) -> list[Addition]:
    """Return what inspections that are known say beside what is held of them.

    That somebody else saw the same is more, too, unless it is kept already or brought before.
    """
    near = np.flatnonzero(np.isin(held.plant, brought.plant) & np.isin(held.date, brought.date))
    may = np.flatnonzero(_may_add(brought, held.take(near)))
    brought, held = brought.take(may), held.take(near)
    same, told = _same(brought, held), _beside(brought)
    which = sorted({j for candidates in same for j in candidates})
    known = dict(zip(which, _beside(held.take(np.array(which, np.intp))), strict=True))
    saw = _who_saw(db, held, known) if any(one["who"] for one in told) else {}
    found = []
    for k, candidates in enumerate(same):
        more = [_adds(told[k], known[j]) for j in candidates]
        if not more:
            continue
        who = person_key(told[k]["who"] or "")
        others = bool(who) and not any(who in saw[j] or not known[j]["who"] for j in candidates)
        if others or (False, False) not in more:
            found.append(Addition(int(may[k]), int(near[candidates[0]]), *more[0]))
            if who and saw:
                saw[candidates[0]].add(who)
    return found


def _who_saw(
    db: sqlite3.Connection, held: Inspections, known: dict[int, Beside]
) -> dict[int, set[str]]:
    """Return by `person_key` who recorded each inspection that is held, given by its number."""
    others = of_others(db)
    return {
        j: {
            person_key(one["who"] or "")
            for one in (beside, *others.get(mark_of(identity(held, j)), ()))
        }
        for j, beside in known.items()
    }


def _may_add(brought: Inspections, held: Inspections) -> NDArray[np.bool_]:
    """Return ``(k,)`` which note anything, say what is left open of any held, or are another's."""
    people = {person_key(str(one)) for one in {*brought.who, *held.who}} - {""}
    may: NDArray[np.bool_] = np.full(len(brought), len(people) > 1) & (brought.who != "")
    for one in BESIDE:
        if one.role == "noted" or not one.says(getattr(held, one.name)).all():
            may |= one.says(getattr(brought, one.name)).astype(np.bool_)
    return may


def keep(db: sqlite3.Connection, held: Inspections, made: Iterable[tuple[int, Row]]) -> None:
    """Keep what was brought of inspections held, given with their numbers: it stands back there.

    What it left open of when and how many is as it is held.
    """
    rows = [standing_back(db, held, k, row) for k, row in made]
    insert(db, INSPECTIONS, [tuple(row[name] for name in INSPECTIONS.names) for row in rows])


def standing_back(db: sqlite3.Connection, held: Inspections, k: int, made: Row) -> dict[str, Any]:
    """Return the row of what was brought of an inspection held, as `keep` keeps it."""
    told = dict(zip(INSPECTIONS.names, made, strict=True))
    own = {name: told[name] for name in (*_NAMES, "batch")}
    return _row(db, held, k) | own | {"undone": STANDS_BACK}


def _beside(inspections: Inspections) -> list[Beside]:
    """Return what is said beside each inspection."""
    columns = [one.to_file(getattr(inspections, one.name)) for one in BESIDE]
    return [dict(zip(_NAMES, values, strict=True)) for values in zip(*columns, strict=True)]


def _same(brought: Inspections, held: Inspections) -> list[list[int]]:
    """Return of each inspection that is brought the numbers of those held that are the same.

    Where no time is said, or no count, it is any of that plant, day and result.
    """
    where: dict[tuple[int, ...], list[int]] = {}
    for j, key in enumerate(_keys(held)):
        where.setdefault(key, []).append(j)
    times, counts, found = _times(held), held.count.tolist(), []
    told = zip(_keys(brought), _times(brought), brought.count.tolist(), strict=True)
    for key, time, count in told:
        same = where.get(key, [])
        if time is not None:
            same = [j for j in same if times[j] == time]
        if not isnan(count) and count != 0:
            same = [j for j in same if counts[j] == count]
        found.append(same)
    return found


def _times(inspections: Inspections) -> list[str | None]:
    """Return the time of each as files have it."""
    return [*map(time_text, inspections.second.tolist())]


def _keys(inspections: Inspections) -> Iterator[tuple[int, ...]]:
    days = inspections.date.astype(np.int64).tolist()
    return zip(inspections.plant.tolist(), days, inspections.result.tolist(), strict=True)


def _row(db: sqlite3.Connection, held: Inspections, k: int) -> Beside:
    """Return the row of an inspection that counts, by the names of its columns."""
    names = ", ".join(INSPECTIONS.names)
    said = identity(held, k)
    wanted = f"SELECT {names} FROM inspections WHERE undone = 0 AND "  # noqa: S608 - ours
    row = db.execute(f"{wanted} digest = ?", (mark_of(said),)).fetchone()
    if row is None:  # of two that a phone told alike the second has a digest of its own
        same = " AND ".join(f"{name} IS ?" for name in IDENTIFIED_BY)
        row = db.execute(f"{wanted} {same}", said).fetchone()
    return dict(zip(INSPECTIONS.names, row, strict=True))


def of_others(db: sqlite3.Connection) -> dict[str, list[Beside]]:
    """Return what is said by inspections that stand back, by their digests, in their order.

    What stood there before a correction is not among it: the correction says otherwise.
    """
    found = db.execute(_OF_OTHERS).fetchall()
    said: dict[str, list[Beside]] = {}
    for mark, *values in found:
        said.setdefault(mark, []).append(dict(zip(_NAMES, values, strict=True)))
    for mark, before in _before_corrections(db, said.keys()):
        stood = {name: before.get(name) for name in _NAMES}
        if stood in said[mark]:
            said[mark].remove(stood)
    return said


def _before_corrections(
    db: sqlite3.Connection, marks: Iterable[str]
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield what was corrected and had the same digest before, with that, of some digests."""
    if not (known := {*marks}):
        return
    rows = db.execute(
        "SELECT now, before FROM outside_changes WHERE batch NOTNULL AND before NOTNULL "
        "AND now NOTNULL AND undone = 0 ORDER BY fid"
    )
    for now, before in rows:
        if now in known and (was := as_it_was(before))["digest"] == now:
            yield now, was


def of(db: sqlite3.Connection, mark: str, others: dict[str, list[Beside]]) -> Beside | None:
    """Return what is said beside the inspection with a digest that counts; None: none does."""
    wanted = f"SELECT {', '.join(_NAMES)} FROM inspections WHERE digest = ? AND undone = 0"  # noqa: S608 - ours
    row = db.execute(wanted, (mark,)).fetchone()
    return None if row is None else together(
        dict(zip(_NAMES, row, strict=True)), others.get(mark, ())
    )  # fmt: skip


class Notes(NamedTuple):
    """Parts of the notes of an inspection: its own alone, and with those of others."""

    own: frozenset[str]
    all: frozenset[str]


def notes(db: sqlite3.Connection, after: int) -> dict[str, Notes]:
    """Return the notes of inspections that count, by their digests.

    Of the first rows, up to number `after`, only of those of which others say something.
    """
    wanted = (
        f"SELECT digest, {', '.join(_NAMES)} FROM inspections WHERE undone = 0 "  # noqa: S608 - ours
        "AND digest NOTNULL AND "
    )
    others, rows = of_others(db), db.execute(f"{wanted} fid > ?", (after,)).fetchall()
    for mark in others:
        rows += db.execute(f"{wanted} fid <= ? AND digest = ?", (after, mark))
    said = {}
    for mark, *values in rows:
        own = dict(zip(_NAMES, values, strict=True))
        said[mark] = Notes(_all(own), _all(together(own, others.get(mark, ()))))
    return said


def _all(said: Beside) -> frozenset[str]:
    """Return every part of what is noted."""
    return frozenset(part for name in _NOTED for part in parts(said[name] or ""))


def n_noted(before: dict[str, Notes], now: dict[str, Notes], first: set[str]) -> int:
    """Return how many inspections have more notes than before, those that were there.

    Of the `first` ones, by their digests, nothing was known but their own where it was not told.
    """
    known = {mark: one.own for mark, one in now.items() if mark in first}
    known |= {mark: one.all for mark, one in before.items()}
    return sum(not now[mark].all <= said for mark, said in known.items() if mark in now)


def with_others(db: sqlite3.Connection, mark: str | None, own: Beside) -> Beside:
    """Return what is said beside an inspection, with what others said while it had a digest."""
    own = {name: own[name] for name in _NAMES}
    return together(own, of_others(db).get(mark or "", ()))


def write_out(db: sqlite3.Connection) -> None:
    """Let each row that counts say itself what others say of the same: they are about to go."""
    others = of_others(db)
    sets = ", ".join(f"{name} = ?" for name in _NAMES)
    for mark in others:
        if (said := of(db, mark, others)) is not None:
            db.execute(
                f"UPDATE inspections SET {sets} WHERE digest = ? AND undone = 0",  # noqa: S608 - ours
                (*said.values(), mark),
            )
