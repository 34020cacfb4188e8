"""Rows of real plants, and plants in real parcels."""

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
import shapely
from pyproj import Geod, Proj
from shapely import MultiPolygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.grid import nearest_plants, plant_numbers
from fieldmon.plot.layout import found_planting, grid_from_plants, lay
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import plot_around
from fieldmon.plot.row_detection import distinct, rows_from_plants

GEOD = Geod(ellps="WGS84")


@pytest.fixture(scope="module")
def vines(shared):
    table = pd.read_csv(shared / "riseholme_vines" / "riseholme_vineyard_lat_long_vines.csv")
    return table.assign(
        row=table["Vine Row"].str.removeprefix("row_").astype(int),
        number=table["Vine ID"].str[-2:].astype(int),
    )


@pytest.fixture(scope="module")
def vine_lonlat(vines):
    return vines[["Longitude", "Latitude"]].to_numpy()


def test_the_riseholme_vines_stand_in_rows_as_surveyed(vine_lonlat):
    rows = rows_from_plants(vine_lonlat)
    # surveyed as 170.5 degrees from the north of the British grid
    lon, lat = vine_lonlat.mean(axis=0)
    grid_north = Proj("EPSG:27700").get_factors(lon, lat).meridian_convergence
    assert rows.bearing_deg - grid_north == pytest.approx(170.5, abs=0.1)
    assert rows.row_spacing_m == pytest.approx(2.50, abs=0.01)
    assert rows.plant_spacing_m == pytest.approx(1.393, abs=0.005)


def test_the_bearing_of_the_riseholme_rows_is_that_of_geodesics_along_them(vines, vine_lonlat):
    ends = vines.sort_values("number").groupby("row")[["Longitude", "Latitude"]]
    (lon, lat), (lon_end, lat_end) = ends.first().to_numpy().T, ends.last().to_numpy().T
    azimuths = np.array(GEOD.inv(lon, lat, lon_end, lat_end)[0])
    assert rows_from_plants(vine_lonlat).bearing_deg == pytest.approx(azimuths.mean(), abs=0.1)


def test_every_riseholme_vine_is_in_its_own_row_and_place(vines, vine_lonlat):
    grid = grid_from_plants(vine_lonlat)
    assert np.diff(grid.row_start).tolist() == [12] * 10
    plant, distance_m = nearest_plants(grid, vine_lonlat, 0.01)
    assert distance_m.max() < 0.001
    numbered = plant_numbers(grid, plant)
    same_way = [numbered.line == vines["row"], numbered.line == 11 - vines["row"]]
    assert any(way.all() for way in same_way)
    same_way = [numbered.number == vines["number"], numbered.number == 13 - vines["number"]]
    assert any(way.all() for way in same_way)
    assert (np.diff(grid.adjacent.start) <= 4).all()
    assert len(grid.along_plant) == 2 * 10 * 11
    assert len(grid.across_plant) == 2 * 9 * 12


def test_every_riseholme_vine_has_the_row_and_the_number_that_it_is_called_by(vines, vine_lonlat):
    rows, plants = (vines[name].to_numpy(np.str_) for name in ("Vine Row", "Vine ID"))
    grid = plot_around("vines", vine_lonlat, names=PlantNames(rows, None, plants)).grid
    numbered = plant_numbers(grid, nearest_plants(grid, vine_lonlat, 0.01)[0])
    assert numbered.line.tolist() == vines["row"].tolist()
    assert numbered.number.tolist() == vines["number"].tolist()


def test_riseholme_rows_are_still_found_with_a_third_of_the_vines_missing(vine_lonlat):
    kept = np.random.default_rng(1).permutation(120)[:80]
    planting = found_planting(vine_lonlat[kept])
    assert planting.row_bearing_deg == pytest.approx(171.6, abs=0.3)
    assert planting.row_spacing_m == pytest.approx(2.50, abs=0.02)
    assert planting.plant_spacing_m == pytest.approx(1.393, abs=0.03)


@pytest.mark.parametrize("place", ["chico_2020_70", "claremont_2020_82"])
def test_street_trees_are_sorted_into_rows_without_losing_one(shared, place):
    trees = gpd.read_file(shared / "naip_trees" / f"{place}.geojson").to_crs("EPSG:4326")
    lonlat = shapely.get_coordinates(trees.geometry)
    grid = grid_from_plants(lonlat)
    plant, distance_m = nearest_plants(grid, lonlat, 0.1)
    assert sorted(plant) == list(range(len(lonlat)))
    assert distance_m.max() < 0.001


def test_diseased_banana_plants_alone_are_said_to_show_no_rows(shared):
    table = pd.read_csv(shared / "banana_fusarium" / "FusariumBanana.csv")
    plants = table.loc[table["marker"] == "plantas", ["lon", "lat"]].to_numpy()
    plants = plants[distinct(plants)]
    assert "hardly stand in rows" in rows_from_plants(plants).how
    assert len(grid_from_plants(plants)) == len(plants)


@pytest.mark.parametrize(
    "file",
    [
        "parcels_orchards_vineyards/aveiro_vinha_olival_epsg3763.gpkg",
        "parcels_orchards_vineyards/california_tuolumne_vineyard_apple_epsg4269_Z.gpkg",
        "parcels_orchards_vineyards/france_vignes_epsg2154.gpkg",
        "parcels_orchards_vineyards/lleida_apricot_orchards_epsg25831.gpkg",
        "parcels_rlp_vineyards/vineyards.shp",
    ],
)
def test_plants_are_laid_into_real_parcels(shared, file):
    parcels = gpd.read_file(shared / file).to_crs("EPSG:4326").geometry
    laid = 0
    for parcel in shapely.force_2d(shapely.make_valid(parcels.to_numpy()))[:12]:
        parts = [part for part in shapely.get_parts(parcel) if part.geom_type == "Polygon"]
        field = Field("parcel", MultiPolygon(parts))
        try:
            grid = lay(field, Planting())
        except PlotError:  # a few parcels are slivers
            continue
        laid += 1
        some = grid.lonlat(np.arange(0, len(grid), 1 + len(grid) // 2000))
        assert shapely.contains_xy(field.boundary, some).all()
    assert laid >= 8
