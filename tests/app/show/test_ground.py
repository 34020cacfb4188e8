"""The ground on a map: an agreed map below, what was brought on it, whom to name."""

import numpy as np
import pytest

from app.show import ground as shown
from app.state import ground
from app.state.kept_ground import GroundPicture, GroundTiles
from fieldmon.io.rasters.read import Backdrop
from fieldmon.io.rasters.tiles import read_tiles
from tests.app.chosen import a_plot, chosen
from tests.app.state.test_ground import AGREED
from tests.io.rasters.tile_maps import about, mbtiles

PICTURE = Backdrop(b"jpeg", "image/jpeg", np.array([[0, 0], [0, 1], [1, 1], [1, 0.0]]))


@pytest.fixture
def under(monkeypatch, session):  # noqa: ARG001 - read within it
    """Return what a map shows under its plants."""

    def of(made=None, agreed=None):
        monkeypatch.setattr(ground, "of", lambda _: made)
        monkeypatch.setattr(ground, "agreement", lambda _: agreed)
        return shown.of(chosen(a_plot()))

    return of


def test_nothing_lies_under_a_plot_of_which_nobody_said_anything(under):
    nothing = under()
    assert (nothing.layers, nothing.credit, nothing.is_picture) == ((), "", False)


def test_a_relief_needs_no_rims_and_a_picture_does(under):
    relief = under(GroundPicture("a", PICTURE, is_relief=True))
    assert [one.id for one in relief.layers] == ["ground-picture"]
    assert not relief.is_picture
    assert under(GroundPicture("a", PICTURE)).is_picture


def test_what_was_brought_lies_on_an_agreed_map_and_both_are_named(under, tmp_path):
    tiles = read_tiles(
        mbtiles(tmp_path / "a.mbtiles", about(35.15, 30.36, [15]), attribution="Our drone")
    )
    both = under(GroundTiles("a", tiles), AGREED)
    assert [one.id for one in both.layers] == ["ground-map", "ground-tiles"]
    assert both.credit == "a.example · Our drone"
    assert both.layers[0].data == AGREED.address
    assert both.layers[1].data.startswith("/map_tiles/")
