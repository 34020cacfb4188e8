"""What a question says to type is typed, and works."""

import json
import re
import shlex

import geopandas as gpd
import openpyxl
import pytest
from shapely import LineString, Point, box

from tests.cli.estate import BEGINS, ZIP, square

ANSWER = re.compile(r'Answer with (--\S+ (?:\S+=)?"[^"]*")')
CORNERS = ((35.15, 30.36), (35.152, 30.36), (35.152, 30.362), (35.15, 30.362))


def two_layers(folder):
    for layer in ("here", "there"):
        square().to_file(folder / "p.gpkg", layer=layer)


def no_system(folder):
    square().to_crs(2039).to_file(folder / "p.shp")
    (folder / "p.prj").unlink()


def latitude_first(folder):
    ring = [[lat, lon] for lon, lat in [*CORNERS, CORNERS[0]]]
    shape = {"type": "Polygon", "coordinates": [[[p[0], p[1] + 80] for p in ring]]}
    (folder / "p.geojson").write_text(json.dumps({"type": "Feature", "geometry": shape}))


def no_names(folder):
    rows = "\n".join(f"{lon};{lat}" for lon, lat in CORNERS)
    (folder / "p.csv").write_text(f"{rows}\n")


def two_sheets(folder):
    book = openpyxl.Workbook()
    for name in ("north", "south"):
        sheet = book.create_sheet(name)
        for row in (("lon", "lat"), *CORNERS):
            sheet.append(row)
    book.save(folder / "p.xlsx")


def words_nobody_knows(folder):
    rows = "\n".join(f"{lon};{lat}" for lon, lat in CORNERS)
    (folder / "p.csv").write_text(f"a;b\n{rows}\n")


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (two_layers, "p.gpkg"),
        (no_system, "p.shp"),
        (latitude_first, "p.geojson"),
        (no_names, "p.csv"),
        (two_sheets, "p.xlsx"),
        (words_nobody_knows, "p.csv"),
    ],
)
def test_questions_about_plots_are_answered_until_they_are_listed(run, tmp_path, make, name):
    make(tmp_path)
    answers: list[str] = []
    for _ in range(4):
        code, out, err, _ = run("plots", name, *answers)
        if code == 0:
            assert " ha  " in out
            assert answers
            return
        answer = ANSWER.search(err)
        assert answer, err
        assert not set(shlex.split(answer[1])) <= set(answers), err
        answers += shlex.split(answer[1])
    pytest.fail(f"still asked: {err}")


def test_the_numbers_that_are_listed_are_those_that_feature_takes(run, tmp_path):
    flat = LineString([(35.15, 30.36), (35.151, 30.36)]).buffer(1e-9)
    areas = [flat, box(35.15, 30.36, 35.152, 30.362), box(35.16, 30.36, 35.1605, 30.3605)]
    names = ["flat", "Big", "Small"]
    gpd.GeoDataFrame({"name": names}, geometry=areas, crs=4326).to_file(tmp_path / "p.gpkg")
    _, out, _, _ = run("plots", "p.gpkg")
    listed = [line.split() for line in out.splitlines()]
    assert [(row[0], row[-1]) for row in listed] == [("1", "Big"), ("2", "Small")]
    for number, *_, name in listed:
        code, out, err, _ = run(
            "plan", "--no-bound", "p.gpkg", "--feature", number, "--hours", 1, "-o", "r.csv"
        )
        assert code == 0, err
        assert f"{name}:" in out
    code, _, err, _ = run("plan", "--no-bound", "p.gpkg", "--feature", 3)
    assert code == 2
    assert "There are 2 plots, but none is called '3'" in err


def test_points_where_a_plot_should_be_are_sent_to_the_option_that_takes_them(run, tmp_path):
    rows = [Point(35.15 + i * 4e-5, 30.36 + j * 4e-5) for i in range(4) for j in range(4)]
    gpd.GeoDataFrame(geometry=rows, crs=4326).to_file(tmp_path / "trees.geojson")
    code, _, err, _ = run("plan", "--no-bound", "trees.geojson")
    assert code == 2
    assert "Give points with --plants FILE and lines with --paths FILE" in err
    code, out, err, _ = run("plan", "--no-bound", "--plants", "trees.geojson", "-o", "r.csv")
    assert code == 0, err
    assert "16 plants" in out


def test_doubles_are_left_out_as_the_question_offers(run, tmp_path):
    rows = [Point(35.15 + i * 4e-5, 30.36 + j * 4e-5) for i in range(4) for j in range(4)]
    again = [Point(p.x, p.y + 2e-7) for p in rows[:3]]
    gpd.GeoDataFrame(geometry=[*rows, *again], crs=4326).to_file(tmp_path / "trees.geojson")
    code, _, err, _ = run("plan", "--no-bound", "--plants", "trees.geojson")
    assert code == 2
    assert "3 of 19 are within 5 cm of an earlier one" in err
    answer = shlex.split(ANSWER.search(err)[1])
    code, out, err, _ = run(
        "plan", "--no-bound", "--plants", "trees.geojson", *answer, "-o", "r.csv"
    )
    assert code == 0, err
    assert "16 plants" in out
    assert "dropped: 3 of 19 plants stood within 5 cm of another one" in err


def test_what_the_files_of_findings_leave_open_is_answered_as_they_say(run, season, tmp_path):
    (tmp_path / "r.csv").write_text("plant,verdict\n17,krobbig\n18,no\n19,no\n")
    code, _, err, _ = run("record", season, "r.csv", "--date", BEGINS)
    assert code == 2
    answers = shlex.split(ANSWER.search(err)[1])
    assert answers == ["--finding-option", "columns=present=verdict"]
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS, *answers)
    assert code == 0, err
    assert "2 new" in out
    answer = re.search(r"as clean: (--finding-option \S+)\)", err)
    answers += shlex.split(answer[1])
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS, *answers)
    assert code == 0, err
    assert "1 new, 2 known already" in out


def test_records_that_say_nothing_of_what_was_found_are_all_finds_if_one_says_so(run, tmp_path):
    (tmp_path / "m.csv").write_text("lon,lat,date\n35.1505,30.3605,2026-03-01\n")
    square(geometry=box(35.15, 30.36, 35.151, 30.361)).to_file(tmp_path / "p.gpkg")
    words = (
        "plan",
        "p.gpkg",
        "--no-bound",
        "--records",
        "m.csv",
        "-o",
        "r.csv",
        "--date",
        "2026-03-02",
    )
    code, _, err, _ = run(*words)
    assert code == 2
    assert "must have a column that says what was found" in err
    code, _, err, _ = run(*words, *shlex.split(ANSWER.search(err)[1]))
    assert code == 0, err
    assert "seen: Every record was taken as a find, as told." in err


def test_the_sample_estate_asks_which_plot_and_takes_the_answer(run):
    code, _, err, _ = run("plan", "--no-bound", ZIP)
    assert code == 2
    answer = re.search(r'(--feature "[^"]+") or (--feature \d+)', err)
    for words in answer.groups():
        code, _, err, _ = run(
            "plan", "--no-bound", ZIP, *shlex.split(words), "--hours", 1, "-o", "r.csv"
        )
        assert code == 0, err
