"""Season files made by earlier versions open, say what they said, and know their findings again.

They were made by version 0.1 on a plot of 30 plants (then packed by SQLite's VACUUM, no row
changed): planned, recorded, undone, treated, changed. Beside each lies what ``fieldmon status
--rows --batches --date 2026-04-09`` said of it, and the files that were recorded.
"""

import re
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import date, datetime
from pathlib import Path

import numpy as np
import pytest

from fieldmon.cli.main import app as command
from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes.earlier_settings import before_change, settings_on
from fieldmon.monitoring.days.kept_routes import planned_only
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.plot.local_clock import local_clock

FOLDER = Path(__file__).with_name("seasons_of_old")
LAST = date(2026, 4, 9)
UTC_TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d")
# season, file, day of findings whose file names none, inspections known again, and those undone
RECORDED = [
    ("adaptive", "monday", "2026-04-06", 8, 1),
    ("adaptive", "tuesday", "2026-04-07", 8, 0),
    ("both_faces_flagged", "monday", "2026-04-06", 12, 0),
]


@pytest.fixture(params=["adaptive", "both_faces_flagged"])
def season(request, tmp_path):
    return Season(shutil.copy(FOLDER / f"{request.param}.gpkg", tmp_path))


def test_a_season_says_what_it_said(season, capsys):
    asked = ["status", str(season.path), "--rows", "--batches", "--date", str(LAST)]
    command(asked, standalone_mode=False)
    done = capsys.readouterr()
    # and besides, what none could know otherwise then or was not foretold
    said = done.out.splitlines(keepends=True)
    unsaid = "  harvest                From when", "  warning                How long to wait"
    news = "  finds are traced       to neighbours", "  forecast ", "  could not be inspected "
    for new in (*news, *unsaid):
        since = [line for line in said if line.startswith(new)]
        assert len(since) == 1
        said.remove(since[0])
    how = "Say it as its label does: fieldmon labels", "It names no product: fieldmon undo"
    since = [line for line in said if any(one in line for one in how)]
    assert len(since) == 1
    said.remove(since[0])
    flagged = ("were found and only flagged.",)
    planned = "  planned, not recorded  2026-04-09", "  Record it; if nobody went, record one stop"
    for new, there in (
        (flagged, "flagged" in season.path.stem),
        (planned, LAST in planned_only(season, LAST)),
    ):
        since = [line for line in said if any(one in line for one in new)]
        assert len(since) == len(new) * there
        said = [line for line in said if line not in since]
    # recorded when, by the clock of the plot instead of UTC, and with what
    told = (FOLDER / f"{season.path.stem}.status.txt").read_text("utf-8")
    told = told.replace("  expected still there   ", "  still infested         ")
    if "flagged" in season.path.stem:  # it left out what was found
        was, now = (next(one for one in of if "it is clean" in one)
                    for of in (told.splitlines(keepends=True), said))  # fmt: skip
        assert float(now.split()[-2]) < float(was.split()[-2])
        told = told.replace(was, now)
        was, now = (next(one for one in of if "still infested  " in one)
                    for of in (told.splitlines(keepends=True), said))  # fmt: skip
        assert "  0.9 (0 to 4 with" in was
        assert "about 0.9 (0 to 4) are not found yet, and 0.3 were found" in done.out
        assert "  1.2 (0 to 4 with" in now
        told = told.replace(was, now)
    clock = local_clock(season.plot.field)
    told = UTC_TIME.sub(
        lambda at: f"{clock.at(datetime.fromisoformat(f'{at[0]}Z')):%F %H:%M}", told
    )
    told = re.sub(r"\b1 days ago", "1 day ago", told)
    # the share found, by its name, with its interval instead of a tenth that nobody knows
    share = r"(?:found of all|share found) +([\d.]+) %.*"
    told, now = (
        re.sub(share, lambda at: f"share found {float(at[1]):.0f} %", text)
        for text in (told, "".join(said))
    )
    more = r"(findings.*?|treatment.*?)  ((?:\d+ counts?, )?\d+ found|\d+ plants, [\d-]+)"
    more += r"(?:, inspected [\d-]+)?"
    # of which days the records are, which no file of before was asked
    now = re.sub(r" +Chances and hot spots begin with .*\n", "", now)
    assert re.sub(more, r"\1", now) == told
    assert "doubtful" not in done.err


def test_its_mornings_come_out_as_they_were_kept(season):
    assert season.verify() == ()
    season.store.check()


@pytest.mark.parametrize(("name", "file", "day", "known", "undone"), RECORDED)
def test_what_was_recorded_then_is_known_now(tmp_path, name, file, day, known, undone):
    season = Season(shutil.copy(FOLDER / f"{name}.gpkg", tmp_path))
    options = InspectionOptions(day=np.datetime64(day))
    read = read_inspections(FOLDER / f"{name}.{file}.csv", season.plot.grid, options)
    again = season.record(read.value, "again")
    assert (again.known, again.new) == (known, undone)


def test_the_last_route_is_planned_again_as_it_was(tmp_path):
    season = Season(shutil.copy(FOLDER / "adaptive.gpkg", tmp_path))
    count = "SELECT count(*) FROM routes"
    with season.store.reading() as db:
        before = db.execute(count).fetchone()
    assert np.array_equal(season.plan(LAST).route.plant, season.kept_route(LAST))
    with season.store.reading() as db:  # the same route, by its digest, is not kept twice
        assert db.execute(count).fetchone() == before


def test_a_day_goes_on_from_there(season):
    today = season.plan(LAST)
    before = season.evening(LAST)
    first = today.route.plant[:3]
    season.record(Inspections.of(first, np.full(3, CLEAN), LAST), "today")
    assert (season.evening(LAST)[first] < before[first]).all()
    assert "3 inspections from today" in season.undo()
    np.testing.assert_array_equal(season.evening(LAST), before)


def test_changes_of_then_are_taken_back_now(tmp_path):
    season = Season(shutil.copy(FOLDER / "adaptive.gpkg", tmp_path))
    assert (season.settings.sampler, season.settings.robot.hours) == ("naive", 0.4)
    assert season.undo_change().sampler == "adaptive"
    flagged = Season(shutil.copy(FOLDER / "both_faces_flagged.gpkg", tmp_path))
    assert not flagged.settings.belief.treated
    # taken back then, which nobody noted: a change as any other, whose taking back makes it anew
    assert flagged.settings.starts.hour == 6
    assert flagged.undo_change().starts.hour == 7
    assert flagged.undo_change().starts.hour == 6
    assert before_change(flagged) is None


def test_a_season_of_format_6_keeps_its_treatments_and_its_log_begins(tmp_path):
    """Made before applications and the log were known: two treatments, one of them undone."""
    season = Season(shutil.copy(FOLDER / "of_format_6.gpkg", tmp_path))
    assert (tmp_path / "of_format_6.gpkg.format-6").is_file()
    (soap,) = season.treatments()
    assert (soap.application.product, soap.efficacy, soap.place.area_ha) == ("soap", 0.8, None)
    assert soap.application.dose is None
    assert season.history.treatments[0].plants.sum() == soap.place.plants.sum() > 0
    (began,) = season.log()
    assert "the file was of format 6" in began.sentence()
    _only_the_map_differs(season, "2026-04-09")
    assert season.treat(soap.on, 0.8, soap.place.area, "soap").new == 0  # by the digest of then
    (effect,) = season.effects(last_date(season))
    assert (effect.before.found, effect.after.found) == (2, 0)
    assert season.undo() != ""
    assert check_against_log(season) == ()


def test_a_season_of_format_8_keeps_its_treatment_and_can_say_more_of_the_next(tmp_path):
    """Made before active ingredient and weather were asked for: its log still holds."""
    season = Season(shutil.copy(FOLDER / "of_format_8.gpkg", tmp_path))
    assert (tmp_path / "of_format_8.gpkg.format-8").is_file()
    assert check_against_log(season) == ()
    (one,) = season.treatments()
    assert one.application.authorised_by == "Ben"
    assert (one.application.active_ingredient, one.application.weather) == ("", "")
    assert season.treat(one.on, 0.8, one.place.area, application=one.application).new == 0
    more = replace(one.application, active_ingredient="fenpyroximate", weather="dry, 2 m/s")
    assert season.treat(LAST, 0.8, one.place.area, application=more).new == 1
    assert season.treatments()[-1].application == more
    assert check_against_log(season) == ()
    _only_the_map_differs(season, "2026-04-07")


def test_a_season_of_format_11_holds_and_knows_its_treatments_again(tmp_path):
    """Made before it was noted what a label adds: to Acarol 7 days; of soap 3 were said."""
    season = Season(shutil.copy(FOLDER / "of_format_11.gpkg", tmp_path))
    assert (tmp_path / "of_format_11.gpkg.format-11").is_file()
    assert season.verify() == ()
    acarol, soap = season.treatments()
    assert (acarol.application.waiting_days, soap.application.waiting_days) == (7, 3)
    plain = replace(acarol.application, waiting_days=None, reentry_hours=None)
    for one, said in ((acarol, plain), (acarol, acarol.application), (soap, soap.application)):
        assert season.treat(one.on, one.efficacy, application=said).known == 1
    assert season.treat(LAST, 0.8, application=plain).new == 1
    with season.store.reading() as db:
        noted = db.execute("SELECT by_label FROM treatments ORDER BY fid").fetchall()
    assert noted == [(None,), (None,), ("waiting_days+reentry_hours",)]
    assert season.verify() == ()


def test_a_season_of_format_12_is_read_as_before_and_takes_what_is_said_from_now_on(tmp_path):
    """Made before inspections said what they find: 40 s a plant, then 25 s, and a correction."""
    path = Path(shutil.copy(FOLDER / "of_format_12.gpkg", tmp_path))
    season = Season(path)
    assert (tmp_path / "of_format_12.gpkg.format-12").is_file()
    assert season.verify() == ()
    assert season.history.detections.tolist() == [0.84] * 20 + [0.6] * 12
    assert np.isnan(season.inspections.detects).all()
    assert "1 correction" in season.undo(3)
    more = Inspections.of(np.array([80]), np.array([CLEAN]), LAST, detects=np.array([0.3]))
    season.record(more, "rex.geojson")
    assert Season(season.path).history.detections[-1] == 0.3
    assert season.verify() == ()


def test_what_another_program_changed_in_a_season_of_format_12_can_be_corrected(tmp_path):
    path = Path(shutil.copy(FOLDER / "of_format_12.gpkg", tmp_path))
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE inspections SET result = 'found' WHERE fid = 20")
        db.commit()
    season = Season(path)
    assert season.correct("Ann") == 1
    assert season.history.detections.tolist() == [0.84] * 20 + [0.6] * 12
    assert "1 correction" in season.undo()


def test_in_a_season_of_format_13_what_was_taken_back_is_a_change_that_can_be_taken_back(tmp_path):
    """Made before a taking back was noted: harvest said, then 4 hours said and taken back."""
    season = Season(shutil.copy(FOLDER / "of_format_13.gpkg", tmp_path))
    assert (tmp_path / "of_format_13.gpkg.format-13").is_file()
    assert check_against_log(season) == ()
    seen = season.settings
    assert (seen.robot.hours, seen.harvest) == (1.5, date(2026, 5, 6))
    season.change(replace(seen, robot=seen.robot.with_hours(3.0)), seen)
    assert season.undo_change() == seen
    again = season.undo_change()
    assert (again.robot.hours, again.harvest) == (4.0, seen.harvest)
    assert season.undo_change() == seen
    assert season.undo_change().harvest is None
    assert before_change(season) is None
    assert check_against_log(season) == ()


def test_a_season_of_format_14_shows_what_both_noted_of_one_find(tmp_path):
    """Made of Ada's and Bob's copies, each with a note on the same find: hers alone was shown."""
    season = Season(shutil.copy(FOLDER / "of_format_14.gpkg", tmp_path))
    assert (tmp_path / "of_format_14.gpkg.format-14").is_file()
    told = season.inspections
    assert list(zip(told.who, told.notes, strict=True)) == [
        ("Ada", "webs; eggs too (Bob)"), ("Ada", ""),
    ]  # fmt: skip
    # nothing else comes out otherwise than it did
    last = season.days()[-1]
    assert (last.expected, last.low, last.high) == (10.256884232151428, 2, 33)
    assert season.verify() == ()
    season.undo(2)
    assert season.inspections.notes.tolist() == ["webs", ""]


def test_in_a_season_of_format_15_those_walk_who_are_charged_a_scouts_times(tmp_path):
    """Made before it was said who walks: a scout, and a team of whom one stops for 8 s."""
    season = Season(shutil.copy(FOLDER / "of_format_15.gpkg", tmp_path))
    assert (tmp_path / "of_format_15.gpkg.format-15").is_file()
    assert season.verify() == check_against_log(season) == ()
    seen = season.settings
    told = {one.name: one.robot for one in seen.team} | {"": seen.robot}
    assert [name for name, robot in told.items() if robot.on_foot] == ["Ada", ""]
    season.change(seen, seen)
    assert season.log()[-1].what["names"] == ""  # what is not said is written as it was
    bob = replace(seen.team[1], robot=replace(told["Bob"], on_foot=True))
    season.change(replace(seen, team=(seen.team[0], bob)), seen)
    walks = Season(season.path).settings.team[1].robot
    assert (walks.on_foot, walks.stop_s) == (True, 8.0)
    assert "Bob 1 h, 30 s a plant, 4 km/h, finds 69 %, " in (said := season.log()[-1].what["said"])
    assert "on foot yes" in said
    assert season.undo_change() == seen


def _only_the_map_differs(season, day):
    """Hold that a map that learns comes out as it learns now, that this is said, and no more."""
    (said,) = season.verify()
    assert said.startswith(f"The chance map of {day} comes out differently")
    assert "it was made by another version of fieldmon" in said


def test_a_change_of_today_alters_no_day_from_before_the_log(season):
    days = [*dict.fromkeys(season.history.inspections.date.tolist())]
    before, seen = [settings_on(season, day).robot for day in days], season.settings
    season.change(replace(seen, robot=seen.robot.with_hours(9.0)), seen)
    assert [settings_on(season, day).robot for day in days] == before
    assert all(robot.hours < 9.0 for robot in before)
    changed = season.log()[-1]
    assert (changed.kind, changed.what["names"]) == ("changed", "robot")
    assert changed.what["said"].startswith("hours ")
    assert ";" not in changed.what["said"]
