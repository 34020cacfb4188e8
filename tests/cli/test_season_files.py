"""Several seasons into one: each counts once."""

import json
import re
import shlex
import shutil

import pyogrio
import pytest

from fieldmon.cli.season_files import opened
from fieldmon.errors import SettingError
from fieldmon.monitoring import Season
from fieldmon.monitoring.merging.other_seasons import is_copy
from tests.cli.estate import BEGINS, MITES, ZIP, begin_next_year, filled_in, table
from tests.cli.test_merge import worked
from tests.cli.test_plan_all import SHAPES
from tests.parcels import many, write_geojson

OTHERS = f"plot,row,plant,found,date\nNursery,1,1,yes,{BEGINS}\nPond,1,2,yes,{BEGINS}\n"


def find_in(file, stop):
    """Fill in a find at a stop of a route's GeoJSON."""
    route = json.loads(file.read_text(encoding="utf-8"))
    route["features"][stop]["properties"]["found"] = True
    file.write_text(json.dumps(route), encoding="utf-8")


def test_a_season_is_not_taken_twice_nor_beside_its_copy(run, season, tmp_path):
    copy = shutil.copy(season, tmp_path / "my copy.gpkg")
    with pytest.raises(SettingError) as told:
        opened([season, copy])
    # the way out can be pasted, whatever the files are called and wherever they are
    assert shlex.split(str(told.value).rpartition(": fieldmon merge ")[2]) == [
        str(season),
        str(copy),
    ]
    worked(run, season, "a.csv", {0}, "Ann")
    for other in (season, copy):
        with pytest.raises(SettingError, match="would stand there twice"):
            opened([season, other])
        for words in (("export", "-o", "all.csv", "--of", "inspections"),
                      ("report", "-o", "all.pdf", "--certification")):  # fmt: skip
            code, _, err, made = run(words[0], season, other, *words[1:])
            assert (code, made) == (2, set())
            assert "copies of one" in err


def test_two_seasons_of_one_plot_begun_on_one_day_are_no_copies(run, season, tmp_path):
    words = ("--feature", "Nursery", "--records", MITES, "--begins", BEGINS, "--hours", "1")
    code, _, err, _ = run("init", "flies.gpkg", ZIP, *words)
    assert code == 0, err
    flies = tmp_path / "flies.gpkg"
    worked(run, flies, "a.csv", {0, 1}, "Ann")
    assert not is_copy(Season(season), flies)
    assert is_copy(Season(season), shutil.copy(season, tmp_path / "copy.gpkg"))
    for words in (("share", "--all", "--date", BEGINS, "-o", "day"),
                  ("export", "-o", "all.csv", "--of", "inspections"),
                  ("report", "-o", "all.html", "--certification")):  # fmt: skip
        code, _, err, _ = run(words[0], season, flies, *words[1:])
        assert code == 0, err
        assert "season and flies are 2 seasons of one plot: each" in err
    called = {next(iter(row.values())) for row in table(tmp_path / "all.csv")}
    assert called == {"Nursery (flies)"}, "their files tell plots of one name apart"
    before = season.read_bytes()
    code, _, err, _ = run("merge", season, flies)
    assert code == 2
    assert "they are two seasons. Leave each in its file" in err
    assert season.read_bytes() == before
    # the way out that is named
    code, out, err, _ = run("record", season, flies)
    assert code == 0, err
    assert "6 new" in out


def test_seasons_of_their_own_go_into_one_table(run, season, tmp_path):
    worked(run, season, "a.csv", {0}, "Ann")
    other = begin_next_year(run, tmp_path)
    assert [one.path for one in opened([season, other])] == [season, other]
    code, _, err, _ = run("export", season, other, "--of", "inspections", "-o", "all.csv")
    assert code == 0, err
    assert len(table(tmp_path / "all.csv")) == len(Season(season).history.inspections) == 6


def test_a_day_that_was_filled_in_is_not_written_over_before_it_is_recorded(run, season, tmp_path):
    words = ("plan", season, "--date", BEGINS, "--no-bound")
    words += ("-o", "day.csv", "-o", "day.gpkg", "-o", "day.geojson")
    for _ in range(2):  # not filled in, it may be
        code, _, err, _ = run(*words)
        assert code == 0, err
    filled_in(tmp_path / "day.csv", {0, 2}, 5)
    for name in ("day.csv", "day.gpkg", "day.geojson"):
        if name == "day.gpkg":
            stops = pyogrio.read_dataframe(tmp_path / name, layer="stops")
            stops.loc[3, "found"] = "clean"
            pyogrio.write_dataframe(stops, tmp_path / name, layer="stops")
        if name == "day.geojson":
            find_in(tmp_path / name, 5)
        held = (tmp_path / name).read_bytes()
        code, _, err, made = run(*words)
        assert (code, made) == (2, set())
        assert f"{name} would be written over" in err
        assert (tmp_path / name).read_bytes() == held
        told = shlex.split(err.partition("Record them first: ")[2].partition(";")[0])
        code, _, err, _ = run(*told[1:])
        assert code == 0, err
        code, _, err, _ = run(*words)
        assert code == 0, err
    filled_in(tmp_path / "day.csv", {0}, 1)
    held = (tmp_path / "day.csv").read_text(encoding="utf-8-sig")
    (tmp_path / "day.csv").write_text(held + '"1,1,1,clean\n')
    code, _, err, made = run(*words)
    assert (code, made) == (2, set())
    assert "cannot be read. day.csv, line" in err
    (tmp_path / "day.csv").write_text(held)
    run("record", season, "day.csv")
    run("undo", season)  # what was taken back was recorded
    code, _, err, _ = run(*words)
    assert code == 0, err


def test_what_was_filled_in_for_another_plot_is_kept_and_nobody_is_told_to_record_it(
    run, season, tmp_path
):
    (tmp_path / "day.csv").write_text(OTHERS)
    words = "plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv"
    code, _, err, _ = run(*words)
    assert (code, "holds 1 result that" in err) == (2, True)
    code, _, err, _ = run("record", season, "day.csv")
    assert code == 0, err
    code, _, err, made = run(*words)
    assert (code, made) == (2, set())
    assert "filled in for another plot. 1 record is of 1 other plot: Pond. Choose" in err


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["-o", "day.csv"], "day.csv"),
        ([], "route.geojson"),
        (["--robots", 1, "-o", "day.csv"], "day-robot-1.csv"),
        (["--all", "-o", "routes"], "routes/2-Gate.geojson"),
    ],
)
def test_a_plan_without_a_season_never_writes_over_what_was_filled_in(run, tmp_path, words, name):
    chosen = [ZIP, "--feature", "Gate"]
    if "--all" in words:  # not all of the estate, whose plots workers would share
        write_geojson(tmp_path / "two.geojson", many(SHAPES, 2), name=["Pond", "Gate"])
        chosen = ["two.geojson"]
    words = ["plan", *chosen, *words, "--date", BEGINS, "--no-bound", "--hours"]
    for hours in (1, 1.5):  # not filled in, it may be
        code, _, err, _ = run(*words, hours)
        assert code == 0, err
    (file,) = [one for one in tmp_path.rglob("*") if one.match(name.replace("2-", "*-"))]
    if file.suffix == ".csv":
        filled_in(file, {0}, 1)
    else:
        find_in(file, 3)
    held = file.read_bytes()
    code, _, err, made = run(*words, 2)
    assert (code, made) == (2, set())
    assert f"{file.name} would be written over, but was filled in" in " ".join(err.split())
    assert file.read_bytes() == held


def test_a_copy_that_looks_for_another_pest_is_a_season_of_its_own_once_nothing_stands_in_both(
    run, season, tmp_path
):
    """Beginning a second pest's season by cp, before anything was recorded or after it."""
    early = shutil.copy(season, tmp_path / "early.gpkg")
    worked(run, season, "a.csv", {0, 1}, "Ann")
    late = shutil.copy(season, tmp_path / "late.gpkg")
    for file, pest in ((season, "spider-mite"), (early, "whitefly"), (late, "whitefly")):
        code, _, err, _ = run("change", file, "--pest", pest)
        assert code == 0, err
    words = ("export", season, early, "-o", "all.csv", "--of", "inspections")
    code, _, err, _ = run(*words)
    assert code == 0, err
    assert "are 2 seasons of one plot: each counts" in err
    code, _, err, _ = run("export", season, late, "-o", "b.csv", "--of", "inspections")
    assert code == 2
    assert "would stand there twice. They look for different pests by now: leave one away" in err
    worked(run, early, "b.csv", {3}, "Ben")
    before = season.read_bytes()
    for words in (("merge", season, early), ("record", season, early)):
        code, _, err, _ = run(*words)
        assert code == 2
        assert "finds would become those of another pest" in err
    assert season.read_bytes() == before


def test_merged_with_a_copy_that_names_no_pest_it_is_said_whose_finds_all_are(
    run, season, tmp_path
):
    for named, other in (("a", "b"), ("b", "a")):
        files = {name: shutil.copy(season, tmp_path / f"{name}.gpkg") for name in "ab"}
        run("change", files[named], "--pest", "whitefly")
        said = "Only one copy names a pest, whitefly: what the other found counts as found of it"
        assert said not in run("merge", files["a"], files["b"])[1]
        files[other] = shutil.copy(season, tmp_path / f"{other}.gpkg")
        worked(run, files[other], f"{other}.csv", {1}, "Ann")
        assert said in run("merge", files["a"], files["b"])[1]


def fill_in(file, stop, word):
    """Fill in one stop of a GPX, a KML or a shapefile, as a handheld or QGIS does."""
    if file.name.endswith(".shp.zip"):
        stops = pyogrio.read_dataframe(file, layer="stops")
        stops.loc[stop, "found"] = word
        folder = file.with_name("shape")
        folder.mkdir(exist_ok=True)
        pyogrio.write_dataframe(stops, folder / "stops.shp")
        shutil.make_archive(str(file.with_suffix("")), "zip", folder)
        return
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".gpx":
        named = re.findall(r"<name>(\d+ R\d+/\d+)</name>", text)[stop]
        text = text.replace(f"<name>{named}</name>", f"<name>{named} {word}</name>")
    else:
        before, *stops = text.split('<Data name="found"><value />')
        stops[stop] = f"\n{stops[stop]}"
        text = '<Data name="found"><value />'.join([before, *stops])
        text = text.replace("<value />\n", f"<value>{word}</value>")
    file.write_text(text, encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "word"), [("day.gpx", "+3"), ("day.kml", "yes"), ("day.shp.zip", "yes")]
)
def test_routes_filled_in_on_a_handheld_or_in_qgis_are_kept_until_they_are_recorded(
    run, season, tmp_path, name, word
):
    words = ("plan", season, "--date", BEGINS, "--no-bound", "-o", name)
    for _ in range(2):  # not filled in, it may be
        code, _, err, _ = run(*words)
        assert code == 0, err
    fill_in(tmp_path / name, 1, word)
    held = (tmp_path / name).read_bytes()
    code, _, err, _ = run(*words)
    assert (code, "holds 1 result that nobody recorded" in " ".join(err.split())) == (2, True)
    code, _, err, _ = run("plan", ZIP, "--feature", "Nursery", *words[2:])
    assert (code, "only a season records results" in " ".join(err.split())) == (2, True)
    assert (tmp_path / name).read_bytes() == held
    code, _, err, _ = run("record", season, name, "--date", BEGINS)
    assert code == 0, err
    code, _, err, _ = run(*words)
    assert code == 0, err
    assert (tmp_path / name).read_bytes() != held


def test_words_that_nobody_reads_were_filled_in_too(run, season, tmp_path):
    words = ("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv")
    assert run(*words)[0] == 0
    filled_in(tmp_path / "day.csv", {0}, 1)
    text = (tmp_path / "day.csv").read_text("utf-8-sig").replace("yes", "blau")
    (tmp_path / "day.csv").write_text(text)
    code, _, err, _ = run(*words)
    assert (code, "no result could be read in it" in " ".join(err.split())) == (2, True)
    assert "blau" in (tmp_path / "day.csv").read_text()


def test_no_table_is_written_over_a_sheet_that_nobody_recorded(run, season, tmp_path):
    code, _, err, _ = run("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.csv")
    assert code == 0, err
    filled_in(tmp_path / "day.csv", {0}, 2)
    held = (tmp_path / "day.csv").read_bytes()
    export = ("export", season, "--of", "log", "-o", "day.csv")
    simulate = ("simulate", ZIP, "--feature", "Nursery", "--days", 1, "-o", "day.csv")
    for words in (export, simulate):
        code, _, err, _ = run(*words)
        assert (code, "day.csv would be written over" in " ".join(err.split())) == (2, True)
        assert (tmp_path / "day.csv").read_bytes() == held
    assert run("record", season, "day.csv")[0] == 0
    for words in (export, ("export", season, "--of", "inspections", "-o", "day.csv")) * 2:
        code, _, err, _ = run(*words)
        assert code == 0, err


def test_zones_are_not_written_over_a_route_that_nobody_recorded(run, season, tmp_path):
    assert run("plan", season, "--date", BEGINS, "--no-bound", "-o", "day.geojson")[0] == 0
    find_in(tmp_path / "day.geojson", 2)
    code, _, err, _ = run("decide", season, "--threshold", "5%", "-o", "day.geojson")
    assert (code, "day.geojson would be written over" in " ".join(err.split())) == (2, True)
