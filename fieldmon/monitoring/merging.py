"""Two copies of a season that went apart become one: all that is in either, once each.

A row is known again by what it says and by the batch it came with, never by its number. What was
taken back in one copy is taken back. What both recorded for themselves counts once; the later one
stands back for the first until that one is taken back. A treatment is known again whatever labels
added to it (`treatments.known_by`). Everything is put in the order in which it was recorded, so
that it does not matter which copy takes in the other; what a copy recorded later stays so, whatever
its clock said. Inspections that both copies begin with, and that come out where they are, are left
there: of a long season these are nearly all.

What is refused here pages may show, so that it is `worded`; what came of merging only commands and
programs say.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import combinations, count
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.compute.wording import first_few, worded
from fieldmon.decisions.labels import plain_name
from fieldmon.errors import FileProblem
from fieldmon.infestation import inspection_columns
from fieldmon.monitoring import (
    phone_tables,
    repeated_recordings,
    rows_that_count,
    schema,
    season_log,
    settings_log,
    treatments,
)
from fieldmon.monitoring.batches import close_if_empty, more_in_words
from fieldmon.monitoring.geopackage import touch
from fieldmon.monitoring.rows_that_count import COUNTS, STANDS_BACK, TAKEN_BACK
from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Hashable, Iterable, Iterator

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.geopackage import GeoPackageTable
    from fieldmon.monitoring.rows_that_count import Corrected
    from fieldmon.monitoring.treatments import Row

_NAMED_PLOTS = 3
#: what the batches of a copy are numbered now, by their numbers in it
Numbers = dict[int, int]

#: what makes a season this one, and must be the same in both
SAME = (schema.ARRAYS, schema.PLOTS, schema.PLACES, schema.ROWS, schema.PLANTS, schema.OBSERVATIONS)
#: what is taken row by row, each as the functions below say
TAKEN = (
    *(schema.BATCHES, schema.INSPECTIONS, schema.TREATMENTS, schema.SETTINGS),
    *(schema.ROUTES, schema.STOPS, schema.IMPORTS, schema.OUTSIDE_CHANGES, schema.LABELS),
)
#: what rows of the same inspections say, beside what makes them the same; numbers may be none
_BESIDE = tuple(
    one.kept if one.is_text and not one.since else f"coalesce({one.kept}, '')"
    for one in inspection_columns.BESIDE
)
_SAYS = "digest", "undone", *_BESIDE
_SAID = f"SELECT {', '.join(_SAYS)} FROM inspections WHERE batch = ? ORDER BY fid"  # noqa: S608 - ours
# the same in one row: whichever way SQLite finds those of a batch, it is in the order of their fid
_TOGETHER = (
    "SELECT "  # noqa: S608 - names of ours
    + ", ".join([*map("count({})".format, _SAYS), *map("group_concat({})".format, _SAYS)])
    + " FROM inspections WHERE batch = ?"
)


@dataclass(frozen=True)
class Merged:
    """What came of merging.

    Parameters
    ----------
    new
        Inspections that count now and did not before.
    contradictions
        A sentence for each result that the copies tell differently, for each setting, for the table
        of labels, for treatments that are alike but for what a label may add, and for each
        treatment that counted in one copy and was undone in the other.
    taken_back
        Inspections that counted before and do not now: the other copy undid or corrected them.
    moved
        Whether batches have other numbers now than they had.
    treatments
        Treatments that count now and did not before.
    codes
        Names of those whose keys hold and were not there, one for each key.
    overlaps
        A sentence for each two codes whose rows overlap.
    chosen
        Settings that were otherwise before, each from what to what, and the table of labels.
    noted
        Inspections known before that have more notes now.
    """

    new: int
    contradictions: tuple[str, ...]
    taken_back: int = 0
    moved: bool = False
    treatments: int = 0
    codes: tuple[str, ...] = ()
    overlaps: tuple[str, ...] = ()
    chosen: tuple[str, ...] = ()
    noted: int = 0

    @property
    def more(self) -> str:
        """What was added to inspections known before, in words; empty: nothing."""
        return more_in_words(self.noted)


class MergedCopy(NamedTuple):
    """What came of another copy.

    Parameters
    ----------
    new, taken_back
        As `Merged` has them.
    differing
        A sentence for each setting, and the table of labels, that both chose differently, for
        treatments that are alike but for what a label may add, and where only one names a pest.
    treatments, codes
        As `Merged` has them.
    numbers
        What batches are numbered now, by their numbers of before, where that is another one.
    gone
        Numbers of treatments that do not count any more: those that counted here alone, there
        alone, and (by their numbers here) in both.
    chosen
        As `Merged` has it.
    alike
        Numbers of each two treatments that count, one of each copy alone, of one day and product.
    noted
        As `Merged` has it.
    """

    new: int
    taken_back: int
    differing: tuple[str, ...]
    treatments: int
    codes: tuple[str, ...]
    numbers: Numbers
    gone: tuple[set[int], set[int], set[int]]
    chosen: tuple[str, ...]
    alike: tuple[tuple[int, int], ...]
    noted: int


def merge(db: sqlite3.Connection, other: sqlite3.Connection) -> MergedCopy:
    """Put all that another copy holds into `db`.

    Raise `FileProblem` if it is no copy of the same season, or is of another pest by now.
    """
    refuse_strangers(db, other)
    refuse_another_pest(db, other)
    both = db, other
    copies = [_read(one) for one in both]
    phones = [phone_tables.brought(one) for one in both]
    batches = _merged_batches(copies)
    numbers = [
        {row["fid"]: batches[_key(row, _BATCH)]["fid"] for row in copied["batches"]}
        for copied in copies
    ]
    stay = _n_staying(both, numbers)
    before = _Standing.of(db, stay)
    unnamed = (*_of_no_pest(db, other), *_of_no_pest(other, db))
    applied = [treatments.counting_of(copied["treatments"]) for copied in copies]
    gone = _merge_changes(db, copies, batches)
    _merge_inspections(both, numbers, gone, stay)
    treated, held = _merge_treatments(db, copies, numbers)
    _write_batches(db, batches)
    _write_routes(db, copies, _given_out(db, other))
    differing, chosen = _merge_settings(db, copies)
    _write(db, schema.IMPORTS, _once(copies, "import_findings", schema.IMPORTS.names, "at"))
    replaced_twice, other_labels = _merge_labels(both, copies)
    for batch, _ in phone_tables.bring_together(db, phones):
        close_if_empty(db, batch)
    after = _Standing.of(db, stay)
    n_treated, undone = _changed_treatments(db, applied)
    return MergedCopy(
        new=len(after.counting - before.counting),
        taken_back=len(before.counting - after.counting),
        differing=(
            *differing,
            *unnamed,
            *replaced_twice,
            *_alike_but_for_labels(treated, held),
        ),
        treatments=n_treated,
        codes=tuple(sorted(name for key, name in after.keys.items() if key not in before.keys)),
        numbers={old: number for old, number in numbers[0].items() if old != number},
        gone=undone,
        chosen=(*chosen, *other_labels),
        alike=tuple(_of_one_product(treated, held)),
        noted=repeated_recordings.n_noted(
            before.notes, after.notes, {*after.notes} - after.counting
        ),
    )


class _Standing(NamedTuple):
    """What holds in a season file at a moment of merging, to tell what merging changed.

    Parameters
    ----------
    counting
        Inspections that count, by their digests.
    keys
        Whose keys hold, by the digests of these.
    notes
        What is noted of each inspection, by its digest.
    """

    counting: set[str]
    keys: dict[str, str]
    notes: dict[str, repeated_recordings.Notes]

    @classmethod
    def of(cls, db: sqlite3.Connection, stay: int) -> _Standing:
        """Return it; inspections that `stay` are left out."""
        return cls(_counting(db, stay), _keys(db), repeated_recordings.notes(db, stay))


def _read(db: sqlite3.Connection) -> dict[str, list[Row]]:
    """Return the rows of what is taken row by row, by their table; inspections are read later."""
    return {table.name: _rows(db, table) for table in TAKEN if table is not schema.INSPECTIONS}


def _merge_changes(
    db: sqlite3.Connection, copies: list[dict[str, list[Row]]], batches: dict[Hashable, Row]
) -> Corrected:
    """Let `db` have what other programs changed in either copy; return what was corrected."""
    changes = _merged_changes(copies, batches)
    _write(db, schema.OUTSIDE_CHANGES, changes)
    return rows_that_count.corrected([row for row in changes if row["batch"] is not None])


def _merge_treatments(
    db: sqlite3.Connection, copies: list[dict[str, list[Row]]], numbers: list[Numbers]
) -> tuple[list[Row], list[set[tuple[str | None, int | None]]]]:
    """Let `db` have the treatments of both; return them, and which each copy had.

    These by their digests and the numbers that their batches have now.
    """
    own = [copied["treatments"] for copied in copies]
    treated = _merged_rows(own, numbers, set(), {})
    treatments.settle(treated)
    _write(db, schema.TREATMENTS, treated)
    held = [{(row["digest"], batch_of.get(row["batch"])) for row in rows}
            for rows, batch_of in zip(own, numbers, strict=True)]  # fmt: skip
    return treated, held


def _write_batches(db: sqlite3.Connection, batches: dict[Hashable, Row]) -> None:
    """Let these be the batches, each with how many rows it has now."""
    _count(db, batches)
    numbered = [row["fid"] for row in batches.values()]
    _write(db, schema.BATCHES, list(batches.values()), numbers=numbered)


def _merge_settings(
    db: sqlite3.Connection, copies: list[dict[str, list[Row]]]
) -> tuple[tuple[str, ...], list[str]]:
    """Let `db` have the choices of both; return which both chose differently, and what changed."""
    chosen = _once(copies, "settings", _CHOICE, "changed")
    before = settings_log.as_written_now(settings_log.now(db))
    _write(db, schema.SETTINGS, chosen)
    after = settings_log.as_written_now(settings_log.now(db))
    return _differing(copies, chosen), settings_log.differences(before, after)


def _merge_labels(
    both: tuple[sqlite3.Connection, sqlite3.Connection], copies: list[dict[str, list[Row]]]
) -> tuple[tuple[str, ...], list[str]]:
    """Let the first have the table of labels kept last; say if both kept one, and if it changed."""
    labels, replaced_twice = _kept_last(copies, [season_log.labels_kept(one) for one in both])
    _write(both[0], schema.LABELS, labels)
    return replaced_twice, _other_labels(copies[0]["labels"], labels)


def _changed_treatments(
    db: sqlite3.Connection, applied: list[dict[int, frozenset[str]]]
) -> tuple[int, tuple[set[int], set[int], set[int]]]:
    """Return how many treatments are new, and the numbers of those that count no more.

    `applied` is what those that counted in each copy are known by, by their numbers there; what
    counts no more is told apart as in `MergedCopy.gone`.
    """
    counting = treatments.counting(db)
    known, theirs = (frozenset().union(*one.values()) for one in applied)
    n_new = sum(known.isdisjoint(marks) for marks in counting)
    now = frozenset().union(*counting)
    here, there = ({n: marks for n, marks in one.items() if marks.isdisjoint(now)}
                   for one in applied)  # fmt: skip
    twice = {n for n, marks in here.items() if marks & theirs}
    alone = {n for n, marks in there.items() if marks.isdisjoint(known)}
    return n_new, ({*here} - twice, alone, twice)


def _counting(db: sqlite3.Connection, stay: int) -> set[str]:
    """Return inspections that count by their digests; those that `stay` are left out."""
    counts = "SELECT digest FROM inspections WHERE undone = 0 AND digest NOTNULL AND fid > ?"
    return {mark for (mark,) in db.execute(counts, (stay,))}


def _keys(db: sqlite3.Connection) -> dict[str, str]:
    """Return whose keys hold, by the digests of these."""
    return dict(db.execute("SELECT key_digest, name FROM scouts WHERE ended IS NULL"))


def refuse_strangers(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    """Raise `FileProblem` unless both are copies of one season."""
    _refuse_two_plots(db, other)
    _refuse_begun_apart(*(settings_log.begun(one) for one in (db, other)))
    for table in SAME:
        if not _is_same(db, other, table):
            why = worded(
                "they differ in the layer {name}: they are two seasons, or another program changed "
                "one of them",
                name=table.name,
            )
            raise _strangers(why)
    at, other_at = (settings_log.begun_at(one) for one in (db, other))
    if at and other_at:
        _refuse_begun_apart(_moment(at), _moment(other_at))
    else:  # too old to say it
        refuse_another_pest(db, other)


def _refuse_two_plots(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    if _is_same(db, other, schema.PLOTS) or are_of_one_plot(db, other):
        return
    here, there = (
        first_few([name or "" for (name,) in one.execute("SELECT name FROM plots")], _NAMED_PLOTS)
        for one in (db, other)
    )
    if here == there:
        raise _strangers(worded("one is of another plot than the other, or of another planting"))
    raise _strangers(
        worded("one is of the plot {here} and the other of {there}", here=here, there=there)
    )


def _refuse_begun_apart(here: str, there: str) -> None:
    if here != there:
        raise _strangers(
            worded(
                "one was begun on {here} and the other on {there}: they are two seasons",
                here=here,
                there=there,
            )
        )


def _strangers(why: Worded) -> FileProblem:
    return FileProblem(
        worded(
            "Two copies of one season can be merged, but {why}. Leave each in its file. If both "
            "are of one plot and look for the same, record what was found in the one into the "
            "other with: fieldmon record",
            why=why,
        )
    )


def _moment(at: str) -> str:
    """Return a moment as people read it."""
    return f"{at.replace('T', ' ').removesuffix('Z')} UTC"


def refuse_another_pest(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    """Raise `FileProblem` where the two are of different pests: finds would be of the wrong one."""
    here, there = _pests(db, other)
    if are_of_two_pests(db, other):
        raise FileProblem(
            worded(
                "What was found can come from one season into another if both look for one pest, "
                "but one looks for {here} and the other for {there}: finds would become those of "
                "another pest. Leave each in its file; where one of them names the wrong pest, "
                "name the right one there first with: fieldmon change --pest",
                here=here,
                there=there,
            )
        )


def _of_no_pest(db: sqlite3.Connection, other: sqlite3.Connection) -> Iterator[str]:
    """Yield a sentence where `db` names a pest, and another names none but found something."""
    pest, named = _pests(db, other)
    if pest and not named and _counting(other, 0) - _counting(db, 0):
        yield (
            f"Only one copy names a pest, {pest}: what the other found counts as found of it, too. "
            "If that one looked for another pest, undo its batches."
        )


def are_of_two_pests(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether two seasons name pests by now that differ."""
    here, there = _pests(db, other)
    return bool(here and there and here != there)


def _pests(db: sqlite3.Connection, other: sqlite3.Connection) -> tuple[str, str]:
    return settings_log.pest(db), settings_log.pest(other)


def hold_in_common(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether an inspection or a treatment that counts stands in both."""
    held = []
    for one in (db, other):
        treated = frozenset[str]().union(*treatments.counting(one))
        held.append(_counting(one, 0) | treated)
    return not held[0].isdisjoint(held[1])


def are_of_one_plot(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether two seasons have the same rows and plants."""
    return all(_is_same(db, other, table) for table in (schema.ROWS, schema.PLANTS))


def _is_same(db: sqlite3.Connection, other: sqlite3.Connection, table: GeoPackageTable) -> bool:
    names = ", ".join(table.names)
    wanted = f"SELECT {names} FROM {table.name} ORDER BY fid"  # noqa: S608 - names of ours
    return bool(db.execute(wanted).fetchall() == other.execute(wanted).fetchall())


def _rows(db: sqlite3.Connection, table: GeoPackageTable, after: int = 0) -> list[Row]:
    """Return the rows of a table after its first ones."""
    names = ("fid", *table.names)
    rows = db.execute(
        f"SELECT {', '.join(names)} FROM {table.name} ORDER BY fid LIMIT -1 OFFSET ?",  # noqa: S608 - ours
        (after,),
    )
    return [dict(zip(names, row, strict=True)) for row in rows]


def _write(
    db: sqlite3.Connection,
    table: GeoPackageTable,
    rows: list[Row],
    after: int = 0,
    numbers: Iterable[int] | None = None,
) -> None:
    """Let these be the rows of a table after number `after`, numbered in their order.

    Or as `numbers` says.
    """
    names = ("fid", *table.names)
    db.execute(f"DELETE FROM {table.name} WHERE fid > ? OR fid < 1", (after,))  # noqa: S608 - names of ours
    db.executemany(
        f"INSERT INTO {table.name} ({', '.join(names)}) VALUES ({', '.join('?' * len(names))})",  # noqa: S608 - ours
        [
            (number, *(row[name] for name in table.names))
            for number, row in zip(numbers or count(after + 1), rows, strict=False)
        ],
    )
    touch(db, table.name)


#: what a batch, and a choice among the settings, is known by in every copy
_BATCH = ("at", "source", "who", "kind")
_CHOICE = ("changed", "name", "value")


def _merged_batches(copies: list[dict[str, list[Row]]]) -> dict[Hashable, Row]:
    """Return the batches of both by what they are known by, numbered as they were recorded.

    One that need not make room keeps its number. Of corrections it is known how many they were and
    whether they were taken back; others are counted (`_count`).
    """
    found: dict[Hashable, Row] = {}
    place = _as_recorded(copies, "batches", _BATCH, "at")
    for copied in copies:
        for row in copied["batches"]:
            known = found.setdefault(_key(row, _BATCH), {**row, "rows": 0, "undone": 0})
            if row["kind"] == "corrections":
                known["rows"] = max(known["rows"], row["rows"])
                known["undone"] = max(known["undone"], row["undone"])
            known["fid"] = min(known["fid"], row["fid"])
    ordered = sorted(found.items(), key=lambda item: place[item[0]])
    number = 0
    for _, row in ordered:
        number = row["fid"] = max(number + 1, row["fid"])
    return dict(ordered)


def _merged_changes(copies: list[dict[str, list[Row]]], batches: dict[Hashable, Row]) -> list[Row]:
    """Return what other programs changed in either copy; what one of them took back is so."""
    for copied in copies:
        for row in copied["outside_changes"]:
            row["batch"] = _number(batches, copied, row["batch"])
    known_by = tuple(name for name in schema.OUTSIDE_CHANGES.names if name != "undone")
    merged = _once(copies, "outside_changes", known_by, "at")
    undone = {_key(row, known_by) for one in copies for row in one["outside_changes"]
              if row["undone"]}  # fmt: skip
    return [{**row, "undone": int(_key(row, known_by) in undone)} for row in merged]


def _number(
    batches: dict[Hashable, Row], copied: dict[str, list[Row]], number: int | None
) -> int | None:
    """Return the number that a batch of a copy has now."""
    row = next((row for row in copied["batches"] if row["fid"] == number), None)
    return None if row is None else int(batches[_key(row, _BATCH)]["fid"])


def _merge_inspections(
    both: tuple[sqlite3.Connection, sqlite3.Connection],
    numbers: list[Numbers],
    gone: Corrected,
    stay: int,
) -> None:
    """Let the first of both have the inspections of both, of which so many `stay`.

    `numbers` says how the batches of each are numbered now, `gone` what was corrected.
    """
    db = both[0]
    copies = [_rows(one, schema.INSPECTIONS, stay) for one in both]
    counts = "SELECT digest FROM inspections WHERE digest = ? AND undone = 0 AND fid <= ?"
    digests = {row["digest"] for rows in copies for row in rows}
    counting = {held for one in digests for (held,) in db.execute(counts, (one, stay))}
    _write(db, schema.INSPECTIONS, _merged_rows(copies, numbers, counting, gone), stay)


def _n_staying(both: tuple[sqlite3.Connection, sqlite3.Connection], numbers: list[Numbers]) -> int:
    """Return how many inspections both copies begin with that come out just as they are in ours.

    They are those of whole batches, which have their numbers already: no other row can be known
    again in one of them, or come between them.
    """
    ours, theirs = numbers
    here, there = (_spans(one) for one in both)
    n, batch = 0, 0
    for number in sorted(ours):
        if number not in here and number not in there:
            continue  # of treatments
        first, last, count = span = here.get(number, (0, 0, 0))
        if (ours[number], theirs.get(number)) != (number, number) or span != there.get(number):
            break
        if (first, last) != (n + 1, n + count) or not _is_same_batch(both, number, count):
            break
        n, batch = last, number
    rest = (
        "SELECT DISTINCT batch FROM (SELECT batch FROM inspections ORDER BY fid LIMIT -1 OFFSET ?)"
    )
    later = [
        batch_of.get(number, batch + 1)
        for one, batch_of in zip(both, numbers, strict=True)
        for (number,) in one.execute(rest, (n,))
    ]
    before = "SELECT count(*) FROM inspections WHERE fid <= ? AND batch < ?"
    (stay,) = both[0].execute(before, (n, min(later, default=batch + 1))).fetchone()
    return int(stay)


def _is_same_batch(
    both: tuple[sqlite3.Connection, sqlite3.Connection], number: int, count: int
) -> bool:
    """Tell whether so many inspections of a batch say the same in both, each something else."""
    one, other = (db.execute(_TOGETHER, (number,)).fetchone() for db in both)
    there, said = {*one[: len(_SAYS)]}, one[len(_SAYS) :]
    # where something holds a comma, or nothing, is looked at row by row
    if there == {count} and one == other and {one.count(",") for one in said} == {count - 1}:
        return len({*said[0].split(",")}) == count
    rows, others = (db.execute(_SAID, (number,)).fetchall() for db in both)
    # what was taken back and recorded again stands there twice
    return (
        rows == others
        and not any(None in row for row in rows)
        and len({digest for digest, *_ in rows}) == count
    )


def _spans(db: sqlite3.Connection) -> dict[int, tuple[int, int, int]]:
    """Return of each batch its first and last inspection, and how many there are."""
    spans = "SELECT batch, min(fid), max(fid), count(*) FROM inspections GROUP BY batch"
    return {number: (first, last, count) for number, first, last, count in db.execute(spans)}


def _merged_rows(
    copies: list[list[Row]], numbers: list[Numbers], counting: set[str], gone: Corrected
) -> list[Row]:
    """Return inspections or treatments of both copies, once each, in the order of their batches.

    Those `counting` already count once, before them; of those `gone` what stands back stays so.
    """
    found: dict[Hashable, Row] = {}
    for own_rows, batch_of in zip(copies, numbers, strict=True):
        again: Counter[Hashable] = Counter()  # taken back, and recorded again with the same batch
        for own in own_rows:
            row = {**own, "batch": batch_of.get(own["batch"])}
            if row["digest"] is None:  # a draft of another program
                key: Hashable = _key(row, tuple(k for k in row if k != "fid"))
            else:
                again[row["digest"], row["batch"]] += 1
                key = row["digest"], row["batch"], again[row["digest"], row["batch"]]
            known = found.setdefault(key, row)
            known["undone"] = _undone_in_either(known["undone"] or 0, row["undone"] or 0)
            known["fid"] = min(known["fid"], row["fid"])
            for one in inspection_columns.BESIDE:  # what is no part of what makes it the same
                if one.kept in row:
                    known[one.kept] = repeated_recordings.either(
                        one, known[one.kept], row[one.kept]
                    )
    drafts_last = max((now for batch_of in numbers for now in batch_of.values()), default=0) + 1
    rows = sorted(
        found.values(), key=lambda r: (r["batch"] or drafts_last, r["fid"], repr(r["digest"]))
    )
    for row in rows:
        stands_back = row["undone"] == STANDS_BACK
        if stands_back and not rows_that_count.may_count(gone, row["digest"], row["batch"]):
            continue
        if row["digest"] is not None and row["undone"] != TAKEN_BACK:
            row["undone"] = STANDS_BACK if row["digest"] in counting else COUNTS
            counting.add(row["digest"])
    return rows


def _undone_in_either(one: int, other: int) -> int:
    """Return what became of a row in either copy: taken back, if it was so in one."""
    return TAKEN_BACK if TAKEN_BACK in (one, other) else max(one, other)


def _count(db: sqlite3.Connection, batches: dict[Hashable, Row]) -> None:
    """Note in the batches how many rows they have; one that was all taken back is undone."""
    by_number = {row["fid"]: row for row in batches.values()}
    for name in ("inspections", "treatments"):
        counted = f"SELECT batch, count(*), min(undone = 1) FROM {name} GROUP BY batch"  # noqa: S608 - ours
        for number, n, undone in db.execute(counted):
            if number is not None and by_number[number]["kind"] != "corrections":
                by_number[number]["rows"] += n
                by_number[number]["undone"] = int(undone)


def _given_out(*both: sqlite3.Connection) -> dict[Hashable, list[str]]:
    """Return when each route was kept, by day, person and digest, as the logs of both say."""
    told: dict[Hashable, set[str]] = {}
    for db in both:
        for one in season_log.given_out(db):
            told.setdefault((one.date, person_key(one.who), one.digest), set()).add(one.at)
    return {key: sorted(at) for key, at in told.items()}


def _write_routes(
    db: sqlite3.Connection, copies: list[dict[str, list[Row]]], given_out: dict[Hashable, list[str]]
) -> None:
    """Keep the routes of both with their stops in the order in which they were given out.

    One that was given out again after another counts as often as it was.
    """
    known_by = ("day", "person", "digest", "again")
    found: dict[Hashable, tuple[Row, list[Row]]] = {}
    for copied in copies:
        stops: dict[int, list[Row]] = {}
        for stop in copied["stops"]:
            stops.setdefault(stop["route"], []).append(stop)
        given: Counter[Hashable] = Counter()
        for route in copied["routes"]:
            route["person"] = person_key(route["who"])
            given[_key(route, known_by[:-1])] += 1
            route["again"] = given[_key(route, known_by[:-1])]
        before = ""
        for route in copied["routes"]:
            at = given_out.get(_key(route, ("date", "person", "digest")), [])
            later = given[_key(route, known_by[:-1])] - route["again"]
            # a clock may be set back: what stands below is later
            before = route["at"] = max(before, at[-1 - later] if later < len(at) else "")
            own = stops.get(route["fid"], [])
            kept, _ = found.setdefault(_key(route, known_by), (route, own))
            kept["revision"] = min(kept["revision"], route["revision"])
            kept["at"] = max(kept["at"], route["at"])
    begin = _alike_at_first(copies, "routes", known_by)
    order = ("at", "day", "person", "revision", "digest", "again")
    rest = sorted(
        (key for key in found if key not in begin), key=lambda key: _key(found[key][0], order)
    )
    ordered = [found[key] for key in (*begin, *rest)]
    revisions: Counter[Hashable] = Counter()
    all_stops: list[Row] = []
    for number, (route, own) in enumerate(ordered, 1):
        of = route["day"], route["person"]
        revisions[of] += 1
        route["revision"] = revisions[of]
        all_stops += [{**stop, "route": number} for stop in own]
    _write(db, schema.ROUTES, [route for route, _ in ordered])
    _write(db, schema.STOPS, all_stops)


def _alike_at_first(
    copies: list[dict[str, list[Row]]], name: str, known_by: tuple[str, ...]
) -> dict[tuple[Any, ...], None]:
    """Return the keys of the rows with which both copies begin, in order."""
    ours, theirs = ([_key(row, known_by) for row in copied[name]] for copied in copies)
    alike = [one == other for one, other in zip(ours, theirs, strict=False)]
    return dict.fromkeys(ours[: (*alike, False).index(False)])


def _as_recorded(
    copies: list[dict[str, list[Row]]], name: str, known_by: tuple[str, ...], at: str
) -> dict[Hashable, tuple[str, int, str]]:
    """Return the place of each row among those of both copies: when it was recorded.

    A clock may be set back: what stands below is later, whatever it says.
    """
    places: dict[Hashable, tuple[str, int, str]] = {}
    for copied in copies:
        latest, n, before = "", 0, None
        for row in copied[name]:
            moment = str(row[at] or "")
            n = 0 if moment > latest else n + (moment != before)
            latest, before = max(latest, moment), moment
            key = _key(row, known_by)
            place = latest, n, repr((moment, key))
            places[key] = max(places.get(key, place), place)
    return places


def _once(
    copies: list[dict[str, list[Row]]], name: str, known_by: tuple[str, ...], at: str
) -> list[Row]:
    """Return the rows of both copies, once each, in an order that both would give.

    What both begin with stays where it is: a copy that brings nothing changes nothing.
    """
    found = {_key(row, known_by): row for copied in copies for row in copied[name]}
    begin = _alike_at_first(copies, name, known_by)
    place = _as_recorded(copies, name, known_by, at)
    rest = sorted((key for key in found if key not in begin), key=place.__getitem__)
    return [found[key] for key in (*begin, *rest)]


def _kept_last(
    copies: list[dict[str, list[Row]]], kept: list[dict[str, str]]
) -> tuple[list[Row], tuple[str, ...]]:
    """Return the table of labels that was kept last, as a whole; say so where both kept one.

    `kept` says when, of all that the log of each copy knows. A copy whose tables the other one
    knows has nothing to add to it.
    """
    tables = [copied["labels"] for copied in copies]
    lines = [[_key(row, schema.LABELS.names) for row in table] for table in tables]
    if lines[0] == lines[1]:
        return tables[0], ()
    own = [
        sorted(at for mark, at in one.items() if mark not in other)
        for one, other in zip(kept, reversed(kept), strict=True)
    ]
    # a clock may be set back: a copy's table is no older than those that it replaced
    last = [(max(kept[k].values(), default=""), own[k][-1:], repr(lines[k])) for k in (0, 1)]
    if bool(own[0]) != bool(own[1]):
        return tables[int(bool(own[1]))], ()
    said = (
        f"The table of labels differs ({_products_apart(*tables)}): each copy replaced it. "
        "What was kept last counts, as a whole: "
        f"the one {'here' if last[0] > last[1] else 'there'}."
    )
    return tables[int(last[1] > last[0])], (said,)


def _products_apart(one: list[Row], other: list[Row]) -> str:
    """Return the first products of which two tables of labels say something else."""
    lines = [{_key(row, schema.LABELS.names) for row in table} for table in (one, other)]
    return first_few(sorted({line[0] for line in lines[0] ^ lines[1]}), 3)


def _other_labels(before: list[Row], after: list[Row]) -> list[str]:
    """Return that the table of labels is another one now, if it is."""
    apart = _products_apart(before, after)
    return [f"table of labels ({apart})"] if apart else []


def _members(team: str) -> str:
    """Return who is in a team as it is kept, each with the hours: all else is in the log."""
    members = (json.loads(team) or {}).get("members", ())
    each = (f"{one['name']} {one['robot']['hours']:g} h" for one in members)
    return ", ".join(each) or "none"


def _chosen(name: str, ours: str, theirs: str) -> tuple[str, str]:
    """Return two values of the setting called `name`, short enough to be read."""
    if name == "team":
        return _members(ours), _members(theirs)
    if name not in ("pest", "weather"):
        return _apart(ours, theirs)
    short = settings_log.pest_in if name == "pest" else _weather
    here, there = (short(one) or "none" for one in (ours, theirs))
    if here != there:
        return here, there
    return f"{here} (this copy's figures)", f"{there} (the other copy's figures)"


def _weather(weather: str) -> str:
    """Return until when weather is, in UTC; "" where there is none."""
    at = (json.loads(weather) or {}).get("at", ())
    return f"until {datetime.fromtimestamp(max(at), UTC):%Y-%m-%d}" if at else ""


def _differing(copies: list[dict[str, list[Row]]], merged: list[Row]) -> tuple[str, ...]:
    """Return a sentence for each setting that both chose, unknown to each other, differently."""
    known = [{_key(row, _CHOICE) for row in copied["settings"]} for copied in copies]
    chosen = [
        {row["name"] for row in copied["settings"] if _key(row, _CHOICE) not in others}
        for copied, others in zip(copies, reversed(known), strict=True)
    ]
    ours, theirs, now = (
        {row["name"]: str(row["value"]) for row in rows}
        for rows in (*(copied["settings"] for copied in copies), merged)
    )
    said = []
    for name in sorted(chosen[0] & chosen[1]):
        values = ours[name], theirs[name]
        if values[0] != values[1]:
            here, there = _chosen(name, *values)
            said.append(
                f"The setting {name} differs: {here} here, {there} there. What was chosen last "
                f"counts: {here if now[name] == values[0] else there}."
            )
    return tuple(said)


#: what a label may fill in, in words
_FILLED = dict(zip(treatments.FILLED, ("waiting days", "re-entry hours", "group"), strict=True))


def _alike_but_for_labels(
    treated: list[Row], held: list[set[tuple[str | None, int | None]]]
) -> Iterator[str]:
    """Yield a sentence for each two treatments that say the same but for what a label may add.

    One is of each copy: `held` are digests and batches of those that each had. Where people said
    the same the second stands back for the first; else nobody knows, and both count.
    """
    alike: dict[str, list[Row]] = {}
    for row in treated:
        if row["undone"] != TAKEN_BACK and row["digest"] is not None:
            alike.setdefault(treatments.but_for_labels(row), []).append(row)
    for one, other in (pair for rows in alike.values() for pair in combinations(rows, 2)):
        of = [[(row["digest"], row["batch"]) in had for had in held] for row in (one, other)]
        names = [name for name in treatments.FILLED if one[name] != other[name]]
        if sorted(of) != [[False, True], [True, False]] or not names:
            continue
        here, there = (one, other) if of[0][0] else (other, one)
        differ = ", ".join(
            f"{_FILLED[name]} {_or_none(here[name])} here, {_or_none(there[name])} there"
            for name in names
        )
        named = f"{one['product'] or 'a product that nobody named'} on {one['date']}"
        counts = [row["undone"] for row in (one, other)].count(COUNTS)
        if counts == 1 and treatments.known_by(one) & treatments.known_by(other):
            yield (
                f"The treatment with {named} was recorded in both, and labels added different "
                f"values: {differ}. It counts once; the longer waits and all groups hold."
            )
        elif counts == 2:
            old = any(row["by_label"] is None and row[name] is not None
                      for row in (one, other) for name in names)  # fmt: skip
            why = " (an earlier version did not note whether a label added that)" if old else ""
            yield (
                f"Treatments with {named}, batches {one['batch']} and {other['batch']}, say the "
                f"same but for {differ}{why}. Both count; if they are one, undo a batch."
            )


def _of_one_product(
    treated: list[Row], held: list[set[tuple[str | None, int | None]]]
) -> Iterator[tuple[int, int]]:
    """Yield the numbers of each two treatments of one day and product that people may have doubled.

    Both count, and one is of each copy: `held` is as above. What differs in what a label may add
    alone is told there.
    """
    same: dict[tuple[str, str], list[tuple[int, Row, list[bool]]]] = {}
    for number, row in enumerate(treated, 1):
        of = [(row["digest"], row["batch"]) in had for had in held]
        if row["undone"] == COUNTS and not all(of):
            product = row["date"], plain_name(row["product"] or "")
            same.setdefault(product, []).append((number, row, of))
    for one, other in (pair for rows in same.values() for pair in combinations(rows, 2)):
        alike = treatments.but_for_labels(one[1]) == treatments.but_for_labels(other[1])
        if one[2] != other[2] and not alike:
            yield one[0], other[0]


def _or_none(value: object) -> str:
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _apart(ours: str, theirs: str) -> tuple[str, str]:
    """Return two values of a setting; of parts with names only those that differ."""
    one, other = json.loads(ours), json.loads(theirs)
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return ours, theirs
    names = [name for name in {**one, **other} if one.get(name) != other.get(name)]
    here, there = (
        ", ".join(_with_unit(name, told.get(name)) for name in names) for told in (one, other)
    )
    return here, there


def _with_unit(name: str, value: object) -> str:
    """Return what a part of a setting says; other names end in their unit."""
    if name == "hours" and isinstance(value, int | float):
        return f"{value:g} h"
    return f"{name} {json.dumps(value, ensure_ascii=False)}"


def _key(row: Row, names: Iterable[str]) -> tuple[Any, ...]:
    return tuple(row[name] for name in names)
