"""`fieldmon record`: what was found."""

import json
import shutil
import uuid
from datetime import date, timedelta

import numpy as np
import pyogrio
import shapely

from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, ZIP, filled_in
from tests.monitoring.changes.test_outside_changes import outside


def test_what_qfield_adds_to_a_copy_comes_back_and_what_was_undone_does_not(
    run,
    season,
    tmp_path,
):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    copy = shutil.copy(season, tmp_path / "copy.gpkg")
    grid = Season(season).plot.grid
    extra = pyogrio.read_dataframe(copy, layer="inspections").tail(1)
    extra.geometry = shapely.points(grid.lonlat(np.array([77])))
    extra[["digest", "batch", "undone", "plant", "line", "number", "day"]] = None
    extra[["result", "count"]] = ["found", 4]
    pyogrio.write_dataframe(extra, copy, layer="inspections", append=True)
    code, out, err, _ = run("record", season, copy)
    assert code == 0, err
    assert "1 new, 5 known" in out
    assert Season(season).history.inspections.plant[-1] == 77
    run("undo", season, "--batch", 1)
    copy = shutil.copy(season, tmp_path / "later.gpkg")
    code, out, err, _ = run("record", season, copy)
    assert "0 new, 1 known" in out


def test_a_file_that_contradicts_what_is_recorded_is_listed_and_taken_only_when_told(
    run, season, tmp_path
):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0, 2}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    filled_in(tmp_path / "r.csv", finds=set(), n=5)
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS)
    assert code == 2
    assert "2 of them contradict it: Row" in err
    assert "recorded as found, now clean" in err
    assert len(Season(season).history.inspections) == 5
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS, "--contradicting")
    assert code == 0, err
    assert "2 new, 3 known" in out


def test_finds_that_are_found_again_are_said_wherever_the_season_is_told(run, season, tmp_path):
    days = [date.fromisoformat(BEGINS) + timedelta(days=k) for k in range(2)]
    for on in days:
        rows = "".join(f"{k},yes,{on}\n" for k in range(20))
        (tmp_path / f"{on}.csv").write_text(f"plant,found,date\n{rows}")
    said = (
        "doubtful: 20 of 20 plants found before were infested again when inspected again, although "
        "finds are taken as treated at once; if nobody treats them, say so: fieldmon change "
        f"{season} --flag-only"
    )
    assert said not in run("record", season, f"{days[0]}.csv")[2]
    told = (["record", season, f"{days[1]}.csv"], ["status", season, "--date", days[1]],
            ["decide", season, "--threshold", "5%", "--date", days[1]],
            ["plan", season, "--no-bound", "--date", days[1], "-o", "r.csv"])  # fmt: skip
    for words in told:
        assert said in run(*words)[2].splitlines(), words
    run("report", season, "--until", days[1], "-o", "r.html")
    assert said[10:80] in (tmp_path / "r.html").read_text(encoding="utf-8")
    assert run("change", season, "--flag-only")[0] == 0
    for words in told[1:]:
        _, out, err, _ = run(*words)
        assert "found before" not in err
        assert "finds are treated" not in out


def test_who_is_told_by_the_option_and_rows_that_say_otherwise_are_counted(run, season, tmp_path):
    """Ann's sheet, walked by Dan: files given out say who was to go."""
    run("change", season, "--robots", "2")
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r-robot-1.csv", finds={0}, n=3)
    code, _, err, _ = run("record", season, "r-robot-1.csv", "--date", BEGINS, "--who", "Dan")
    assert code == 0, err
    assert "By the file robot-1 made 3 inspections; taken as those of Dan" in err
    kept = Season(season)
    assert {*kept.history.inspections.who.tolist()} == {"Dan"}
    assert [batch.who for batch in kept.batches()] == ["Dan"]
    assert [one.who for one in kept.log() if one.kind == "seen"] == ["Dan"]


def test_who_is_told_by_the_option_of_a_season_begun_apart_but_not_of_a_copy(run, season, tmp_path):
    copy = shutil.copy(season, tmp_path / "copy.gpkg")
    words = (ZIP, "--feature", "Nursery", "--hours", "1", "--begins", BEGINS)
    assert run("init", "apart.gpkg", *words)[0] == 0
    for k, (file, who) in enumerate(((copy, "Ann"), ("apart.gpkg", "Ben"))):
        (tmp_path / "r.csv").write_text(f"plant,date,result\n{k},{BEGINS},clean\n")
        assert run("record", file, "r.csv", "--who", who)[0] == 0
    code, _, err, _ = run("record", season, copy, "apart.gpkg", "--who", "Zed")
    assert code == 0, err
    assert "apart.gpkg: seen: By the file Ben made 1 inspection; taken as those of Zed" in err
    assert Season(season).history.inspections.who.tolist() == ["Ann", "Zed"]


def test_two_files_that_contradict_each_other_are_refused_before_either_is_recorded(
    run, season, tmp_path
):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "a.csv")
    shutil.copy(tmp_path / "a.csv", tmp_path / "b.csv")
    filled_in(tmp_path / "a.csv", finds={0}, n=3)
    filled_in(tmp_path / "b.csv", finds=set(), n=3)
    code, _, err, _ = run("record", season, "a.csv", "b.csv", "--date", BEGINS)
    assert code == 2
    assert "1 of them does, of the same plant and day" in err
    assert not len(Season(season).history.inspections)


def test_a_day_told_for_files_without_one_is_none_of_records_beside_dated_ones(
    run, season, tmp_path
):
    (tmp_path / "day.csv").write_text(f"row,plant,date,result\n1,1,{BEGINS},clean\n1,2,,found\n")
    code, _, err, _ = run("record", season, "day.csv", "--date", BEGINS)
    assert code == 0, err
    assert "1 record has no date, as others have: left out" in err
    assert "--finding-option day=" in err
    assert len(Season(season).history.inspections) == 1
    run("record", season, "day.csv", "--finding-option", f"day={BEGINS}")
    assert len(Season(season).history.inspections) == 2


def test_a_file_all_of_which_names_another_plot_is_refused_before_others_are_recorded(
    run, season, tmp_path
):
    (tmp_path / "ours.csv").write_text("plot,row,plant,found\nNursery,1,1,yes\n")
    (tmp_path / "pond.csv").write_text("plot,row,plant,found\nPond,1,2,yes\n")
    words = "record", season, "ours.csv", "pond.csv", "--date", BEGINS
    code, _, err, _ = run(*words)
    assert code == 2
    assert "pond.csv must hold records of Nursery, but none could be taken" in err
    assert not len(Season(season).history.inspections)
    code, out, err, _ = run(*words, "--finding-option", "columns=plot=")
    assert (code, out.count("1 new")) == (0, 2), err


def test_corrections_of_a_copy_are_taken_with_its_findings_or_not_at_all(run, season, tmp_path):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    copy = shutil.copy(season, tmp_path / "copy.gpkg")
    outside(copy, "UPDATE inspections SET result = 'found' WHERE fid = 2")
    filled_in(tmp_path / "r.csv", finds={0}, n=2)  # of the second plant it says clean again
    code, _, err, _ = run("record", season, copy, "r.csv", "--date", BEGINS)
    assert code == 2
    assert "must have an author" in err
    code, _, err, _ = run("record", season, copy, "r.csv", "--date", BEGINS, "--who", "Ann")
    assert code == 2
    assert "recorded as found, now clean" in err
    assert "Confirm with: --contradicting" in err
    assert [one.kind for one in Season(season).batches()] == ["findings"]
    code, out, err, _ = run("record", season, copy, "--who", "Ann")
    assert code == 0, err
    assert "1 correction taken, by Ann" in out


def test_what_a_phone_saved_as_not_sent_is_recorded_and_changes_nothing_twice(
    run, season, tmp_path
):
    one = {"at": f"{BEGINS}T06:00:00.123Z", "season": Season(season).path.stem, "who": "Ann"}
    ids = [str(uuid.UUID(int=k)) for k in range(4)]
    told = [
        one | {"id": ids[0], "plant": 3, "result": "found", "count": 4},
        one | {"id": ids[1], "plant": 4, "result": "clean"},
        one | {"id": ids[2], "undoes": ids[1]},
        one | {"id": ids[3], "plant": 10**6, "result": "clean"},
    ]
    (tmp_path / "rescue.json").write_text(json.dumps({"findings": told, "photos": []}))
    code, out, err, _ = run("record", season, "rescue.json")
    assert (code, "rescue.json: 3 new, 0 known already" in out) == (0, True), err
    assert "plant's number" in err
    seen = Season(season).history.inspections
    assert (seen.plant.tolist(), seen.who.tolist()) == ([3], ["Ann"])
    code, out, _, _ = run("record", season, "rescue.json")
    assert "0 new, 3 known already" in out
    assert len(Season(season).history.inspections) == 1


def test_what_a_phone_saved_is_of_whom_the_option_names_and_others_are_counted(
    run, season, tmp_path
):
    one = {"at": f"{BEGINS}T06:00:00Z", "who": "Ann", "result": "clean"}
    of = [Season(season).path.stem] * 2 + ["", "Other"]
    told = [
        one | {"id": str(uuid.UUID(int=k)), "plant": k, "season": name} for k, name in enumerate(of)
    ]
    told[2]["who"] = ""
    (tmp_path / "rescue.json").write_text(json.dumps({"findings": told, "photos": []}))
    code, _, err, _ = run("record", season, "rescue.json", "--who", "Zed")
    assert code == 0, err
    assert "By the file Ann made 2 records; taken as those of Zed, as --who says." in err
    assert Season(season).history.inspections.who.tolist() == ["Zed"] * 3


def test_a_day_that_no_file_takes_is_refused_and_one_that_some_take_is_said(run, season, tmp_path):
    assert run("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv")[0] == 0
    filled_in(tmp_path / "day.csv", {0}, 2)
    (tmp_path / "own.csv").write_text("row,plant,found\n1,9,no\n")
    later = "2026-11-03"
    code, _, err, _ = run("record", season, "day.csv", "--date", later)
    assert code == 2
    told = " ".join(err.split())
    assert f"day.csv names the days of its results: {BEGINS}, and none is of {later}" in told
    assert len(Season(season).inspections) == 0
    code, _, err, _ = run("record", season, "day.csv", "own.csv", "--date", later)
    assert code == 0, err
    assert f"{BEGINS}; --date {later} is not of them" in " ".join(err.split())
    days = Season(season).inspections.date.astype(str).tolist()
    assert days == [BEGINS, BEGINS, later]
    code, _, err, _ = run("record", season, "day.csv", "--date", BEGINS)
    assert (code, "--date" in err) == (0, False)


def test_where_no_result_could_be_taken_the_exit_code_says_so(run, season, tmp_path):
    assert run("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv")[0] == 0
    assert run("record", season, "day.csv")[0] == 0  # nobody filled it in
    (tmp_path / "ahead.csv").write_text("plant,result,date\n3,found,2030-01-01\n")
    code, _, err, _ = run("record", season, "ahead.csv")
    assert (code, "At least one result must be taken" in " ".join(err.split())) == (2, True)
    filled_in(tmp_path / "day.csv", {0}, 2)
    for _ in range(2):  # known already is no problem
        assert run("record", season, "day.csv")[0] == 0
