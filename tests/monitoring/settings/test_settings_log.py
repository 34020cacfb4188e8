"""What was chosen, choice after choice; going back is a choice too."""

import pytest

from fieldmon.errors import SettingError
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import MonitoringSettings, as_json
from fieldmon.plot.local_clock import utc_text
from tests.monitoring.seasons import BEGINS, ROBOT

FIRST = as_json(MonitoringSettings(BEGINS, robot=ROBOT))
LONGER = as_json(MonitoringSettings(BEGINS, robot=ROBOT.with_hours(3.0)))
OTHER = as_json(MonitoringSettings(BEGINS, robot=ROBOT.with_hours(4.0), sampler="naive"))


def rows(db):
    return db.execute("SELECT count(*) FROM settings").fetchone()[0]


def test_what_was_written_last_counts_and_only_what_differs_is_written(db):
    settings_log.write(db, FIRST)
    assert (settings_log.now(db), rows(db)) == (FIRST, 6)
    settings_log.write(db, FIRST)
    assert rows(db) == 6
    settings_log.write(db, OTHER)
    assert (settings_log.now(db), rows(db)) == (OTHER, 8)


def test_a_change_of_two_parts_is_taken_back_as_one(db):
    settings_log.write(db, FIRST)
    settings_log.write(db, OTHER)
    assert settings_log.before_now(db) == FIRST
    assert as_json(settings_log.undo(db)) == FIRST
    assert settings_log.now(db) == FIRST


def test_changes_are_taken_back_one_by_one_until_there_is_none(db):
    for parts in (FIRST, LONGER, OTHER):
        settings_log.write(db, parts)
    assert as_json(settings_log.undo(db)) == LONGER
    assert as_json(settings_log.undo(db)) == FIRST
    assert settings_log.before_now(db) is None
    with pytest.raises(SettingError, match="there is none"):
        settings_log.undo(db)


def test_whoever_goes_back_by_hand_has_made_a_change_that_can_be_taken_back(db):
    harvest = {**FIRST, "season": as_json(MonitoringSettings(BEGINS, harvest=BEGINS))["season"]}
    back = {**harvest, "robot": LONGER["robot"]}
    for parts in (FIRST, harvest, back, harvest):
        settings_log.write(db, parts)
    assert as_json(settings_log.undo(db)) == back
    assert as_json(settings_log.undo(db)) == harvest
    assert as_json(settings_log.undo(db)) == FIRST
    assert settings_log.before_now(db) is None


def test_what_an_earlier_version_took_back_is_a_change_and_no_other_is_taken_back_for_it(db):
    for parts in (FIRST, OTHER, LONGER, OTHER):  # the last by an undo that nobody noted
        settings_log.write(db, parts)
    assert as_json(settings_log.undo(db)) == LONGER
    assert as_json(settings_log.undo(db)) == OTHER
    assert as_json(settings_log.undo(db)) == FIRST


def test_of_two_copies_each_takes_back_its_own_change(db):
    settings_log.write(db, FIRST)
    settings_log.write(db, LONGER)
    at = settings_log.all_moments(db)[-1]
    settings_log.write(db, {**LONGER, "sampler": OTHER["sampler"]})  # came from the other copy
    settings_log.write(db, {**FIRST, "sampler": OTHER["sampler"]}, undoes=at)
    assert as_json(settings_log.undo(db)) == FIRST
    assert settings_log.before_now(db) is None


def test_what_the_other_copy_changed_since_is_passed_over(db):
    settings_log.write(db, FIRST)
    settings_log.write(db, LONGER)
    at = settings_log.all_moments(db)[-1]
    settings_log.write(db, {**LONGER, "robot": OTHER["robot"]})
    settings_log.write(db, FIRST, undoes=at)
    assert settings_log.before_now(db) is None
    settings_log.write(db, {**FIRST, "sampler": OTHER["sampler"]})
    assert as_json(settings_log.undo(db)) == FIRST


def test_a_choice_that_is_taken_back_counts_as_never_made(db):
    pest = {**FIRST, "pest": '{"name": "mite"}'}
    for parts in (FIRST, LONGER, {**LONGER, "pest": pest["pest"]}):
        settings_log.write(db, parts)
    settings_log.undo(db)
    assert settings_log.before_now(db) == FIRST
    assert as_json(settings_log.undo(db)) == FIRST


def test_what_counted_at_a_moment_is_told(db):
    settings_log.write(db, FIRST)
    between = utc_text()
    settings_log.write(db, OTHER)
    assert settings_log.at(db, between) == FIRST
    assert settings_log.at(db, utc_text()) == OTHER
    assert settings_log.at(db, "2000-01-01T00:00:00.000000Z") == FIRST


def test_a_clock_that_is_set_back_leaves_no_half_of_the_settings(db):
    settings_log.write(db, FIRST)
    settings_log.write(db, LONGER)
    db.execute("UPDATE settings SET changed = '2026-04-06T06:00:00.000000Z' WHERE fid <= 6")
    db.execute("UPDATE settings SET changed = '2026-04-06T05:57:00.000000Z' WHERE fid > 6")
    assert len(settings_log.all_moments(db)) == 2
    for minute in (56, 58, 59):
        at = settings_log.at(db, f"2026-04-06T05:{minute}:00.000000Z")
        assert at == (FIRST if minute == 56 else LONGER)


def test_settings_are_found_again_by_when_each_part_was_chosen(db):
    settings_log.write(db, FIRST)
    first, moment = settings_log.marks(db), utc_text()
    settings_log.write(db, OTHER)
    assert settings_log.of(db, first) == FIRST
    assert settings_log.of(db, settings_log.marks(db)) == OTHER
    assert settings_log.marks(db, moment) == first
    assert settings_log.of(db, first | {"robot": "2000-01-01T00:00:00.000000Z"}) == {}
