"""How many plants are still infested, where some were found and only flagged."""

from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.monitoring.estimates.still_infested import (
    infested_in_all,
    not_found_yet,
    still_certain,
)
from fieldmon.plot.layout import rectangle

GRID = rectangle(8, 8)
FLAGGED = np.arange(len(GRID)) < 4


def believed(*flagged):
    """Return what is believed of a nearly clean plot whose first plants have these chances."""
    chance = np.full(len(GRID), 1e-6)
    chance[: len(flagged)] = flagged
    return SimpleNamespace(
        chance=chance, pair_chance=None, doubt=0.0, since_inspected=None, pest=None
    )


def test_flagged_plants_are_certain_until_a_treatment_leaves_them_in_doubt():
    certain = still_certain(believed(0.999, 0.999, 0.2, 0.999), FLAGGED)
    assert np.flatnonzero(certain).tolist() == [0, 1, 3]
    assert still_certain(believed(0.999), None) is None


def test_those_found_are_counted_once_be_it_among_all_or_beside_those_not_found_yet():
    known = believed(0.999, 0.999, 0.999, 0.999)
    left, everything = (of(GRID, known, FLAGGED) for of in (not_found_yet, infested_in_all))
    assert left.expected == pytest.approx(0.0, abs=1e-3)
    assert everything.expected == pytest.approx(4.0, abs=1e-2)
    assert left.chance_clean == everything.chance_clean == 0.0


def test_what_was_treated_may_be_clean_and_the_chance_of_that_is_of_all_plants():
    treated = believed(0.1, 0.1, 0.1, 0.1)
    left, everything = (of(GRID, treated, FLAGGED) for of in (not_found_yet, infested_in_all))
    assert left.expected < 0.01
    assert everything.expected == pytest.approx(0.4, abs=0.01)
    assert left.chance_clean == everything.chance_clean
    assert 0.5 < left.chance_clean < 0.8


def test_without_flagged_plants_both_are_the_estimate_of_the_plot():
    known, nobody = believed(0.3), np.zeros(len(GRID), np.bool_)
    wanted = estimate_of(GRID, known)
    assert not_found_yet(GRID, known, None) == infested_in_all(GRID, known, None) == wanted
    assert not_found_yet(GRID, known, nobody) == wanted
