"""`fieldmon record`: what was found."""

import json
import shutil
import sys
import uuid

import numpy as np
import pyogrio
import shapely

import fieldmon.cli.record  # noqa: F401 - its module, which has the name of the command
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, filled_in

command = sys.modules["fieldmon.cli.record"]


def test_what_qfield_adds_to_a_copy_comes_back_and_what_was_undone_does_not(
    run,
    season,
    tmp_path,
):
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
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
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
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


def test_who_is_told_by_the_option_and_rows_that_say_otherwise_are_counted(run, season, tmp_path):
    """Ann's sheet, walked by Dan: files given out say who was to go."""
    run("change", season, "--robots", "2")
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r-robot-1.csv", finds={0}, n=3)
    code, _, err, _ = run("record", season, "r-robot-1.csv", "--date", BEGINS, "--who", "Dan")
    assert code == 0, err
    assert "By the file robot-1 made 3 inspections; taken as those of Dan" in err
    kept = Season(season)
    assert {*kept.history.inspections.who.tolist()} == {"Dan"}
    assert [batch.who for batch in kept.batches()] == ["Dan"]
    assert [one.who for one in kept.log() if one.kind == "seen"] == ["Dan"]


def test_two_files_that_contradict_each_other_are_refused_before_either_is_recorded(
    run, season, tmp_path
):
    run("plan", season, "--date", BEGINS, "-o", "a.csv")
    shutil.copy(tmp_path / "a.csv", tmp_path / "b.csv")
    filled_in(tmp_path / "a.csv", finds={0}, n=3)
    filled_in(tmp_path / "b.csv", finds=set(), n=3)
    code, _, err, _ = run("record", season, "a.csv", "b.csv", "--date", BEGINS)
    assert code == 2
    assert "1 of them do, of the same plant and day" in err
    assert not len(Season(season).history.inspections)


def test_what_somebody_else_recorded_meanwhile_is_not_contradicted_unasked(
    run, season, tmp_path, monkeypatch
):
    """Between the look at the season and the writing another command may record."""
    run("plan", season, "--date", BEGINS, "-o", "a.csv")
    shutil.copy(tmp_path / "a.csv", tmp_path / "b.csv")
    filled_in(tmp_path / "a.csv", finds={0}, n=3)
    filled_in(tmp_path / "b.csv", finds=set(), n=3)
    other, theirs = Season(season), read_inspections(tmp_path / "a.csv", Season(season).plot.grid)
    looked = command._refuse_contradictions

    def look(kept, read):
        looked(kept, read)
        other.record(theirs.value, "a.csv", "Ben")

    monkeypatch.setattr(command, "_refuse_contradictions", look)
    code, _, err, _ = run("record", season, "b.csv", "--date", BEGINS)
    assert code == 2
    assert "1 of them contradict it" in err
    assert "Confirm with: --contradicting" in err
    assert len(Season(season).history.inspections) == 3


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
