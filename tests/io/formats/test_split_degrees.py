"""Degrees, minutes and seconds in columns of their own are put together, others left alone."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.formats.split_degrees import names_degrees, with_degrees
from fieldmon.io.options import ReadOptions, Upload
from fieldmon.io.read import read_plants
from tests.io.tables_of_cells import sentences, table

HEADS = [
    "lat_d lat_m lat_s lon_d lon_m lon_s",
    "lat lat_min lat_sec lon lon_min lon_sec",
    "Lat(°) Lat(') Lat(\") Lon(°) Lon(') Lon(\")",
    "latitude min sec longitude min_2 sec_2",
    "LonGrad LonMinuten LonSekunden BreiteGrad BreiteMinuten BreiteSekunden",
    "deg_lat min_lat sec_lat deg_long min_long sec_long",
]


@pytest.mark.parametrize("head", HEADS)
def test_degrees_minutes_and_seconds_are_put_together(head):
    lat, lon = (["30"], ["21"], ["36.9"]), (["35"], ["9"], ["0,36"])
    names = head.split()
    cells = (*lon, *lat) if "lon" in names[0].lower() else (*lat, *lon)
    layer = with_degrees(table(**dict(zip(names, cells, strict=True)), id=["7"]))
    assert list(layer.columns) == ["lat", "lon", "id"] or list(layer.columns) == [
        "lon",
        "lat",
        "id",
    ]
    assert layer.columns["lat"][0] == pytest.approx(30 + 21 / 60 + 36.9 / 3600)
    assert layer.columns["lon"][0] == pytest.approx(35 + 9 / 60 + 0.36 / 3600)
    assert "were put together: " in sentences(layer)


def test_south_and_west_come_by_sign_or_letter_and_what_is_no_position_stays_as_written():
    layer = table(
        lat_deg=["-0", "33", "33", "33", None], lat_min=["30", "30", "75", "30", None],
        lat_dir=["S", "S", "S", "E", None],
        lon_deg=["-70", "70", "70", "70", None], lon_min=["0", "6", "6", "6", None],
        lon_dir=["W", "w", "W", "W", None],
    )  # fmt: skip
    read = with_degrees(layer).columns
    assert read["lat"].tolist() == [-0.5, -33.5, "33 / 75 / S", "33 / 30 / E", None]
    np.testing.assert_allclose(read["lon"][:4].astype(float), [-70.0, -70.1, -70.1, -70.1])


def test_other_tables_stay_as_they_are():
    for layer in (
        table(lat=[30.36], lon=[35.15], lat_min=[30.0], lon_min=[35.0]),
        table(lat=[30], lat_min=[21], lon=[35]),
        table(lat=[30.36], lon=[35.15], min=[3], max=[9]),
        table(row=[1], plant=[2]),
    ):
        assert with_degrees(layer) is layer
    assert names_degrees("Latitude Minutes")
    assert not names_degrees("minutes")


def test_a_file_is_read_so_with_letters_beside_and_not_where_columns_are_named():
    head = "id,lat_deg,lat_min,lat_sec,lat_dir,lon_deg,lon_min,lon_sec,lon_dir\n"
    rows = "".join(f"{k},30,21,{36 + k / 10},N,35,9,{k / 10},E\n" for k in range(4))
    file = Upload("vines.csv", (head + rows).encode())
    plants = read_plants(file).value
    seconds = np.arange(4) / 36000
    np.testing.assert_allclose(plants.lonlat[:, 0], 35.15 + seconds)
    np.testing.assert_allclose(plants.lonlat[:, 1], 30.36 + seconds)
    with pytest.raises(FileProblem):
        read_plants(file, ReadOptions().naming(lat="lat_dir", lon="lon_dir"))
