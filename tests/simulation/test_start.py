"""The first morning: drawn by each plant's own chance, alike on both faces of a vine."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.plot.layout import Planting, rectangle
from fieldmon.simulation.start import draw_start

GRID = rectangle(20, 20)
CHANCE = np.where(np.arange(400) < 100, 0.2, 0.01)


def test_as_many_are_infested_as_expected_and_more_where_the_chance_is_higher():
    drawn = np.array(
        [draw_start(GRID, CHANCE, 0.05, RandomStreams(s)).infested for s in range(400)]
    )
    assert drawn.mean() == pytest.approx(0.05, rel=0.03)
    assert drawn[:, :100].mean() > 5 * drawn[:, 100:].mean()


def test_without_a_share_the_chances_are_drawn_as_they_are():
    drawn = np.array(
        [draw_start(GRID, CHANCE, None, RandomStreams(s)).infested for s in range(400)]
    )
    assert drawn.mean() == pytest.approx(CHANCE.mean(), rel=0.03)


def test_a_seed_has_one_start_and_what_is_believed_is_the_map_itself():
    one, again, other = (draw_start(GRID, CHANCE, 0.05, RandomStreams(s)) for s in (1, 1, 2))
    assert (one.infested == again.infested).all()
    assert (one.infested != other.infested).any()
    assert one.chance is CHANCE


def test_both_faces_of_a_vine_start_alike():
    faces = rectangle(6, 30, Planting(faces=2))
    start = draw_start(faces, np.full(len(faces), 0.5), 0.3, RandomStreams(4))
    assert (start.infested == start.infested[faces.vine]).all()
    assert 0 < start.infested.sum() < len(faces)
    assert len(np.unique(faces.vine)) < len(faces)
