"""What phones and robots tell of plants: taken once each, whatever comes twice, late or never.

Each finding has an id made where it was told. What is told may come in any order and as often as
a network breaks; once `take` returns, it is on the disk, and comes to no second inspection.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, replace
from datetime import date, datetime, timedelta
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import worded
from fieldmon.errors import LimitError, ObservationError, SettingError
from fieldmon.infestation.inspections import FOUND, RESULT_NAMES, Inspections
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.estimates.told_detection import said_now
from fieldmon.monitoring.file import phone_tables, rows_that_count, schema
from fieldmon.monitoring.file.geopackage import beside_plot, insert, point_blobs, touch
from fieldmon.monitoring.inspecting import batches, inspection_table
from fieldmon.monitoring.phones import people, photos, scouts
from fieldmon.monitoring.phones.people import as_written
from fieldmon.monitoring.phones.scouts import Scout
from fieldmon.monitoring.phones.sent_findings import (
    CLOCK_IS_WRONG,
    Finding,
    SentFindings,
    what_is_said,
    when_seen,
)
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import local_clock, utc_now, utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence

    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.monitoring.estimates.season_contents import SeasonChange
    from fieldmon.monitoring.season.season_file import Season

SOURCE = "phone"
#: what one person may tell in a day: ten times what anybody can inspect
MOST_A_DAY = 20_000
_WEEK = timedelta(days=7)


@dataclass(frozen=True)
class Taken:
    """What became of a finding, which is on the disk.

    Parameters
    ----------
    id
        Of the finding.
    new
        Whether it was not there before.
    problem
        Why it does not count though it is kept; empty: it counts.
    """

    id: str
    new: bool
    problem: str = ""


def take(
    season: Season, key: str, findings: Sequence[Finding], sent: datetime
) -> tuple[Taken, ...]:
    """Keep what was told, each finding once; what is returned is on the disk.

    Where a finding does not fit the season (no such plant, a day before its first), it is kept and
    does not count. The same plant told by two people is kept twice: see `contradicting`.

    Parameters
    ----------
    season
        The season.
    key
        Of whoever tells, see `fieldmon.monitoring.phones.scouts`.
    findings
        In the order in which they were told.
    sent
        The phone's clock as it sends: where it is wrong, times are put right by as much.

    Raises
    ------
    AccessError
        If the key does not hold.
    LimitError
        If somebody tells more than `MOST_A_DAY`.
    """
    received = utc_now()
    fast = sent - received
    shift = fast if abs(fast) > CLOCK_IS_WRONG else timedelta()
    with season.changing() as change:
        scout = scouts.key_owner_in(change.db, season, key)
        letter = SentFindings([*findings], (received, sent), received, shift)
        return _take(season, change, scout, letter)


def take_saved(season: Season, saved: PhoneFile, who: str = "") -> tuple[Taken, ...]:
    """Keep what phones saved to a file, as what they send; it may be in the season already.

    Nobody needs a key who has the season's file. What is of another season is left out.

    Parameters
    ----------
    season
        The season.
    saved
        See `fieldmon.io.readers.phone_file`.
    who
        Whose it is, where the file does not say.

    Raises
    ------
    SettingError
        If nobody says whose it is.
    LimitError
        If somebody tells more than `MOST_A_DAY`.
    """
    received = utc_now()
    taken: list[Taken] = []
    here = saved.of(season.path.stem)
    arrived, shift = _as_if_sent(here, received)
    names = {one.who or who for one in (*here.findings, *here.photos)}
    if "" in names:
        raise SettingError(
            worded("Records must have an author, but the file names none. Say who (--who NAME).")
        )
    with season.changing() as change:
        known = people.names_written(change.db)
        for name in sorted({as_written(known, name) for name in names}):
            told = [
                Finding(**one.fields)
                for one in here.findings
                if as_written(known, one.who or who) == name
            ]
            letter = SentFindings(told, (received, received + shift), arrived, shift)
            taken += _take(season, change, Scout(name, None, ""), letter)
        for one in here.photos:
            new, problem = False, ""
            try:
                name = as_written(known, one.who or who)
                new = photos.keep_of(change.db, name, photos.Photo(**one.fields))
            except (ObservationError, LimitError) as error:  # it may be why it is in the file
                problem = str(error)
            taken.append(Taken(one.fields["id"], new, problem))
    return tuple(taken)


def _as_if_sent(saved: PhoneFile, received: datetime) -> tuple[datetime, timedelta]:
    """Return when a file was saved, and by how much the phone's clock was ahead then.

    Where it does not say, or cannot have been then, it is taken as sent now by a clock that is
    right.
    """
    if saved.clocks is None or saved.clocks[1] > received + CLOCK_IS_WRONG:
        return received, timedelta()
    clock, time = saved.clocks
    return min(time, received), clock - time if abs(clock - time) > CLOCK_IS_WRONG else timedelta()


def of_others(season: Season, saved: PhoneFile) -> tuple[str, ...]:
    """Return a sentence for each other season of which a phone saved something."""
    of = Counter(one.season for one in (*saved.findings, *saved.photos))
    return tuple(
        worded(
            "{n} of season {name} {n:was|were} left out: record {n:it|them} there.", n=n, name=name
        )
        for name, n in sorted(of.items())
        if name not in {"", season.path.stem}
    )


def _take(
    season: Season, change: SeasonChange, scout: Scout, letter: SentFindings
) -> tuple[Taken, ...]:
    """Keep what somebody tells, each finding once."""
    findings = letter.findings
    known = _known(change.db, [one.id for one in findings])
    news: dict[str, Finding] = {}
    for one in findings:
        if one.id not in known:
            news.setdefault(one.id, one)  # of two with one id the first is kept
    _limit(change.db, scout, letter.clocks[0], len(news))
    for one in news.values():
        known[one.id] = one.content(), ""
    letter = replace(letter, findings=list(news.values()))
    problems, batch, made = _write(season, change, scout, letter)
    taken_back = _undo_as_told(change) if news else set()
    if made:
        states = season_log.states(change.db, {batch, *taken_back})
        seen = reduce(Inspections.and_those, made)
        detects = said_now(change.db, seen, scout.name)
        said = {"batch": batch, "source": SOURCE, **inspection_table.in_words(seen, detects)}
        season_log.append(change.db, "seen", scout.name, states=states, **said)
    elif taken_back:
        states = season_log.states(change.db, taken_back)
        said = {"said": "What a phone told was taken back by it."}
        season_log.append(change.db, "undone", scout.name, states=states, **said)
    return tuple(
        Taken(
            one.id,
            news.get(one.id) is one,
            problems.get(one.id, known[one.id][1]) or _differs(one, known),
        )
        for one in findings
    )


def taken_back(season: Season, who: str, on: date) -> tuple[str, ...]:
    """Return the ids of what somebody told of a day and somebody else took back in the season.

    What the same person took back, or counts in another recording, is not among it.
    """
    return _taken_back(season, who, on, on).get(str(on), ())


def taken_back_before(season: Season, who: str, on: date) -> dict[str, tuple[str, ...]]:
    """Return the same of the week before a day, by day (ISO)."""
    return _taken_back(season, who, on - _WEEK, on - timedelta(days=1))


def _taken_back(season: Season, who: str, first: date, last: date) -> dict[str, tuple[str, ...]]:
    with season.store.reading() as db:
        rows = db.execute(
            "SELECT t.id, t.scout, i.date FROM tellings t "
            "JOIN inspections i ON i.fid = t.inspection "
            "WHERE i.undone = ? AND i.date BETWEEN ? AND ? AND NOT EXISTS (SELECT 1 FROM "
            "inspections WHERE digest = i.digest AND undone = 0) AND NOT EXISTS (SELECT 1 FROM "
            "tellings WHERE undoes = t.id) ORDER BY i.date, t.fid",
            (rows_that_count.TAKEN_BACK, str(first), str(last)),
        ).fetchall()
    days: dict[str, tuple[str, ...]] = {}
    for one, name, day in rows:
        if person_key(name) == person_key(who):
            days[day] = (*days.get(day, ()), one)
    return days


def _known(db: sqlite3.Connection, ids: list[str]) -> dict[str, tuple[str, str]]:
    """Return content and problem of those of the findings that are there, by id."""
    wanted = "SELECT content, coalesce(problem, '') FROM tellings WHERE id = ?"
    rows = ((one, db.execute(wanted, (one,)).fetchone()) for one in ids)
    return {one: row for one, row in rows if row is not None}


def _differs(one: Finding, known: dict[str, tuple[str, str]]) -> str:
    if what_is_said(json.loads(known[one.id][0])) == json.loads(one.content()):
        return ""
    return worded("Another finding has the same id; the first one was kept.")


def _limit(db: sqlite3.Connection, scout: Scout, now: datetime, news: int) -> None:
    since = utc_text(now - timedelta(days=1))
    before = phone_tables.n_sent(db, phone_tables.FINDINGS, scout.name, since)
    if before + news > MOST_A_DAY:
        raise LimitError(
            worded(
                "One person may tell {most} findings a day, but this makes {n}. Wait a day.",
                most=MOST_A_DAY, n=before + news,
            )
        )  # fmt: skip


def _write(
    season: Season, change: SeasonChange, scout: Scout, letter: SentFindings
) -> tuple[dict[str, str], int, list[Inspections]]:
    """Write findings and their inspections.

    Return what is wrong with those that do not count, the batch, and what was seen.
    """
    seen: list[Inspections] = []
    if not letter.findings:
        return {}, 0, seen
    settings = settings_of(change.db)
    batch = batches.begin(change.db, "findings", SOURCE, scout.name)
    problems: dict[str, str] = {}
    for one in letter.findings:
        inspection = None
        if one.undoes:
            problems |= _of_another(change.db, scout, one)
        else:
            try:
                made = _inspection(season, one, letter)
                days = (settings, (batch, scout.name))
                (row,) = inspection_table.rows(made, season.plot.grid, season.plant_numbers, *days)
                mark = str(row[schema.INSPECTIONS.names.index("digest")])
                phone_tables.move_photos(change.db, mark, one.id)
                inspection = _insert(change.db, row, one.id)
                change.reaches(settings.day(made.date[0].item()))
                seen.append(made)
            except (ObservationError, SettingError) as error:
                problems[one.id] = str(error)
        _keep(change.db, scout, letter.clocks, (one, inspection, problems.get(one.id)))
    batches.end(change.db, batch, len(seen))
    touch(change.db, phone_tables.FINDINGS.name)
    touch(change.db, schema.INSPECTIONS.name)
    return problems, batch, seen


def _of_another(db: sqlite3.Connection, scout: Scout, one: Finding) -> dict[str, str]:
    """Return why a finding takes nothing back, by its id: nobody takes back what others told."""
    told = db.execute("SELECT scout FROM tellings WHERE id = ?", (one.undoes,)).fetchone()
    if told is None or person_key(told[0]) == person_key(scout.name):
        return {}
    said = worded("This was recorded by {who}, so nobody else can take it back here.", who=told[0])
    return {one.id: said}


def _inspection(season: Season, one: Finding, letter: SentFindings) -> Inspections:
    """Return a finding as an inspection; raise `ObservationError` where it names none."""
    if one.plant is None or one.result not in RESULT_NAMES:
        raise ObservationError(
            worded("A finding must name a plant and a result, but one of them is missing.")
        )
    if (
        one.result == FOUND
        and one.count is not None
        and not (one.count >= 1 and one.count % 1 == 0)
    ):
        raise ObservationError(
            worded(
                "Pests of a find must be a whole number from 1, but it says {count:g}.",
                count=one.count,
            )
        )
    day, second = when_seen(local_clock(season.plot.field), one, letter)
    count = np.nan if one.count is None or one.result != FOUND else one.count
    return Inspections.of(
        np.array([one.plant]),
        np.array([one.result]),
        np.datetime64(day, "D"),
        second=np.array([second]),
        count=np.array([count]),
        detects=np.array([np.nan if one.detects is None else one.detects]),
        notes=np.array([one.notes], object),
    )


def _insert(db: sqlite3.Connection, row: tuple[object, ...], told: str) -> int:
    """Add an inspection and return its number: two people may find the same at one second."""
    names = schema.INSPECTIONS.names
    mark = names.index("digest")
    same = "SELECT 1 FROM inspections WHERE digest = ? AND undone = 0"
    if db.execute(same, (row[mark],)).fetchone():
        own = digest(str(row[mark]), told, length=24)
        row = (*row[:mark], own, *row[mark + 1 :])
    marks = ", ".join("?" * len(names))
    into = f"INSERT INTO inspections ({', '.join(names)}) VALUES ({marks})"  # noqa: S608 - ours
    row = (beside_plot(db, row[0]), *row[1:])
    return int(db.execute(into, row).lastrowid or 0)


def _keep(
    db: sqlite3.Connection,
    scout: Scout,
    clocks: tuple[datetime, datetime],
    told: tuple[Finding, int | None, str | None],
) -> None:
    received, sent = clocks
    one, inspection, problem = told
    place = None if one.lonlat is None else point_blobs(np.array([one.lonlat]))[0]
    insert(
        db,
        phone_tables.FINDINGS,
        [
            (
                *(place, one.id, scout.name, one.undoes or None),
                *(one.at.isoformat(), sent.isoformat(), utc_text(received)),
                *(one.accuracy_m, one.stage or None, one.leaves, int(one.off_route)),
                *(inspection, problem, one.content()),
            )
        ],
    )


def _undo_as_told(change: SeasonChange) -> set[int]:
    """Undo what was told to be taken back; return the batches that it was of."""
    back = phone_tables.undo_as_told(change.db)
    for batch, day in back:
        batches.close_if_empty(change.db, batch)
        change.reaches(day)
    return {batch for batch, _ in back}
