"""Tiles of people's own maps: under addresses nobody can guess, and nothing else is handed out."""

import pytest

from app.state.map_tiles import PATH, TileShelf
from fieldmon.io.rasters.tiles import read_tiles
from tests.io.rasters.tile_maps import about, mbtiles

TILES = about(35.15, 30.36, [15])


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    return read_tiles(mbtiles(tmp_path_factory.mktemp("tiles") / "own.mbtiles", TILES))


def test_a_tile_is_found_at_its_address(own):
    shelf = TileShelf()
    address = shelf.publish(own)
    assert address.startswith(PATH)
    (z, x, y), data = next(iter(TILES.items()))
    assert shelf.get(address.format(z=z, x=x, y=y)) == ("image/png", data)
    assert shelf.get(address.format(z=z, x=x + 9, y=y)) is None
    assert shelf.publish(own) == address, "the same file is found at the same address"
    assert TileShelf().publish(own) != address, "another server's cannot be guessed"


@pytest.mark.parametrize(
    "path", ["/15/1/1", "/../x", "", "/15/1", "/15/1/1/1", "/-1/1/1", "/a/b/c"]
)
def test_any_other_address_is_nothing(own, path):
    shelf = TileShelf()
    address = shelf.publish(own).removesuffix("/{z}/{x}/{y}")
    other = address[:-1] + ("0" if address[-1] != "0" else "1")
    assert shelf.get(other + "/15/1/1") is None
    assert shelf.get(address + path) is None


def test_maps_that_were_not_shown_for_long_are_let_go(own, tmp_path):
    shelf = TileShelf(at_most=1)
    first = shelf.publish(own)
    shelf.publish(read_tiles(mbtiles(tmp_path / "more.mbtiles", TILES)))
    z, x, y = next(iter(TILES))
    assert shelf.get(first.format(z=z, x=x, y=y)) is None
