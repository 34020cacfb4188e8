"""Plots as GeoDataFrames: the same places in as out."""

import warnings

import geopandas
import numpy as np
import pandas as pd
import pytest
import shapely
from shapely import LineString, MultiPolygon, Point, box

from fieldmon.errors import ImportDoubt, PlotError, SettingError
from fieldmon.plot.field import Field
from fieldmon.plot.frames import plant_frame
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot

# that is said, and what to do then: tests/plot/test_order_in_frame.py
pytestmark = pytest.mark.filterwarnings("ignore:Plants were numbered along rows")

UTM = "EPSG:32636"
SQUARE = box(700_000, 3_360_000, 700_200, 3_360_100)
PLANTING = Planting(row_bearing_deg=90, row_spacing_m=4, plant_spacing_m=2)


def said_of_names(warned):
    """Return what was said, but for the order of plants."""
    return [one for one in warned if "numbered along rows" not in str(one.message)]


def frame(*shapes, crs=UTM):
    return geopandas.GeoDataFrame(geometry=list(shapes), crs=crs)


def test_plants_come_out_where_they_stand_with_row_and_number():
    grid = rectangle(3, 4, Planting())
    plants = plant_frame(grid)
    assert plants.crs.to_epsg() == 4326
    assert np.allclose(np.c_[plants.geometry.x, plants.geometry.y], grid.lonlat(), atol=1e-12)
    assert plants["row"].tolist() == [1] * 4 + [2] * 4 + [3] * 4
    assert plants["number"].tolist() == [1, 2, 3, 4] * 3
    assert plants["plant"].tolist() == list(range(12))
    assert "face" not in plants


def test_some_plants_come_out_in_the_order_asked_for():
    grid = rectangle(3, 4, Planting())
    assert plant_frame(grid, np.array([7, 2]))["plant"].tolist() == [7, 2]


@pytest.mark.parametrize("west", [179.9995, 179.9999, -180.0005])
def test_plants_across_180_lie_in_their_boundary_and_come_back(west):
    """A plot on Taveuni, Fiji."""
    area = MultiPolygon([box(west, -16.9, west + 0.001, -16.8993)])
    plot = Plot.of(Field("Taveuni", area), Planting())
    frame = plot.to_geopandas()
    assert shapely.contains(area.buffer(1e-9), frame.geometry.to_numpy()).all()
    some = plant_frame(plot.grid, np.array([3, len(plot.grid) - 1]))  # whose boundary is not known
    assert (some.geometry.x > 179).all()
    back = Plot.from_geopandas(frame)
    np.testing.assert_allclose(
        back.grid.lonlat()[:, 0] % 360, plot.grid.lonlat()[:, 0] % 360, atol=1e-9
    )
    assert len(back.grid) == len(plot.grid)


def test_faces_are_told_apart_where_both_are_inspected():
    grid = rectangle(2, 3, Planting(faces=2))
    plants = plant_frame(grid)
    first = plants[plants["face"] == 1]["plant"].to_numpy()
    assert (grid.twin[first] > first).all() | (grid.twin[first] < 0).any()
    assert set(plants["face"]) == {1, 2}


def test_a_plot_from_an_area_in_metres_lies_on_that_ground():
    plot = Plot.from_geopandas(frame(SQUARE), PLANTING, "square")
    back = plot.to_geopandas().to_crs(UTM)
    assert plot.field.name == "square"
    assert plot.n_plants == len(back) > 1000
    assert back.within(SQUARE.buffer(0.01)).all()


def test_measured_plants_are_taken_as_they_stand_with_and_without_an_area():
    laid = Plot.from_geopandas(frame(SQUARE), PLANTING)
    plants = laid.to_geopandas()[["geometry"]]
    alone = Plot.from_geopandas(plants)
    area = frame(SQUARE).to_crs(4326)
    both = Plot.from_geopandas(geopandas.GeoDataFrame(
        geometry=[*area.geometry, *plants.geometry], crs=4326))  # fmt: skip
    for plot in (alone, both):
        assert plot.n_plants == laid.n_plants
        assert plot.grid.row_spacing_m == pytest.approx(4, abs=1e-3)
        assert plot.grid.plant_spacing_m == pytest.approx(2, abs=1e-3)
    moved = alone.to_geopandas().to_crs(UTM).geometry
    known = {(round(p.x, 2), round(p.y, 2)) for p in plants.to_crs(UTM).geometry}
    assert {(round(p.x, 2), round(p.y, 2)) for p in moved} == known


def test_points_outside_the_area_are_left_out_as_of_files_and_it_is_said():
    points = Plot.from_geopandas(frame(SQUARE), PLANTING).to_geopandas()[["geometry"]]
    near = box(*SQUARE.buffer(-20).bounds)
    both = pd.concat([frame(near).to_crs(4326), points])
    with pytest.warns(ImportDoubt, match="outside plot") as said:
        plot = Plot.from_geopandas(both, PLANTING)
    left_out, beside = (str(one.message) for one in said)
    assert "left out: " in left_out
    assert 'far="keep" keeps them' in left_out
    assert "taken to be of it" in beside
    within = points.to_crs(UTM).distance(near)
    assert plot.n_plants == (within <= 5.0).sum() < len(points)
    assert {one.filename for one in said} == {__file__}
    with pytest.warns(ImportDoubt, match="left out"):
        assert Plot.from_geopandas(both, PLANTING, far="drop").n_plants == (within == 0).sum()
    assert Plot.from_geopandas(both, PLANTING, far="keep").n_plants == len(points)
    with pytest.raises(SettingError, match="must be one of 'keep', 'drop'"):
        Plot.from_geopandas(both, PLANTING, far="maybe")


@pytest.mark.parametrize("nowhere", [None, Point(), Point(np.nan, np.nan)])
def test_lines_of_a_frame_that_have_no_place_are_said(nowhere):
    points = named_points().reset_index(drop=True)
    points.loc[[3, 7], "geometry"] = nowhere
    with pytest.warns(ImportDoubt, match=r"without a place were left out: 2 of 15 \(3, 7\)"):
        plot = Plot.from_geopandas(points)
    kept = points.drop([3, 7])
    back = plot.to_geopandas()
    assert back.groupby("row_name")["number"].agg(set)["Top"] == {
        *kept[kept["row"] == "Top"]["plant"].astype(int)
    }


@pytest.mark.parametrize(
    ("given", "error", "sentence"),
    [
        (frame(SQUARE, crs=None), SettingError, "set_crs"),
        (frame(SQUARE, SQUARE), PlotError, "holds 2"),
        (frame(LineString([(0, 0), (1, 1)])), PlotError, "LineString"),
        (frame(), PlotError, "nothing"),
        (frame(MultiPolygon()), PlotError, "nothing"),
        (frame(SQUARE, Point(0, 0), LineString([(0, 0), (1, 1)])), PlotError, "LineString"),
    ],
)
def test_what_is_no_plot_is_refused_with_what_to_do(given, error, sentence):
    with pytest.raises(error, match=sentence):
        Plot.from_geopandas(given, PLANTING)


def named_points():
    """Return 3 rows of 5 plants, which are called 12, 7 and "Top", 21 to 25 each."""
    row, k = np.divmod(np.arange(15), 5)
    metres = np.c_[700_000 + 3 * row, 3_360_000 + 2 * k]
    called = np.array(["12", "7", "Top"])[row]
    return geopandas.GeoDataFrame(
        {"row": called, "plant": (k + 21).astype(float)},
        geometry=[Point(one) for one in metres],
        crs=UTM,
    ).sample(frac=1.0, random_state=1)


@pytest.mark.parametrize("within", [False, True])
def test_rows_and_plants_keep_what_a_frame_calls_them_and_come_back_so(within):
    points = named_points()
    if within:
        area = frame(box(699_990, 3_359_990, 700_020, 3_360_020))
        points = pd.concat([area, points])
    plot = Plot.from_geopandas(points)
    back = plot.to_geopandas()
    assert back.groupby("row")["number"].agg(list).tolist() == [[*range(21, 26)]] * 3
    assert {*back["row"]} == {7, 12, 101}
    assert {*back["row_name"]} == {"", "Top"}
    again = Plot.from_geopandas(back).to_geopandas()
    assert again.drop(columns="geometry").equals(back.drop(columns="geometry"))


@pytest.mark.parametrize("outer_faces", [True, False])
def test_both_faces_come_back_as_they_were_and_no_others(outer_faces):
    planting = Planting(row_spacing_m=4, plant_spacing_m=2, faces=2, outer_faces=outer_faces)
    quarter = box(700_000, 3_360_000, 700_100, 3_360_050)
    out = Plot.from_geopandas(frame(quarter), planting).to_geopandas()
    with warnings.catch_warnings():
        warnings.simplefilter("error", ImportDoubt)
        back = Plot.from_geopandas(out).to_geopandas()
    columns = ["row", "number", "face"]
    out, back = (one.sort_values(columns, ignore_index=True) for one in (out, back))
    assert back[columns].equals(out[columns])
    assert back.geometry.geom_equals_exact(out.geometry, 1e-7).all()
    seen = out.groupby(["row", "number"]).size()
    n_both, n_one = (seen == 2).sum(), (seen == 1).sum()
    said = f"faces of {n_both} plants" + (f" and one face of {n_one}" if n_one else "")
    with pytest.warns(ImportDoubt, match=f"{said}, but one is inspected"):
        single = Plot.from_geopandas(out, Planting())
    assert single.n_plants == len(out.drop_duplicates(["row", "number"]))
    lettered = out.assign(face=out["face"].map({1: "A", 2: "b"}))
    assert Plot.from_geopandas(lettered).n_plants == len(out)
    first, row = out["face"] == 1, out["row"]
    for some in (
        out[first | (row == 5)],
        out[first | row.isin([1, 2])],
        out.drop(index=out.index[~first][:5]),
        out[out.index % 7 != 0],
    ):
        with pytest.raises(PlotError, match=r"has both faces of [\d,]+ plants and one face of"):
            Plot.from_geopandas(some)
    with pytest.warns(ImportDoubt, match="but the planting says of which plants both"):
        Plot.from_geopandas(some, planting)


@pytest.mark.parametrize(
    ("row", "plant"),
    [("Row", "Plant"), ("Reihe", "Pflanze"), ("row", "Number"), ("ROW_NUM", "number")],
)
def test_columns_are_recognised_as_those_of_a_file_are_and_said(row, plant):
    points = named_points()
    as_usual = Plot.from_geopandas(points)
    with pytest.warns(ImportDoubt, match=f"rows from '{row}', plants from '{plant}'") as said:
        plot = Plot.from_geopandas(points.rename(columns={"row": row, "plant": plant}))
    assert len(said_of_names(said)) == 1
    assert plot.to_geopandas().equals(as_usual.to_geopandas())


def test_a_column_face_is_recognised_so_too_and_numbers_alone_are_numbers():
    planting = Planting(row_spacing_m=4, plant_spacing_m=2, faces=2)
    out = Plot.from_geopandas(frame(SQUARE), planting).to_geopandas()
    back = Plot.from_geopandas(out.rename(columns={"face": "Face"}))
    assert back.n_plants == len(out)
    points = named_points().drop(columns="row").rename(columns={"plant": "number"})
    assert {*Plot.from_geopandas(points).to_geopandas()["number"]} == {*range(21, 26)}


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (lambda k: np.ones(len(k)), "Column 'plant' was not taken for the numbers of plants"),
        (lambda k: np.where(k < 3, np.nan, k), "Plants count from 1 in all rows"),
        (lambda k: k // 2, "Plants count from 1 in all rows, not by the numbers"),
    ],
)
def test_numbers_of_plants_that_tell_most_not_apart_are_not_dropped_without_a_word(number, said):
    points = named_points()
    points["plant"] = number(points["plant"].to_numpy(int) - 21)
    with pytest.warns(ImportDoubt, match=said) as warned:
        plot = Plot.from_geopandas(points)
    assert len(said_of_names(warned)) == 1
    assert {*plot.to_geopandas()["number"]} == {*range(1, 6)}


@pytest.mark.parametrize(
    ("crs", "said"),
    [
        ('LOCAL_CS["Site",UNIT["metre",1]]', "PROJ finds no way from 'Site'"),
        ("EPSG:4978", "must have x, y and z, but"),
    ],
)
@pytest.mark.parametrize("face", [{}, {"face": [1, 2]}])
def test_a_coordinate_system_that_does_not_lead_to_the_ground_is_refused(crs, said, face):
    places = geopandas.GeoDataFrame(face, geometry=[Point(0, 0), Point(0, 0)], crs=crs)
    with pytest.raises(SettingError, match=said):
        Plot.from_geopandas(places)


def test_an_area_that_crosses_itself_is_refused_with_what_mends_it():
    x, y = 700_000, 3_360_000
    corners = [(0, 0), (100, 0), (100, 60), (60, 60), (60, 61), (59, 60), (61, 60.5), (0, 60)]
    crossing = frame(shapely.Polygon([(x + a, y + b) for a, b in corners]))
    with pytest.raises(PlotError, match=r"self-intersection at 35\.\d+ / 30\.\d+\. .*make_valid"):
        Plot.from_geopandas(crossing, PLANTING)
    mended = crossing.set_geometry(crossing.make_valid())
    assert Plot.from_geopandas(mended, PLANTING).n_plants > 100


def test_a_grid_s_count_of_plants_is_not_taken_for_numbers_in_rows():
    out = Plot.from_geopandas(named_points()).to_geopandas()
    with pytest.warns(ImportDoubt, match="The column plant counts the plants of all rows on"):
        back = Plot.from_geopandas(out.drop(columns="number")).to_geopandas()
    assert back["number"].max() == 5


def test_points_of_two_blocks_are_called_as_a_file_of_plants_calls_them():
    points = named_points()
    there = points.assign(geometry=points.geometry.translate(100), block="South")
    both = pd.concat([points.assign(block="North"), there])  # each label twice
    plot = Plot.from_geopandas(both)
    lonlat = shapely.get_coordinates(both.geometry.to_crs(4326).to_numpy())
    plants = both["plant"].astype(int).astype(str).to_numpy(np.str_)
    named = PlantNames(both["row"].to_numpy(np.str_), both["block"].to_numpy(np.str_), plants)
    as_file = Plot.around("plot", lonlat, names=named)
    assert plot.to_geopandas().equals(as_file.to_geopandas())
    assert len({*plot.grid.block_named}) == 2
