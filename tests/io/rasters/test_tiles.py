"""The door for maps in tiles: what they hold, a tile at its place, and what is refused."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.rasters.tiles import is_tiles, read_tiles
from tests.io.rasters.raster_files import PLOT
from tests.io.rasters.tile_maps import about, mbtiles, pmtiles, tile_at

LON, LAT = 35.151, 30.3604


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    """Return the same tiles as MBTiles and as PMTiles."""
    folder, tiles = tmp_path_factory.mktemp("maps"), about(LON, LAT, range(14, 17))
    bounds = (35.1, 30.3, 35.2, 30.4)
    said = {"bounds": "35.1,30.3,35.2,30.4", "attribution": '<a href="x">Our drone</a>'}
    return tiles, {
        "mbtiles": mbtiles(folder / "a.mbtiles", tiles, **said),
        "pmtiles": pmtiles(folder / "a.pmtiles", tiles, bounds, credit="Our drone"),
    }


@pytest.mark.parametrize("kind", ["mbtiles", "pmtiles"])
def test_every_tile_is_found_at_its_place_and_none_beside_them(maps, kind):
    tiles, files = maps
    found = read_tiles(files[kind], PLOT)
    assert (found.mime, found.zooms, found.size) == ("image/png", (14, 16), 256)
    assert found.bounds == pytest.approx((35.1, 30.3, 35.2, 30.4))
    assert found.credit == "Our drone"
    assert {at: found.tile(*at) for at in tiles} == tiles
    column, row = tile_at(LON, LAT, 16)
    for beside in ((16, column + 9, row), (17, 2 * column, 2 * row), (16, -1, row), (99, 0, 0)):
        assert found.tile(*beside) is None


def test_a_map_that_says_no_bounds_covers_what_its_tiles_do(tmp_path):
    column, row = tile_at(LON, LAT, 15)
    file = mbtiles(tmp_path / "b.mbtiles", about(LON, LAT, [15]))
    west, south, east, north = read_tiles(file).bounds
    assert west < LON < east
    assert south < LAT < north
    assert tile_at(west + 1e-9, north - 1e-9, 15) == (column - 1, row - 1)
    assert tile_at(east - 1e-9, south + 1e-9, 15) == (column + 1, row + 1)


def test_a_map_of_another_place_is_refused(tmp_path):
    file = mbtiles(tmp_path / "far.mbtiles", about(-3.7, 40.4, [15]))
    with pytest.raises(FileProblem, match=r"must show plot home, but it shows another place"):
        read_tiles(file, PLOT)


def test_by_its_first_bytes_a_file_may_be_a_map_in_tiles():
    assert is_tiles(b"PMTiles\x03")
    assert is_tiles(b"SQLite format 3\x00 and more")
    assert not is_tiles(b"II*\x00")
