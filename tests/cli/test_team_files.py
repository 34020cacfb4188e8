"""A team's season on the command line: one route file each, and several findings at once."""

from dataclasses import replace
from datetime import datetime, time
from pathlib import Path

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.cli.team_files import files_of_each, members_of, tell_member
from fieldmon.cli.worker_options import WorkerOptions
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings import settings_log
from fieldmon.planning.members import TeamMember
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot, scout
from tests.cli.estate import BEGINS, MITES, ZIP, filled_in


@pytest.fixture
def season(run, tmp_path):
    code, _, err, _ = run(
        *("init", "season.gpkg", ZIP, "--feature", "Nursery", "--records", MITES),
        *("--begins", BEGINS, "--hours", "0.5", "--robots", "2", "--contact", "10"),
    )
    assert code == 0, err
    return tmp_path / "season.gpkg"


def test_each_has_a_route_file_and_the_findings_of_both_are_recorded_at_once(run, season, tmp_path):
    assert Season(season).settings.teamwork.contact_s == 600.0
    code, out, err, files = run("plan", season, "--date", BEGINS, "-o", "r.csv")
    assert code == 0, err
    assert {file.name for file in files} == {"r-robot-1.csv", "r-robot-2.csv"}
    assert "robot-1: from 06:00" in out
    assert "no routes of these hours can expect more than" in out
    for k, finds in ((1, set()), (2, {0, 1})):
        filled_in(tmp_path / f"r-robot-{k}.csv", finds, n=5)
    code, out, err, _ = run("record", season, "r-robot-1.csv", "r-robot-2.csv", "--date", BEGINS)
    assert code == 0, err
    assert out.count("5 new, 0 known already") == 2
    done = Season(season).history.inspections
    assert [list(done.who).count(f"robot-{k}") for k in (1, 2)] == [5, 5]
    assert done.result[done.who == "robot-2"].sum() == 2
    code, out, err, files = run(
        "plan", season, "--no-bound", "--date", BEGINS, "-o", "rest.geojson"
    )
    assert code == 0, err
    assert f"{BEGINS}: 10 done" in out
    assert "robot-1: from 06:0" in out
    assert "no routes" not in out
    assert len(files) == 2


def test_what_one_did_who_left_the_team_is_done_all_the_same(run, season):
    kept = Season(season)
    day = np.datetime64(kept.settings.begins)
    for who, plants in (("robot-1", [3]), ("robot-2", [40, 41, 42])):
        kept.record(Inspections.of(np.array(plants), np.zeros(len(plants)), day), who, who)
    seen = kept.settings
    first = seen.team[0]
    kept.change(replace(seen, team=(first, TeamMember("Ann", first.robot))), seen)
    words = ("plan", season, "--date", BEGINS, "--no-bound", "--as-now")
    assert f"{BEGINS}: 4 done" in run(*words)[1]


def test_a_plant_of_which_two_said_otherwise_is_done_once(run, season):
    kept = Season(season)
    day = np.datetime64(kept.settings.begins)
    for who, results in (("robot-1", [0, 0]), ("robot-2", [1, 0])):
        kept.record(Inspections.of(np.array([3, 4]), np.array(results), day), who, who,
                    confirmed=True)  # fmt: skip
    words = ("plan", season, "--date", BEGINS, "--no-bound")
    assert f"{BEGINS}: 2 done" in run(*words)[1]
    run("change", season, "--robots", "1")
    assert f"{BEGINS}: 2 done, " in run(*words, "--as-now")[1]


def test_who_is_too_wide_for_a_plot_is_named_where_a_season_has_them_already(run, season):
    kept = Season(season)
    first = kept.settings
    wide = TeamMember("Ben", replace(first.robot, width_m=9.0))
    with kept.store.writing() as db:  # as a season of an earlier version may
        settings_log.change(db, replace(first, team=(first.team[0], wide)))
    code, _, err, made = run("plan", season, "--no-bound", "--date", BEGINS)
    assert (code, made) == (2, set())
    assert "Ben: A robot's aisles must be as wide as it is" in err
    assert f"Give the team anew with: fieldmon change {season} --robots TEAM.csv" in err
    with pytest.raises(SettingError, match=r"^Ben: "):
        Season(season).plan_each(first.begins)


def test_a_season_goes_on_with_another_team(run, season, tmp_path):
    (tmp_path / "team.csv").write_text("name,who,start\nwheels,robot,05:30\nAnn,scout,06:15\n")
    code, _, err, _ = run("change", season, "--robots", "team.csv")
    assert code == 0, err
    code, out, err, _ = run("plan", season, "--date", BEGINS, "--no-bound")
    assert code == 0, err
    assert "wheels: from 05:30" in out
    assert "Ann: from 06:15" in out
    run("change", season, "--robots", "1")
    code, out, err, files = run("plan", season, "--date", BEGINS, "--no-bound")
    assert code == 0, err
    assert [file.name for file in files] == ["route.geojson"]


def test_a_team_without_time_to_reach_a_plant_is_told_so(run, season):
    code, _, err, files = run("plan", season, "--no-bound", "--date", BEGINS, "--now", "23:00")
    assert code == 2
    assert "nobody has" in err
    assert not files


def members(tmp_path, text):
    (tmp_path / "team.csv").write_text(text)
    return members_of(str(tmp_path / "team.csv"), time(6), WorkerOptions())[0]


def test_each_of_a_table_has_its_own_width_and_the_rest_is_usual(tmp_path, capsys):
    wide, usual = members(tmp_path, "name,width_m,length_m\nwide,1.4,2\nusual,,\n")
    assert (wide.robot.width_m, wide.robot.length_m) == (1.4, 2.0)
    assert usual.robot == Robot()
    assert "wide, robot, 12 h, 1.4 m wide; usual, robot, 12 h." in capsys.readouterr().err


def test_a_robot_of_a_table_is_one_though_the_seasons_work_with_scouts(tmp_path, capsys):
    (tmp_path / "team.csv").write_text("name,who,hours\nR,robot,12\nS,scout,\nU,,\n")
    told = str(tmp_path / "team.csv"), time(6)
    for worker, usual in ((WorkerOptions(), scout()), (WorkerOptions(scout=True), None)):
        made, _ = members_of(*told, worker, usual)
        assert [one.robot for one in made] == [Robot(hours=12), scout(), scout()]
        assert "R, robot, 12 h; S, scout, 4 h; U, scout, 4 h." in capsys.readouterr().err


def test_a_scout_of_a_table_walks_whatever_a_stop_takes(tmp_path):
    (ann,) = members(tmp_path, "name,who,stop_s\nAnn,scout,8\n")
    assert ann.robot == scout(stop_s=8.0)
    assert ann.robot.on_foot


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name,start\na,\nb,25:00\n", "line 3: start must be a time as HH:MM, but it is '25:00'"),
        ("name,start\na,6.30\n", "line 2: start must be a time as HH:MM, but it is '6.30'"),
        ("name\nAnn\nb\n ann\n", "line 4: members of .* but ann is that of .*csv, line 2 too"),
        ("name,length_m\na,2\n", "line 2: A robot whose length is known must have a width too"),
    ],
)
def test_what_is_wrong_in_a_table_is_said_with_file_and_line(tmp_path, text, said):
    with pytest.raises(SettingError, match=f"team.csv, {said}"):
        members(tmp_path, text)


def test_a_file_is_named_as_any_other_of_a_name():
    ((path,), _) = files_of_each([Path("r.csv")], (TeamMember("Ann / 2"), TeamMember("מטע" * 60)))
    assert path == Path("r-Ann___2.csv")
    (_, (long,)) = files_of_each([Path("r.csv")], (TeamMember("Ann"), TeamMember("מטע" * 60)))
    assert len(long.name.encode()) == 126, "a longer one may be no file's"


def test_names_that_are_one_in_file_names_are_refused():
    with pytest.raises(SettingError, match="differ in file names"):
        files_of_each(None, (TeamMember("a b"), TeamMember("A/b")))


@pytest.mark.parametrize(("faces", "stops"), [(1, "2 plants"), (2, "2 faces")])
def test_of_each_it_is_said_where_its_way_leaves_the_plot(faces, stops, capsys):
    field = Field("home", MultiPolygon([box(35.15, 30.36, 35.151, 30.361)]), row_bearing_deg=90.0)

    class Leaving(list):
        aisles = Plot.of(field, Planting(faces=faces)).aisles
        expected_finds, end_s, drive_m = 1.0, 3600.0, 500.0
        ways_said = ("5 m of the way lie outside.", "The body reaches over.")

    tell_member("Ann", datetime(2026, 11, 18, 6), Leaving([1, 2]))
    first, *said = capsys.readouterr().out.splitlines()
    assert first.startswith(f"Ann: from 06:00, {stops} in 1.0 h, 0.50 km")
    assert said == [f"Ann: {one}" for one in Leaving.ways_said]
