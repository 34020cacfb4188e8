"""Directions of rows over one another: unlike lines, on the plants, few enough for a map."""

import numpy as np
import pytest

from app.show.maps import directions
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import RowDirection

FRAME = Frame(35.15, 30.36, 90.0)
WAYS = RowDirection(90.0, 10, 3.0), RowDirection(0.0, 24, 3.0)


def planted(n_rows=10, n_plants=24):
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    return FRAME.lonlat(3.0 * np.stack([j, k], axis=1))


def test_the_first_direction_is_drawn_whole_and_others_are_broken_differently():
    whole, broken = directions.layers(planted(), WAYS, ("one", "other"))
    assert len(whole.data) == 10
    ends_m = FRAME.xy_m(np.array([row["path"] for row in whole.data]).reshape(-1, 2))
    assert np.ptp(ends_m.reshape(-1, 2, 2)[..., 0], axis=1) == pytest.approx(69.0, abs=0.05)
    strokes_m = FRAME.xy_m(np.array([row["path"] for row in broken.data]).reshape(-1, 2))
    length_m = np.ptp(strokes_m.reshape(-1, 2, 2)[..., 1], axis=1)
    # 60 % of 27 m in 24 rows is drawn
    assert length_m.sum() == pytest.approx(0.6 * 27.0 * 24, rel=0.01)
    assert {row["t"] for row in broken.data} == {"other"}


def test_lines_legend_and_numbers_have_the_colour_and_order_of_their_direction():
    layers = directions.layers(planted(), WAYS, ("one", "other"))
    items = directions.legend(("one", "other"))["items"]
    assert [tuple(one.get_color) for one in layers] == [colour for _, colour, _ in items]
    assert len({colour for _, colour, _ in items}) == 2
    assert [one["t"] for one in directions.numbers(planted(), WAYS)] == ["1", "2"]


def test_a_large_plot_has_no_more_strokes_than_a_map_draws_at_once():
    many = RowDirection(90.0, 600, 3.0), RowDirection(0.0, 60, 3.0)
    layers = directions.layers(planted(600, 60), (many[1], many[0]), ("one", "other"))
    assert len(layers[1].data) <= 6_000
