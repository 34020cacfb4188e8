"""Pieces of rows, from what stands in line about every place."""

import numpy as np
import pytest

from fieldmon.plot.row_pieces import Windows, pieces


def windows(xy_m, area_m2=3.5, near_m=1.4):
    return Windows.of(xy_m, near_m, area_m2)


def lattice(n_rows, n_plants):
    k, j = np.divmod(np.arange(n_rows * n_plants), n_plants)
    return np.stack([1.4 * j, 2.5 * k], axis=1), k


def test_every_row_of_a_lattice_is_one_piece():
    xy_m, row = lattice(12, 60)
    piece, _ = pieces(xy_m, windows(xy_m))
    assert len(np.unique(piece)) == 12
    assert len(np.unique(np.stack([piece, row]), axis=1).T) == 12


@pytest.mark.parametrize("angle_deg", [0.0, 33.0, 90.0, 170.0])
def test_directions_are_those_of_the_rows(angle_deg):
    xy_m, _ = lattice(12, 40)
    turn = np.deg2rad(angle_deg)
    way = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    _, directions = pieces(xy_m @ way, windows(xy_m @ way))
    off = (np.rad2deg(directions.angle) - angle_deg + 90) % 180 - 90
    # about a corner there are few plants to tell
    assert np.quantile(np.abs(off), 0.9) < 1.0
    assert np.quantile(np.abs(directions.bend_per_m), 0.9) < 0.01


def test_bends_are_those_of_the_circle():
    at = 50.0 + 2.5 * np.repeat(np.arange(8), 40)
    turn = 1.4 * np.tile(np.arange(40) - 20, 8) / at
    xy_m = np.stack([at * np.sin(turn), at * np.cos(turn)], axis=1)
    piece, directions = pieces(xy_m, windows(xy_m))
    assert len(np.unique(piece)) == 8
    # the circle bends to the right of its direction
    assert -1 / 30 < np.median(directions.bend_per_m) < -1 / 120


def test_every_plant_is_in_a_piece_wherever_it_stands():
    xy_m = np.random.default_rng(1).uniform(0, 80, (300, 2))
    piece, _ = pieces(xy_m, windows(xy_m, 20.0, 2.5))
    assert len(piece) == 300
    assert sorted(np.unique(piece)) == list(range(piece.max() + 1))
