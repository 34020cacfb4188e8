"""`fieldmon plan --robots`: a file for each of a team."""

import json

import pytest

from tests.cli.estate import ZIP

NURSERY = ("plan", ZIP, "--feature", "Nursery", "--date", "2026-11-18")


def routes(paths):
    """Return the summary and the stops of each file."""
    read = [json.loads(path.read_text(encoding="utf-8"))["features"] for path in paths]
    return [(line["properties"], [one["properties"] for one in stops]) for line, *stops in read]


def test_two_robots_have_a_file_each_and_no_plant_in_both(run, tmp_path):
    code, out, err, made = run(*NURSERY, "--robots", 2, "--hours", 0.5, "-o", "day.geojson")
    assert code == 0, err
    assert made == {tmp_path / "day-robot-1.geojson", tmp_path / "day-robot-2.geojson"}
    first, second = routes(sorted(made))
    assert (first[0]["who"], second[0]["who"]) == ("robot-1", "robot-2")
    assert not {one["plant"] for one in first[1]} & {one["plant"] for one in second[1]}
    assert "robot-1: from 06:00, " in out
    assert "finds expected; no routes of these hours can expect more" in out


def test_a_table_says_who_works_from_when_and_where(run, tmp_path):
    (tmp_path / "team.csv").write_text(
        "name;who;hours;speed_km_h;look_s;start;lon;lat\n"
        "Rover 1;robot;0,5;3;20;06:30;;\n"
        "Ann;scout;1;;;07:00;35.1529;30.3525\n"
    )
    words = ("--robots", "team.csv", "--no-bound", "-o", "a.geojson", "-o", "a.csv")
    code, out, err, made = run(*NURSERY, *words)
    assert code == 0, err
    names = {f"a-{name}.{ending}" for name in ("Rover_1", "Ann") for ending in ("geojson", "csv")}
    assert {path.name for path in made} == names
    rover, ann = routes([tmp_path / "a-Rover_1.geojson", tmp_path / "a-Ann.geojson"])
    assert rover[0]["start"] == "2026-11-18T06:30:00"
    assert ann[0]["start"] >= "2026-11-18T07:00:00"
    assert rover[0]["seconds"] <= 1800
    assert {one["inspect_s"] for one in rover[1]} == {20 + 1.13}
    assert "Ann: from 07:" in out


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("who\nrobot\n", "must have a column name"),
        ("name,size\na,1\n", "of others only who"),
        ("name,who\na,dog\n", "line 2: who must be robot or scout"),
        ("name,hours\na,long\n", "line 2: hours must be a number"),
        ("name,lon\na,35\n", "must have lon and lat"),
        ("name\n", "must name a member"),
        ("name,who\n,robot\n", "every member must have a name"),
        ("name,start\na,six\n", "start must be a time as HH:MM"),
        ("name\na b\na-b\na_b\n", "must have names that differ in file names"),
        ("name,hours\na,30\n", "line 2: hours must be 24 at most"),
        ("name,lon,lat\na,35.5,30.35\n", "a: The gate at 35.5, 30.35 (longitude, latitude) lies 3"),
        ("name,speed_km_h\na,-1\n", "line 2: speed_km_h must be above 0, but it is -1"),
    ],
)
def test_a_table_that_makes_no_team_is_a_sentence(run, tmp_path, table, says):
    (tmp_path / "team.csv").write_text(table)
    code, _, err, made = run(*NURSERY, "--robots", "team.csv")
    assert (code, made) == (2, set())
    assert says in err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--robots", 2, "--sampler", "naive"), "leave out --sampler"),
        (("--robots", 2, "--all"), "leave out --all"),
        (("--robots", 0), "1 member or more"),
        (("--robots", 10**30), "1000 members at most"),
        (("--robots", "nobody.csv"), "but there is none. Check the name."),
    ],
)
def test_what_does_not_go_with_a_team_is_a_sentence(run, words, says):
    code, _, err, made = run(*NURSERY, *words)
    assert (code, made) == (2, set())
    assert says in err


def test_a_season_keeps_who_works(run, season):
    code, _, err, _ = run("plan", season, "--robots", 2)
    assert code == 2
    assert "Change it with: fieldmon change --robots" in err


def test_one_alone_needs_no_room_to_pass_another(run):
    code, _, err, _ = run(*NURSERY, "--passing", 5)
    assert code == 2
    assert "--passing goes with --robots" in err
