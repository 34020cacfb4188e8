"""Inspections exported from a season, changed in another program, are corrected only when told."""

import csv
import io
import shutil
from datetime import date

import numpy as np
import pandas as pd
import pyogrio
import pytest

from fieldmon.errors import FieldmonError, FileProblem, ObservationError
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting.certifier_tables import csv_bytes, inspections_table
from fieldmon.monitoring.season.exported_inspections import edited_copy
from fieldmon.monitoring.season.inspection_import import read_brought
from tests.monitoring.seasons import BEGINS, a_plot, a_season

OPTIONS = InspectionOptions()


@pytest.fixture(scope="module")
def of_two(recorded, tmp_path_factory):
    """Record what Ann and Ben saw, once; return the season's file."""
    path = shutil.copy(recorded, tmp_path_factory.mktemp("of_two") / "season.gpkg")
    Season(path).record(
        Inspections.of(
            np.array([300, 301]), np.array([0, 1]), BEGINS, second=[np.nan, 30_000],
            count=[np.nan, 2.0], who=["Ann", "Ben"], notes=["", "below, left"], detects=[0.4, 0.3],
        ),
        "more",
    )  # fmt: skip
    return path


@pytest.fixture
def season(of_two, tmp_path):
    return Season(shutil.copy(of_two, tmp_path / "season.gpkg"))


def exported(season):
    """Return the layer of inspections as QGIS exports it."""
    return pyogrio.read_dataframe(season.path, layer="inspections")


def brought(season, layer, folder, name="edited.gpkg"):
    """Return how many corrections a changed layer brings."""
    shutil.rmtree(folder / name, ignore_errors=True)
    (folder / name).mkdir()
    file = folder / name / name
    if name.endswith(".csv"):
        pd.DataFrame(layer.drop(columns="geometry")).to_csv(file, index=False)
    else:
        pyogrio.write_dataframe(layer, file)
    edited = edited_copy(season, file, OPTIONS, folder / name)
    return season.take_corrections(edited.path, name, "Cid"), edited.n_added


@pytest.mark.parametrize("name", ["edited.gpkg", "edited.geojson", "edited.csv"])
def test_what_an_export_says_otherwise_is_corrected_and_undone(season, tmp_path, name):
    layer = exported(season)
    assert brought(season, layer, tmp_path, name) == (0, 0)  # what says the same is no correction
    held = season.history.inspections
    layer.loc[layer["plant"] == 301, ["result", "count", "who"]] = ["clean", None, "Dan"]
    layer.loc[layer["plant"] == 300, "date"] = "2026-04-07"
    layer = layer[::-1].iloc[:-3]  # in another order, and a selection only
    added = layer[layer["plant"] == 300].copy()
    added["digest"] = None
    assert brought(season, pd.concat([layer, added]), tmp_path, name) == (2, 1)
    now = season.history.inspections
    assert len(now) == len(held)
    (k,) = np.flatnonzero(now.plant == 301)
    assert (now.result[k], now.who[k], now.second[k]) == (0, "Dan", 30_000)
    assert np.isnan(now.count[k])
    assert str(now.date[now.plant == 300][0]) == "2026-04-07"
    assert season.verify() == ()
    assert season.batches()[0].who == "Cid"
    assert brought(season, layer, tmp_path, name) == (0, 0)  # twice is once
    season.undo()
    assert season.history.inspections.result.tolist() == held.result.tolist()


def test_what_an_export_does_not_say_or_nobody_can_read_erases_nothing(season, tmp_path):
    layer, held = exported(season), season.history.inspections
    mine = layer["plant"] == 301
    some = layer[["plant", "date", "result", "digest", "undone", "geometry"]].copy()
    assert brought(season, some, tmp_path, "some.csv") == (0, 0)
    some.loc[layer["plant"] == 300, "result"] = "found"
    assert brought(season, some, tmp_path) == (1, 0)
    now = season.history.inspections
    assert np.array_equal(now.count, held.count, equal_nan=True)
    assert now.who.tolist() == held.who.tolist()
    season.undo()
    for column, value in [("result", None), ("result", "maybe"), ("count", "abc"), ("count", "-3"),
                          ("time", "25:00"), ("time", "7h15")]:  # fmt: skip
        wrong = layer.astype({column: object})
        wrong.loc[mine, column] = value
        if column == "result":
            wrong.loc[mine, "count"] = None
        with pytest.raises(ObservationError, match="must be read for certain"):
            brought(season, wrong, tmp_path, "wrong.csv")
    ahead = layer.copy()
    ahead.loc[mine, "date"] = "2199-04-07"
    with pytest.raises(FieldmonError, match="2199"):
        brought(season, ahead, tmp_path)
    pasted = layer[mine].copy()
    pasted["result"], pasted["count"] = "clean", None
    with pytest.raises(ObservationError, match="stands there twice"):
        brought(season, pd.concat([layer, pasted]), tmp_path)
    assert season.history.inspections.result.tolist() == held.result.tolist()


def test_an_export_that_is_no_longer_or_nowhere_of_the_season_is_refused(season, tmp_path):
    layer = exported(season)
    mine = layer["plant"] == 301
    with pytest.raises(ObservationError, match="must hold inspections exported"):
        brought(season, layer.drop(columns="digest"), tmp_path)
    moved = layer.copy()
    moved.loc[mine, "geometry"] = moved[layer["plant"] == 300].geometry.to_numpy()
    with pytest.raises(ObservationError, match="elsewhere than its plant"):
        brought(season, moved, tmp_path)
    layer.loc[mine, "count"] = 0
    with pytest.raises(ObservationError, match=r"record \d+ of .* its count is 0"):
        brought(season, layer, tmp_path)
    layer.loc[mine, ["result", "count"]] = ["clean", 2.0]
    with pytest.raises(ObservationError, match="result and its count contradict each other"):
        brought(season, layer, tmp_path)
    layer.loc[mine, "count"] = None
    season.undo()
    with pytest.raises(FileProblem, match=r"1 inspection of .* is not in it"):
        brought(season, layer, tmp_path)


def test_a_changed_export_is_told_from_plants_inspected_anew_on_another_day(season, tmp_path):
    layer = exported(season)
    layer.loc[layer["plant"] == 301, "count"] = 5
    layer.loc[layer["plant"] == 300, ["date", "result"]] = ["2026-04-07", "found"]
    layer.loc[layer["plant"] == 301, "notes"] = "anew"
    pyogrio.write_dataframe(layer, tmp_path / "edited.gpkg")
    (tmp_path / "new").mkdir()
    read = read_brought(season, tmp_path / "edited.gpkg", OPTIONS, tmp_path / "new")
    assert read.changed == 1
    assert "1 inspection was exported from this season and changed" in read.messages[-1].sentence
    layer.loc[layer["plant"] == 300, "geometry"] = layer.geometry.iloc[0]
    pyogrio.write_dataframe(layer, tmp_path / "moved.gpkg")
    (tmp_path / "moved").mkdir()
    read = read_brought(season, tmp_path / "moved.gpkg", OPTIONS, tmp_path / "moved")
    assert read.changed == 2


@pytest.fixture
def varied(season):
    """Give a season with finds and clean plants, at times to the second, by several people."""
    n = 6
    season.record(
        Inspections.of(
            np.arange(310, 310 + n), np.arange(n) % 2, np.datetime64("2026-04-07") + np.arange(n),
            second=[np.nan, *(30_000.0 + 61 * np.arange(1, n))], who=["Ann", "Jörg", "דנה"] * 2,
            count=np.where(np.arange(n) % 2, np.arange(n) / 2, np.nan), notes=["", "+3, or 4"] * 3,
            detects=np.full(n, 0.3),
        ),
        "varied",
    )  # fmt: skip
    # said again by another, with what the first left open
    season.record(Inspections.of([300], [0], BEGINS, notes=["seen, too"], who=["Eve"]), "again")
    return season


def a_table(season):
    """Return the lines of the table that the command exports."""
    data = csv_bytes([inspections_table(season)]).decode("utf-8-sig")
    return [*csv.DictReader(io.StringIO(data, newline=""))]


def from_spreadsheet(season, lines, folder, *, delimiter=",", code="utf-8-sig", day="", clock=""):
    """Return how many corrections, and what else, a table brings that a spreadsheet saved."""
    said = [{**line} for line in lines]
    for line in said:
        year, month, on = line["date"].split("-")
        line["date"] = day.format(y=year, m=int(month), d=int(on)) or line["date"]
        hour, _, rest = line.get("time", "").partition(":")
        if clock and rest:
            line["time"] = clock.format(h=int(hour), m=rest[:2], s=rest[3:])
        for name in ("lon", "lat", "count", "detects") if delimiter == ";" else ():
            line[name] = line[name].replace(".", ",")
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, [*said[0]], delimiter=delimiter)
    table.writeheader()
    table.writerows(said)
    shutil.rmtree(folder / "table", ignore_errors=True)
    (folder / "table").mkdir()
    file = folder / "table" / "edited.csv"
    file.write_bytes(text.getvalue().encode(code, errors="replace"))
    edited = edited_copy(season, file, OPTIONS, folder / "table")
    n = season.take_corrections(edited.path, file.name, "Cid")
    return n, edited.n_added, edited.n_notes


def test_the_table_that_is_exported_comes_back_as_spreadsheets_save_it(varied, tmp_path):
    lines = a_table(varied)
    plants = [(int(line["row"]), int(line["number"])) for line in lines]
    numbers, done = varied.plant_numbers, varied.history.inspections
    assert plants == [*zip(numbers.line[done.plant], numbers.number[done.plant], strict=True)]
    german = {"delimiter": ";", "day": "{d:02d}.{m:02d}.{y}"}
    american = {"day": "{m}/{d}/{y}", "clock": "{h}:{m}:{s}"}
    minutes = {"day": "{d:02d}/{m:02d}/{y}", "clock": "{h}:{m}"}
    # what says the same is no correction, nor a note
    for way in ({}, minutes, {"delimiter": "\t"}):
        assert from_spreadsheet(varied, lines, tmp_path, **way) == (0, 0, 0), way
    edited = [{**line} for line in lines]
    of = {line["who"] + line["date"]: line for line in edited}
    of["Ann2026-04-10"].update(result="clean", count="")
    of["Jörg2026-04-08"].update(who="Dan", notes="other")
    of["דנה2026-04-09"].update(number="2", lon="", lat="")
    edited.append({**lines[0], "row": "1", "number": "2", "lon": "", "lat": "", "digest": ""})
    # nor is it beside what is changed
    for way in (german, german | {"code": "cp1252"}, american):
        assert from_spreadsheet(varied, edited, tmp_path, **way) == (3, 1, 1), way
        now = varied.history.inspections
        (moved,) = numbers.number[now.plant[now.date == np.datetime64("2026-04-09")]]
        assert moved == 2, way
        assert "Dan" in now.who.tolist()
        assert varied.verify() == ()
        varied.undo()


def test_a_table_that_cannot_be_taken_is_refused_and_says_what_to_do(varied, tmp_path):
    lines = a_table(varied)
    elsewhere = [{**line, "digest": f"{line['digest'][:-1]}x"} for line in lines]
    capitals = [{**lines[-1], "digest": lines[-1]["digest"].upper()}]
    nameless = [{**line, "digest": ""} for line in lines]
    other = [{**line, "digest": f"i{line['digest'][:0:-1]}"} for line in lines]
    moved = [{**line} for line in lines]
    moved[3]["number"] = "2"
    erased = [{**line, "result": "", "count": ""} if line["notes"] else line for line in lines]
    for said, wanted in (
        (elsewhere, r"of record 1 of .* it is 'i[0-9a-f]{23}x'\. Put it there as"),
        (lines[:-1] + capitals, r"24 small letters and digits .* of record \d+ of .* it is 'I"),
        (nameless, r"with their columns result and digest .*fieldmon export --of inspections"),
        (lines + other, r"Export this season alone, and anew"),
        (moved, r"empty its position if the plant is right"),
        (erased, r"no result any more: left unknown\. Correct it there or"),  # once
    ):
        with pytest.raises(FieldmonError, match=wanted):
            from_spreadsheet(varied, said, tmp_path)


def test_what_another_season_of_the_plot_says_in_one_table_is_none_of_this(varied, tmp_path):
    name, file = varied.plot.field.name, varied.path.stem
    lines = [{"plot": f"{name} ({file})"} | line for line in a_table(varied)]
    theirs = [line | {"plot": f"{name} (thrips)"} for line in lines]
    (one,) = (line for line in theirs if line["who"] + line["date"] == "Ann2026-04-10")
    one.update(result="clean", count="")
    assert from_spreadsheet(varied, lines + theirs, tmp_path) == (0, 0, 0)
    table = tmp_path / "table" / "edited.csv"
    edited = edited_copy(varied, table, OPTIONS, tmp_path / "table")
    assert f"of 1 other plot: {name} (thrips)." in edited.of_others
    (tmp_path / "read").mkdir()
    assert read_brought(varied, table, OPTIONS, tmp_path / "read").changed == 0
    with pytest.raises(ObservationError, match="must be of this season"):
        from_spreadsheet(varied, theirs, tmp_path)
    folder = varied.path.absolute().parent.name
    mine = [
        line | {"plot": f"{name} ({folder}/{file})"} for line in theirs
    ]  # of files called alike
    assert from_spreadsheet(varied, mine, tmp_path) == (1, 0, 0)


def test_an_edit_that_makes_an_inspection_like_another_is_none_that_was_taken_already(
    path, tmp_path
):
    season = Season(path)
    season.record(
        Inspections.of([300, 300, 301, 302], [1, 0, 0, 0], date(2026, 4, 7),
                       second=[25_200.0, 46_800.0, np.nan, np.nan]),
        "today", confirmed=True,
    )  # fmt: skip
    lines = [line for line in a_table(season) if line["date"] == "2026-04-07"]
    (found,) = (line for line in lines if line["result"] == "found")
    found["result"], found["count"] = "clean", ""
    for gone in (("time",), ("time", "row", "row_name", "number")):
        said = [{k: v for k, v in line.items() if k not in gone} for line in lines]
        assert from_spreadsheet(season, said, tmp_path) == (1, 0, 0), gone
        assert from_spreadsheet(season, said, tmp_path) == (0, 0, 0), gone  # twice is once
        season.undo()
    numbers = season.plant_numbers.number
    (late,) = (line for line in lines if line["number"] == str(numbers[302]))
    late.update(number=str(numbers[301]), lon="", lat="")
    with pytest.raises(FieldmonError, match="twice"):
        from_spreadsheet(season, lines, tmp_path)


def test_a_table_without_faces_moves_nothing_to_another_face(tmp_path):
    season = a_season(tmp_path / "s.gpkg", a_plot(faces=2))
    twin = season.plot.grid.twin
    (second,) = np.flatnonzero(twin >= 0)[-1:]
    first = twin[second]
    season.record(Inspections.of([second, first], [1, 0], BEGINS, second=[25_200.0, 25_300.0]))
    lines = [line for line in a_table(season) if line["date"] == str(BEGINS)]
    assert {line["face"] for line in lines} == {"1", "2"}
    for line in lines:
        line.update(face="", lon="", lat="")
    assert from_spreadsheet(season, lines, tmp_path) == (0, 0, 0)
    lines[0]["number"] = str(int(lines[0]["number"]) - 1)
    with pytest.raises(ObservationError, match="which face of its plant"):
        from_spreadsheet(season, lines, tmp_path)


def test_seconds_that_a_file_may_not_show_are_no_correction_and_counted(path, tmp_path):
    season = Season(path)
    season.record(Inspections.of([300], [0], date(2026, 4, 7), second=[25_231.0]), "today")
    (line,) = (line for line in a_table(season) if line["date"] == "2026-04-07")
    for at, n, n_seconds in (("07:00:31", 0, 0), ("07:00:00", 0, 1), ("07:00:45", 1, 0)):
        assert from_spreadsheet(season, [line | {"time": at}], tmp_path) == (n, 0, 0), at
        file = tmp_path / "table" / "edited.csv"
        assert edited_copy(season, file, OPTIONS, tmp_path).n_seconds == n_seconds, at


def test_dates_whose_order_nothing_tells_are_refused(path, tmp_path):
    season = Season(path)
    season.record(Inspections.of([300, 301], [0, 1], date(2026, 5, 5)), "today")
    lines = [line for line in a_table(season) if line["date"] == "2026-05-05"]
    assert from_spreadsheet(season, lines, tmp_path, day="{m}/{d}/{y}") == (0, 0, 0)
    lines[0]["date"] = "2026-05-06"
    with pytest.raises(ObservationError, match="day or month first"):
        from_spreadsheet(season, lines, tmp_path, day="{m}/{d}/{y}")
    assert from_spreadsheet(season, lines, tmp_path) == (1, 0, 0)


@pytest.mark.parametrize(
    ("column", "cell", "said"),
    [("time", "24:00", "1 time is 24:00"), ("count", "1.234", "Counts such as 1.234 were read")],
)
def test_a_cell_that_could_say_something_else_is_no_correction(
    season, tmp_path, column, cell, said
):
    layer = exported(season).astype({column: object})
    layer.loc[layer["plant"] == 301, column] = cell
    layer[column] = [one if isinstance(one, str) else "" for one in layer[column]]
    held = season.history.inspections
    with pytest.raises(ObservationError, match=f"must be read for certain, but .*{said}"):
        brought(season, layer, tmp_path, "edited.csv")
    assert season.history.inspections.date.tolist() == held.date.tolist()


def test_a_name_that_was_emptied_is_said_as_the_file_holds_it_then(season, tmp_path):
    season.record(
        Inspections.of([301], [1], BEGINS, second=[30_000], count=[2.0], who=["Bob"]), "again"
    )
    layer = exported(season)
    layer = layer[layer["undone"] == 0]
    layer.loc[layer["plant"] == 301, "who"] = None
    assert brought(season, layer, tmp_path)[0] == 1
    sentence = season.log()[-1].sentence()
    assert "is now who Bob" in sentence
    seen = season.history.inspections
    assert seen.who[seen.plant == 301].tolist() == ["Bob"]
