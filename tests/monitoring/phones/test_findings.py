"""What phones tell is taken once each, in any order, however often it comes."""

import json
import random
import uuid
from dataclasses import asdict, replace
from datetime import date, timedelta

import numpy as np
import pyogrio
import pytest

from fieldmon.errors import AccessError, LimitError, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES, SKIPPED
from fieldmon.io.readers.phone_file import PhoneFile, SavedRecord, fields_of
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting.contradictions import contradicting
from fieldmon.monitoring.phones import findings, photos, scouts
from fieldmon.monitoring.phones.findings import (
    of_others,
    take,
    take_saved,
    taken_back,
    taken_back_before,
)
from fieldmon.monitoring.phones.photos import Photo
from fieldmon.monitoring.phones.sent_findings import Finding
from fieldmon.planning.members import TeamMember
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import Robot
from tests.monitoring.phone import JPEG, NOW, a_days_findings, a_finding, told
from tests.monitoring.seasons import BEGINS, state


@pytest.fixture
def season(path):
    return Season(path)


@pytest.fixture
def key(season):
    return scouts.let_in(season, "Ann")


@pytest.fixture(autouse=True)
def _now(monkeypatch):
    monkeypatch.setattr(findings, "utc_now", lambda: NOW)


def test_each_finding_is_one_inspection_however_often_and_in_whatever_order_it_comes(season, key):
    before = state(season.path)
    day = a_days_findings(season)
    rng = random.Random(1)
    for _ in range(6):
        some = rng.sample(day, rng.randint(1, len(day)))
        take(season, key, some, NOW)
    last = take(season, key, day, NOW)
    assert [one.id for one in last] == [one.id for one in day]
    assert {one.problem for one in take(season, key, day, NOW)} == {""}
    ids, rows = told(season)
    assert sorted(ids) == sorted(one.id for one in day)
    names = {CLEAN: "clean", FOUND: "found"}
    assert sorted(rows) == sorted((one.id, one.plant, names[one.result]) for one in day)
    assert state(season.path) == before + len(day)


def test_what_is_taken_back_does_not_count_whichever_came_first(season, key):
    kept, gone, early = a_finding(33), a_finding(34), a_finding(35)
    take(season, key, [a_finding(None, None, undoes=early.id)], NOW)
    take(season, key, [kept, gone, early], NOW)
    take(season, key, [a_finding(None, None, undoes=gone.id)], NOW)
    ids, rows = told(season)
    assert len(ids) == 5
    assert [one for one, *_ in rows] == [kept.id]
    assert season.history.inspections.plant.tolist().count(34) == 0
    season.store.check()
    assert season.verify() == ()


def test_whoever_told_what_the_season_took_back_learns_which_and_may_tell_it_again(season, key):
    kept, gone, own = a_finding(33), a_finding(34, FOUND), a_finding(35)
    on = local_clock(season.plot.field).at(NOW).date()
    take(season, key, [kept], NOW)
    take(season, key, [gone, own, a_finding(None, None, undoes=own.id)], NOW)
    photos.keep(season, key, photos.Photo("one", gone.id, JPEG, NOW))
    assert taken_back(season, "Ann", on) == ()
    batch = season.batches()[0].number
    season.undo(batch)
    assert taken_back(season, "ann", on) == (gone.id,)
    assert taken_back(season, "Ben", on) == taken_back(season, "Ann", on - timedelta(days=1)) == ()
    days = [on + timedelta(days=k) for k in (0, 1, 7, 8)]
    before = [taken_back_before(season, "ann", day) for day in days]
    assert before == [{}, {str(on): (gone.id,)}, {str(on): (gone.id,)}, {}]
    assert taken_back_before(season, "Ben", days[1]) == {}
    again = replace(gone, id="again")
    assert [one.new for one in take(season, key, [again], NOW)] == [True]
    assert taken_back(season, "Ann", on) == ()
    assert taken_back_before(season, "Ann", days[1]) == {}
    assert [one.plant for one in photos.photos_of(season)] == [34]
    season.redo(batch)
    assert sorted(season.history.inspections.on(on).plant.tolist()).count(34) == 1
    assert season.history.inspections.plant.tolist().count(35) == 0, "that was told to be no more"
    season.store.check()
    assert season.verify() == ()


def test_nobody_takes_back_what_somebody_else_told(season, key):
    one = a_finding(3)
    take(season, key, [one], NOW)
    other = scouts.let_in(season, "Ben")
    take(season, other, [a_finding(None, None, undoes=one.id)], NOW)
    assert [row[0] for row in told(season)[1]] == [one.id]


def test_two_people_at_one_plant_are_both_kept_and_the_contradiction_shown(season, key):
    other = scouts.let_in(season, "Ben")
    take(season, key, [a_finding(20, FOUND), a_finding(21)], NOW)
    take(season, other, [a_finding(20, CLEAN), a_finding(21)], NOW)
    assert len(told(season)[1]) == 4
    against = contradicting(season.inspections.on(BEGINS))
    assert against.plant.tolist() == [20, 20]
    assert sorted(zip(against.who, against.result.tolist(), strict=True)) == [
        ("Ann", 1),
        ("Ben", 0),
    ]


@pytest.mark.parametrize(
    ("wrong", "why"),
    [
        ({"plant": 10**6}, "plant's number"),
        ({"plant": None}, "must name a plant"),
        ({"result": 7}, "must name a plant and a result"),
        ({"on": date(2001, 1, 1)}, "of this season"),
        ({"result": FOUND, "count": -1.0}, "whole number from 1"),
    ],
)
def test_what_does_not_fit_is_kept_and_does_not_count(season, key, wrong, why):
    good, bad = a_finding(3), a_finding(**({"plant": 4} | wrong))
    first, second = take(season, key, [bad, good], NOW)
    assert why in first.problem
    assert second.problem == ""
    ids, rows = told(season)
    assert ids == [bad.id, good.id]
    assert [row[0] for row in rows] == [good.id]
    assert why in take(season, key, [bad], NOW)[0].problem, "as often as it comes"


def test_another_finding_with_the_same_id_does_not_replace_the_first(season, key):
    one = a_finding(3)
    take(season, key, [one], NOW)
    (answer,) = take(season, key, [a_finding(4, id=one.id)], NOW)
    assert (answer.new, "same id" in answer.problem) == (False, True)
    assert [row[1] for row in told(season)[1]] == [3]


def test_of_two_findings_with_one_id_in_a_letter_the_first_is_kept(season, key):
    one = a_finding(3)
    first, second = take(season, key, [one, a_finding(4, id=one.id)], NOW)
    assert (first.new, first.problem) == (True, "")
    assert (second.new, "same id" in second.problem) == (False, True)
    assert [row[1] for row in told(season)[1]] == [3]


def test_a_key_that_was_taken_back_writes_nothing(season, key):
    scouts.withdraw_key(season, "Ann")
    with pytest.raises(AccessError):
        take(season, key, [a_finding(3)], NOW)
    assert told(season) == ([], [])


def test_more_than_anybody_can_inspect_is_not_taken(season, key, monkeypatch):
    monkeypatch.setattr(findings, "MOST_A_DAY", 3)
    take(season, key, [a_finding(k) for k in range(3)], NOW)
    with pytest.raises(LimitError, match="3 findings a day"):
        take(season, key, [a_finding(4)], NOW)
    assert len(told(season)[0]) == 3


def test_a_gis_sees_where_a_phone_stood_and_nothing_where_it_did_not_know(season, key):
    at = {0: (35.0123456, 32.5), 1: None, 2: (-70.25, -33.75)}
    take(season, key, [a_finding(plant, lonlat=place) for plant, place in at.items()], NOW)
    points = pyogrio.read_dataframe(season.path, layer="tellings").geometry
    seen = [None if one is None else (one.x, one.y) for one in points]
    assert seen == [at[plant] for plant in sorted(at)]


def test_what_a_phone_says_that_it_finds_holds_and_is_in_the_file_that_it_saves(season, key):
    season.plan(BEGINS)
    told = [a_finding(3, FOUND, detects=0.3), a_finding(4, CLEAN), a_finding(5, CLEAN, detects=1.5),
            a_finding(6, CLEAN, detects=0.0)]  # fmt: skip
    taken = take(season, key, told, NOW)
    assert [one.problem[:26] for one in taken] == ["", "", *["The chance to see an infes"] * 2]
    usual = season.settings.robot.detects
    history = Season(season.path).history
    read = dict(zip(history.inspections.plant.tolist(), history.detections.tolist(), strict=True))
    assert (read[3], read[4]) == (0.3, usual)
    assert season.log()[-1].sentence().endswith("told to find 30 % of what is there")
    assert [one.who for one in season.other_detections(BEGINS)] == ["Ann"]
    again = Finding(**fields_of(json.loads(json.dumps({
        "id": told[0].id, "at": told[0].at.isoformat(), "plant": 3, "result": "found",
        "detects": 0.3,
    }))))  # fmt: skip
    (once,) = take(season, key, [again], NOW)
    assert (once.new, once.problem) == (False, "")


def test_a_phone_of_the_team_that_says_its_own_says_nothing_else(season, key):
    ann = TeamMember("Ann", Robot(hours=1.5, detection=0.6))
    season.change(replace(season.settings, team=(ann,)), season.settings)
    day = BEGINS + timedelta(days=1)
    season.plan_each(day)
    take(season, key, [a_finding(3, FOUND, detects=0.6, on=day)], NOW)
    assert season.history.detections[-1] == 0.6
    assert "told to find" not in season.log()[-1].sentence()
    assert season.other_detections(day) == ()


def test_each_field_of_a_finding_is_read_by_a_gis_as_it_was_told(season, key):
    told = [
        a_finding(3, FOUND, count=7.0, stage="eggs", leaves=12.0, accuracy_m=4.5, off_route=True,
                  notes="underside", lonlat=(35.15, 30.36)),
        a_finding(4, CLEAN, count=2.0),
        a_finding(5, SKIPPED),
        a_finding(9999, FOUND),
    ]  # fmt: skip
    told.append(a_finding(None, None, undoes=told[1].id))
    sent = NOW + timedelta(seconds=30)
    take(season, key, told, sent)
    table = pyogrio.read_dataframe(season.path, layer="tellings").astype(object)
    rows = table.where(table.notna(), None).set_index("id")
    assert rows.index.tolist() == [one.id for one in told]
    inspections = pyogrio.read_dataframe(season.path, layer="inspections", fid_as_index=True)
    for one in told:
        row = rows.loc[one.id]
        assert (row["scout"], row["undoes"] or "") == ("Ann", one.undoes)
        assert (row["stage"] or "", row["leaves"]) == (one.stage, one.leaves)
        assert (row["accuracy_m"], bool(row["off_route"])) == (one.accuracy_m, one.off_route)
        assert (row["at_phone"], row["sent_phone"]) == (one.at.isoformat(), sent.isoformat())
        assert row["content"] == one.content()
        if one.plant in (3, 4, 5):
            kept = inspections.loc[int(row["inspection"])]
            assert (kept["plant"], kept["result"]) == (one.plant, RESULT_NAMES[one.result])
            assert (kept["who"], kept["notes"] or "") == ("Ann", one.notes)
            assert kept["count"] == 7.0 if one.plant == 3 else np.isnan(kept["count"])
            assert kept["undone"] == (one.plant == 4)
            assert row["problem"] is None
        else:
            assert row["inspection"] is None
    assert "A plant's number must be" in rows.loc[told[3].id]["problem"]
    (batch,) = [one for one in season.batches() if one.source == "phone"]
    assert (batch.rows, batch.who) == (3, "Ann")


def test_a_day_later_as_much_may_be_told_again_but_not_a_moment_sooner(season, key, monkeypatch):
    monkeypatch.setattr(findings, "MOST_A_DAY", 2)
    clock = [NOW]
    monkeypatch.setattr(findings, "utc_now", lambda: clock[0])
    take(season, key, [a_finding(0), a_finding(1)], NOW)
    clock[0] = NOW + timedelta(hours=24, seconds=-1)
    with pytest.raises(LimitError, match="but this makes 3"):
        take(season, key, [a_finding(2)], clock[0])
    clock[0] = NOW + timedelta(hours=24, seconds=1)
    take(season, key, [a_finding(2), a_finding(3)], clock[0])
    assert len(told(season)[0]) == 4


@pytest.mark.parametrize("count", [0.0, 0.5, 2.5])
def test_pests_of_a_find_are_whole_and_at_least_one(season, key, count):
    before = len(season.history.inspections)
    (done,) = take(season, key, [a_finding(3, FOUND, count=count)], NOW)
    assert "whole number from 1" in done.problem
    assert len(season.history.inspections) == before
    (done,) = take(season, key, [a_finding(3, count=0.0)], NOW)
    assert done.problem == "", "none were counted on a clean plant"


def test_what_was_taken_by_a_version_that_knew_less_or_kept_more_is_still_the_same(season, key):
    one = a_finding(0)
    assert set(json.loads(one.content())) == {"id", "at", "plant", "result"}
    assert "after" in a_finding(3, after=NOW).content()
    take(season, key, [one], NOW)
    kept = json.dumps({**asdict(one), "known_later": None}, default=str)
    with season.store.writing() as db:
        db.execute("UPDATE tellings SET content = ? WHERE id = ?", (kept, one.id))
    assert take(season, key, [one], NOW)[0].problem == ""
    assert "same id" in take(season, key, [replace(one, plant=None)], NOW)[0].problem


def test_one_takes_back_ones_own_though_an_older_file_writes_the_name_in_capitals(season, key):
    one = a_finding(37)
    take(season, key, [one], NOW)
    with season.store.writing() as db:
        db.execute("UPDATE tellings SET scout = 'ANN'")
    (back,) = take(season, key, [a_finding(None, None, undoes=one.id)], NOW)
    assert back.problem == ""
    assert 37 not in season.history.inspections.plant


def test_what_another_recorded_of_the_same_plant_counts_once_ones_own_is_taken_back(season, key):
    one = a_finding(37)
    take(season, key, [one], NOW)
    told = season.inspections
    same = told.take(np.flatnonzero(told.plant == 37))
    season.record(replace(same, who=np.array(["Ben"], object)), "ben.csv")
    take(season, key, [a_finding(None, None, undoes=one.id)], NOW)
    told = season.inspections
    assert told.who[told.plant == 37].tolist() == ["Ben"]


def test_nobody_takes_back_what_another_told_and_that_is_said(season, key):
    theirs = a_finding(37)
    take(season, scouts.let_in(season, "Ben"), [theirs], NOW)
    back = a_finding(None, None, undoes=theirs.id)
    assert "recorded by Ben" in take(season, key, [back], NOW)[0].problem
    assert "recorded by Ben" in take(season, key, [back], NOW)[0].problem, "as often as it comes"
    assert 37 in season.history.inspections.plant


def _saved(findings, season="season", who="Ann", photos=(), clocks=None):
    def each(some):
        return tuple(SavedRecord(season, who, vars(one)) for one in some)

    return PhoneFile(each(findings), each(photos), clocks)


def test_what_a_phone_saved_is_recorded_once_whether_it_is_sent_or_not(season, key):
    sent, unsent = a_finding(37), a_finding(38, FOUND, count=2.0)
    photo = Photo(str(uuid.UUID(int=7)), unsent.id, JPEG, NOW)
    take(season, key, [sent], NOW)
    file = _saved([sent, unsent], photos=[photo])
    assert [one.new for one in take_saved(season, file)] == [False, True, True]
    before = state(season.path)
    assert not any(one.new for one in take_saved(season, file))
    assert not take(season, key, [unsent], NOW)[0].new, "the phone sees a network after all"
    assert state(season.path) == before
    assert [one.id for one in photos.photos_of(season)] == [photo.id]
    (who,) = {
        str(one) for one in season.history.inspections.who[season.history.inspections.plant == 38]
    }
    assert who == "Ann"


def test_what_a_phone_saved_of_another_season_or_of_nobody_is_not_recorded(season):
    before = state(season.path)
    other = _saved([a_finding(37)], season="Other")
    assert take_saved(season, other) == ()
    assert of_others(season, other) == ("1 of season Other was left out: record it there.",)
    with pytest.raises(SettingError, match="--who"):
        take_saved(season, _saved([a_finding(37)], season="", who=""))
    assert state(season.path) == before
    broken = Photo(str(uuid.UUID(int=7)), str(uuid.UUID(int=8)), b"no picture", NOW)
    told = _saved([a_finding(37)], season="", who="", photos=[broken])
    one, photo = take_saved(season, told, "Dan")
    assert (one.new, photo.new) == (True, False)
    assert "JPEG" in photo.problem


@pytest.mark.parametrize(
    ("fast", "said", "time"),
    [
        (timedelta(days=1), True, "09:00"),
        (timedelta(days=-40), True, "09:00"),
        (timedelta(), True, "09:00"),
        (timedelta(days=1), False, "09:00 a day later"),
    ],
)
def test_what_a_phone_saved_counts_as_if_it_had_been_sent_then(
    season, monkeypatch, fast, said, time
):
    monkeypatch.setattr(findings, "utc_now", lambda: NOW + timedelta(days=3))
    saved = NOW + timedelta(minutes=30)
    clocks = (saved + fast, saved) if said else None
    take_saved(season, _saved([a_finding(37, at=NOW + fast)], clocks=clocks))
    done = season.history.inspections
    (mine,) = np.flatnonzero(done.plant == 37)
    day, second = int((done.date[mine] - np.datetime64(BEGINS)).astype(int)), done.second[mine]
    assert (day, second) == (1 if time.endswith("later") else 0, 9 * 3600)


def test_nothing_that_a_phone_saved_was_told_after_that(season, monkeypatch):
    monkeypatch.setattr(findings, "utc_now", lambda: NOW + timedelta(days=3))
    late = a_finding(37, at=NOW + timedelta(days=1), after=NOW)
    assert take_saved(season, _saved([late], clocks=(NOW, NOW)))[0].problem == ""
    done = season.history.inspections
    (mine,) = np.flatnonzero(done.plant == 37)
    assert done.date[mine] == np.datetime64(BEGINS)
    assert np.isnan(done.second[mine])
