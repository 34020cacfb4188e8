"""The reading process: it may crash, hang or fill the memory, and the program goes on."""

import os
import struct
import sys
import time

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
from shapely import LineString, Point, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io import read
from fieldmon.io.sandbox import limits, process
from fieldmon.io.sandbox.process import ReadingProcess


@pytest.fixture
def reader():
    one = ReadingProcess()
    yield one
    one.stop()


def test_values_and_problems_come_out_as_they_are(reader):
    assert reader.call("math:hypot", (3, 4), 10.0) == 5.0
    assert reader.call("numpy:arange", (3,), 10.0).tolist() == [0, 1, 2]
    with pytest.raises(ZeroDivisionError):
        reader.call("operator:truediv", (1, 0), 10.0)
    with pytest.raises(ChoiceNeeded) as asked:
        reader.call("fieldmon.io.sandbox.unpack:choose_member", ((), "a", "estate.zip"), 10.0)
    assert asked.value.option == "member"
    assert reader.is_alive


def test_it_is_a_process_of_its_own(reader):
    assert reader.pid == reader.call("os:getpid", (), 10.0) != os.getpid()


def test_what_a_library_prints_does_not_end_up_among_the_answers(reader):
    assert reader.call("builtins:print", ("a line",), 10.0) is None
    assert reader.call("os:write", (1, b"another"), 10.0) == 7
    assert reader.call("math:sqrt", (9,), 10.0) == 3.0


@pytest.mark.parametrize(("task", "number"), [("time:sleep", 60), ("math:factorial", 3_000_000)])
def test_the_clock_ends_what_sleeps_and_what_works_too_long_with_a_sentence(reader, task, number):
    began = time.monotonic()
    with pytest.raises(FileProblem, match="must be read within 10 seconds"):
        reader.call(task, (number,), 0.3)
    assert time.monotonic() - began < limits.PATIENCE * 0.3 + 40.0  # others may be at work
    assert not reader.is_alive


def test_a_crash_is_said_to_be_one_and_not_a_slow_file(reader):
    with pytest.raises(FileProblem, match="made its reader crash"):
        reader.call("os:abort", (), 10.0)


def test_nesting_beyond_reason_is_a_sentence_and_the_process_goes_on(reader):
    with pytest.raises(FileProblem, match="nested beyond reason"):
        reader.call("tests.io.sandbox.harm:endless", (1,), 10.0)
    assert reader.call("math:sqrt", (9,), 10.0) == 3.0


@pytest.mark.skipif(sys.platform == "win32", reason="there the clock holds alone")
def test_more_memory_than_allowed_is_a_sentence_and_the_process_goes_on(reader):
    with pytest.raises(FileProblem, match="may take 1 GB of memory at most"):
        reader.call("tests.io.sandbox.harm:hungry", (limits.MEMORY_BYTES,), 10.0)
    assert reader.call("tests.io.sandbox.harm:hungry", (10,), 10.0) == 10


def test_gdal_loads_without_pandas_which_is_there_for_nanoseconds(reader, tmp_path):
    gpd.GeoSeries([Point(35, 30)], crs=4326).to_file(tmp_path / "p.gpkg")
    task = "fieldmon.io.formats.gdal:list_layers"
    (layer,) = reader.call(task, (tmp_path / "p.gpkg", "p.gpkg"), 60.0)
    assert layer.geometry_type == "Point"
    assert reader.call("tests.io.sandbox.harm:loaded", (), 10.0) == []
    when = pd.Timestamp("2026-11-18 06:30:00.123456789")
    frame = gpd.GeoDataFrame({"date": [when]}, geometry=[Point(35, 30)], crs=4326)
    frame.astype({"date": "datetime64[ns]"}).to_parquet(tmp_path / "p.parquet")
    task = "fieldmon.io.formats.geoparquet:read_parquet"
    read = reader.call(task, (tmp_path / "p.parquet", "p.parquet"), 60.0)
    assert read.columns["date"].tolist() == [str(when)]


def test_it_is_kept_for_the_next_file_and_replaced_after_its_last():
    process.stop()
    first = process.call("os:getpid")
    assert process.call("os:getpid") == first
    process.stop()
    assert process.call("os:getpid") != first


def test_a_process_that_was_used_up_is_not_kept(monkeypatch):
    monkeypatch.setattr(process, "_USES", 1)
    process.stop()
    assert process.call("os:getpid") != process.call("os:getpid")
    assert process.peaks_bytes() == []


def test_one_that_died_while_it_waited_is_replaced():
    process.stop()
    first = process.call("os:getpid")
    with pytest.raises(FileProblem, match="crash"):
        process.call("os:_exit", 3)
    assert process.call("os:getpid") != first


@pytest.mark.skipif(sys.platform == "win32", reason="the system does not tell")
def test_the_most_memory_it_ever_took_is_known(reader):
    reader.call("builtins:len", (bytes(60_000_000),), 10.0)
    assert 60_000_000 < reader.peak_bytes < limits.MEMORY_BYTES


# --- broken shapefiles, whose index GDAL makes anew from the shapes themselves ------------------

SHAPES = {
    "areas": [box(35.15, 30.36, 35.151, 30.361), box(35.152, 30.36, 35.153, 30.361)],
    "lines": [LineString([(35.15, 30.36), (35.16, 30.37)])] * 2,
    "points": [Point(35.15, 30.36), Point(35.16, 30.36)],
}


def broken(whole, rng):
    """Yield what may become of a .shp of some hundred bytes on its way."""
    yield from (whole[:cut] for cut in (1, 4, 24, 50, 99, 100, 101, 104, 108, 112, len(whole) - 1))
    yield from (whole[:100] + filler * 50 for filler in (b"\x00" * 8, b"\xff" * 8, b"\x00\x01" * 4))
    yield whole[:4] + rng.bytes(400)
    yield whole[:100] + rng.bytes(400)
    # lengths of the file and of the first record, in words: none, backwards, and to the end of time
    for at in (24, 104):
        for words in (0, 1, 2, 4, 2**31 - 1, -1, -2, -4, -50, -54, -2 - len(whole) // 2):
            yield whole[:at] + struct.pack(">i", words) + whole[at + 4 :]


@pytest.mark.parametrize(
    ("kind", "ends"),
    [
        *(("areas", ends) for ends in ((), (".dbf", ".shx", ".prj"), (".shx",))),
        ("lines", ()),
        ("points", (".shx",)),
    ],
)
def test_a_broken_shapefile_ends_in_plots_or_in_a_sentence_and_never_in_the_clock(
    tmp_path, kind, ends
):
    path = tmp_path / "whole" / "plots.shp"
    path.parent.mkdir()
    frame = gpd.GeoDataFrame({"name": ["a", "b"]}, geometry=SHAPES[kind], crs=4326)
    frame.to_file(path)
    folder = tmp_path / "broken"
    folder.mkdir()
    for end in ends:
        (folder / f"plots{end}").write_bytes(path.with_suffix(end).read_bytes())
    sentences = []
    for data in broken(path.read_bytes(), np.random.default_rng(len(ends))):
        (folder / "plots.shp").write_bytes(data)
        try:
            assert len(read.read_plots(folder / "plots.shp").value) > 0
        except (FileProblem, ChoiceNeeded) as said:
            sentences.append(str(said))
    assert len(sentences) > 20
    assert [said for said in sentences if "must be read within" in said or "crash" in said] == []
    assert process.call("math:sqrt", 4) == 2.0
