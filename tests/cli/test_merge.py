"""`fieldmon merge`: two copies of a season become one."""

import shutil

from fieldmon.decisions.labels import ProductLabel
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.phones import scouts
from tests.cli.estate import BEGINS, ZIP, begin_next_year, filled_in
from tests.monitoring.changes.test_outside_changes import outside


def worked(run, season, route, finds, who):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", route)
    filled_in(season.parent / route, finds=finds, n=6)
    code, _, err, _ = run("record", season, route, "--date", BEGINS, "--who", who)
    assert code == 0, err


def test_two_copies_are_merged_and_what_they_tell_differently_is_listed(run, season, tmp_path):
    other = shutil.copy(season, tmp_path / "other.gpkg")
    worked(run, season, "a.csv", {0}, "Ann")
    worked(run, other, "b.csv", {1}, "Ben")
    before = other.read_bytes()
    code, out, err, made = run("merge", season, other)
    assert (code, made) == (0, set()), err
    assert "other.gpkg: 2 inspections were new" in out
    assert out.count("differs: Row") == 2
    assert other.read_bytes() == before
    assert {batch.who for batch in Season(season).batches()} == {"Ann", "Ben"}
    code, out, _, _ = run("merge", season, other)
    assert "0 inspections were new" in out


def test_a_treatment_that_both_recorded_is_marked_where_it_does_not_count(run, season, tmp_path):
    other = shutil.copy(season, tmp_path / "other.gpkg")
    for copy in (season, other):
        run("treat", copy, "--efficacy", "0.8", "--product", "Oil", "--date", BEGINS)
    run("merge", season, other)
    _, out, _, _ = run("status", season, "--batches")
    lines = [line for line in out.splitlines() if "  1 treatment  Oil" in line]
    marked = [line.endswith("  (counts in another batch)") for line in lines]
    assert marked == [True, False]


def test_treatments_and_codes_that_came_in_are_counted_and_hours_have_a_unit(run, season, tmp_path):
    other = shutil.copy(season, tmp_path / "other.gpkg")
    run("change", season, "--hours", "1.5")
    run("change", other, "--hours", "2")
    theirs = Season(other)
    theirs.treat(last_date(theirs), 0.5)
    scouts.let_in(theirs, "Ann", (1, 2))
    code, out, err, _ = run("merge", season, other)
    assert code == 0, err
    assert "0 inspections, 1 treatment, 1 scout's code were new" in out
    assert "codes: of Ann. They read this season and record into it: take back" in out
    assert "robot differs: 1.5 h here, 2 h there" in out


def test_who_was_where_another_copy_knows_that_nobody_might_enter_is_named(run, season, tmp_path):
    other = shutil.copy(season, tmp_path / "other.gpkg")
    worked(run, season, "a.csv", {0}, "Ann")
    treated = "--efficacy", "0.8", "--product", "Oil", "--reentry-hours", "24"
    run("treat", other, *treated, "--began", "00:00", "--ended", "00:10", "--date", BEGINS)
    _, out, err, _ = run("merge", season, other)
    (line,) = (one for one in out.splitlines() if one.startswith("  warning: "))
    assert line.startswith("  warning: Ann was at 6 plants in"), err
    assert f"where Oil was applied on {BEGINS}: entry was allowed from 00:10 on" in line
    assert line.removeprefix("  warning: ") in run("status", season)[1]
    assert "warning: " not in run("merge", season, other)[1]


def test_settings_that_a_merge_takes_over_are_said_and_in_the_log(run, season, tmp_path):
    run("change", season, "--flag-only")
    other = shutil.copy(season, tmp_path / "other.gpkg")
    run("change", other, "--treat-finds", "--hours", "2", "--harvest", "2026-12-10")
    Season(other).keep_labels([ProductLabel("Acarol", waiting_days=7)])
    _, out, err, _ = run("merge", season, other)
    said = "finds only flagged to treated at once; hours 1 to 2; harvest none to 2026-12-10"
    (line,) = (one for one in out.splitlines() if one.startswith("  taken over: "))
    told = line.removeprefix("  taken over: ")
    assert sorted(told.split("; ")) == sorted([*said.split("; "), "table of labels (Acarol)"]), err
    assert f"; taken over: {told}" in run("log", season)[1]
    assert "taken over" not in run("merge", season, other)[1]


def test_a_season_is_not_merged_with_itself_and_a_like_copy_changes_nothing(run, season, tmp_path):
    worked(run, season, "a.csv", {0}, "Ann")
    run("change", season, "--hours", "2")
    (tmp_path / "link.gpkg").symlink_to(season)
    before, log = season.read_bytes(), Season(season).log()
    for other in (season, "link.gpkg"):
        code, _, err, made = run("merge", season, other)
        assert (code, made) == (2, set())
        assert "must be another copy of the season" in err
    assert season.read_bytes() == before
    copy = shutil.copy(season, tmp_path / "copy.gpkg")
    code, out, err, _ = run("merge", season, copy)
    assert code == 0, err
    assert "0 inspections were new" in out
    assert Season(season).log() == log


def test_what_is_no_copy_of_the_season_is_a_sentence(run, season, tmp_path):
    (tmp_path / "notes.txt").write_text("hello")
    (tmp_path / "map.gpkg").touch()
    outside(tmp_path / "map.gpkg", "CREATE TABLE plots (fid)")
    for other in ("notes.txt", "nowhere.gpkg", ".", "map.gpkg"):
        code, _, err, made = run("merge", season, other)
        assert (code, made) == (2, set())
        assert "must be the file of a season" in err
    assert err.startswith("map.gpkg must be")


def test_of_two_copies_the_one_that_another_program_changed_is_named(run, season, tmp_path):
    worked(run, season, "a.csv", {0}, "Ann")
    other = shutil.copy(season, tmp_path / "other.gpkg")
    outside(other, "UPDATE inspections SET result = 'found' WHERE fid = 2")
    for words in (("merge", season, other), ("status", other)):
        assert "fieldmon correct other.gpkg --who NAME" in run(*words)[2]
    run("undo", season, "--inspection", 3)
    outside(other, "UPDATE inspections SET result = 'clean' WHERE fid = 2")
    run("correct", other, "--who", "Ben")
    assert ", 1 was taken back there" in run("merge", other, season)[1]


def test_seasons_of_two_years_on_one_plot_are_no_copies(run, tmp_path):
    words = (ZIP, "--feature", "Nursery", "--hours", "1", "--begins", BEGINS)
    assert run("init", tmp_path / "this.gpkg", *words)[0] == 0
    other = begin_next_year(run, tmp_path)
    kept = (tmp_path / "this.gpkg").read_bytes()
    code, _, err, made = run("merge", "this.gpkg", other)
    assert (code, made) == (2, set())
    assert f"one was begun on {BEGINS} and the other on 2027-11-02" in err
    assert (tmp_path / "this.gpkg").read_bytes() == kept


def test_a_note_is_said_where_it_is_added_and_where_it_comes_from_another_copy(
    run, season, tmp_path
):
    other = shutil.copy(season, tmp_path / "other.gpkg")
    for of, who, notes in ((season, "Ada", ("", "webs")), (other, "Bob", ("eggs",))):
        for note in notes:
            line = f"row,number,date,result,count,notes\n2,1,{BEGINS},found,3,{note}\n"
            (season.parent / "found.csv").write_text(line)
            code, out, err, _ = run("record", of, "found.csv", "--who", who)
            assert code == 0, err
    assert "found.csv: 1 new, 0 known already (batch 1)" in out
    code, out, _, _ = run("record", season, "found.csv", "--who", "Ada")
    assert (code, "found.csv: 0 new, 1 known already, 1 note added (batch 3)" in out) == (0, True)
    code, _, _, _ = run("undo", season)
    code, out, err, _ = run("merge", season, other)
    assert "other.gpkg: 0 inspections were new, 1 note added" in out, err
    assert Season(season).inspections.notes.tolist() == ["webs; eggs (Bob)"]
    _, out, _, _ = run("log", season)
    assert "found.csv: 1 note added to what was known, batch 2" in out
