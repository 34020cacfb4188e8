"""The ground under the plot: what a file shows, and that a season keeps it."""

from types import SimpleNamespace

import numpy as np
import pytest

from app.state import brought_files, ground, kept_ground
from app.state.kept_ground import Agreement, GroundPicture, GroundTiles
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from tests.app.chosen import CORNER, DAY, a_plot, chosen, in_season
from tests.app.driving import geotiff
from tests.io.rasters.tile_maps import about, mbtiles

LON, LAT = CORNER
EDGES = (LON - 0.001, LAT - 0.001, LON + 0.0016, LAT + 0.0016)
HILL = np.add.outer(np.linspace(100, 130, 40), np.linspace(0, 9, 40)).astype(np.float32)
AGREED = Agreement("https://a.example/{z}/{x}/{y}", "a.example", "2026-11-16")


@pytest.fixture(scope="module")
def plot():
    return a_plot()


@pytest.fixture
def season(plot, tmp_path):
    settings = MonitoringSettings(DAY)
    return in_season(Season.create(tmp_path / "s.gpkg", plot, Records.none(), settings))


def bring(data, name="ground.tif"):
    brought_files.keep(ground.GROUND, [SimpleNamespace(name=name, getvalue=lambda: data)])


@pytest.mark.usefixtures("session")
def test_without_a_file_or_an_agreement_there_is_nothing(plot):
    assert ground.of(chosen(plot)) is None
    assert ground.agreement(None) is None


def test_a_picture_lies_about_the_plot_and_heights_are_drawn_as_relief(plot, session):
    bring(geotiff(np.full((60, 60), 90, np.uint8), EDGES))
    made = ground.of(chosen(plot))
    assert not made.is_relief
    corners, lonlat = made.picture.corners_lonlat, plot.grid.lonlat()
    assert (corners.min(axis=0) <= lonlat.min(axis=0)).all()
    assert (corners.max(axis=0) >= lonlat.max(axis=0)).all()
    bring(geotiff(HILL, EDGES))
    assert ground.of(chosen(plot)).is_relief
    assert any("times as steep" in str(one.message.sentence) for one in ground.said())
    file = brought_files.brought()[ground.GROUND]
    session[f"{ground.SHOWS} {file.key}"] = ground.PICTURE
    assert not ground.of(chosen(plot)).is_relief, "who says it is a picture is believed"


@pytest.mark.usefixtures("session")
def test_a_map_in_tiles_is_known_by_its_content_whatever_its_name(plot, tmp_path):
    data = mbtiles(tmp_path / "m.mbtiles", about(LON, LAT, [16])).read_bytes()
    bring(data, "anything.bin")
    made = ground.of(chosen(plot))
    assert isinstance(made, GroundTiles)
    assert made.tiles.zooms == (16, 16)


@pytest.mark.usefixtures("session")
def test_a_season_keeps_what_is_brought_until_it_is_forgotten(season):
    bring(geotiff(HILL, EDGES))
    made = ground.of(season)
    assert isinstance(made, GroundPicture)
    assert ground.GROUND not in brought_files.brought()
    assert ground.of(season).picture.image == made.picture.image
    assert kept_ground.ground(season.season.path).is_relief
    ground.forget(season)
    assert ground.of(season) is None


@pytest.mark.usefixtures("session")
def test_a_file_that_cannot_be_used_is_left_out_and_its_problem_kept_until_it_is_gone(season):
    bring(b"no picture")
    assert ground.of(season) is None
    assert ground.problem() is not None
    ground.forget(season)
    ground.of(season)
    assert ground.problem() is None


@pytest.mark.usefixtures("session")
def test_an_agreement_is_a_season_s_own_and_a_session_s_own(season):
    ground.agree(season.season, AGREED)
    assert ground.agreement(season.season) == AGREED
    assert ground.agreement(None) is None
    ground.agree(None, AGREED)
    ground.agree(season.season, None)
    assert ground.agreement(season.season) is None
    assert ground.agreement(None) == AGREED
