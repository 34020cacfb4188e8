"""What each inspection was told to find: who works otherwise changes nothing of before."""

import json
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import ObservationError
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.estimates.told_detection import ToldDetection
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.estimates.what_was_told import detection_of, earlier_season_note
from fieldmon.monitoring.settings.settings import as_json
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot, scout
from tests.monitoring.seasons import BEGINS, ROBOT, a_season, clock_on, on, some_results

SHARP, DULL = ROBOT.detects, 0.5
LOOKS_LESS = replace(ROBOT, look_s=20.0)
TEAM = (
    TeamMember("Ann", replace(scout(), detection=0.9)),
    TeamMember("Ben", replace(scout(), detection=0.3)),
)


def change(season, **choices):
    season.change(replace(season.settings, **choices), season.settings)


def seen(first, n=4, day=0, who="", second=np.nan, detects=np.nan):
    plants = np.arange(first, first + n)
    return Inspections.of(
        plants, plants % 2, np.datetime64(on(day), "D"),
        who=np.full(n, who, object), second=np.full(n, second), detects=np.full(n, detects),
    )  # fmt: skip


def told(season):
    """Return it as the file says it, and see that who has the season open knows the same."""
    read = Season(season.path).history.detections.tolist()
    assert season.history.detections.tolist() == read
    return read


def test_a_day_that_was_planned_is_read_by_who_it_was_planned_for(season):
    season.plan(BEGINS)
    season.record(seen(0))
    before, learnt = season.evening(BEGINS).tolist(), season.learnt(BEGINS)
    for choices in ({"robot": LOOKS_LESS}, {"team": TEAM}, {"team": (), "robot": ROBOT}):
        change(season, **choices)
        assert season.evening(BEGINS).tolist() == before
        assert Season(season.path).evening(BEGINS).tolist() == before
        assert season.learnt(BEGINS) == learnt
    assert told(season) == [SHARP] * 4


def test_what_is_recorded_only_after_a_change_is_read_by_what_was_planned(season):
    season.plan(BEGINS)
    change(season, robot=LOOKS_LESS)
    season.record(seen(0))
    season.record(seen(0, day=1))  # nobody planned it
    assert told(season) == [SHARP] * 4 + [DULL] * 4


def test_a_day_that_nobody_planned_is_read_by_what_counted_when_it_was_first_recorded(season):
    season.record(seen(0))
    change(season, robot=LOOKS_LESS)
    season.record(seen(4))
    season.undo()
    season.record(seen(4))
    assert told(season) == [SHARP] * 8


def test_the_rest_of_a_day_that_is_planned_anew_is_read_by_who_does_it(season, monkeypatch):
    clock_on(monkeypatch, 0)
    season.plan(BEGINS)
    season.record(seen(0, second=6.4 * 3600.0))
    change(season, robot=LOOKS_LESS)
    season.plan(BEGINS)
    # of before in the order of their times
    season.record(seen(4, second=6.2 * 3600.0))
    assert told(season) == [DULL] * 4 + [SHARP] * 4


def test_a_day_that_is_planned_again_after_it_was_worked_is_read_as_before(season):
    season.plan(BEGINS)
    season.record(seen(0))
    change(season, robot=LOOKS_LESS)
    season.plan(BEGINS)
    assert told(season) == [SHARP] * 4


def test_a_late_find_of_a_day_that_is_planned_again_is_read_by_who_worked_then(season):
    season.plan(BEGINS)
    season.record(seen(0))
    change(season, robot=LOOKS_LESS)
    season.plan(BEGINS)  # as it was: the day is past
    season.record(seen(4))
    assert told(season) == [SHARP] * 8


def test_each_of_a_team_of_then_is_read_by_its_own(season):
    change(season, team=TEAM)
    season.plan_each(BEGINS)
    season.record(seen(0, 2, who="ann"))
    season.record(seen(2, 2, who="Ben"))
    season.record(seen(4, 2, who="Zoë"))
    change(season, team=(TeamMember("Ben", replace(scout(), detection=0.6)),))
    season.plan_each(on(1))
    season.record(seen(0, 2, day=1, who="Ben"))
    assert told(season) == [0.9, 0.9, 0.3, 0.3, SHARP, SHARP, 0.6, 0.6]
    history = season.history
    assert history.mean_detection(0) == pytest.approx((0.9 + 0.3 + SHARP) / 3)


def test_what_is_said_with_inspections_holds_and_each_robot_keeps_its_own(season):
    season.plan(BEGINS)
    rex, max_ = seen(0, 2, who="Rex", detects=0.3), seen(2, 2, who="Max", detects=0.6)
    not_seen = replace(seen(6, 1, who="Rex", detects=0.3), result=np.array([SKIPPED], np.int8))
    typed = seen(4, 2)
    files = [(rex, "rex.geojson"), (max_, "max.geojson"), (typed, "typed"), (not_seen, "no.csv")]
    season.record_all(files)
    held = [0.3, 0.3, 0.6, 0.6, SHARP, SHARP, 0.3]
    assert told(season) == held
    evening = season.evening(BEGINS).tolist()
    change(season, robot=LOOKS_LESS, team=TEAM)
    assert told(season) == held
    assert season.evening(BEGINS).tolist() == evening
    assert Season(season.path).evening(BEGINS).tolist() == evening
    assert [(one.who, one.detects, one.own, one.first, one.n)
            for one in season.other_detections(BEGINS)] == [
        ("Rex", 0.3, SHARP, BEGINS, 2), ("Max", 0.6, SHARP, BEGINS, 2)
    ]  # fmt: skip


def test_the_map_learns_by_what_is_said(season, tmp_path):
    other = a_season(tmp_path / "other.gpkg", robot=replace(ROBOT, detection=0.3))
    season.record(seen(0, detects=0.3))
    other.record(seen(0))
    assert season.evening(BEGINS).tolist() == other.evening(BEGINS).tolist()
    usual = a_season(tmp_path / "usual.gpkg")
    usual.record(seen(0))
    assert season.evening(BEGINS).tolist() != usual.evening(BEGINS).tolist()


def test_the_seasons_own_said_to_six_digits_is_its_own_to_the_bit(season):
    exact = 0.123456789
    change(season, robot=replace(ROBOT, detection=exact))
    season.record(seen(0, detects=round(exact, 6)))
    assert told(season) == [exact] * 4
    assert season.other_detections(BEGINS) == ()
    assert "told to find" not in season.log()[-1].sentence()


def test_what_is_said_stays_through_undoing_correcting_merging_and_saving(season, tmp_path):
    season.plan(BEGINS)
    season.record(seen(0, detects=0.3), "rex.geojson")
    season.store.back_up(tmp_path / "copy.gpkg")
    other = Season(tmp_path / "copy.gpkg")
    other.record(seen(4, day=1, detects=0.5), "max.geojson")
    before = season.evening(BEGINS).tolist()
    season.undo()
    season.record(seen(0, detects=0.3), "rex.geojson")
    assert (told(season), season.evening(BEGINS).tolist()) == ([0.3] * 4, before)
    # plant 0 was clean: it is found now
    corrected = Inspections.of(np.array([0]), np.array([1]), np.datetime64(BEGINS))
    season.record_instead(corrected, "typed", "Cas")
    assert told(season) == [0.3] * 4
    season.undo()
    assert (told(season), season.evening(BEGINS).tolist()) == ([0.3] * 4, before)
    season.merge(other)
    assert told(season) == [0.3] * 4 + [0.5] * 4
    assert season.verify() == ()
    assert [one.detects for one in season.other_detections(on(1))] == [0.3, 0.5]


def test_a_correction_that_says_another_chance_takes_its_own(season):
    season.record(seen(0, detects=0.3), "rex.geojson")
    plant = np.array([0])
    said = Inspections.of(plant, plant + 1, np.datetime64(BEGINS), detects=np.array([0.6]))
    season.record_instead(said, "max.geojson")
    assert told(season) == [0.6, 0.3, 0.3, 0.3]
    season.undo()
    assert told(season) == [0.3] * 4


def test_the_log_says_what_was_said_where_the_season_would_read_it_otherwise(season):
    season.record(seen(0, detects=SHARP))
    season.record(seen(4, detects=0.3), "rex.geojson")
    change(season, robot=LOOKS_LESS)
    season.record(seen(0, day=1, detects=SHARP))
    said = [one.sentence().partition("; ")[2] for one in season.log() if one.kind == "seen"]
    assert said == ["", "told to find 30 % of what is there", "told to find 84 % of what is there"]
    with season.store.writing() as db:
        db.execute("UPDATE inspections SET detects = 0.4 WHERE detects = 0.3")
    assert any("batch 2" in one for one in check_against_log(season))


@pytest.mark.parametrize("detects", [0.0, -0.1, 1.01, np.inf])
def test_what_is_no_chance_to_see_anything_is_refused(season, detects):
    with pytest.raises(ObservationError, match="must be above 0, and 1 at most, but"):
        season.record(seen(0, detects=detects))
    assert told(season) == []


def test_what_was_said_before_a_pest_that_is_seen_otherwise_was_named_is_of_that_pest(season):
    season.record(seen(0, detects=0.3))
    pest = replace(shipped_pest("spider-mite"), detection=0.7)
    change(season, pest=pest, robot=pest.seen_by(season.settings.robot))
    season.record(seen(0, day=1, detects=0.5))
    assert told(season) == [0.7] * 4 + [0.5] * 4


def test_what_was_said_of_a_pest_holds_though_its_figures_are_others_now(season):
    pest = replace(shipped_pest("spider-mite"), detection=0.7)
    change(season, pest=pest, robot=pest.seen_by(season.settings.robot))
    season.record(seen(0, detects=0.3))
    sharper = replace(pest, detection=0.8)
    change(season, pest=sharper, robot=sharper.seen_by(season.settings.robot))
    assert told(season) == [0.3] * 4


def test_what_was_said_before_a_pest_that_says_nothing_of_that_was_named_holds(season):
    season.record(seen(0, detects=0.3))
    pest = replace(shipped_pest("spider-mite"), detection=None, viewpoints=None)
    change(season, pest=pest)
    assert told(season) == [0.3] * 4


def test_whoever_asks_is_told_by_what_a_day_will_be_read(season):
    change(season, team=TEAM)
    season.plan_each(BEGINS)
    change(season, team=(), robot=LOOKS_LESS)
    assert [detection_of(season, BEGINS, who) for who in ("ben", "Ann", "Zoë")] == [0.3, 0.9, SHARP]
    assert detection_of(season, on(1), "ben") == DULL


def test_a_pest_that_is_named_later_was_looked_for_from_the_first_day_on(season):
    season.record(seen(0))
    change(season, robot=LOOKS_LESS)
    season.record(seen(0, day=1))
    pest = replace(shipped_pest("spider-mite"), detection=0.7)
    change(season, pest=pest, robot=pest.seen_by(season.settings.robot))
    assert told(season) == [0.7] * 8
    change(season, robot=replace(ROBOT, detection=0.4))
    season.record(seen(0, day=2))
    assert told(season) == [0.7] * 8 + [0.4] * 4


def test_a_copy_that_planned_and_recorded_brings_what_it_was_told(season, tmp_path):
    season.store.back_up(tmp_path / "copy.gpkg")
    other = Season(tmp_path / "copy.gpkg")
    other.plan(BEGINS)
    change(season, robot=LOOKS_LESS)
    other.record(seen(0))
    season.merge(other)
    assert told(season) == [SHARP] * 4


def test_a_season_without_a_log_of_a_day_is_read_by_when_it_was_recorded(season):
    season.record(seen(0))
    change(season, robot=LOOKS_LESS)
    season.record(seen(0, day=1))
    with season.store.writing() as db:
        db.execute("DELETE FROM log WHERE json_extract(entry, '$.kind') = 'seen'")
    assert Season(season.path).history.detections.tolist() == [SHARP] * 4 + [DULL] * 4


def test_mornings_that_the_file_keeps_are_still_those_after_another_robot(season):
    for day in range(4):
        season.record(seen(day, day=day))
    change(season, robot=LOOKS_LESS)
    assert Season(season.path)._now().mornings.last_until(3) == 3
    assert Season(season.path).verify() == ()


def test_a_robot_that_may_not_be_chosen_any_more_is_read_nevertheless():
    parts = as_json(MonitoringSettings(BEGINS, robot=ROBOT))
    robot = json.loads(parts["robot"]) | {"speed_m_s": -1.0, "look_s": 25.0}
    assert ToldDetection.in_parts({"robot": json.dumps(robot)}, parts) == (0.6, {})


def test_what_is_learnt_of_an_earlier_season_is_of_the_detection_at_first(season, tmp_path):
    season.plan(BEGINS)
    season.record(some_results(season, n=6, found=(1, 3)))
    change(season, robot=LOOKS_LESS)
    assert season.as_earlier().believed.detection == SHARP  # nobody inspected with the new one
    earlier = replace(season.as_earlier(), until=on(-1))
    belief = replace(season.settings.belief, earlier=earlier)
    second = a_season(tmp_path / "second.gpkg", belief=belief)
    before, said = second.learnt(BEGINS), earlier_season_note(second)
    change(second, robot=Robot(hours=1.5, detection=0.4))
    second.record(seen(0))
    change(second, robot=ROBOT)
    assert earlier_season_note(second) == said
    assert second.history.first_morning.counts.found.any()
    assert second.learnt(BEGINS)[0].value < before[0].value
