"""A file brought to a season is read in one way, by whatever way it is brought."""

import json
import shutil
import sqlite3
import uuid
from contextlib import closing
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from fieldmon.errors import ContradictionError, FieldmonError, FileProblem, ObservationError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.monitoring import Season
from fieldmon.monitoring.merging import same_season
from fieldmon.monitoring.season.inspection_import import counting_copy, read_brought, record_saved
from fieldmon.monitoring.treating.applications import Application
from tests.monitoring.changes.test_outside_changes import outside
from tests.monitoring.seasons import BEGINS, a_season, clock_on, on

OPTIONS = InspectionOptions(work_day=np.datetime64(BEGINS, "D"))


def brought(season, text, folder, options=OPTIONS):
    return read_brought(season, Upload("day.csv", text.encode()), options, folder)


def test_what_has_no_date_beside_what_says_one_gets_none_unasked(season, tmp_path):
    text = "row,plant,date,result\n1,1,2026-04-07,clean\n1,2,,found\n"
    read = brought(season, text, tmp_path)
    assert BEGINS not in read.findings.date.tolist()
    (said,) = [one for one in read.messages if "no date, as others have" in one.sentence]
    assert said.remedy.option == "day"
    told = brought(season, text, tmp_path, OPTIONS.choose("day", "2026-04-08"))
    assert told.findings.date.astype(str).tolist() == ["2026-04-07", "2026-04-08"]


def test_what_has_no_date_beside_what_says_none_gets_none_unasked(season, tmp_path):
    text = "row,plant,date,result\n1,1,30.02.2026,clean\n1,2,,found\n"
    with pytest.raises(ObservationError, match=r"a date that is none \(record 1: '30.02.2026'\)"):
        brought(season, text, tmp_path)
    told = brought(season, text, tmp_path, OPTIONS.choose("day", "2026-04-08"))
    assert told.findings.date.astype(str).tolist() == ["2026-04-08"]


def test_records_are_of_the_season_whose_plot_or_file_they_name(season, tmp_path):
    names = season.plot.field.name, season.path.stem, "Pond"
    lines = [f"{name},1,{k},clean" for k, name in enumerate(names, 1)]
    read = brought(season, "\n".join(["plot,row,plant,result", *lines]), tmp_path)
    assert len(read.findings) == 2
    assert any("1 other plot: Pond" in one.sentence for one in read.messages)


def test_where_no_record_says_a_day_all_are_of_the_day_of_the_work(season, tmp_path):
    read = brought(season, "row,plant,time,result\n1,1,07:30,clean\n1,2,,found\n", tmp_path)
    assert read.findings.date.tolist() == [BEGINS] * 2
    assert read.findings.second[0] == 7.5 * 3600
    assert (read.name, read.saved, read.copy, read.corrections) == ("day.csv", None, None, 0)


def test_a_copy_in_which_inspections_of_this_season_were_corrected_is_for_merge(path, tmp_path):
    season, copy = Season(path), Season(shutil.copy(path, tmp_path / "copy.gpkg"))
    new = Inspections.of([250], [FOUND], BEGINS)
    added = copy.record(new, "phone", "Ann")
    (own,) = [one.number for one in copy.numbered(plant=250)]
    copy.correct_time(own, None, "Ann", BEGINS + timedelta(days=1))
    (tmp_path / "own").mkdir()
    # what was recorded there, too, is new here as it was corrected
    read = read_brought(season, copy.path, OPTIONS, tmp_path / "own")
    assert added.new == 1
    assert BEGINS + timedelta(days=1) in read.findings.date.tolist()
    first = copy.numbered(plant=int(season.history.inspections.plant[0]))[0].number
    copy.correct_time(first, None, "Ann", BEGINS + timedelta(days=2), confirmed=True)
    (tmp_path / "again").mkdir()
    with pytest.raises(
        FileProblem, match=r"but 1 inspection of this .* with: fieldmon merge season.gpkg copy.gpkg"
    ):
        read_brought(season, copy.path, OPTIONS, tmp_path / "again")
    season.merge(copy)
    (tmp_path / "merged").mkdir()
    assert read_brought(season, copy.path, OPTIONS, tmp_path / "merged").corrections == 0


@pytest.mark.parametrize("kind", [Path, lambda path: Upload("copy.gpkg", path.read_bytes())])
def test_of_a_copy_what_was_corrected_is_no_new_finding(path, tmp_path, kind):
    copy, season = Path(shutil.copy(path, tmp_path / "copy.gpkg")), Season(path)
    outside(copy, "UPDATE inspections SET result = 'found' WHERE fid = 1",
            "DELETE FROM inspections WHERE fid = 2")  # fmt: skip
    (tmp_path / "own").mkdir()
    read = read_brought(season, kind(copy), OPTIONS, tmp_path / "own")
    assert read.corrections == 2
    assert read.copy.parent == tmp_path / "own"
    assert len(read.findings) == 10
    (done,) = season.record_all([(read.findings, read.name)], "Ann", copies=[read.copy])
    assert (done.new, done.known, done.corrected) == (0, 10, 2)
    assert season.batches()[0].source == "changed in copy.gpkg"
    assert season.verify() == ()


def test_contradictions_are_held_to_what_corrections_leave_and_nothing_of_both_is_kept(
    path, tmp_path
):
    copy, season = Path(shutil.copy(path, tmp_path / "copy.gpkg")), Season(path)
    outside(copy, "UPDATE inspections SET result = 'found' WHERE fid = 1")
    first = replace(season.history.inspections.take(np.array([0])), second=np.array([60.0]))
    assert first.result.tolist() == [CLEAN]
    before = season.morning(BEGINS).tolist(), len(season.log())
    with pytest.raises(ContradictionError, match="recorded as found, now clean"):
        season.record_all([(first, "copy.gpkg")], "Ann", copies=[copy])
    assert season.history.inspections.result[0] == CLEAN
    assert (season.morning(BEGINS).tolist(), len(season.log())) == before
    found = replace(first, result=np.array([FOUND], np.int8))
    (done,) = season.record_all([(found, "copy.gpkg")], "Ann", copies=[copy])
    assert (done.new, done.corrected) == (1, 1)
    assert season.verify() == ()


def test_what_a_phone_saved_is_read_and_recorded_with_what_there_is_to_say(season, tmp_path):
    one = {"at": f"{BEGINS}T06:00:00Z", "season": season.path.stem, "who": "Ann"}
    told = [
        one | {"id": str(uuid.UUID(int=1)), "plant": 3, "result": "found"},
        one | {"id": str(uuid.UUID(int=2)), "plant": 10**6, "result": "clean"},
        one | {"id": str(uuid.UUID(int=3)), "plant": 4, "result": "clean", "season": "Other"},
    ]
    data = json.dumps({"kind": "fieldmon findings", "findings": told, "photos": []}).encode()
    read = read_brought(season, Upload("rescue.json", data), OPTIONS, tmp_path)
    assert len(read.findings) == 0
    done, said = record_saved(season, read.saved)
    assert (done.new, done.known, len(said)) == (1, 0, 2)
    assert "Other" in said[0]
    assert season.history.inspections.result.tolist() == [FOUND]


def test_a_copy_for_another_season_holds_only_what_was_not_undone(path, tmp_path):
    Season(path).undo(inspection=3)
    (tmp_path / "copy").mkdir()
    copy = counting_copy(path, tmp_path / "copy")
    for file, n in ((path, 12), (copy, 11)):
        with closing(sqlite3.connect(file)) as db:
            assert db.execute("SELECT count(*) FROM inspections").fetchone() == (n,)


def test_what_was_taken_back_in_a_copy_and_counts_on_here_is_said(path, tmp_path):
    season, copy = Season(path), Season(shutil.copy(path, tmp_path / "my copy.gpkg"))

    def doubts(name):
        (own := tmp_path / name).mkdir()
        read = read_brought(season, copy.path, OPTIONS, own)
        return [one.sentence for one in read.messages if "taken back" in one.sentence]

    assert doubts("before") == []
    copy.undo(inspection=3)
    copy.undo(inspection=5)
    assert doubts("after") == [
        (
            "2 inspections were taken back in that copy, and count on here. Take all that it holds "
            "with Merge in the app, or with: fieldmon merge season.gpkg 'my copy.gpkg'"
        )
    ]
    season.merge(copy)
    assert doubts("merged") == []


def test_whether_a_file_is_a_copy_of_the_season_is_asked_once(path, tmp_path, monkeypatch):
    asked, ask = [], same_season.refuse_strangers
    monkeypatch.setattr(
        same_season, "refuse_strangers", lambda *both: asked.append(both) or ask(*both)
    )
    season, copy = Season(path), Season(shutil.copy(path, tmp_path / "copy.gpkg"))
    copy.treat(BEGINS, 0.5)
    copy.undo(inspection=3)
    (own := tmp_path / "own").mkdir()
    read = read_brought(season, copy.path, OPTIONS, own)
    told = " ".join(one.sentence for one in read.messages)
    assert (read.is_copy, told.count("Take all that it holds"), len(asked)) == (True, 2, 1)


def test_treatments_of_another_season_are_said_to_stay_there(path, tmp_path):
    season, stranger = Season(path), a_season(tmp_path / "stranger.gpkg")
    copy = Season(shutil.copy(path, tmp_path / "copy.gpkg"))
    for number, (other, says) in enumerate(((stranger, "of that season"), (copy, "of that copy"))):
        for told in (0, 1):
            (own := tmp_path / f"{number}{told}").mkdir()
            read = read_brought(season, other.path, OPTIONS, own)
            said = [one.sentence for one in read.messages if "treatment" in one.sentence]
            assert len(said) == told
            if not told:
                other.treat(BEGINS, 0.5, application=Application("Acarol"))
        assert said[0].startswith(f"1 treatment {says} is not taken (Acarol on {BEGINS}), nor its")


def test_results_of_days_to_come_are_left_out_once_the_season_has_begun_unless_taken(
    season, tmp_path, monkeypatch
):
    days = [str(on(k)) for k in (1, 2)]
    text = f"plant,result,date\n3,found,{days[0]}\n4,clean,{days[1]}\n"
    for today, taken, options in (
        (0, [], OPTIONS),
        (0, [3, 4], replace(OPTIONS, take_doubtful=True)),
        (1, [3], OPTIONS),
        (2, [3, 4], OPTIONS),
        (-1, [3, 4], OPTIONS),  # of a season that has not begun: a rehearsal
    ):
        clock_on(monkeypatch, today)
        read = brought(season, text, tmp_path, options)
        assert read.findings.plant.tolist() == taken
        said = [one.sentence for one in read.messages if "have not come" in one.sentence]
        assert [f"it is {on(today)} on the plot" in one for one in said] == [True] * (
            len(taken) < 2
        )


def test_results_of_before_the_first_day_are_left_out_where_others_are_of_the_season(
    season, tmp_path
):
    text = f"plant,result,date\n3,found,{on(-1)}\n4,clean,{on(0)}\n"
    read = brought(season, text, tmp_path, OPTIONS)
    assert read.findings.plant.tolist() == [4]
    (said,) = (one.sentence for one in read.messages if "first day" in one.sentence)
    assert said.startswith(f"1 result of before the season's first day, {on(0)}, was left out")
    alone = brought(season, f"plant,result,date\n3,found,{on(-1)}\n", tmp_path, OPTIONS)
    with pytest.raises(FieldmonError, match="which began on"):
        season.record(alone.findings, "old.csv")
