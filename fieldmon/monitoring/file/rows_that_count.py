"""Which rows count: others stand back for them, and count again once those no longer do.

Two people who worked apart may record the same result of the same plant and time: the first of
them counts, the other stands back. It was not taken back: whoever undoes the first one's file
leaves the other's as it was recorded. So does an inspection that was corrected stand back for what
was made of it, or for nothing if it was deleted: whoever undoes the correction has it back. Where
two copies of a season corrected one inspection otherwise, what was corrected last holds, and what
the others made of it stands back.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Sequence

#: in the column `undone` of inspections and treatments
COUNTS, TAKEN_BACK, STANDS_BACK = 0, 1, 2


def count_again(db: sqlite3.Connection) -> list[int]:
    """Let inspections count again where none stands for them any more; return their batches."""
    found = db.execute(
        "SELECT digest, fid, batch FROM inspections AS one WHERE undone = ? AND NOT EXISTS "
        "(SELECT 1 FROM inspections WHERE digest = one.digest AND undone = 0) "
        "ORDER BY batch DESC, fid DESC",
        (STANDS_BACK,),
    ).fetchall()
    gone = corrected_in(db) if found else NOTHING_CORRECTED
    first = {mark: (fid, batch) for mark, fid, batch in found if may_count(gone, mark, batch)}
    db.executemany(
        "UPDATE inspections SET undone = 0 WHERE fid = ?", [(fid,) for fid, _ in first.values()]
    )
    _point_findings(db, found, {mark: fid for mark, (fid, _) in first.items()})
    return sorted({batch for _, batch in first.values()})


def _point_findings(
    db: sqlite3.Connection, found: list[tuple[str, int, int]], again: dict[str, int]
) -> None:
    """Let what phones told be of inspections that count again, where its people recorded those.

    Given digest, number and batch of those that stood back, and by digests which count again.
    """
    names = dict(db.execute("SELECT fid, who FROM batches").fetchall())
    recorded = {(mark, names.get(batch)) for mark, _, batch in found if mark in again}
    told = db.execute(
        "SELECT t.fid, i.digest, t.scout FROM tellings t JOIN inspections i "
        "ON i.fid = t.inspection WHERE i.undone <> 0"
    ).fetchall()
    db.executemany(
        "UPDATE tellings SET inspection = ? WHERE fid = ?",
        [(again[mark], fid) for fid, mark, who in told if (mark, who) in recorded],
    )


class Corrected(NamedTuple):
    """Which inspections stand back for a correction.

    Parameters
    ----------
    gone
        Their digests, and the batch of the last correction that left them the same, as one of who
        inspected does; None: none did.
    of_one
        The corrections that stand, in order, those of one inspection together.
    outdone
        Digests and batches of what corrections made of an inspection that was corrected again, to
        something else.
    """

    gone: dict[str | None, int | None]
    of_one: Sequence[list[dict[str, Any]]]
    outdone: frozenset[tuple[str | None, int | None]]


NOTHING_CORRECTED = Corrected({}, (), frozenset())


def corrected(
    corrections: Sequence[dict[str, Any]], recorded: Callable[[str], Iterable[int]]
) -> Corrected:
    """Return which inspections stand back for a correction, given rows of those in order.

    Where one that was taken back had been corrected itself, the last correction stands. `recorded`
    returns the batches of all inspections with a digest.
    """
    gone: dict[str | None, int | None] = {}
    for row in reversed(corrections):
        if row["before"] and (not row["undone"] or row["now"] in gone):
            was = as_it_was(row["before"])["digest"]
            same = was == row["now"] and not row["undone"]
            gone.setdefault(was, row["batch"] if same else None)
    stand = [
        row
        for row in corrections
        if row["before"] and not (row["undone"] and row["now"] not in gone)
    ]
    of_one = _of_one(stand, recorded)
    outdone = {
        (row["now"], row["batch"])
        for rows in of_one
        for row in rows
        if row["now"] != rows[-1]["now"]
    }
    return Corrected(gone, of_one, frozenset(outdone))


def _of_one(
    stand: list[dict[str, Any]], recorded: Callable[[str], Iterable[int]]
) -> list[list[dict[str, Any]]]:
    """Return corrections that were not taken back, those of one inspection together."""
    found: dict[int, list[dict[str, Any]]] = {}
    known: dict[str, tuple[list[dict[str, Any]], int | None]] = {}  # and since when corrected
    for row in sorted(stand, key=lambda row: int(row["batch"])):
        was, made, batch = as_it_was(row["before"])["digest"], row["now"], row["batch"]
        if was is None:
            continue
        own, since = known.get(was, ([], None))
        # what was recorded anew once it had been corrected is another inspection
        if since is not None and any(since < one < batch for one in recorded(was)):
            own = []
        found.setdefault(id(own), own)
        known[was] = own, batch
        if made is not None:
            known[made] = own, None
        if not row["undone"]:
            own.append(row)
    return [own for own in found.values() if own]


def may_count(of: Corrected, mark: str, batch: int | None) -> bool:
    """Return whether an inspection of a batch counts where no other of its digest does."""
    gone = mark in of.gone and (batch is None or of.gone[mark] != batch)
    return not gone and (mark, batch) not in of.outdone


def as_it_was(before: str) -> dict[str, Any]:
    """Return what an inspection said before it was corrected, by the names of its columns.

    Its digest is None where that is not known.
    """
    try:
        return {"digest": None, **json.loads(before, strict=False)}
    except (ValueError, TypeError):  # another program wrote it
        return {"digest": None}


def corrected_in(db: sqlite3.Connection, redone: int | None = None) -> Corrected:
    """Return which inspections of a season stand back for a correction.

    Or would, if those of the batch `redone` stood again.
    """
    held = "SELECT batch FROM inspections WHERE digest = ? AND batch NOTNULL"
    rows = [{**row, "undone": 0} if row["batch"] == redone else row for row in _corrections(db)]
    return corrected(rows, lambda mark: [batch for (batch,) in db.execute(held, (mark,))])


def _corrections(db: sqlite3.Connection) -> list[dict[str, Any]]:
    names = ("before", "now", "undone", "batch")
    rows = db.execute(
        f"SELECT {', '.join(names)} FROM outside_changes WHERE batch NOTNULL "  # noqa: S608 - ours
        "AND before NOTNULL ORDER BY fid"
    )
    return [dict(zip(names, row, strict=True)) for row in rows]


# what a correction of a batch made
_MADE = "SELECT min(fid) FROM inspections WHERE digest = ? AND batch = ?"


def undo_corrections(db: sqlite3.Connection, batch: int, now: str | None = None) -> list[str]:
    """Note that the corrections of a batch were taken back, or the one that came to `now`.

    What stood there before takes its old place in the order, and has what a phone told of it.
    Return its digests.
    """
    rows = db.execute(
        "SELECT fid, before, now FROM outside_changes "
        "WHERE batch = ? AND before NOTNULL AND coalesce(?, now, '') = coalesce(now, '')",
        (batch, now),
    ).fetchall()
    before_it = []
    # of several that say the same, its own
    own = (
        "SELECT min(fid) FROM inspections WHERE digest = ? AND undone = ? AND batch <> ? "
        "GROUP BY batch ORDER BY batch = ? DESC, min(fid) LIMIT 1"
    )
    for fid, before, made in rows:
        db.execute("UPDATE outside_changes SET undone = 1 WHERE fid = ?", (fid,))
        stood = as_it_was(before)
        was = stood["digest"]
        before_it.append(was)
        (held,) = db.execute(own, (was, STANDS_BACK, batch, stood.get("batch"))).fetchone() or (
            None,
        )
        (new,) = db.execute(_MADE, (made, batch)).fetchone()
        if held is not None and new is not None and new < held:
            _exchange(db, new, held)
    return [was for was in before_it if was is not None]


_HELD = "SELECT fid, batch FROM inspections WHERE digest = ? AND undone = 0"


def not_as_before(db: sqlite3.Connection, batch: int, but: Sequence[str] = ()) -> list[str]:
    """Return the digests that corrections of a batch were of, and that do not count any more.

    Those that were taken back are meant, `but` for those to these digests, and for those that would
    hold in place of what another copy made of the same inspection.
    """
    rows = db.execute(
        "SELECT before, now FROM outside_changes WHERE batch = ? AND before NOTNULL AND undone = 1",
        (batch,),
    ).fetchall()
    now, then, missing = corrected_in(db), corrected_in(db, batch), []
    for before, made in rows:
        was = as_it_was(before)["digest"]
        # what was corrected once more still stands back for that
        if was is None or made in but or made in now.gone:
            continue
        if was in now.gone and (made, batch) not in then.outdone:
            continue
        if db.execute(_HELD, (was,)).fetchone() is None:
            missing.append(was)
    return missing


def redo_corrections(
    db: sqlite3.Connection, batch: int, but: Sequence[str] = ()
) -> set[int] | None:
    """Let corrections of a batch that were taken back stand again, `but` those to these digests.

    What stood there before stands back as it did, and has its place in the order again. Return its
    batches; None, with nothing done: something else was made of it since.
    """
    rows = db.execute(
        "SELECT fid, before, now FROM outside_changes WHERE batch = ? AND before NOTNULL "
        "AND undone = 1",
        (batch,),
    ).fetchall()
    if not_as_before(db, batch, but):
        return None
    found = []
    for fid, before, made in rows:
        if made not in but:
            was = as_it_was(before)["digest"]
            found.append((fid, made, db.execute(_HELD, (was,)).fetchone()))
    for fid, made, held in found:
        db.execute("UPDATE outside_changes SET undone = 0 WHERE fid = ?", (fid,))
        if held is None:
            continue
        db.execute("UPDATE inspections SET undone = ? WHERE fid = ?", (STANDS_BACK, held[0]))
        (new,) = db.execute(_MADE, (made, batch)).fetchone()
        if new is not None and held[0] < new:
            _exchange(db, new, held[0])
    return {held[1] for _, _, held in found if held is not None} | _let_outdone_stand_back(db)


def _let_outdone_stand_back(db: sqlite3.Connection) -> set[int]:
    """Let what was made of inspections that were corrected again stand back; return its batches."""
    of = "FROM inspections WHERE digest = ? AND batch = ? AND undone = 0"
    found = [
        row
        for one in corrected_in(db).outdone
        for row in db.execute(f"SELECT fid, batch {of}", one)
    ]
    stands_back = "UPDATE inspections SET undone = ? WHERE fid = ?"
    db.executemany(stands_back, [(STANDS_BACK, fid) for fid, _ in found])
    return {batch for _, batch in found}


def _exchange(db: sqlite3.Connection, one: int, other: int) -> None:
    """Let two inspections have each other's number, and so place in the order."""
    for here, there in ((one, -1), (other, one), (-1, other)):
        db.execute("UPDATE inspections SET fid = ? WHERE fid = ?", (there, here))


def undo_same(db: sqlite3.Connection, inspection: int) -> list[int]:
    """Mark as undone all that say the same as an inspection that is, and name nobody else.

    Return their batches.
    """
    (who,) = db.execute("SELECT who FROM inspections WHERE fid = ?", (inspection,)).fetchone()
    same = (
        "SELECT fid, batch, who FROM inspections WHERE undone <> ? AND digest = "
        "(SELECT digest FROM inspections WHERE fid = ?)"
    )
    key = person_key(who or "")
    found = [
        (fid, batch)
        for fid, batch, other in db.execute(same, (TAKEN_BACK, inspection)).fetchall()
        if person_key(other or "") in {"", key}
    ]
    taken = [(TAKEN_BACK, fid) for fid, _ in found]
    db.executemany("UPDATE inspections SET undone = ? WHERE fid = ?", taken)
    return sorted({batch for _, batch in found})


def n_counting(db: sqlite3.Connection, mark: str) -> int:
    """Return how many inspections with a digest count: one or none."""
    counts = "SELECT count(*) FROM inspections WHERE digest = ? AND undone = 0"
    (n,) = db.execute(counts, (mark,)).fetchone()
    return int(n)


def n_corrected(db: sqlite3.Connection, batch: int) -> int:
    """Return how many inspections of a batch stand back, but for none that says the same."""
    (n,) = db.execute(
        "SELECT count(*) FROM inspections AS one WHERE batch = ? AND undone = ? AND NOT EXISTS "
        "(SELECT 1 FROM inspections WHERE digest = one.digest AND undone = 0)",
        (batch, STANDS_BACK),
    ).fetchone()
    return int(n)


def n_elsewhere(db: sqlite3.Connection, batch: int, only: int | None = None) -> int:
    """Return how many inspections of a batch do not count, but another that says the same does.

    `only`: `TAKEN_BACK` or `STANDS_BACK`; None: either.
    """
    (n,) = db.execute(
        "SELECT count(*) FROM inspections AS one WHERE batch = ? AND undone <> 0 "
        "AND undone = coalesce(?, undone) AND EXISTS "
        "(SELECT 1 FROM inspections WHERE digest = one.digest AND undone = 0)",
        (batch, only),
    ).fetchone()
    return int(n)
