"""A file of three plots, records that name their rows and plants, and what to prepare of them."""

import json

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.plot_request import (
    PlotRequest,
    PlotSources,
    RecordSource,
)
from fieldmon.io.read import read_plots
from fieldmon.plot.grid import plant_at
from fieldmon.plot.projection import Frame
from tests.paths import SAMPLE_DATA

ZIP, MITES = SAMPLE_DATA / "paran_estate.zip", SAMPLE_DATA / "mite_records.csv"
TRACKS = SAMPLE_DATA / "tracks.geojson"
FRAME = Frame(5.0, 45.0)
DAY = "2026-03-01"


def area(x, y, high=30.0):
    return FRAME.geometry_lonlat(MultiPolygon([shapely.box(x, y, x + 60.0, y + high)]))


def csv(text, name="records.csv"):
    return Upload(name, text.encode())


ROWS = csv(f"row,plant,date,count\n3,7,{DAY},4\n99,1,{DAY},2\n")
PLOTS_AND_ROWS = csv(
    f"plot,row,plant,date,count\nPlot 1,2,3,{DAY},4\nPlot 2,2,3,{DAY},0\nPlot 2,99,1,{DAY},2\n"
    f"Moon,1,1,{DAY},1\nPlot 1,4,1,{DAY},1\n"
)


def one(file, feature=None, records=None, options=None, **more):
    """Return what to prepare of one plot."""
    source = None if records is None else RecordSource(records, options or RecordOptions())
    return PlotRequest(PlotSources(file, PlotOptions(feature=feature)), records=source, **more)


def said(prepared, role=None):
    return [m.message.line() for m in prepared.messages if role in {None, m.role}]


def place(plot, row, plant):
    return plot.grid.lonlat(np.array([plant_at(plot.grid, row, plant)]))[0]


def same(records, other):
    for name, values in vars(records).items():
        np.testing.assert_array_equal(values, getattr(other, name))


def field_called(name):
    return read_plots(ZIP, PlotOptions(feature=name)).value[0]


def labelled_vines(path):
    """Write forty vines on the first plot, rows called A to D; return their positions."""
    lonlat = FRAME.lonlat(
        np.array([(6.0 + 3 * i, 5.0 + 4 * j) for j in range(4) for i in range(10)])
    )
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": spot.tolist()},
            "properties": {"row": "ABCD"[k // 10], "plant": str(k % 10 + 1)},
        }
        for k, spot in enumerate(lonlat)
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return lonlat
