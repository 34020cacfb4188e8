"""What a season has under its plants: found again, replaced, taken out; an agreement beside it."""

import json

import numpy as np
import pytest

from app.state import kept_ground
from app.state.kept_ground import Agreement, GroundPicture, GroundTiles
from fieldmon.io.rasters.read import Backdrop
from fieldmon.io.rasters.tiles import read_tiles
from tests.io.rasters.tile_maps import about, mbtiles

CORNERS = np.array([[35.0, 30.0], [35.0, 30.1], [35.1, 30.1], [35.1, 30.0]])


@pytest.fixture
def season(tmp_path):
    return tmp_path / "Gate 2026.gpkg"


def picture(**more):
    return GroundPicture("שדה.tif", Backdrop(b"jpeg", "image/jpeg", CORNERS.copy()), **more)


def test_a_season_without_anything_has_nothing_and_no_folder(season):
    assert kept_ground.ground(season) is None
    assert kept_ground.agreement(season) is None
    assert not kept_ground.folder_of(season).exists()


def test_a_picture_is_found_again_as_it_was(season):
    kept_ground.keep(season, picture(is_relief=True, said=("steep",)))
    found = kept_ground.ground(season)
    assert (found.name, found.is_relief, found.said) == ("שדה.tif", True, ("steep",))
    assert (found.picture.image, found.picture.mime) == (b"jpeg", "image/jpeg")
    assert found.picture.corners_lonlat == pytest.approx(CORNERS)


def test_a_map_in_tiles_takes_the_place_of_a_picture_and_is_read_where_it_is_kept(season, tmp_path):
    kept_ground.keep(season, picture())
    tiles = about(35.05, 30.05, [14])
    brought = read_tiles(mbtiles(tmp_path / "own.mbtiles", tiles))
    kept_ground.keep(season, GroundTiles("own.mbtiles", brought))
    (tmp_path / "own.mbtiles").unlink()
    found = kept_ground.ground(season)
    assert found.tiles.tile(*next(iter(tiles))) == next(iter(tiles.values()))
    names = {path.name for path in kept_ground.folder_of(season).iterdir()}
    assert names == {"ground.json", "map.mbtiles"}
    kept_ground.take_out(season)
    assert kept_ground.ground(season) is None
    assert {path.name for path in kept_ground.folder_of(season).iterdir()} == {"ground.json"}


def test_an_agreement_is_kept_beside_the_ground_until_it_is_taken_back(season):
    agreed = Agreement("https://a.example/{z}/{x}/{y}", "somebody", "2026-11-22")
    kept_ground.agree(season, agreed)
    kept_ground.keep(season, picture())
    assert kept_ground.agreement(season) == agreed
    kept_ground.take_out(season)
    assert kept_ground.agreement(season) == agreed
    kept_ground.agree(season, None)
    assert kept_ground.agreement(season) is None


@pytest.mark.parametrize(
    "text", ["", "[]", "{", '{"ground": {"kind": "picture"}}', '{"agreed": {}}']
)
def test_what_cannot_be_read_is_nothing(season, text):
    kept_ground.keep(season, picture())
    (kept_ground.folder_of(season) / "ground.json").write_text(text, encoding="utf-8")
    assert kept_ground.ground(season) is None
    assert kept_ground.agreement(season) is None


def test_a_picture_that_is_gone_is_nothing(season):
    kept_ground.keep(season, picture())
    (kept_ground.folder_of(season) / "picture").unlink()
    assert kept_ground.ground(season) is None
    assert json.loads((kept_ground.folder_of(season) / "ground.json").read_bytes())["ground"]
