"""What a session brought is its own."""

from types import SimpleNamespace

import pytest

from app.state import brought_files, plot_source
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from tests.app.driving import opened, plot_name, square, texts_of, upload, zipped


def test_one_session_does_not_see_the_files_of_another(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(name="secret"))))
    assert plot_name(app) == "secret"
    other = opened(plot_source.FILES)
    assert "Bring a plot" in texts_of(other)


def part(name, data):
    return SimpleNamespace(name=name, getvalue=lambda: data)


@pytest.mark.usefixtures("session")
def test_parts_dropped_together_are_one_file_with_one_key():
    brought_files.keep("plot", [part("a.shp", b"1"), part("a.dbf", b"2")])
    both = brought_files.brought()["plot"]
    assert both.name == "a.shp"
    assert [one.name for one in both.source] == ["a.shp", "a.dbf"]
    brought_files.keep("plot", [part("a.shp", b"1")])
    alone = brought_files.brought()["plot"]
    assert alone.source == Upload("a.shp", b"1")
    assert alone.key != both.key
    brought_files.keep("plot", [])
    assert brought_files.brought() == {}


@pytest.mark.usefixtures("session")
def test_a_box_is_another_one_once_its_file_was_taken_out():
    before = brought_files.box("plot"), brought_files.box("record")
    brought_files.keep("plot", [part("a.shp", b"1"), part("a.dbf", b"2")])
    assert brought_files.brought()["plot"].names == ["a.shp", "a.dbf"]
    brought_files.take_out("plot")
    after = brought_files.box("plot"), brought_files.box("record")
    assert after[0] != before[0]
    assert after[1] == before[1]


@pytest.mark.usefixtures("session")
def test_the_same_bytes_under_another_name_are_another_file():
    keys = set()
    for name, data in (("a.csv", b"1"), ("b.csv", b"1"), ("a.csv", b"2"), ("a.csv", b"1")):
        brought_files.keep("record", [part(name, data)])
        keys.add(brought_files.brought()["record"].key)
    assert len(keys) == 3


@pytest.mark.usefixtures("session")
def test_answers_about_a_file_settle_its_options_and_are_taken_back_in_order():
    file = brought_files.File("key", Upload("a.csv", b""), "plot")
    brought_files.answer(file.asked, "crs", "EPSG:2039")
    brought_files.answer(file.asked, "crs", "")
    brought_files.answer(file.asked, "crs", "EPSG:4326")
    brought_files.answer("other", "crs", "EPSG:25831")
    assert brought_files.settled(file, PlotOptions()).crs == "EPSG:4326"
    assert brought_files.asking() == file.asked
    brought_files.drop_answer(file.asked)
    assert brought_files.settled(file, PlotOptions()).crs == "EPSG:2039"
    brought_files.drop_answer(file.asked)
    assert brought_files.settled(file, PlotOptions()) == PlotOptions()


@pytest.mark.usefixtures("session")
def test_one_file_as_plot_and_as_records_is_answered_twice():
    both = [part("both.gpkg", b"1")]
    for kind in (brought_files.PLOT, brought_files.RECORDS):
        brought_files.keep(kind, both)
    plot, records = brought_files.brought().values()
    brought_files.answer(plot.asked, "layer", "plots")
    assert brought_files.settled(plot, PlotOptions()).layer == "plots"
    assert brought_files.settled(records, RecordOptions()).layer is None
