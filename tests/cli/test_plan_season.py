"""`fieldmon plan` with a season: from plan to status, and again."""

import csv
import errno
import json
import os
from datetime import date, time, timedelta

import numpy as np
import pytest

from fieldmon.compute.wording import written
from fieldmon.errors import ImportDoubt
from fieldmon.infestation.inspections import FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days import kept_routes
from fieldmon.monitoring.days.day_ahead import WorkPart, route_ahead, work_hours
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.treating.applications import Application
from fieldmon.reports.day import DayFacts
from tests.cli.estate import BEGINS, ZIP, filled_in


def test_a_day_from_plan_to_status(run, season, tmp_path):
    code, out, err, made = run("plan", season, "--date", BEGINS, "-o", "r.csv", "-o", "r.geojson")
    assert code == 0, err
    assert {path.name for path in made} == {"r.csv", "r.geojson"}
    plants = filled_in(tmp_path / "r.csv", finds={1, 4}, n=10)
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS, "--who", "Ann")
    assert code == 0, err
    assert "10 new, 0 known" in out
    assert "2 found infested" in out
    code, out, _, _ = run("record", season, "r.csv", "--date", BEGINS, "--who", "Ben")
    assert "0 new, 10 known" in out
    history = Season(season).history
    assert sorted(history.inspections.plant) == sorted(plants)
    assert np.count_nonzero(history.inspections.result == FOUND) == 2
    code, out, _, _ = run("status", season, "--batches", "--rows")
    assert "r.csv" in out
    assert "10 findings by Ann  r.csv  2 found" in out
    assert "never" in out
    assert "chance it is clean" in out


def test_a_sheet_to_print_is_in_the_language_of_the_season(run, season, tmp_path):
    assert run("change", season, "--language", "es")[0] == 0
    code, _, err, _ = run("plan", season, "--no-bound", "--date", BEGINS, "-o", "sheet.html")
    assert code == 0, err
    sheet = (tmp_path / "sheet.html").read_text()
    assert '<html lang="es" dir="ltr"' in sheet
    assert "<th>hilera</th>" in sheet


def test_where_a_route_cannot_be_written_it_is_said_that_the_season_has_the_plan(
    run, season, monkeypatch
):
    sync, left = os.fsync, iter([True])

    def full(file):
        if not next(left, False):
            raise OSError(errno.ENOSPC, "No space left on device")
        sync(file)

    monkeypatch.setattr(os, "fsync", full)
    words = "--date", BEGINS, "--no-bound", "-o", "a.csv", "-o", "b.geojson"
    code, out, err, made = run("plan", season, *words)
    assert code == 2
    assert {path.name for path in made} == {"a.csv"}
    assert "Route written to a.csv" in out
    err = " ".join(err.split())
    assert "b.geojson could not be written (No space left on device). Make room" in err
    assert f"The plan of {BEGINS} is kept in {season.name}; of files, only those named" in err
    with Season(season).store.reading() as db:
        assert len(kept_routes.days(db)) == 1


def test_command_report_and_phone_say_the_same_route_and_hours_after_any_record(
    run, season, tmp_path
):
    kept, on, dana = Season(season), date.fromisoformat(BEGINS), WorkPart(name="Dana")
    scouts.let_in(kept, "Dana")
    given = route_ahead(kept, on, dana).plant
    for k, (who, result) in enumerate((("Dana", 0), ("", 1), ("Dana", 0))):
        results = np.array([0, 0, result])
        kept.record(Inspections.of(given[3 * k : 3 * k + 3], results, on), "f", who)
        assert run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")[0] == 0
        with (tmp_path / "r.csv").open(encoding="utf-8-sig", newline="") as file:
            command = [int(row["plant"]) for row in csv.DictReader(file)]
        facts = DayFacts.of_season(kept, on)
        assert command == route_ahead(kept, on, dana).plant.tolist()
        assert command == facts.route.plant.tolist()
        assert facts.route.end_s <= work_hours(kept, on, dana).left_s + 1.0


def test_a_plant_that_was_pulled_out_is_recorded_by_file_and_no_treatment_stands(
    run, season, tmp_path
):
    run("change", season, "--flag-only")
    kept, first = Season(season), date.fromisoformat(BEGINS)
    kept.record(Inspections.of(np.arange(3), np.ones(3, int), np.datetime64(first)), "x")
    after = first + timedelta(days=1)
    line, number = (of[:3].tolist() for of in kept.plant_numbers)
    (tmp_path / "gone.csv").write_text(
        f"row,number,found,date,who\n{line[1]},{number[1]},pulled out,{after},Ana\n"
    )
    code, _, err, _ = run("record", season, tmp_path / "gone.csv")
    assert code == 0, err
    out = run("status", season, "--date", after)[1]
    assert "gone                        1 does not stand there any more: plans leave it out" in out
    assert "not found yet, and 2 were found and only flagged." in out
    assert "could not be inspected" not in out
    assert 1 not in Season(season).plan(after + timedelta(days=1)).route.plant
    assert Season(season).treatments() == ()
    run("undo", season)
    assert not Season(season).history.gone(1).any()


@pytest.mark.parametrize("robots", ["1", "2"])
def test_where_every_plant_is_known_and_flagged_the_day_is_not_called_too_short(
    run, season, robots
):
    run("change", season, "--flag-only", "--robots", robots)
    kept, first = Season(season), date.fromisoformat(BEGINS)
    plants = np.arange(len(kept.plot.grid))
    kept.record(Inspections.of(plants, np.ones(len(plants), int), np.datetime64(first)), "x")
    code, _, err, _ = run(
        "plan", season, "--no-bound", "--date", first + timedelta(days=1), "-o", "r.csv"
    )
    assert code == 2
    told = f"{len(plants):,} plants were found and only flagged"
    said = f"Every plant is known: {told}. Nothing is left"
    assert said in " ".join(err.split())
    assert "long enough" not in err


def test_it_is_said_by_what_a_past_day_is_planned_and_how_to_plan_it_otherwise(run, season):
    kept, first = Season(season), date.fromisoformat(BEGINS)
    for day, hours in ((0, 2), (2, 1)):
        run("change", season, "--hours", hours)
        seen = np.datetime64(first + timedelta(days=day))
        kept.record(Inspections.of(np.array([day]), np.array([0]), seen), "x")
    words = ["plan", season, "--date", first + timedelta(days=1), "--no-bound", "-o", "r.csv"]
    said = f"{words[3]} is past and planned by what counted then: hours 2. To plan it by what"
    assert said in run(*words)[2]
    assert "counted then" not in run(*words, "--as-now")[2]
    assert "counted then" not in run(*words)[2]
    assert "--as-now needs a season" in run("plan", ZIP, "--feature", "Nursery", "--as-now")[2]


def test_plants_where_people_may_not_be_yet_are_left_out_and_that_is_said(run, season):
    kept, words = Season(season), ["plan", season, "--date", BEGINS, "--no-bound"]
    on, line = date.fromisoformat(BEGINS), kept.plant_numbers.line

    def sprayed(rows):
        waits = Application("Acarol", reentry_hours=24.0, ended=time(5))
        kept.treat(on, 0.0, plants=np.isin(line, rows), application=waits)

    sprayed([1, 2])
    n, day = np.count_nonzero(np.isin(line, [1, 2])), on + timedelta(days=1)
    said = f"Closed until 05:00 on {day} after Acarol, so not on the route: {n} plants in rows 1–2."
    code, _, err, _ = run(*words)
    assert code == 0
    assert f"seen: {said}\n" in err
    assert "people or robots" in err
    assert not np.isin(line[kept.kept_route(on)], [1, 2]).any()
    assert "may not be yet" not in run(*words, "--enter-treated")[2]  # the route is elsewhere
    err = run(*words, "--now", "23:00")[2]
    assert "0.0 h are left" in err
    assert "Closed until" not in err
    sprayed(np.unique(line))
    code, _, err, made = run(*words, "-o", "r.csv")
    assert (code, made) == (2, set())
    assert "Closed until 05:00 on" in err
    assert "Plan another day with --date, or for robots" in err
    code, _, err, made = run(*words, "-o", "r.csv", "--enter-treated")
    assert (code, len(made)) == (0, 1)
    assert "seen: Routes lead to plants where people may not be yet." in err
    run("change", season, "--robots", "2")
    assert "Closed until" in run(*words)[2]
    assert run(*words, "--enter-treated")[0] == 0
    assert "needs a season" in run("plan", ZIP, "--feature", "Nursery", "--enter-treated")[2]


def test_half_way_the_rest_of_the_day_is_planned(run, season, tmp_path):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    plants = filled_in(tmp_path / "r.csv", finds={0}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    code, out, err, _ = run(
        "plan", season, "--no-bound", "--date", BEGINS, "--now", "06:30", "-o", "r2.geojson"
    )
    assert code == 0, err
    assert "5 done" in out
    assert "so that it can be seen" not in out  # nothing hides
    features = json.loads((tmp_path / "r2.geojson").read_text(encoding="utf-8"))["features"]
    assert features[0]["properties"]["start"] == f"{BEGINS}T06:30:00"
    assert not {f["properties"].get("plant") for f in features} & set(plants)


@pytest.mark.parametrize(("who", "whose"), [("", "the"), ("robot-2", "robot-2's")])
def test_hours_that_are_worked_already_are_no_hours_left(run, season, who, whose):
    if who:
        run("change", season, "--robots", "2")
    kept, on = Season(season), date.fromisoformat(BEGINS)
    for plant, second in enumerate((22_000, 23_430)):
        kept.record(Inspections.of([plant], [0], on, second=[second], who=[who]))
    words = ["plan", season, "--date", BEGINS, "--no-bound", "-o", "r.csv"]
    code, _, err, made = run(*words, "--now", "06:10")
    assert (code, made) == (2, set())
    assert f"it is 06:10 and {whose} last result of {BEGINS} is of 06:30: hours already" in err
    assert run(*words, "--now", "06:30")[0] == 0  # 30 seconds earlier: times are told to the minute
    correct = " ".join(err.split()).partition("fieldmon correct ")[2].split()
    assert correct[1:] == ["--inspection", "2", "--time", "HH:MM", "--who", "NAME"]
    assert run("correct", *correct[:4], "06:07", "--who", "Ann")[0] == 0
    assert run(*words, "--now", "06:10")[0] == 0


def test_three_days_by_command_are_three_days_of_the_library(run, season, tmp_path):
    """The app calls the library: the same findings give the same belief and the same routes."""
    begun = Season(season)
    with pytest.warns(ImportDoubt, match="15 of the records are of a later day"):
        with_library = Season.create(
            tmp_path / "library.gpkg", begun.plot, begun.records, begun.settings
        )
    for day in range(3):
        on = date.fromisoformat(BEGINS) + timedelta(days=day)
        code, _, err, _ = run("plan", season, "--no-bound", "--date", on, "-o", "r.csv")
        assert code == 0, err
        plants = filled_in(tmp_path / "r.csv", finds={day, day + 3}, n=12)
        code, _, err, _ = run("record", season, "r.csv", "--date", on)
        assert code == 0, err
        assert with_library.plan(on).route.plant[:12].tolist() == plants
        found = np.isin(np.arange(12), [day, day + 3])
        with_library.record(Inspections.of(np.array(plants), found, np.datetime64(on)), "app")
        assert np.array_equal(with_library.evening(on), Season(season).evening(on))
    assert len(with_library.history.inspections) == 36


def test_a_plan_says_which_detection_counts_for_what_once_the_season_learnt_another(run, season):
    code, _, err, _ = run("plan", season, "--date", BEGINS, "--no-bound")
    assert code == 0, err
    assert "as this season learnt" not in err
    kept, on = Season(season), date.fromisoformat(BEGINS)
    plants = kept.plan(on, keep=False).route.plant[:40]
    for day in range(2):  # what is found on the second day was overlooked on the first
        today, found = on + timedelta(days=day), np.full(40, day, np.int8)
        kept.record(Inspections.of(plants, found, np.datetime64(today)), f"{day}")
    (learnt,) = [one for one in kept.learnt(today) if one.name == "detection"]
    assert written(learnt.value, ".0%") != "84 %"
    code, _, err, _ = run("plan", season, "--date", today + timedelta(days=1), "--no-bound")
    assert code == 0, err
    assert f"find {written(learnt.value, '.0%')} of what is there, as this season learnt" in err
    assert "routes and their finds go by the 84 %" in err


def test_of_a_team_it_is_said_of_whom_something_is_assumed_and_who_finds_otherwise(
    run, season, tmp_path
):
    team = tmp_path / "team.csv"
    team.write_text("name,who,look_s,detection\nAnn,scout,20,\nBen,scout,20,\nR1,robot,,0.9\n")
    assert run("change", season, "--robots", team)[0] == 0
    kept, on = Season(season), date.fromisoformat(BEGINS)
    plants = kept.plan(on, keep=False).route.plant[:40]
    for day in range(2):
        today, found = on + timedelta(days=day), np.full(40, day, np.int8)
        kept.record(Inspections.of(plants, found, np.datetime64(today)), f"{day}")
    asked = ("--date", today + timedelta(days=1), "--no-bound", "-o", "day.geojson")
    code, _, err, _ = run("plan", season, *asked)
    assert code == 0, err
    for said in ("speed 4 km/h (Ann, Ben);", "speed 2.5 km/h (R1)", "there 50 % (Ann, Ben)"):
        assert said in err
    assert "there 84 %" not in err
    for who, told in (("Ann, Ben", 0.5), ("R1", 0.9)):
        (learnt,) = [one for one in kept.learnt(today, told) if one.name == "detection"]
        assert f"by {who} find {written(learnt.value, '.0%')} of what is there" in err
        assert f"go by the {written(told, '.0%')} of who inspects" in err
    routes = [tmp_path / f"day-{name}.geojson" for name in ("Ann", "Ben", "R1")]
    ahead = kept.forecast(today + timedelta(days=1))
    for route in routes:
        said = json.loads(route.read_text())["features"][0]["properties"]["forecast"]
        assert said["expected"][0] == round(ahead.expected[0], 1)


def test_plants_left_out_because_nobody_could_inspect_them_are_counted(run, season):
    kept, begins = Season(season), date.fromisoformat(BEGINS)
    next_day = ["plan", season, "--date", begins + timedelta(days=1), "--no-bound"]
    assert "Left out" not in run(*next_day)[2]
    plants = kept.plan(begins).route.plant[:3]
    kept.record(Inspections.of(plants, np.full(3, SKIPPED), np.datetime64(BEGINS)), "x")
    code, _, err, _ = run(*next_day)
    assert code == 0, err
    assert "seen: Left out of this plan: 3 plants that nobody could inspect last time." in err
    everything = np.arange(len(kept.plot.grid))
    all_skipped = np.full(len(everything), SKIPPED)
    kept.record(Inspections.of(everything, all_skipped, np.datetime64(BEGINS)), "y")
    code, _, err, _ = run(*next_day)
    # where all were skipped none is left out
    assert code == 0, err
    assert "Left out" not in err
