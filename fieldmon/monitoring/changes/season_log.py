"""The log of a season: what was seen, planned, advised and treated, by whom and when.

Entries are only ever added. Each has a digest, of its own words and of the digest before it: who
changes one, takes one out or puts one elsewhere breaks the chain there. Entries also hold digests
of what the file says after them, batch by batch, so that a file whose tables say otherwise than
its log is found too. Somebody who writes the whole log anew can hide: only a last digest that was
given away, as a certification report gives it, tells of that.
"""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import datetime
from hashlib import sha256
from typing import TYPE_CHECKING, Any

from fieldmon.compute.wording import worded, written
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspection_columns import BESIDE, InspectionColumn
from fieldmon.monitoring.changes.log_entry import LogEntry, Numbers, lost_in_words
from fieldmon.monitoring.changes.log_visits import LogVisit, by_visit
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import touch
from fieldmon.monitoring.settings import settings_log
from fieldmon.plot.local_clock import utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Iterator, Sequence

    from fieldmon.plot.local_clock import LocalClock

#: in `fieldmon`: how many entries the log has, and the last one's digest
_HEAD = "log"
_NOTHING = "0" * 64
#: before the number of a batch, in names of states
_BATCH = "batch "
#: what a log does not hold but is held to: by name, and how it is read
_PLOT = ("arrays", "plots", "places", "observations")
#: layers whose rows are of batches, which say how many each has
_OF_BATCHES = (schema.INSPECTIONS.name, schema.TREATMENTS.name)
_NONE_SAVED = "of the one before, which was damaged, nothing could be saved"
# what is done by settings, which the entry names: see `settings_log.marks`
_BY_SETTINGS = ("planned", "seen")


# -- writing


def begin(db: sqlite3.Connection, why: str) -> None:
    """Begin the log of a file; what stands in it already is held to from here on."""
    append(db, "begins", states=states(db), why=why)


def go_on_saved(db: sqlite3.Connection, unread: Sequence[str]) -> tuple[str, ...]:
    """Go on with a log that was saved from a damaged file; begin a new one where it has a hole.

    `unread` are the layers of which rows could not be read. What is known to be gone is noted, and
    returned in words.
    """
    rows = db.execute("SELECT fid, digest FROM log ORDER BY fid").fetchall()
    _note_head(db, *(rows[-1] if rows else (0, _NOTHING)))
    gone = _gone_of_batches(db)
    are_counted = bool(gone) and schema.BATCHES.name not in unread
    gone += [{"layer": one} for one in unread if not (are_counted and one in _OF_BATCHES)]
    lost: dict[str, Any] = {"lost": gone} if gone else {}
    try:
        refuse_changed(db)
    except FileProblem as hole:
        db.execute("DELETE FROM log")
        _note_head(db, 0, _NOTHING)
        why = f"the one before could not be saved whole ({hole})"
        append(db, "begins", states=states(db), why=why, **lost)
    else:
        why = _NONE_SAVED if schema.LOG.name in unread else "saved from an old file"
        append(db, "saved" if rows else "begins", states=states(db), why=why, **lost)
    return tuple(map(lost_in_words, gone))


def _gone_of_batches(db: sqlite3.Connection) -> list[dict[str, Any]]:
    """Return of which batches rows are missing, how many and of how many."""
    rows = db.execute(
        "SELECT fid, source, rows, rows - (SELECT count(*) FROM inspections WHERE batch = b.fid) "
        "- (SELECT count(*) FROM treatments WHERE batch = b.fid) AS missing FROM batches AS b "
        "WHERE missing > 0 ORDER BY fid"
    )
    return [
        {"batch": batch, "source": source or "", "of": of, "missing": missing}
        for batch, source, of, missing in rows
    ]


def append(
    db: sqlite3.Connection,
    kind: str,
    who: str = "",
    *,
    states: dict[str, str] | None = None,
    **what: Any,  # noqa: ANN401 - whatever JSON can hold
) -> None:
    """Add an entry; `states` are the digests of what the file says now, by name."""
    number, before = _head(db)
    if states:
        what["states"] = states
    if kind in _BY_SETTINGS and (chosen := settings_log.marks(db)):
        what.setdefault("by", chosen)
    content = _canonical(
        {"entry": number + 1, "at": utc_text(), "kind": kind, "who": who, "what": what}
    )
    mark = _chained(before, content)
    db.execute("INSERT INTO log (fid, entry, digest) VALUES (?, ?, ?)", (number + 1, content, mark))
    _note_head(db, number + 1, mark)
    touch(db, schema.LOG.name)


def _note_head(db: sqlite3.Connection, number: int, mark: str) -> None:
    db.execute(
        "INSERT OR REPLACE INTO fieldmon (key, value) VALUES (?, ?)", (_HEAD, f"{number} {mark}")
    )


def _head(db: sqlite3.Connection) -> tuple[int, str]:
    row = db.execute("SELECT value FROM fieldmon WHERE key = ?", (_HEAD,)).fetchone()
    if row is None:
        return 0, _NOTHING
    number, _, mark = str(row[0]).partition(" ")
    return (int(number) if number.isdigit() else -1), mark


def _canonical(entry: dict[str, Any]) -> str:
    return json.dumps(entry, sort_keys=True, ensure_ascii=False, separators=(",", ":"), default=str)


def _chained(before: str, content: str) -> str:
    return sha256(f"{before}\n{content}".encode("utf-8", "surrogatepass")).hexdigest()


# -- what the file says, as digests


def states(db: sqlite3.Connection, batches: Iterable[int] | None = None) -> dict[str, str]:
    """Return digests of what the file says, by name; of some batches alone, or of everything."""
    if batches is not None:
        return {f"{_BATCH}{number}": _batch_state(db, number) for number in sorted({*batches})}
    numbers = [number for (number,) in db.execute("SELECT fid FROM batches ORDER BY fid")]
    return {
        **states(db, numbers),
        "settings": settings_state(db),
        "labels": labels_state(db),
        "plot": _plot_state(db),
    }


def settings_state(db: sqlite3.Connection) -> str:
    """Return the digest of all that was ever chosen for the season."""
    chosen = db.execute("SELECT name, value, undoes FROM settings ORDER BY fid")
    # as earlier versions, which did not know of undoing, noted it
    return _digest(row if row[2] is not None else row[:2] for row in chosen)


def labels_state(db: sqlite3.Connection) -> str:
    """Return the digest of the label table."""
    names = ", ".join(schema.LABELS.names)
    return _digest(db.execute(f"SELECT {names} FROM labels ORDER BY fid"))  # noqa: S608 - ours


def _plot_state(db: sqlite3.Connection) -> str:
    return _digest(
        row
        for table in _PLOT
        for row in db.execute(f"SELECT * FROM {table} ORDER BY fid")  # noqa: S608 - ours
    )


def _batch_state(db: sqlite3.Connection, number: int) -> str:
    """Return the digest of a batch: what was recorded, by whom, and what of it was undone."""
    own = db.execute("SELECT at, kind, source, who FROM batches WHERE fid = ?", (number,))
    return _digest([*own, tuple(_rows_of_batch(db, number))])


# the last version whose columns a batch's digest names by nothing but their places
_UNNAMED = 13


def _beside(column: InspectionColumn) -> str:
    """Return in SQL what a batch's digest says of a column; what nobody said is left out of it."""
    if not column.since:
        return f"coalesce({column.kept}, '')"
    called = f"{column.kept} " if column.since > _UNNAMED else ""
    return f"coalesce('|{called}' || nullif({column.kept}, ''), '')"


_LOGGED = tuple(column for column in BESIDE if column.watched)
_SAID_BESIDE = "undone || '|' || " + " || ".join(map(_beside, _LOGGED))
_ONE_BY_ONE = (
    f"SELECT digest || '|' || {_SAID_BESIDE} FROM inspections WHERE batch = ?1 "  # noqa: S608 - ours
    "UNION ALL SELECT digest || '|' || undone FROM treatments WHERE batch = ?1 ORDER BY 1"
)
# the same but for the order: all marks with one ending in one text
_TOGETHER = (
    f"SELECT '|' || {_SAID_BESIDE}, count(*), count(digest), group_concat(digest) "  # noqa: S608 - as above
    "FROM inspections WHERE batch = ?1 "
    f"GROUP BY undone, {', '.join(column.kept for column in _LOGGED)} "
    "UNION ALL SELECT '|' || undone, 1, count(digest), digest FROM treatments "
    "WHERE batch = ?1 GROUP BY fid"
)


def _rows_of_batch(db: sqlite3.Connection, number: int) -> Sequence[str | None]:
    """Return what each row of a batch says of itself, in order."""
    rows: list[str] = []
    for ending, n, marked, marks in db.execute(_TOGETHER, (number,)):
        if ending is None or marked < n or marks.count(",") != n - 1:  # a draft, or no mark of ours
            return [row for (row,) in db.execute(_ONE_BY_ONE, (number,))]
        rows += [mark + ending for mark in marks.split(",")]
    return sorted(rows)


def _digest(rows: Iterable[tuple[object, ...]]) -> str:
    everything = sha256()
    for row in rows:
        everything.update(repr(tuple(row)).encode("utf-8", "surrogatepass"))
    return everything.hexdigest()[:32]


# -- reading and checking


def entries(db: sqlite3.Connection) -> tuple[LogEntry, ...]:
    """Return every entry, the first one first; raise `FileProblem` where the past was changed."""
    refuse_changed(db)
    return _read(db)


def numbered_anew(db: sqlite3.Connection) -> dict[int, dict[int, int | None]]:
    """Return what batches are numbered now that entries named otherwise, by the entries' numbers.

    Before the first merge of a season there are none.
    """
    merged = 'SELECT 1 FROM log WHERE entry LIKE \'%"kind":"merged"%\''
    if db.execute(merged).fetchone() is None:
        return {}
    return {entry.number: entry.numbers for entry in _read(db) if entry.numbers}


def saved_without(db: sqlite3.Connection) -> tuple[LogEntry, ...]:
    """Return the entries that note what was lost when the file was saved from a damaged one."""
    noted = "SELECT 1 FROM log WHERE entry LIKE '%\"lost\":[%'"
    if db.execute(noted).fetchone() is None:
        return ()
    return tuple(entry for entry in _read(db) if entry.lost)


def _read(db: sqlite3.Connection) -> tuple[LogEntry, ...]:
    rows = db.execute("SELECT entry, digest FROM log ORDER BY fid")
    return _numbered_now([_entry(content, mark) for content, mark in rows])


def _entry(content: str, mark: str, *, is_ours: bool = True) -> LogEntry:
    """Return an entry as written; what a copy had merged stands beside its entries, not in them."""
    said = json.loads(content)
    what = said["what"]
    inner = what.get("theirs", ()) if is_ours else ()
    theirs = tuple(_entry(one["entry"], one["digest"], is_ours=False) for one in inner)
    of = said["entry"], said["at"], said["kind"], said["who"], what, mark
    return LogEntry(*of, theirs=theirs, of_copy=not is_ours)


def _numbered_now(log: list[LogEntry]) -> tuple[LogEntry, ...]:
    """Return entries with what the batches that they tell of are numbered now."""
    merges, now, said = _merges(log), Numbers(), []
    for entry in reversed(log):
        numbers = {n: number for n, number in now.items() if entry.batch == n}
        said.append(replace(entry, numbers=numbers) if numbers else entry)
        if (anew := merges.get(entry.number)) is not None:
            through = {n: anew.get(n, n) for n in {**anew, **now}}
            now = {n: None if number is None else now.get(number, number)
                   for n, number in through.items()}  # fmt: skip
            now = {n: number for n, number in now.items() if number != n}
    return tuple(reversed(said))


def _batches_in(states: dict[str, str]) -> dict[int, str]:
    """Return the digests of batches among all that an entry holds, by number."""
    return {
        int(name.removeprefix(_BATCH)): state
        for name, state in states.items()
        if name.startswith(_BATCH)
    }


def _merges(log: Sequence[LogEntry]) -> dict[int, Numbers]:
    """Return how each merge numbered batches anew, by its entry's number.

    Batches that an earlier version's merge left out, as they were not in the file, are not told of.
    """
    merges: dict[int, Numbers] = {}
    last: dict[int, str] = {}
    for entry in log:
        told = _batches_in(entry.what.get("states", {}))
        if entry.kind == "merged" and told:
            noted = entry.what.get("numbers")
            merges[entry.number] = (
                _found_again(last, told)
                if noted is None
                else {int(old): number for old, number in noted.items()}
            )
            last = {}
        last |= told
    return merges


def _found_again(before: dict[int, str], after: dict[int, str]) -> Numbers:
    """Return how a merge that did not note it numbered batches anew, by what was in them.

    They kept their order: those of which the other copy took something back, and no other, are
    found by what stands around them.
    """
    found = {state: number for number, state in after.items()}
    there: Numbers = {n: found[state] for n, state in before.items() if state in found}
    free = sorted({*after} - {*there.values()})
    last, waiting = 0, list[int]()
    for n in (*sorted(before), None):
        if n is not None and n not in there:
            waiting.append(n)
            continue
        upto = max(after) + 1 if n is None else there[n] or 0
        room = [number for number in free if last < number < upto]
        if len(room) == len(waiting):
            there |= zip(waiting, room, strict=True)
        elif len(room) > len(waiting):
            there |= dict.fromkeys(waiting)
        last, waiting = upto, []
    return there


def first(db: sqlite3.Connection) -> str:
    """Return the digest of the first entry: it tells of the plot and the moment it was made."""
    row = db.execute("SELECT digest FROM log WHERE fid = 1").fetchone()
    return "" if row is None else str(row[0])


def refuse_changed(
    db: sqlite3.Connection, checked: tuple[int, str] | None = None
) -> tuple[int, str]:
    """Raise `FileProblem` where the chain of the log does not hold, and say at which entry.

    Return number and digest of its last entry. `checked` is such an answer from before: entries up
    to that one are not looked at again.
    """
    number, before = checked or (0, _NOTHING)
    row = db.execute("SELECT digest FROM log WHERE fid = ?", (number,)).fetchone()
    if row is None or row[0] != before:  # another file stands here now: a copy was brought back
        number, before = 0, _NOTHING
    rows = db.execute("SELECT fid, entry, digest FROM log WHERE fid > ? ORDER BY fid", (number,))
    for fid, content, mark in rows:
        number += 1
        if fid != number:
            raise _changed(number, worded("is missing, or stands elsewhere"))
        if mark != _chained(before, str(content)):
            raise _changed(number, worded("is not what was written"))
        before = mark
    head = _head(db)
    if head[0] > number:
        raise _changed(number + 1, worded("is missing, and whatever came after it"))
    if head != (number, before):
        raise _changed(number, worded("is not the last that was written"))
    return number, before


def _changed(number: int, how: str) -> FileProblem:
    return FileProblem(
        worded(
            "The log of the season must be as fieldmon wrote it, but entry {number} {how}. "
            "Somebody changed the past: nothing is added to it. Go back to a copy from before.",
            number=number,
            how=how,
        )
    )


def differing(db: sqlite3.Connection) -> tuple[str, ...]:
    """Return a sentence for each thing that the file says otherwise than its log."""
    last: dict[str, tuple[str, LogEntry]] = {}
    lost: list[tuple[str, LogEntry]] = []
    planned: dict[str, LogEntry] = {}
    log = entries(db)
    merges = _merges(log)
    for entry in log:
        if (anew := merges.get(entry.number)) is not None:
            numbers = _batches_in({name: name for name in last})
            gone = [] if "numbers" in entry.what else [n for n in numbers if n not in anew]
            lost += [(numbers[n], last.pop(numbers[n])[1]) for n in gone]
            for old in anew:
                last.pop(f"{_BATCH}{old}", None)
        for name, state in entry.what.get("states", {}).items():
            last[name] = state, entry
        if entry.kind == "planned":
            planned[entry.what["digest"]] = entry
    now = states(db)
    lost += [(name, entry) for name, (_, entry) in last.items() if name not in now]
    said = [
        f"The {name} of the file is not what {entry} says."
        for name, (state, entry) in last.items()
        if name in now and now[name] != state
    ]
    said += [f"The {name} that {entry} tells of is not in the file." for name, entry in lost]
    said += [f"The log knows nothing of {name}." for name in now if name not in last]
    routes = {mark for (mark,) in db.execute("SELECT digest FROM routes")}
    said += [
        f"The route of {entry.what['date']} that {entry} tells of is not in the file."
        for mark, entry in planned.items()
        if mark not in routes
    ]
    return tuple(said)


# -- two copies


def taken_in(ours: sqlite3.Connection, theirs: sqlite3.Connection) -> list[dict[str, str]]:
    """Return the entries of another copy's log that ours does not know, word for word."""
    refuse_changed(theirs)
    known = {mark for mark, _ in with_those_taken_in(ours)}
    unknown = dict(one for one in with_those_taken_in(theirs) if one[0] not in known)
    return [{"digest": mark, "entry": content} for mark, content in unknown.items()]


def left_out_of(db: sqlite3.Connection, batch: int) -> list[str]:
    """Return the digests of what was taken back of a batch before it was undone last."""
    for entry in reversed(entries(db)):
        number = entry.what.get("batch") if entry.kind == "undone" else None
        if number is not None and entry.numbers.get(number, number) == batch:
            return list(entry.what.get("but", ()))
    return []


def labels_kept(db: sqlite3.Connection) -> dict[str, str]:
    """Return when (UTC) each table of labels was kept, here or in a copy, by its entry's digest."""
    kept = {}
    for mark, content in with_those_taken_in(db):
        if '"kind":"labels"' in content and (said := json.loads(content))["kind"] == "labels":
            kept[mark] = said["at"]
    return kept


def with_those_taken_in(db: sqlite3.Connection) -> Iterator[tuple[str, str]]:
    """Yield digest and words of the entries of a log, those of copies that were taken in before."""
    for content, mark in db.execute("SELECT entry, digest FROM log ORDER BY fid"):
        for inner in json.loads(content)["what"].get("theirs", ()):
            yield inner["digest"], inner["entry"]
        yield mark, content


def lines(of: Sequence[LogEntry], clock: LocalClock, *, whole: bool = False) -> Iterator[str]:
    """Yield entries as lines for people, with the times that a clock shows.

    A visit that was told plant by plant is one line, unless the `whole` log is wanted. Entries of
    a copy that was taken in stand indented below that entry, without a number.
    """

    def told(entries: Sequence[LogEntry]) -> list[LogVisit]:
        return [LogVisit(one, one) for one in entries] if whole else by_visit(entries)

    def line(visit: LogVisit, number: str) -> str:
        one = visit.entry
        at, until = (f"{clock.at(datetime.fromisoformat(each.at)):%Y-%m-%dT%H:%M}"
                     for each in (one, visit.last))  # fmt: skip
        who = one.who or "-"
        return f"{number}  {at}  {one.kind:9}  {who:12}  {visit.sentence(until)}"

    for visit in told(of):
        yield line(visit, f"{visit.entry.number:5d}")
        for inner in told(visit.entry.theirs):
            yield line(inner, f"{'':7}in the copy:")
    if of:
        n = len(of)
        entries_ = written(n, "entry|entries")
        yield f"{n} {entries_}, the chain holds; the last digest is {of[-1].digest}"
