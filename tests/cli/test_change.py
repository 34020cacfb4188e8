"""`fieldmon change`: a season goes on otherwise."""

from datetime import timedelta

import numpy as np
import pytest

from fieldmon.cli.status import lines
from fieldmon.compute.wording import estimate
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.figures_of_day import flagged, still_infested
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from tests.cli.estate import ZIP
from tests.monitoring.seasons import a_season


def test_choices_can_be_changed(run, season):
    code, _, err, _ = run("change", season, "--sampler", "snake", "--every", 2, "--hours", "0.5")
    assert code == 0, err
    settings = Season(season).settings
    assert (settings.sampler, settings.sampler_settings, settings.robot.hours) == (
        "snake",
        {"every": 2},
        0.5,
    )
    assert "Nothing" in run("change", season)[1]
    code, out, err, _ = run("undo", season, "--change")
    assert code == 0, err
    said = "sampler snake 2 (now adaptive again), hours 0.5 (now 1 again)"
    assert out == f"The last change was taken back: {said}.\n"
    assert Season(season).settings.robot.hours == 1.0
    code, _, err, _ = run("undo", season, "--change")
    assert (code, "there is none" in err) == (2, True)


def test_a_season_is_charged_the_times_that_are_chosen(run, season):
    assert Season(season).settings.robot.times == "measured"
    code, _, err, _ = run("change", season, "--robot-times", "thesis")
    assert code == 0, err
    assert Season(season).settings.robot.times == "thesis"


def test_a_season_gets_a_robot_of_another_size_and_it_is_said_when_it_is_taken_back(run, season):
    size = ("--width", 0.9, "--length", 1.4, "--turning-radius", 1.9)
    code, _, err, _ = run("change", season, *size)
    assert code == 0, err
    robot = Season(season).settings.robot
    assert (robot.width_m, robot.length_m, robot.turning_radius_m) == (0.9, 1.4, 1.9)
    out = run("undo", season, "--change")[1]
    assert "width 0.9 m (now none again)" in out
    assert "turning radius 1.9 m (now none again)" in out
    code, _, err, _ = run("change", season, "--turning-radius", 1.9)
    assert (code, "must have a width too" in err) == (2, True)


def test_finds_are_traced_or_not_as_is_chosen(run, season):
    assert Season(season).settings.belief.traces
    code, _, err, _ = run("change", season, "--no-trace", "--spread", "0.03")
    assert code == 0, err
    kept = Season(season)
    assert not kept.settings.belief.traces
    assert kept.settings.belief.spread.rate_per_day == 0.03
    said = "\n".join(lines(kept, kept.status(last_date(kept))))
    assert "to neighbours only" in said
    assert "detection" not in said


def test_a_change_says_that_days_with_results_go_on_as_before_and_how_they_do_not(run, season):
    assert run("change", season, "--robots", "2")[1].count("\n") == 1
    kept = Season(season)
    on = kept.settings.begins + timedelta(days=3)
    kept.record(Inspections.of(np.array([4]), np.array([0]), np.datetime64(on)), "x")
    out = run("change", season, "--robots", "3")[1]
    assert f"\n{on} and days before it go on by what counted then" in out
    assert "fieldmon plan --as-now --date DAY" in out
    plan = ("plan", season, "--date", on, "--no-bound", "-o", "r.csv")
    assert "counted then" in run(*plan)[2]
    assert "robot-3" in run(*plan, "--as-now")[1]
    assert "go on" not in run("change", season, "--robots", "2")[1]


def test_a_change_that_reaches_into_the_past_says_what_it_makes_of_the_last_day(run, season):
    on = last_date(Season(season)) + timedelta(days=2)
    Season(season).plan(on)
    before = Season(season).status(on).estimate
    out = run("change", season, "--spread", "0.1")[1]
    after = Season(season).status(on).estimate
    assert f"after {on} {estimate(after.expected)} ({after.low:,} to {after.high:,})" in out
    assert f"it was {estimate(before.expected)} ({before.low:,} to {before.high:,})." in out
    assert f"it was {estimate(after.expected)}" in run("undo", season, "--change")[1]
    assert "past" not in run("change", season, "--look", "20")[1]
    assert "past" not in run("change", season, "--robots", "2", "--start", "07:00")[1]


def test_what_is_said_of_everybody_is_refused_where_members_of_a_team_differ(run, season, tmp_path):
    team = tmp_path / "team.csv"
    team.write_text("name,who,hours,detection\nR1,robot,3,\nAnn,scout,2,0.6\n")
    assert run("change", season, "--robots", team)[0] == 0
    for said in (("--hours", "5"), ("--look", "30"), ("--robot-times", "thesis")):
        code, _, err, _ = run("change", season, *said)
        assert (code, "team is R1 3 h, 40 s a plant" in err, "--robots TEAM.csv" in err) == (
            2,
            1,
            1,
        )
    assert [one.robot.hours for one in Season(season).settings.team] == [3.0, 2.0]
    assert run("change", season, "--start", "07:00")[0] == 0
    # what the table leaves open is as told beside it
    team.write_text("name,who,hours\nR1,scout,3\nR2\n")
    _, _, err, _ = run("change", season, "--robots", team, "--hours", "5")
    assert "seen: The team is R1, scout, 3 h; R2, robot, 5 h." in err
    assert [one.robot.hours for one in Season(season).settings.team] == [3.0, 5.0]


def test_what_is_said_of_a_team_of_a_kind_is_said_of_each_by_name(run, season):
    run("change", season, "--robots", "2")
    out = run("change", season, "--hours", "5", "--look", "30")[1]
    assert "Changed for robot-1, robot-2;" in out
    assert {one.robot.hours for one in Season(season).settings.team} == {5.0}
    assert run("change", season, "--robots", "1")[1].startswith("Changed;")


def test_seconds_do_not_go_with_a_detection_that_a_table_gives(run, season, tmp_path):
    team = tmp_path / "team.csv"
    team.write_text("name,who,detection\nAnn,scout,0.6\nBen,scout,0.6\n")
    run("change", season, "--robots", team)
    assert "finds 60 %" in run("change", season, "--look", "30")[2]
    assert run("change", season, "--hours", "3")[0] == 0


def test_whether_finds_are_treated_or_only_flagged_is_chosen(run, season):
    for option, treated in (("--flag-only", False), ("--treat-finds", True)):
        code, _, err, _ = run("change", season, option)
        assert code == 0, err
        assert Season(season).settings.belief.treated is treated


def test_what_finds_become_is_told_of_all_that_are_infested_before_and_after(run, tmp_path):
    kept = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    on = kept.settings.begins
    kept.record(Inspections.of(np.arange(20), np.ones(20, int), np.datetime64(on)), "x")
    before = still_infested(kept, on)
    assert before.low >= 20
    assert flagged(kept, on) > 19
    out = run("change", kept.path, "--treat-finds")[1]
    after = still_infested(kept, on)
    # of the rest the number may go either way, as who infested whom is drawn anew
    assert flagged(kept, on) == 0
    assert f"after {on} {estimate(after.expected)} ({after.low:,} to {after.high:,})" in out
    assert f"it was {estimate(before.expected)} ({before.low:,} to {before.high:,})." in out


def test_what_is_usual_where_nothing_is_known_is_told_when_a_season_begins_and_later(run, tmp_path):
    begun = run("init", "s.gpkg", ZIP, "--feature", "Nursery", "--background", "0.03")
    assert begun[0] == 0, begun[2]
    expected = [Season(tmp_path / "s.gpkg").morning(Season(tmp_path / "s.gpkg").settings.begins)]
    code, out, err, _ = run("change", "s.gpkg", "--background", "0.01")
    assert (code, "Days past are worked out anew" in out) == (0, True), err
    season = Season(tmp_path / "s.gpkg")
    expected.append(season.morning(season.settings.begins))
    # the edge adds some everywhere
    assert expected[0].min() - expected[1].min() == pytest.approx(0.02, rel=0.02)
    told = run("plan", ZIP, "--feature", "Nursery", "--background", "0.03", "-o", "r.gpx")[2]
    usual = run("plan", ZIP, "--feature", "Nursery", "-o", "r.gpx")[2]
    assert ("nothing is known" in told, "nothing is known" in usual) == (False, True)
    code, _, err, _ = run("plan", "s.gpkg", "--background", "0.03", "-o", "r.csv")
    assert (code, "--background goes with a plot file" in err) == (2, True)
