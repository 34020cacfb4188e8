"""Finds that are taken as treated, and are found again, are doubted; what is infested anew not."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.estimates import figures_of_day
from fieldmon.monitoring.estimates.found_again import FoundAgain, found_again
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.treating.treatment import Treatment
from tests.monitoring.seasons import BEGINS, a_plot, a_season, on

PLANTS = np.arange(100, 120)


def seen(day, found, plants=PLANTS):
    """Return inspections of a day, of which the first so many found something."""
    result = (np.arange(len(plants)) < found).astype(np.int8)
    return Inspections.of(plants, result, np.datetime64(on(day)))


def told(*inspections, treatments=(), **belief):
    """Return what is said of plants on the last day of inspections."""
    grid = a_plot().grid
    chosen = BeliefSettings(**belief)
    morning = chosen.first_morning(grid, np.full(len(grid), 0.01))
    columns = ("plant", "result", "date")
    every = Inspections.of(*(np.concatenate([getattr(one, c) for one in inspections])
                             for c in columns))  # fmt: skip
    history = History(grid, BEGINS, morning, every, tuple(treatments), belief=chosen)
    return found_again(history, int(history.days[-1]))


def test_what_nobody_treats_is_found_again_and_that_is_said():
    first, then = seen(0, 20), seen(1, 17)
    assert told(first) is None
    said = told(first, then)
    assert said == FoundAgain(17, 20)
    assert said.sentence("here").startswith(
        "17 of 20 plants found before were infested again when inspected again, although finds are "
        "taken as treated at once; if nobody treats them, say so: here"
    )
    assert told(first, then, seen(2, 0), seen(3, 0)) == said  # what was so stays true
    assert told(first, then, treated=False) is None


@pytest.mark.parametrize(
    ("inspections", "why"),
    [
        ((seen(0, 20), seen(1, 9)), "most were clean"),
        ((seen(0, 20), seen(0, 20)), "the same day"),
        ((seen(0, 20), seen(1, 20, PLANTS + 50)), "other plants"),
        ((seen(0, 3), seen(1, 3)), "so few may be chance"),
        ((seen(0, 20), seen(21, 20)), "so late they may be infested anew"),
        ((seen(0, 0), seen(1, 20)), "found once"),
        ((seen(0, 20), seen(1, 17), seen(1, 17, PLANTS + 50)), "others are infested as often"),
    ],
)
def test_nothing_is_said_of_what_may_be_otherwise(inspections, why):
    assert told(*inspections) is None, why


def test_what_a_night_infests_is_no_sign_that_nobody_treats():
    """By what a season believes of its insects."""
    fast = replace(BeliefSettings().spread, rate_per_day=0.4)
    assert told(seen(0, 20), seen(1, 17), spread=fast) is None


def test_what_was_sprayed_in_between_or_could_not_be_inspected_says_nothing():
    grid = a_plot().grid
    half = Treatment(1, np.isin(np.arange(len(grid)), PLANTS[:10]), 0.8)
    first, then = seen(0, 20), seen(2, 20)
    assert told(first, then, treatments=[half]) == FoundAgain(10, 10)
    skipped = replace(then, result=np.full(20, SKIPPED, np.int8))
    assert told(first, skipped) is None


def test_a_season_tells_it_by_its_pest_and_its_advice_names_what_it_assumes(tmp_path):
    season = a_season(tmp_path / "s.gpkg", pest=shipped_pest("spider-mite"))
    for day in (0, 1):
        season.record(seen(day, 20), f"day {day}")
    assert figures_of_day.found_again(season, on(0)) is None
    assert figures_of_day.found_again(season, on(1)) == FoundAgain(20, 20)
    assert "Assumed: finds are treated at once, " in season.advice(on(1)).assumed()
    flagged = replace(season.settings, belief=replace(season.settings.belief, treated=False))
    season.change(flagged, season.settings)
    assert figures_of_day.found_again(season, on(1)) is None
    assert "finds are treated" not in season.advice(on(1)).assumed()
