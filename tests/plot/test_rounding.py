"""Rounding is measured by how far apart plants stand."""

import geopandas
import numpy as np
import pytest
from shapely import Point

from fieldmon.compute.rounding_step import step_of
from fieldmon.errors import FileProblem, ImportDoubt, PlotError
from fieldmon.io.options import ReadOptions
from fieldmon.io.readers.points_and_lines import plants_of
from fieldmon.plot.plot import Plot
from fieldmon.plot.projection import Frame
from fieldmon.plot.rounding import too_coarse
from tests.io.tables_of_cells import sentences, table

M = 111_320.0


def rows_of(row_m, plant_m, bearing_deg=25.0):
    """Return six rows of twenty plants, degrees ``(120, 2)``."""
    row, plant = np.divmod(np.arange(120), 20)
    frame = Frame(35.1, 31.5).turned(bearing_deg)
    return frame.lonlat(np.c_[plant * plant_m, row * row_m])


@pytest.mark.parametrize(
    ("spacings", "decimals", "hides"),
    [
        ((3.0, 1.5), 5, True),
        ((3.0, 1.5), 4, True),
        ((6.0, 3.0), 5, False),
        ((6.0, 4.0), 5, None),
        ((2.0, 1.0, 75.0), 5, True),
        ((3.0, 1.5), 6, None),
        ((3.0, 1.5), 7, None),
    ],
)
def test_rows_are_hidden_by_a_rounding_near_the_spacing(spacings, decimals, hides):
    lonlat = rows_of(*spacings).round(decimals)
    said = too_coarse(lonlat, step_of(lonlat) * M, named=False)
    assert hides == (None if said is None else said.hides_rows)


def test_plants_put_down_exactly_are_not_rounded_nor_are_a_few():
    east, north = np.meshgrid(np.arange(6) * 4e-5, np.arange(20) * 2e-5)
    drawn = np.c_[35.1 + east.ravel(), 31.5 + north.ravel()].round(7)
    assert too_coarse(drawn, step_of(drawn) * M, named=False) is None
    assert too_coarse(rows_of(3, 1.5).round(5)[:19], 1.1, named=False) is None


@pytest.mark.parametrize("decimals", [5, 4])
def test_a_file_of_plants_is_refused_by_its_rounding_before_doubles_are_asked_about(decimals):
    lon, lat = rows_of(3.0, 1.5).round(decimals).T.tolist()
    said = r"rounded to 1\.?1 m and .* Export them with 7 decimals"
    with pytest.raises(FileProblem, match=said):
        plants_of(table(lon=lon, lat=lat), ReadOptions(doubles="one"))
    named = plants_of(
        table(lon=lon, lat=lat, row=[str(k // 20) for k in range(120)]), ReadOptions(doubles="one")
    )
    assert "and rows may be others" in sentences(named)


def test_points_of_a_frame_are_refused_too_and_doubted_where_rows_are_named():
    places = [Point(*at) for at in rows_of(3.0, 1.5).round(5)]
    frame = geopandas.GeoDataFrame(geometry=places, crs=4326)
    with pytest.raises(PlotError, match=r"rounded to 1\.1 m and the nearest"):
        Plot.from_geopandas(frame)
    frame["row"] = np.arange(120) // 20
    with pytest.warns(ImportDoubt, match=r"rounded to 1\.1 m"):
        Plot.from_geopandas(frame)
