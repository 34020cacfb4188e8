"""Samplers compared in seasons of the same insects."""

import dataclasses
from itertools import count

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import SIMULATED_PER_DAY, Spread
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.samplers.base import Sampler, Stops
from fieldmon.samplers.sweeps import Bouncy, Naive
from fieldmon.simulation.comparison import CompareSettings, Comparison, compare
from fieldmon.simulation.library import draw_start, simulate
from fieldmon.simulation.season import SimulationSettings
from fieldmon.simulation.treating import TreatmentRule
from tests.simulation.test_library import CHANCE, PLOT, ROBOT, SHORT

SETTINGS = CompareSettings(seeds=4, share=0.1, robot=ROBOT, season=SHORT)
COLUMNS = ("detection_pct", "visited_pct", "found", "left", "worked_h")


class Mine(Sampler):
    """A sampler of one's own: as Naive."""

    def walk(self, scene, would_find):
        return Naive().walk(scene, would_find)


class Nobody(Sampler):
    """It goes nowhere."""

    def walk(self, scene, would_find):  # noqa: ARG002 - the protocol's
        return Stops(np.empty(0, np.int32), np.empty(0))


def compared(left, names=("one", "other")):
    """Return a comparison of which only who is left infested is told, (k, s, d)."""
    left = np.asarray(left)
    zero = np.zeros(left.shape)
    return Comparison(names, np.arange(1, left.shape[1] + 1), zero, zero, left, left, zero)


def test_seed_by_seed_it_is_the_season_that_is_simulated_alone():
    made = compare(PLOT, CHANCE, ("naive", "adaptive"), settings=SETTINGS)
    assert made.seeds.tolist() == [1, 2, 3, 4]
    for i, name in enumerate(made.samplers):
        for j, seed in enumerate(made.seeds.tolist()):
            start = draw_start(PLOT, CHANCE, 0.1, seed=seed)
            alone = simulate(PLOT, start, name, robot=ROBOT, settings=SHORT, seed=seed)
            for column in COLUMNS:
                np.testing.assert_array_equal(getattr(made, column)[i, j], getattr(alone, column))
            assert made.infested_plant_days[i, j] == alone.infested_plant_days


def test_samplers_of_ones_own_go_by_their_class_or_by_names_of_choice():
    made = compare(PLOT, CHANCE, [Mine(), "naive"], settings=SETTINGS)
    assert made.samplers == ("Mine", "naive")
    np.testing.assert_array_equal(made.left[0], made.left[1])
    named = compare(PLOT, CHANCE, {"a": Bouncy(), "b": Bouncy(), "c": "naive"}, settings=SETTINGS)
    assert repr(named) == "<Comparison: a, b, c, 4 seasons>"
    np.testing.assert_array_equal(named.left[0], named.left[1])
    np.testing.assert_array_equal(named.left[2], made.left[1])


def test_what_lost_half_is_half_and_its_interval_is_of_paired_seasons():
    left = np.random.default_rng(1).integers(1, 50, (20, 3))
    made = compared([left, 2 * left])
    ratio = made.ratios("other")["one"]
    assert (ratio.value, ratio.low, ratio.high) == pytest.approx((0.5, 0.5, 0.5))
    assert [*made.ratios("one")] == ["other"]
    assert made.sentence("other") == (
        "Infested plant-days over those of other, in 20 simulated seasons: one 0.50 (0.50-0.50)."
    )


def test_a_frame_has_a_line_for_each_sampler_seed_and_day():
    made = compared(np.arange(24).reshape(2, 4, 3))
    lines = made.to_pandas()
    assert [*lines.columns] == ["sampler", "seed", "day", *COLUMNS]
    last = lines.iloc[-1]
    assert (last.sampler, last.seed, last.day, last.left) == ("other", 4, 3, 23)
    lost = lines.groupby(["sampler", "seed"]).left.sum().loc["one"]
    np.testing.assert_array_equal(lost, made.infested_plant_days[0])


def test_seasons_are_those_of_the_commands_and_a_sentence_says_what_insects_did():
    assert CompareSettings().season.spread == Spread(SIMULATED_PER_DAY) == Spread(0.1)
    made = compared(np.ones((2, 20, 3), int))
    worlds = {
        "each neighbour with a chance of 10 % a night): ": {"spread": Spread(0.1)},
        "one neighbour with a chance of 30 % a night): ": {"spread": Spread(0.3, "one")},
        "(pest spider-mite): ": {"pest": PestInWeather(shipped_pest("spider-mite"))},
        "a night, and 0.02 % of the others are infested from outside): ": {
            "spread": Spread(0.1, arrivals_per_day=0.0002)
        },
        " % a night; new infestations hide for 3 nights; a visit every 7 days): ": {
            "hidden_nights": 3,
            "visit_every": 7,
        },
        " % a night; zones treated from 5 % infested on): ": {"treating": TreatmentRule()},
        "; the plot treated from 2 % infested on): ": {"treating": TreatmentRule(0.02, "whole")},
        "(insects of your own): ": {"own_night": lambda _grid, infested, _key: infested},
    }
    for words, chosen in worlds.items():
        told = dataclasses.replace(made, season=SimulationSettings(n_days=3, **chosen))
        assert words in told.sentence("one")
    assert compare(PLOT, CHANCE, ("naive", "bouncy"), settings=SETTINGS).season == SHORT


def test_one_alone_is_held_to_nobody():
    assert compared(np.ones((1, 4, 3), int), ("one",)).sentence("one") == (
        "Only one was compared, in 4 simulated seasons: there is no other to hold it to."
    )


def test_few_seasons_are_said_to_be_few():
    made = compared(np.ones((2, 5, 3), int))
    assert made.sentence("one").endswith("Choose nothing by fewer than 20 (seeds).")


def test_a_comparison_with_a_sampler_that_was_not_compared_is_refused():
    made = compared(np.ones((2, 5, 3), int))
    with pytest.raises(SettingError, match="one of one, other, which were compared, but it is 'n"):
        made.ratios("naive")


def test_progress_is_told_of_all_seasons():
    told = []
    compare(
        PLOT,
        CHANCE,
        ("naive", "bouncy"),
        settings=SETTINGS,
        progress=lambda *done: told.append(done),
    )
    assert told == [(done, 8) for done in range(9)]


def test_stopped_it_returns_what_all_have_been_through():
    asked = count()
    # one of one's own: seasons are simulated one after the other
    made = compare(
        PLOT, CHANCE, [Mine(), "naive"], settings=SETTINGS, stop=lambda: next(asked) >= 5
    )
    assert made.seeds.tolist() == [1, 2]
    assert made.left.shape == (2, 2, SHORT.n_days)
    none = compare(PLOT, CHANCE, ("naive", "bouncy"), settings=SETTINGS, stop=lambda: True)
    assert none.left.shape == (2, 0, SHORT.n_days)
    assert none.left.dtype == np.int64
    assert none.sentence("naive") == "No seed has been met by every sampler yet."


def test_one_of_ones_own_that_names_nobody_is_refused():
    with pytest.raises(SettingError, match="Nobody must name plants"):
        compare(PLOT, CHANCE, [Nobody(), "naive"], settings=SETTINGS)


@pytest.mark.parametrize(
    ("samplers", "said"),
    [
        ("naive", "must be a list of names or samplers, or a dict of them by name, but it is 'na"),
        ((), "must have one sampler or more"),
        (("naive", "naive"), "of different names, but they are naive, naive"),
        ((Mine(), Mine()), "of different names, but they are Mine, Mine. Give a dict"),
        (("best",), "but it is 'best'"),
        ({3: "naive"}, "of different names, but they are 3"),
    ],
)
def test_samplers_that_cannot_be_told_apart_or_are_none_are_refused(samplers, said):
    with pytest.raises(SettingError, match=said):
        compare(PLOT, CHANCE, samplers, settings=SETTINGS)


def test_chances_of_another_plot_and_settings_beyond_reason_are_refused():
    with pytest.raises(SettingError, match="chance map must have the shape"):
        compare(PLOT, CHANCE[:5], ("naive",), settings=SETTINGS)
    for name, value in (("seeds", 1), ("share", 0.0), ("share", 1.0)):
        with pytest.raises(SettingError, match=f"A comparison's {name} must be"):
            dataclasses.replace(SETTINGS, **{name: value})
