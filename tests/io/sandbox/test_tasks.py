"""What the reading process is asked for: each door gives what its reader gives, from files."""

import json
import pickle

import numpy as np
import pytest

from fieldmon.io.formats.open_layer import open_layer
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Upload
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.plots import plots_of
from fieldmon.io.sandbox import process, tasks
from fieldmon.io.sandbox.workroom import Workroom


def feature(kind, coordinates, **properties):
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": properties}


def collection(*features):
    text = json.dumps({"type": "FeatureCollection", "features": features})
    return Upload("p.geojson", text.encode())


SQUARE = [[[5.0, 45.0], [5.001, 45.0], [5.001, 45.001], [5.0, 45.001], [5.0, 45.0]]]
PLOTS = collection(feature("Polygon", SQUARE, name="North", crew="Ann", hours=3))
POINTS = collection(
    *(feature("Point", [5.0002 + k / 1e4, 45.0002], row=1, plant=k) for k in (1, 2))
)
LINES = collection(feature("LineString", [[5.0, 45.0], [5.001, 45.0]], name="track"))
RECORDS = Upload("r.csv", b"plot,lat,lon,date,count\nNorth,45.0002,5.0002,2026-04-01,3\n")
DONE = Upload("d.csv", b"plant,found,date\n3,yes,2026-04-01\n4,no,2026-04-01\n")

DOORS = {
    "layers": (PLOTS,),
    "plots": (PLOTS, PlotOptions()),
    "crews": (PLOTS, PlotOptions()),
    "records": (RECORDS, RecordOptions(), None),
    "plants": (POINTS, ReadOptions()),
    "lines": (LINES, ReadOptions()),
    "inspection_rows": (DONE, InspectionOptions()),
}


@pytest.mark.parametrize("door", DOORS)
def test_what_a_door_gives_comes_out_of_the_other_process_as_it_is_here(tmp_path, door):
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    here = getattr(tasks, door)(str(tmp_path / "here"), *DOORS[door])
    there = process.call(f"fieldmon.io.sandbox.tasks:{door}", str(tmp_path / "there"), *DOORS[door])
    assert pickle.dumps(there) == pickle.dumps(pickle.loads(pickle.dumps(here)))  # noqa: S301


def test_plots_are_those_of_their_reader(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    layer = open_layer(PLOTS, PlotOptions(), Workroom(tmp_path / "a"))
    (wanted,) = plots_of(layer, PlotOptions()).value
    (made,) = tasks.plots(str(tmp_path / "b"), PLOTS, PlotOptions()).value
    assert made.name == wanted.name == "North"
    assert made.boundary.equals(wanted.boundary)


def test_who_works_on_a_plot_comes_with_it(tmp_path):
    fields, crews = tasks.crews(str(tmp_path), PLOTS, PlotOptions()).value
    assert [field.name for field in fields] == ["North"]
    assert (crews["North"].who, crews["North"].hours) == ("Ann", 3.0)


def test_points_are_plants_and_lines_are_lines(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    plants = tasks.plants(str(tmp_path / "a"), POINTS, ReadOptions()).value
    np.testing.assert_allclose(plants.lonlat, [[5.0003, 45.0002], [5.0004, 45.0002]])
    assert plants.plant.tolist() == ["1", "2"]
    line = tasks.lines(str(tmp_path / "b"), LINES, ReadOptions()).value
    assert line.length == pytest.approx(0.001)
