"""What phones and robots tell of plants: taken once each, whatever comes twice, late or never.

Each finding has an id made where it was told. What is told may come in any order and as often as
a network breaks; once `take` returns, it is on the disk, and comes to no second inspection.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, dataclass, fields, replace
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
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import local_clock, utc_now, utc_text

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence

    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.monitoring.estimates.season_contents import SeasonChange
    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.plot.local_clock import LocalClock

SOURCE = "phone"
#: what one person may tell in a day: ten times what anybody can inspect
MOST_A_DAY = 20_000
#: a clock as wrong as this was set wrong; less is the way through the network
CLOCK_IS_WRONG = timedelta(minutes=2)
_WEEK = timedelta(days=7)


@dataclass(frozen=True)
class Finding:
    """What somebody tells of one plant, or that an earlier finding is taken back.

    Parameters
    ----------
    id
        Made where it was told, unlike any other: a UUID.
    at
        When, by the clock of the phone; it names its zone.
    plant, result
        Number in the grid, and `CLEAN`, `FOUND` or `SKIPPED`; None where it only takes back.
    count, stage, leaves
        Of a find: pests counted, their stage, leaves looked at.
    notes
        Text.
    lonlat, accuracy_m
        Where the phone was, and how well it knew.
    on
        The day it is meant for, where that is not today; another one than `at` has no time.
    after
        The least that the time can be, by the season's clock; None: nothing is known.
    known_at
        When, by the season's clock as far as the phone knew it then; None: it did not.
    off_route
        Whether the plant was not on the route.
    undoes
        Id of the finding that it takes back.
    detects
        Chance to see an infested plant that is inspected; None: it is that of the season.
    """

    id: str
    at: datetime
    plant: int | None = None
    result: int | None = None
    count: float | None = None
    stage: str = ""
    leaves: float | None = None
    notes: str = ""
    lonlat: tuple[float, float] | None = None
    accuracy_m: float | None = None
    on: date | None = None
    off_route: bool = False
    undoes: str = ""
    after: datetime | None = None
    detects: float | None = None
    known_at: datetime | None = None

    def content(self) -> str:
        """Return what it says as JSON, the same for the same finding whichever version told it."""
        return json.dumps(_said(asdict(self)), default=str, sort_keys=True, ensure_ascii=False)


#: what a finding has where nothing is said
_UNSAID = {one.name: one.default for one in fields(Finding)}


def _said(content: dict[str, object]) -> dict[str, object]:
    """Return what of a finding's content is said; older files hold what is not, too."""
    return {name: value for name, value in content.items() if value != _UNSAID.get(name)}


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
        letter = _SentFindings([*findings], (received, sent), received, shift)
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
            letter = _SentFindings(told, (received, received + shift), arrived, shift)
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
    season: Season, change: SeasonChange, scout: Scout, letter: _SentFindings
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


@dataclass(frozen=True)
class _SentFindings:
    """What came at once.

    Parameters
    ----------
    findings
        What is told.
    clocks
        Ours and the phone's as it came.
    arrived
        When it left the phone: none of it was told after that.
    shift
        By how much the phone's clock was ahead then.
    """

    findings: list[Finding]
    clocks: tuple[datetime, datetime]
    arrived: datetime
    shift: timedelta


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
    if _said(json.loads(known[one.id][0])) == json.loads(one.content()):
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
    season: Season, change: SeasonChange, scout: Scout, letter: _SentFindings
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


def _inspection(season: Season, one: Finding, letter: _SentFindings) -> Inspections:
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
    day, second = _when(local_clock(season.plot.field), one, letter)
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


def _when(clock: LocalClock, one: Finding, letter: _SentFindings) -> tuple[date, float]:
    """Return a finding's day, and its second or NaN; raise `ObservationError` if no day is sure.

    No time is believed after its arrival, or before the least that it can be.
    """
    received, named = letter.arrived, one.on
    least = one.after if one.after is None or one.after <= received + CLOCK_IS_WRONG else None
    earliest = None if least is None else least - CLOCK_IS_WRONG
    at = _moment(one, letter, earliest)
    local, is_believed = clock.at(at), _can_be(at, letter, earliest)
    if named is not None:
        return named, seconds(local.time()) if is_believed and named == local.date() else np.nan
    if is_believed:
        return local.date(), seconds(local.time())
    day = clock.at(received).date()
    if least is None or clock.at(least).date() != day:
        raise ObservationError(
            worded(
                "The clock of the phone was wrong when this was recorded ({at}), so nobody knows "
                "its day. Record it by hand.",
                at=f"{local:%Y-%m-%d %H:%M}",
            )
        )
    return day, np.nan


def _moment(one: Finding, letter: _SentFindings, earliest: datetime | None) -> datetime:
    """Return when a finding was made: by what its clock was off then, else as it sends.

    A phone that sleeps does not notice that its clock is set ahead. Where that may have been since
    it last heard the season's clock, what it is off as it sends tells more.
    """
    put_right = one.at - letter.shift
    if one.known_at is None or not _can_be(one.known_at, letter, earliest):
        return put_right
    set_ahead = one.known_at - put_right
    asleep = timedelta() if one.after is None else one.known_at - one.after
    return put_right if CLOCK_IS_WRONG < set_ahead <= asleep else one.known_at


def _can_be(at: datetime, letter: _SentFindings, earliest: datetime | None) -> bool:
    return at <= letter.arrived + CLOCK_IS_WRONG and (earliest is None or at >= earliest)


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
