"""Where infestations come from: finds over expected finds, and intervals that hold the truth."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import (
    ANYWHERE,
    AT_START,
    JUMPED,
    N_ORIGINS,
    OVERLOOKED,
    OriginCounts,
)


def counted(origin, found, expected):
    """Return what is known after so many finds of one origin."""
    each = np.eye(N_ORIGINS)[origin]
    return OriginCounts.none().and_those(found * each, expected * each)


def test_before_the_season_nothing_is_known_better():
    none = OriginCounts.none()
    assert (none.scale == 1.0).all()
    assert none.detects(np.array([0.84])) == pytest.approx(0.84)
    assert none.estimate(AT_START, 60.0).value == 60.0


def test_many_finds_tell_how_much_more_an_origin_brings_and_none_of_the_others():
    much = counted(ANYWHERE, 300.0, 100.0)
    assert much.scale[ANYWHERE] == pytest.approx(3.0, abs=0.1)
    assert (np.delete(much.scale, ANYWHERE) == 1.0).all()


def test_the_interval_holds_the_rate_that_finds_were_drawn_with():
    rng, held = np.random.default_rng(3), 0
    for _ in range(400):
        rate = rng.gamma(5.0) / 5.0
        one = counted(JUMPED, float(rng.poisson(20.0 * rate)), 20.0).estimate(JUMPED)
        held += one.low <= rate <= one.high
    assert held / 400 == pytest.approx(0.9, abs=0.04)


def test_more_overlooked_is_a_poorer_detection():
    seen = counted(OVERLOOKED, 60.0, 20.0)
    detection = seen.detection(0.84)
    assert detection.value == pytest.approx(1.0 - 0.16 * 65.0 / 25.0)
    assert detection.low < detection.value < detection.high < 0.84
    assert seen.detects(np.array([0.84]))[0] == pytest.approx(detection.value)
