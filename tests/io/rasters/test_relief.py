"""The relief of heights: lit as the published formula says, however the raster lies."""

import numpy as np
import pytest
from rasterio.transform import from_origin

from fieldmon.errors import FileProblem
from fieldmon.io.rasters import relief
from fieldmon.io.rasters.read import read_relief
from tests.io.rasters.raster_files import PLOT, said, shown, turned, write

NORTH_UP = np.array([[1.0, 0.0], [0.0, -1.0]])


def plane(east, north, size=20):
    """Return heights that rise so many metres per metre, on pixels of 1 m, north up."""
    rows, columns = np.indices((size, size))
    return east * columns - north * rows.astype(float)


def test_slopes_of_a_plane_are_those_of_the_plane_on_any_pixels():
    wanted = np.array([0.2, -0.3])
    assert relief.slopes(plane(0.2, -0.3), NORTH_UP).mean(axis=(1, 2)) == pytest.approx(wanted)
    turn = np.deg2rad(30)
    ground = 2.0 * np.array([[np.cos(turn), np.sin(turn)], [np.sin(turn), -np.cos(turn)]])
    rows, columns = np.indices((9, 9))
    heights = wanted[0] * (ground[0, 0] * columns + ground[0, 1] * rows)
    heights += wanted[1] * (ground[1, 0] * columns + ground[1, 1] * rows)
    assert relief.slopes(heights, ground).mean(axis=(1, 2)) == pytest.approx(wanted)


def test_flat_ground_is_half_lit_and_what_faces_the_light_is_lighter():
    flat = relief.shade(np.zeros((2, 3, 3)))
    assert flat == pytest.approx(0.5)
    towards, away = (relief.shade(np.full((2, 1, 1), s) * [[[1]], [[-1]]]) for s in (0.4, -0.4))
    assert towards > 0.5 > away, "the light comes from the north-west"


def test_one_light_of_the_four_is_horns_shading():
    """Where only one of the four lights weighs in, it is Horn's (1981) cosine of the normal."""
    east, north = 0.0, -0.5  # downhill to the north: the light of azimuth 360 weighs nothing
    lights = np.deg2rad([225.0, 270.0, 315.0])
    normal = np.array([-east, -north, 1.0]) / np.sqrt(1.25)
    rays = np.stack([np.sin(lights) * np.cos(np.pi / 6), np.cos(lights) * np.cos(np.pi / 6),
                     np.full(3, 0.5)])  # fmt: skip
    wanted = (np.sin(0.0 - lights) ** 2 * np.clip(normal @ rays, 0, None)).sum() / 2
    assert relief.shade(np.array([[[east]], [[north]]])) == pytest.approx(wanted)


def test_gentle_slopes_are_drawn_steeper_and_steep_ones_as_they_are():
    assert relief.steeper(np.full((2, 9), 0.0)) == 1.0
    assert relief.steeper(np.full((2, 9), 1.0)) == 1.0
    assert 1.0 < relief.steeper(np.full((2, 9), 0.1)) < 10.0
    assert relief.steeper(np.full((2, 9), 0.001)) == 10.0


def test_gaps_take_the_nearest_height_and_stay_clear_on_finer_pixels():
    heights, gap = plane(0.1, 0.0, 30), np.zeros((30, 30), bool)
    gap[10:12, 10:12] = True
    heights[gap] = np.nan
    full = relief.filled(heights, gap)
    assert np.isfinite(full).all()
    fine, missing = relief.finer(full, gap)
    assert fine.shape == missing.shape == (600, 600)
    assert missing.mean() == pytest.approx(gap.mean())
    assert np.diff(fine[300, 300:580]).min() > 0, "the surface is smooth"


def test_a_hill_is_lit_from_the_north_west_where_it_is_also_on_a_turned_raster(tmp_path):
    rows, columns = np.indices((400, 400))
    heights = 20 * np.exp(-(((columns - 200) / 60) ** 2 + ((rows - 200) / 60) ** 2))
    for name, place in (("up", None), ("turned", turned(90))):
        file = write(tmp_path / f"{name}.tif", heights.astype("float32"), place)
        got = read_relief(file)
        image = shown(got.value)[0].astype(int)
        turns = 1 if name == "turned" else 0
        image = np.rot90(image, turns)  # counter-clockwise: back to north up
        quarter = image.shape[0] // 2
        north_west, south_east = image[:quarter, :quarter], image[quarter:, quarter:]
        assert north_west.mean() > south_east.mean() + 8, name
        assert said(got, "times as steep as they are")


def test_heights_that_are_not_about_the_plot_are_refused_with_a_sentence(tmp_path):
    far = write(tmp_path / "far.tif", plane(0.1, 0.1).astype("float32"),
                from_origin(200_000, 3_000_000, 1, 1))  # fmt: skip
    with pytest.raises(FileProblem, match="must lie on the plot"):
        read_relief(far, None, PLOT)
    empty = write(tmp_path / "empty.tif", np.full((40, 40), -9999, "float32"), nodata=-9999)
    with pytest.raises(FileProblem, match="must show something"):
        read_relief(empty)
