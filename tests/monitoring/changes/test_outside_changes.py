"""What other programs change of a season is refused by name or taken as a correction."""

import shutil
import sqlite3
from contextlib import closing
from datetime import UTC, datetime

import pyogrio
import pytest
from shapely import Point

from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import outside_changes
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.file.geopackage import blob
from tests.monitoring.seasons import BEGINS, state


def outside(path, *statements):
    """Do what another program does, which knows nothing of us."""
    with closing(sqlite3.connect(path)) as db:
        for statement in statements:
            db.execute(statement)
        db.commit()


def refused(path):
    """Return what each way in says of a season, which must be the same."""
    said = set()
    for ask in (lambda s: s.status(BEGINS), lambda s: s.plan(BEGINS), lambda s: s.undo()):
        with pytest.raises(FileProblem) as problem:
            ask(Season(path))
        said.add(str(problem.value))
    (sentence,) = said
    return sentence


EDITS = {
    "another result": "UPDATE inspections SET result = 'found' WHERE fid = 1",
    "another day": "UPDATE inspections SET date = '2026-04-07' WHERE fid = 1",
    "another plant": "UPDATE inspections SET plant = 300 WHERE fid = 1",
    "another place": "UPDATE inspections SET geom = (SELECT geom FROM plants WHERE fid = 9) "
    "WHERE fid = 1",
    "another person": "UPDATE inspections SET who = 'Eve' WHERE fid = 1",
    "taken back": "UPDATE inspections SET undone = 1 WHERE fid = 1",
    "deleted": "DELETE FROM inspections WHERE fid = 1",
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
def test_a_changed_inspection_is_refused_by_name_until_it_is_a_correction_of_either_copy(
    path, tmp_path, edit
):
    other, was = (shutil.copy(path, tmp_path / name) for name in ("other.gpkg", "was.gpkg"))
    there, before = Season(other), Season(was)
    outside(path, edit)
    sentence = refused(path)
    assert "row 1 of the layer inspections (clean at row" in sentence
    assert "fieldmon correct" in sentence
    season = Season(path)
    assert season.correct("Ann") == 1
    assert season.correct("Ann") == 0
    last = season.batches()[0]
    assert (last.kind, last.who, last.rows) == ("corrections", "Ann", 1)
    assert season.status(BEGINS).day == 0
    season.store.check()
    corrected = season.history.states(0).tolist()
    done = season.merge(there)  # where it was not corrected
    assert (done.new, done.taken_back, done.contradictions) == (0, 0, ())
    there.merge(season)
    for one in (season, there):
        assert one.history.states(0).tolist() == corrected
    assert season.verify() == there.verify() == ()
    # undone it brings back what stood there
    season.undo()
    there.merge(season)
    for one in (season, there):
        assert one.evening(BEGINS).tolist() == before.evening(BEGINS).tolist()
        assert check_against_log(one) == ()
        assert one.batches()[0].undone


def test_a_result_changed_to_gone_is_a_correction_and_is_taken_back(path):
    outside(path, "UPDATE inspections SET result = 'gone', notes = 'burnt' WHERE fid = 1")
    assert "row 1 of the layer inspections" in refused(path)
    season = Season(path)
    plant = plant_of(path, 1)
    assert season.correct("Ann") == 1
    assert season.history.gone(0).nonzero()[0].tolist() == [plant]
    assert season.log()[-1].sentence().endswith("is now gone: burnt")
    assert season.verify() == ()
    season.undo()
    assert not season.history.gone(0).any()
    assert season.history.states(0)[plant] == CLEAN


def plant_of(path, row):
    with closing(sqlite3.connect(path)) as db:
        return db.execute("SELECT plant FROM inspections WHERE fid = ?", (row,)).fetchone()[0]


def test_a_correction_counts_in_every_column_and_is_taken_back_as_a_whole(path, tmp_path):
    other = shutil.copy(path, tmp_path / "other.gpkg")
    outside(path, "UPDATE inspections SET plant = 301, result = 'found' WHERE fid = 1")
    season = Season(path)
    evening, plants = Season(other).evening(BEGINS), Season(other).history.inspections.plant
    season.correct("Ann")
    states = season.history.states(0)
    assert states[301] == FOUND
    with season.store.reading() as db:
        line, number, batch, x, y = db.execute(
            "SELECT i.line, i.number, i.batch, i.geom = p.geom, i.undone FROM inspections i "
            "JOIN plants p ON p.plant = i.plant WHERE i.fid = 1"
        ).fetchone()
    assert (line, number) == (
        int(season.plant_numbers.line[301]),
        int(season.plant_numbers.number[301]),
    )
    assert (batch, x, y) == (season.batches()[0].number, 1, 0)
    season.undo()
    assert season.history.states(0)[301] == -1
    assert season.history.inspections.plant.tolist() == plants.tolist()
    assert season.evening(BEGINS).tolist() == evening.tolist()  # all is as it was before
    assert season.verify() == ()
    assert check_against_log(season) == ()


def moved_to(lonlat, fid=1):
    """Return what moves the point of an inspection, as QGIS does."""
    return f"UPDATE inspections SET geom = x'{blob(Point(lonlat)).hex()}' WHERE fid = {fid}"  # noqa: S608 - ours


def test_a_finding_that_was_moved_is_of_the_plant_at_its_new_place(path):
    season = Season(path)
    grid, stood = season.plot.grid, int(season.history.inspections.plant[0])
    beside_m = grid.xy_m[[301]] + 0.3
    outside(path, moved_to(grid.frame.lonlat(beside_m)[0]))
    season = Season(path)
    assert season.correct("Ann") == 1
    states = season.history.states(0)
    assert (states[301], states[stood]) == (CLEAN, -1)
    place = (
        f"is now at row {season.plant_numbers.line[301]}, plant {season.plant_numbers.number[301]}"
    )
    assert place in season.log()[-1].sentence()
    season.undo()
    assert season.history.states(0)[stood] == CLEAN
    assert season.verify() == ()


@pytest.mark.parametrize("far_m", [2.5, 40])
def test_a_finding_moved_to_where_no_plant_is_or_away_from_the_one_it_names_is_refused(path, far_m):
    season = Season(path)
    grid, stood = season.plot.grid, int(season.history.inspections.plant[0])
    away = grid.frame.lonlat(grid.xy_m.min(axis=0, keepdims=True) - far_m)[0]
    outside(path, moved_to(away))
    with pytest.raises(FileProblem, match=r"row 1 .*\(clean at row .* from the nearest plant"):
        Season(path).correct("Ann")
    outside(path, moved_to(grid.lonlat()[301]), "UPDATE inspections SET plant = 9 WHERE fid = 1")
    with pytest.raises(FileProblem, match=r"row 1 .*\(clean at row"):
        Season(path).correct("Ann")
    # a number alone is where it is, as ever
    outside(path, moved_to(grid.lonlat()[stood]))
    assert Season(path).correct("Ann") == 1
    assert Season(path).history.states(0)[9] == CLEAN


@pytest.mark.parametrize("result", ["clean", "skipped"])
def test_the_count_of_a_find_that_is_none_any_more_goes_along_and_the_log_says_it(path, result):
    outside(path, "UPDATE inspections SET result = 'found', count = 2 WHERE fid = 1")
    Season(path).correct("Ann")
    outside(path, f"UPDATE inspections SET result = '{result}' WHERE fid = 1")  # noqa: S608 - above
    season = Season(path)
    assert season.correct("Ann") == 1
    assert f"is now result {result}, count none" in season.log()[-1].sentence()
    assert season.verify() == ()
    # a count that was given with it contradicts it
    outside(path, "UPDATE inspections SET count = 3 WHERE fid = 1")
    with pytest.raises(FileProblem, match="Only a find has a count"):
        Season(path).correct("Ann")


def test_what_an_inspection_finds_is_corrected_and_refused_as_the_rest_of_it(path):
    before = Season(path).history.detections.tolist()
    outside(path, "UPDATE inspections SET detects = 0.3 WHERE fid = 1")
    season = Season(path)
    assert season.correct("Ann") == 1
    assert season.history.detections.tolist() == [0.3, *before[1:]]
    assert "is now detects 0.3" in season.log()[-1].sentence()
    season.undo()
    assert season.history.detections.tolist() == before
    outside(path, "UPDATE inspections SET detects = 30 WHERE fid = 1")
    with pytest.raises(FileProblem, match="above 0, and 1 at most"):
        Season(path).correct("Ann")


def test_what_was_corrected_twice_goes_back_step_by_step(path):
    season = Season(path)
    plant = int(season.history.inspections.plant[0])
    said = [season.history.states(0)[plant]]
    for what in ("found", "clean"):
        outside(path, f"UPDATE inspections SET result = '{what}', notes = 'a \"\\\n' WHERE fid = 1")  # noqa: S608 - above
        season = Season(path)
        season.correct("Ann")
        said.append(season.history.states(0)[plant])
    assert said == [CLEAN, FOUND, CLEAN]
    season.undo()
    assert season.history.states(0)[plant] == FOUND
    season.undo()
    assert season.history.states(0)[plant] == CLEAN
    assert season.verify() == ()
    assert len(season.history.inspections) == 12


def test_the_log_says_what_was_corrected(path):
    outside(path, "UPDATE inspections SET result = 'found', count = 99 WHERE fid = 1",
            "DELETE FROM inspections WHERE fid = 3")  # fmt: skip
    season = Season(path)
    season.correct("Eve")
    said = season.log()[-1].sentence()
    assert "on 2026-04-06 is now result found, count 99; " in said
    assert said.endswith(" was deleted")


def test_a_correction_that_makes_no_sense_is_refused_and_nothing_is_taken(path, monkeypatch):
    monkeypatch.setattr(
        "fieldmon.plot.local_clock.utc_now", lambda: datetime(2026, 11, 5, 12, tzinfo=UTC)
    )
    for column, bad, says in (
        ("result", "maybe", "maybe"),
        ("plant", "99999", "from another plot"),
        ("date", "soon", "soon"),
        ("date", "2020-01-01", "began on"),
        ("date", "2026-11-06", "its day, 2026-11-06, has not come"),
    ):
        outside(
            path,
            "UPDATE inspections SET plant = 0, date = '2026-04-06', result = 'clean' WHERE fid = 1",
            f"UPDATE inspections SET {column} = '{bad}' WHERE fid = 1",  # noqa: S608 - written above
        )
        season = Season(path)
        with pytest.raises(FileProblem, match=says):
            season.correct("Ann")
        assert len(season.batches()) == 1


def test_a_correction_that_says_what_stands_there_already_is_refused_by_name(path):
    outside(path, "UPDATE inspections SET plant = 1 + plant WHERE fid = 1")
    with pytest.raises(FileProblem, match=r"row 1 of the layer .* says what row 2 says"):
        Season(path).correct("Ann")


@pytest.mark.parametrize(
    "edit",
    [
        "UPDATE settings SET value = '1' WHERE name = 'season'",
        "UPDATE plots SET name = 'mine'",
        "DELETE FROM batches",
        "DELETE FROM arrays WHERE name = 'stated'",
        "INSERT INTO treatments (geom) SELECT geom FROM plots",
        "UPDATE observations SET present = 1",
        "DELETE FROM stops WHERE stop = 1",
    ],
)
def test_what_is_no_inspection_is_refused_by_name_and_no_correction(path, edit):
    layer = edit.split()[1 if edit.startswith("UPDATE") else 2]
    season = Season(path)
    outside(path, edit)
    for ask in (lambda: season.status(BEGINS), lambda: season.correct("Ann")):
        with pytest.raises(FileProblem, match=f"of the layer {layer}.*go back to a copy"):
            ask()


def test_what_was_added_and_taken_away_again_is_nothing(path):
    outside(path, "INSERT INTO treatments (geom) SELECT geom FROM plots", "DELETE FROM treatments")
    assert Season(path).status(BEGINS).found == 3


def test_a_layer_a_style_and_a_draft_of_another_program_change_nothing(path):
    """As QGIS does: a layer of one's own, another style, an inspection by hand; notes are free."""
    before = Season(path).evening(BEGINS).tolist()
    frame = pyogrio.read_dataframe(path, layer="plots")
    pyogrio.write_dataframe(frame, path, layer="my_notes", append=True)
    draft = pyogrio.read_dataframe(path, layer="inspections").head(1)
    draft[["digest", "batch", "undone"]] = None
    pyogrio.write_dataframe(draft, path, layer="inspections", append=True)
    outside(
        path,
        "UPDATE layer_styles SET styleQML = '<qgis/>', owner = 'Ann'",
        "UPDATE inspections SET notes = 'seen again' WHERE fid = 2",
    )
    season = Season(path)
    assert season.evening(BEGINS).tolist() == before
    assert "seen again" in season.history.inspections.notes.tolist()
    season.store.check()


def test_what_we_write_ourselves_is_no_outside_change(path):
    season = Season(path)
    season.plan(BEGINS)
    season.treat(BEGINS, 0.5)
    season.undo()
    season.rebuild()
    with season.store.reading() as db:
        assert outside_changes.waiting(db) == ()
        assert db.execute("SELECT count(*) FROM outside_changes").fetchone() == (0,)
    assert state(path) == 12
