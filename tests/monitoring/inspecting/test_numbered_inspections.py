"""Inspections of a plant by their numbers."""

from datetime import time

import numpy as np
import pytest

from fieldmon.errors import ObservationError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from tests.monitoring.seasons import on


def test_a_plants_inspections_that_count_come_in_their_order_with_their_numbers(season):
    def say(day, result, second=np.nan, plant=7):
        told = Inspections.of([plant], [result], on(day), second=[second])
        return season.record(told, "x", "Ann").batch

    say(1, FOUND)
    say(1, CLEAN, 40_000, plant=8)
    say(1, FOUND, 30_000)
    say(0, CLEAN, 50_000)
    season.undo(say(0, CLEAN, 20_000), who="Ann")
    made = season.numbered(plant=7)
    assert [(one.number, one.on, one.result, one.who) for one in made] == [
        (4, on(0), CLEAN, "Ann"), (3, on(1), FOUND, "Ann"), (1, on(1), FOUND, "Ann"),
    ]  # fmt: skip
    assert [one.second for one in made[:2]] == [50_000, 30_000]
    assert np.isnan(made[2].second)
    assert [one.number for one in season.numbered(on(1))] == [1, 2, 3]
    assert [one.plant for one in season.numbered(on(1))] == [7, 8, 7]
    assert season.numbered(on(1), 8) == season.numbered(plant=8)
    for none in (-1, 438):
        with pytest.raises(ObservationError, match=f"A plant must be 0 to 437, but it is {none}"):
            season.numbered(plant=none)
    season.correct_time(1, time(6), "Ben", on(0), confirmed=True)
    assert [one.number for one in season.numbered(plant=7)] == [1, 4, 3]
