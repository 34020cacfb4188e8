"""One working day: what an inspection would find, and when the day ends."""

import numpy as np
import pytest

from fieldmon.planning.workday import draw_detections
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive import Adaptive


def test_a_longer_inspection_finds_what_a_shorter_one_does_and_no_more_than_its_share():
    infested = np.ones(20_000, bool)
    detects = Adaptive(chooses_time=True).inspection_times(Robot()).detects
    first = draw_detections(infested, detects, np.uint64(5))
    for k, chance in enumerate(detects):
        assert np.mean((first > 0) & (first <= k + 1)) == pytest.approx(chance, abs=0.01)
    assert not draw_detections(~infested, detects, np.uint64(5)).any()


def test_what_is_found_follows_from_the_key_alone():
    infested = np.arange(500) % 3 == 0
    one, same, other = (
        draw_detections(infested, np.array([0.5]), np.uint64(key)) for key in (7, 7, 8)
    )
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
    assert not one[~infested].any()
