"""Verdicts of the chance map: right as often as they say, neighbours together or not."""

import numpy as np
import pytest
from scipy import stats

from fieldmon.decisions.map_verdict import AskedVerdict, map_verdict, zone_verdicts
from fieldmon.errors import SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting

GRID = rectangle(20, 25, Planting(90.0, 4.0, 2.0))
ALONE = np.zeros(len(GRID.adjacent.plant))


def independent(chance):
    """Return the chance that two neighbours are both infested, were they to share no fate."""
    of = np.repeat(np.arange(len(GRID)), np.diff(GRID.adjacent.start))
    return chance[of] * chance[GRID.adjacent.plant]


@pytest.mark.parametrize("level", [0.03, 0.05, 0.08])
def test_of_independent_plants_the_chance_is_binomial(level):
    chance = np.full(len(GRID), 0.05)
    said = map_verdict(GRID, chance, AskedVerdict(level), independent(chance))
    true = stats.binom(len(GRID), 0.05).sf(np.ceil(level * len(GRID)) - 1)
    assert said.chance_above == pytest.approx(true, abs=4 * np.sqrt(0.25 / 400))


def test_neighbours_that_share_their_fate_make_it_less_sure():
    chance = np.full(len(GRID), 0.05)
    together = map_verdict(GRID, chance, AskedVerdict(0.07))
    apart = map_verdict(GRID, chance, AskedVerdict(0.07), independent(chance))
    assert together.high - together.low > apart.high - apart.low


def test_it_treats_leaves_or_looks_on_as_sure_as_asked():
    def verdict(share):
        return map_verdict(GRID, np.full(len(GRID), share), AskedVerdict(0.05)).verdict

    assert verdict(0.3) == "treat"
    assert verdict(0.005) == "do not treat"
    assert verdict(0.05) == "inspect more"


@pytest.mark.parametrize("n", [1, 7, 25, 333])
def test_of_plants_that_are_known_to_be_infested_their_share_is_the_level_and_no_less(n):
    known = np.arange(len(GRID)) < n
    asked = AskedVerdict(n / len(GRID), found=known)
    said = map_verdict(GRID, np.where(known, 1.0 - 1e-6, 1e-6), asked)
    assert (said.verdict, said.chance_above) == ("treat", 1.0)


def test_a_part_of_the_plot_is_asked_about_by_itself():
    chance = np.where(np.arange(len(GRID)) < 100, 0.4, 0.001)
    here = np.arange(len(GRID)) < 100
    assert map_verdict(GRID, chance, AskedVerdict(0.1), plants=here).verdict == "treat"
    assert map_verdict(GRID, chance, AskedVerdict(0.1), plants=~here).verdict == "do not treat"


def test_the_sentence_answers_the_question():
    said = map_verdict(GRID, np.full(len(GRID), 0.3), AskedVerdict(0.05)).sentence()
    assert said.startswith("Treat: 30.0 % of the plants are believed infested. ")
    assert "Treating pays if it is 5.0 % or more; the chance of that is over 99 %." in said


def test_the_same_question_has_the_same_answer():
    chance = np.full(len(GRID), 0.05)
    assert map_verdict(GRID, chance, AskedVerdict(0.05)) == map_verdict(
        GRID, chance, AskedVerdict(0.05)
    )


@pytest.mark.parametrize(
    ("asked", "plants", "said"),
    [
        ((0.0,), None, "between 0 and 1"),
        ((np.nan,), None, "between 0 and 1"),
        ((0.1, 0.5), None, "between 0.5 and 1"),
        ((0.1,), np.zeros(500, bool), "the area holds none"),
        ((0.1,), np.ones(10, bool), "each of the 500 plants, but it is of 10"),
        ((0.1,), [1, 2], "must hold True or False"),
    ],
)
def test_questions_without_an_answer_are_refused(asked, plants, said):
    with pytest.raises(SettingError, match=said):
        map_verdict(GRID, np.full(len(GRID), 0.1), AskedVerdict(*asked), plants=plants)


def test_doubt_about_the_number_makes_it_less_sure():
    chance = np.full(len(GRID), 0.05)
    sure, doubted = (
        map_verdict(GRID, chance, AskedVerdict(0.04, doubt=doubt)) for doubt in (0.0, 0.5)
    )
    assert doubted.high - doubted.low > 1.5 * (sure.high - sure.low)
    assert doubted.chance_above < sure.chance_above


def test_a_zones_verdict_is_that_of_its_plants_alone():
    chance = np.where(np.arange(len(GRID)) < 100, 0.4, 0.001)
    zone = np.full(len(GRID), -1)
    zone[:50], zone[200:260] = 0, 1
    said = zone_verdicts(GRID, (chance, None), zone, AskedVerdict(0.1), 0.9)
    for k, one in enumerate(said.zones):
        alone = map_verdict(GRID, chance, AskedVerdict(0.1), plants=zone == k)
        assert one.verdict == alone.verdict
        assert one.share == pytest.approx(alone.share)
        assert one.wrong <= 0.1
    assert [one.verdict for one in said.zones] == ["treat", "do not treat"]


def test_treating_is_enough_if_what_is_left_stays_below():
    chance = np.where(np.arange(len(GRID)) < 100, 0.4, 0.001)
    zone = np.where(np.arange(len(GRID)) < 100, 0, -1)
    assert zone_verdicts(GRID, (chance, None), zone, AskedVerdict(0.03), 0.9).enough > 0.95
    assert zone_verdicts(GRID, (chance, None), zone, AskedVerdict(0.03), 0.05).enough < 0.05
    nowhere = np.full(len(GRID), -1)
    assert zone_verdicts(GRID, (chance, None), nowhere, AskedVerdict(0.03), 0.9).enough < 0.05
