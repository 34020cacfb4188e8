"""A field with its plants and ways: whichever way it is made, the plants are those."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import MultiLineString, MultiPolygon, box

import fieldmon as fm
from fieldmon.errors import ImportDoubt, PlotError, SettingError
from fieldmon.io import prepare
from fieldmon.io.guessed_bearing import doubts_of_bearing
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot, planting_of, plot_around
from tests.walked import FRAME, walked

AREA = MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)])
PLANTING = Planting(row_bearing_deg=90.0, row_spacing_m=5.0, plant_spacing_m=4.0)
FIELD = Field("Gate", AREA)


def test_what_is_said_by_hand_goes_before_what_the_field_states_and_that_before_the_default():
    stated = Field("Gate", AREA, row_bearing_deg=10.0, plant_spacing_m=2.0)
    planting = planting_of(stated, plant_spacing_m=1.5, row_spacing_m=None, headland_m=6.0)
    assert planting == Planting(row_bearing_deg=10.0, plant_spacing_m=1.5, headland_m=6.0)
    assert planting_of(FIELD) == Planting()


def test_plants_are_laid_as_the_field_states_where_nobody_says_otherwise():
    stated = Field("Gate", AREA, row_bearing_deg=90.0, row_spacing_m=5.0, plant_spacing_m=4.0)
    np.testing.assert_array_equal(Plot.of(stated).grid.xy_m, lay(FIELD, PLANTING).xy_m)
    np.testing.assert_array_equal(Plot.of(FIELD, PLANTING).grid.xy_m, lay(FIELD, PLANTING).xy_m)


def test_a_spacing_is_chosen_where_it_is_neither_assumed_nor_as_files_have_it():
    both = ("row_spacing_m", "plant_spacing_m")
    stated = Field("Gate", AREA, row_bearing_deg=90.0, row_spacing_m=5.0, plant_spacing_m=4.0)
    assert prepare.lay(FIELD).plot.chosen == ()
    assert prepare.lay(FIELD, PlantingChoices(plant_spacing_m=2.0)).plot.chosen == both[1:]
    assert prepare.lay(stated).plot.chosen == ()
    assert prepare.lay(stated, PlantingChoices(row_spacing_m=6.0)).plot.chosen == both[:1]
    assert prepare.lay(stated, PlantingChoices(row_spacing_m=5.0)).plot.chosen == ()
    assert Plot.of(replace(FIELD, plants=measured())).chosen == ()


def measured():
    """Return the positions of laid plants, as if somebody had measured them."""
    return lay(FIELD, PLANTING).lonlat()


@pytest.mark.parametrize("planting", [None, PLANTING])
def test_measured_plants_stay_where_they_were_measured(planting):
    there = measured()
    field = Field("Gate", AREA, plants=there)
    for plot in (Plot.of(field, planting), plot_around("Gate", there, planting)):
        assert plot.n_plants == len(there)
        off = plot.grid.frame.xy_m(np.array(sorted(there.tolist())))
        off -= plot.grid.frame.xy_m(np.array(sorted(plot.grid.lonlat().tolist())))
        assert np.abs(off).max() < 1e-3
        assert plot.grid.n_rows == lay(FIELD, PLANTING).n_rows


def test_what_is_doubtful_about_measured_plants_is_warned_of():
    there, other = measured(), replace(PLANTING, row_spacing_m=9.0)
    with pytest.warns(ImportDoubt, match="apart") as said:
        plot = Plot.around("Gate", there, other)
    assert any("not 9 m as was said" in one for one in plot.doubts)
    assert tuple(str(one.message) for one in said) == plot.doubts
    assert {one.filename for one in said} == {__file__}
    with pytest.warns(ImportDoubt, match="No rows were found"):
        Plot.around("three", np.array([[1.0, 41.0], [1.0001, 41.0], [2.0, 41.0]]))


def test_rows_along_a_ragged_outline_are_doubted_as_those_of_a_file_unless_they_are_said():
    import geopandas as gpd

    ring = walked([(0, 0), (100, 0), (100, 98), (0, 98)], 3, 1)
    area = MultiPolygon([FRAME.geometry_lonlat(shapely.Polygon(ring))])
    ragged, frame = Field("Gate", area), gpd.GeoSeries([area], crs="EPSG:4326")
    (doubt,) = doubts_of_bearing(ragged, PlantingChoices())
    for make in (lambda: Plot.of(ragged), lambda: Plot.from_geopandas(frame)):
        with pytest.warns(ImportDoubt) as said:
            make()
        assert [str(one.message) for one in said] == [doubt.sentence]
        assert {one.filename for one in said} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Plot.of(ragged, PLANTING)
        Plot.of(FIELD)


def test_around_plants_whose_boundary_nobody_drew_there_is_room_to_turn():
    there = measured()
    plot = Plot.around("Gate", there, PLANTING, gate=(35.15, 30.36))
    assert shapely.contains_xy(plot.field.boundary, there).all()
    assert plot.field.boundary.is_valid
    assert plot.field.gate == (35.15, 30.36)


def test_a_gate_is_where_the_working_day_begins():
    gate = (35.1504, 30.3599)
    plot = Plot.of(Field("Gate", AREA, gate=gate), PLANTING)
    np.testing.assert_allclose(plot.grid.frame.lonlat(plot.aisles.gate_m[None])[0], gate, atol=1e-8)


def test_missing_plants_are_left_out_and_the_others_keep_their_places():
    plot = Plot.of(FIELD, PLANTING)
    missing = np.zeros(plot.n_plants, np.bool_)
    missing[[3, 17]] = True
    left = plot.without(missing)
    np.testing.assert_array_equal(left.grid.xy_m, plot.grid.xy_m[~missing])
    assert left.field is plot.field
    assert plot.without(np.zeros(plot.n_plants, np.bool_)) is plot
    with pytest.raises(PlotError):
        plot.without(np.ones(plot.n_plants, np.bool_))


def test_frames_lead_out_and_back_again():
    import geopandas as gpd

    plot = Plot.of(FIELD, PLANTING)
    out = plot.to_geopandas()
    assert out.crs.to_epsg() == 4326
    assert out["plant"].tolist() == list(range(plot.n_plants))
    back = Plot.from_geopandas(out.to_crs(32636), PLANTING, name="again")
    assert (back.n_plants, back.grid.n_rows) == (plot.n_plants, plot.grid.n_rows)
    with pytest.raises(SettingError, match="coordinate system"):
        Plot.from_geopandas(gpd.GeoDataFrame(geometry=list(AREA.geoms)))


def test_a_plot_and_all_that_is_worked_out_on_it_say_themselves_in_a_line():
    plot = Plot.of(FIELD, PLANTING)
    grid, n = plot.grid, plot.n_plants
    assert repr(plot) == f"<Plot Gate: {grid.counts}>"
    things = (plot, grid, grid.adjacent, grid.linked, plot.aisles, plot.aisles.travel,
              plot.aisles.roads)  # fmt: skip
    for thing in things:
        assert len(repr(thing)) < 80
        assert "array" not in repr(thing)
    assert repr(grid.adjacent) == f"<Csr: {len(grid.adjacent.plant):,} plants in lists of {n}>"


@pytest.mark.parametrize(
    "use", [fm.Monitor, fm.plan_day, lambda given: fm.Season.create("s.gpkg", given)]
)
def test_plants_alone_or_a_file_are_refused_where_a_plot_is_asked_for(use, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for given, kind in ((Plot.of(FIELD, PLANTING).grid, "a PlantGrid"), ("plot.zip", "'plot.zip'")):
        with pytest.raises(SettingError, match=f"but it is {kind}. Give the plot itself"):
            use(given)
    assert not list(tmp_path.iterdir())


def test_plants_and_rows_across_longitude_180_make_a_plot_if_written_from_0_to_360():
    lon, lat = np.meshgrid(180.0 + 1.5e-5 * np.arange(-5, 9), -16.5 + 4e-5 * np.arange(5))
    plants = np.stack([lon.ravel(), lat.ravel()], axis=1)
    rows = MultiLineString([np.stack([lon[k, [0, -1]], lat[k, [0, -1]]], 1) for k in range(5)])
    for plot in (Plot.around("measured", plants), Plot.along("drawn", rows)):
        west, _, east, _ = plot.field.boundary.bounds
        assert 179.999 < west < 180.0 < east < 180.001
        assert plot.grid.n_rows == 5
