"""A season's team that is driven: its robots, their files, who is left out."""

import pytest

from fieldmon.drive.day import DrivenDay, DrivenStop
from fieldmon.drive.errand import Visit
from tests.cli.estate import BEGINS, table


def test_a_team_is_driven_by_its_robots_and_not_by_one_that_is_made_up(run, season):
    run("change", season, "--robots", "2")
    kept = season.read_bytes()
    code, _, err, _ = run("drive", season, "--date", BEGINS, "--made-up")
    assert code == 2
    assert "Give --robot vda5050" in err
    assert season.read_bytes() == kept


def test_a_teams_robots_have_their_own_serial_numbers_and_none_is_given(run, season):
    run("change", season, "--robots", "2")
    words = ("--robot", "vda5050", "--serial", "A", "--broker", "127.0.0.1:1")
    code, _, err, _ = run("drive", season, "--date", BEGINS, *words)
    assert code == 2
    assert "names as serial numbers (robot-1, robot-2), but --serial was given too" in err


@pytest.mark.parametrize("stops", [0, 1, 2])
def test_a_team_that_breaks_off_writes_the_tables_of_those_that_drove(
    run, season, tmp_path, monkeypatch, stops
):
    def drive_team(day, *told):
        stop, day.stops = day.member("robot-1").ask(), stops
        driven = DrivenDay([DrivenStop(stop, Visit(found=False), 40.0, 40.0)])
        told[-1].update({"robot-1": driven, "robot-2": DrivenDay(broken="It has no order.")})
        if stops > 1:
            raise KeyboardInterrupt
        return told[-1]

    monkeypatch.setattr("fieldmon.drive.vda5050.team.drive_team", drive_team)
    run("change", season, "--robots", "2")
    words = ("--date", BEGINS, "--robot", "vda5050", "-o", "day.csv")
    code, out, err, made = run("drive", season, *words)
    assert code == (130 if stops else 2), err
    assert "nothing was written" not in err
    assert ("It has no order." in err) == (not stops)
    wanted = {f"day-robot-{n}{end}" for n in (1, 2) for end in (".csv", ".stops.csv")}
    assert {one.name for one in made} == wanted  # also of who came to no plant, as of one robot
    assert [table(tmp_path / f"day-robot-{n}.csv")[0]["stops"] for n in (1, 2)] == ["1", "0"]
    assert (f"0 results of {BEGINS} in the season" in out) == bool(stops)


def test_a_team_of_scouts_has_nobody_who_drives(run, season, tmp_path):
    (tmp_path / "team.csv").write_text("name,who\nAnn,scout\nDan,scout\n")
    run("change", season, "--robots", "team.csv")
    code, _, err, _ = run("drive", season, "--date", BEGINS, "--robot", "vda5050")
    assert code == 2
    assert "driven by robots, but the team has none: Ann, Dan." in err
