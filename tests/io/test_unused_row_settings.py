"""What is said of rows by hand where something else says it: it is not used, and that is said."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import LineString, MultiLineString, MultiPolygon

from fieldmon.errors import ImportDoubt
from fieldmon.io.library import read_plot
from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources
from fieldmon.io.prepare import lay, prepare, prepare_estate
from fieldmon.io.unused_row_settings import unused_of
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from fieldmon.plot.projection import Frame
from tests.parcels import write_geojson

FRAME = Frame(8.0, 47.0)
SAID = PlantingChoices(row_bearing_deg=40.0, row_spacing_m=7.0, plant_spacing_m=2.0)


def on_earth(shape):
    return FRAME.geometry_lonlat(shape)


def rows(*ys):
    return on_earth(MultiLineString([LineString([(5, y), (75, y + 5)]) for y in ys]))


FIELD = Field("west", on_earth(MultiPolygon([shapely.box(0, 0, 80, 60)])))


def said(field, choices=SAID):
    return [one.sentence for one in unused_of(field, choices)]


def test_drawn_rows_decide_what_they_show_and_what_was_said_of_it_is_told():
    one, three = (replace(FIELD, row_lines=rows(*ys)) for ys in ([10], [10, 20, 30]))
    as_drawn = "Rows run as they were drawn, and not as was said: "
    assert said(one) == [as_drawn + "row bearing."]
    assert said(three) == [as_drawn + "row bearing, row spacing."]
    for field, apart_m in ((one, 7.0), (three, 10.0)):
        grid = lay(field, SAID).plot.grid
        assert grid.row_spacing_m == pytest.approx(apart_m, rel=0.01)
        bearing = np.degrees(np.arctan2(70, 5))
        assert grid.frame.bearing_deg % 180 == pytest.approx(bearing, abs=0.3)
    assert said(three, PlantingChoices(plant_spacing_m=2.0, headland_m=3.0)) == []
    assert said(FIELD) == []


def test_blocks_that_have_their_own_are_named():
    west, east = (
        Block(name, on_earth(MultiPolygon([shapely.box(x, 0, x + 40, 60)])), **own)
        for name, x, own in (("a", 0, {"row_spacing_m": 3.0}), ("b", 40, {}))
    )
    parted = replace(FIELD, blocks=(west, east))
    not_used = "The {} that was said is not used in 1 block with one of its own: {}."
    assert said(parted) == [not_used.format("row spacing", "a")]
    in_b = on_earth(MultiLineString([LineString([(x, 5), (x, 55)]) for x in (50, 60)]))
    assert said(replace(parted, row_lines=in_b)) == [
        not_used.format("row bearing", "b"),
        "The row spacing that was said is not used in 2 blocks with one of their own: a, b.",
    ]


def test_plants_in_no_rows_have_nothing_of_rows(tmp_path):
    plants = tmp_path / "trees.csv"
    at = FRAME.lonlat(np.random.default_rng(1).uniform(0, 60, (40, 2)))
    plants.write_text("lon,lat\n" + "\n".join(f"{x:.8f},{y:.8f}" for x, y in at))
    choices = PlantingChoices(row_spacing_m=5.0, faces=2, in_rows=False)
    told = prepare(PlotRequest(PlotSources(plants=plants), choices)).messages
    sentence = "Plants in no rows have none of what was said of them: row spacing, faces."
    assert sentence in [one.message.sentence for one in told]
    assert unused_of(FIELD, PlantingChoices(in_rows=False)) == ()


def test_the_library_and_every_plot_of_a_file_say_it_too(tmp_path):
    plot, drawn = tmp_path / "plots.geojson", tmp_path / "rows.geojson"
    write_geojson(plot, [FIELD.boundary], name=["west"])
    write_geojson(drawn, list(rows(10, 20, 30).geoms))
    for source in (plot, None):
        with warnings.catch_warnings(record=True) as doubts:
            warnings.simplefilter("always", ImportDoubt)
            read_plot(source, rows=drawn, planting=PlantingChoices(row_spacing_m=7.0))
        assert [one for one in doubts if "not as was said: row spacing" in str(one.message)]
    estate = prepare_estate(PlotRequest(PlotSources(plot, rows=drawn), SAID))
    told = [one for one in estate.messages if "not as was said" in one.message.sentence]
    assert [one.role for one in told] == ["rows"]


def test_the_usual_spacing_is_doubted_where_somebody_said_it_of_measured_plants(tmp_path):
    plants = tmp_path / "vines.csv"
    at = FRAME.lonlat([(x, y) for y in range(0, 15, 2) for x in range(0, 12, 1)])
    plants.write_text("lon,lat\n" + "\n".join(f"{x:.8f},{y:.8f}" for x, y in at))
    usual = PlantingChoices(row_spacing_m=4.0)
    doubts = prepare(PlotRequest(PlotSources(plants=plants), usual)).plot.doubts
    assert any("are 2.00 m apart, not 4 m as was said" in one for one in doubts)
    assert not prepare(PlotRequest(PlotSources(plants=plants))).plot.doubts
