"""What a night changes in a traced map, and what it says in hindsight."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry.ancestry_night import ToldNight, overnight
from fieldmon.infestation.ancestry.origins import ANYWHERE, BY_ADJACENT, BY_EDGE, JUMPED, N_ORIGINS
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.chance_bounds import AS_GOOD_AS_CLEAN
from fieldmon.infestation.insects.pest_in_weather import PestInWeather, PestSpread
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.clustering import leaning
from fieldmon.infestation.pairs.pair_changes import pairs_after_arrivals
from fieldmon.infestation.pairs.pair_nights import night_of_pairs
from fieldmon.infestation.tracing.traced_evening import inspected
from fieldmon.infestation.tracing.traced_night import _of_late, brought_from_afar, by_origins
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Movement, Pest
from tests.infestation.tracing.traced_maps import (
    FEW,
    FLAT,
    GRID,
    LEARNING,
    QUIET,
    N,
    mid_season,
    seen,
)


@pytest.mark.parametrize(
    "pest", [None, Pest("mite", movement=Movement("exponential", 0.4, reach_m=6.0))]
)
def test_a_night_that_tells_nothing_apart_brings_the_same_chances(pest):
    first = TracedPairs.of(GRID, FLAT, by_ancestry=False)
    belief = first if pest is None else first.of_pest(pest)
    told = untold = seen(belief, np.arange(N) % 41 == 0)
    spread = Spread(0.1) if pest is None else PestInWeather(pest).spread(0, GRID.frame)
    for _ in range(3):
        told, untold = told.overnight(spread), untold.untold_night(spread)
        np.testing.assert_allclose(untold.chance, told.chance, rtol=1e-12)
        np.testing.assert_allclose(untold.pair_chance, told.pair_chance, rtol=1e-10)


@pytest.mark.parametrize("to", ["one", "each"])
@pytest.mark.parametrize("arrivals", [0.0, 0.01])
def test_a_night_brings_each_plant_what_each_origin_sends_it(to, arrivals):
    belief, spread = mid_season(), Spread(0.2, to, arrivals_per_day=arrivals)
    reach, scale, jumps = belief.reach, belief.counts.scale, belief.jumps
    n_beside = np.diff(FEW.adjacent.start).mean()
    sends = 0.2 if to == "one" else 0.2 * n_beside  # of a plant, in a night
    # half of what jumpers send goes beside; others send all of it there
    beside = jumps * 0.5 + (1.0 - jumps)
    near = Spread(0.2 * min(1.0, beside * scale[BY_ADJACENT]), to)
    pairs, lean = (belief.chance, belief.pair_chance), leaning(belief.evidence)
    chance, pair_chance = night_of_pairs(pairs, FEW.linked, near, lean)
    brought = np.zeros((N_ORIGINS, 12))
    for k in range(6):
        sent = sends * jumps * reach.beyond[k] * scale[JUMPED + k]
        brought[JUMPED + k] = sent * reach.landed(belief.chance, reach.mixed(np.eye(6)[k]))
    brought[ANYWHERE] = max(arrivals, 0.0002) * scale[ANYWHERE]
    brought[BY_EDGE] = 0.0001 * scale[BY_EDGE] * reach.at_edge
    arrives = 1.0 - np.exp(-brought.sum(axis=0))
    morning = belief.overnight(spread)
    assert morning.chance == pytest.approx(1.0 - (1.0 - chance) * (1.0 - arrives))
    both = pairs_after_arrivals((chance, pair_chance), FEW.adjacent, arrives, morning.chance)
    assert morning.pair_chance == pytest.approx(both)
    assert morning.unseen == pytest.approx(np.minimum(belief.unseen + sends, 7.0))
    parts = belief.shares * belief.chance[:, None]
    parts[:, BY_ADJACENT] += chance - belief.chance
    parts += (brought / brought.sum(axis=0) * (morning.chance - chance)).T
    assert morning.shares == pytest.approx(parts / morning.chance[:, None], abs=1e-6)


def test_in_hindsight_an_evening_says_what_the_next_morning_does_of_the_same_finds():
    """Where a third of what was inspected is infested, and a fiftieth was told."""
    belief, plants = TracedPairs.of(GRID, FLAT), np.arange(40, dtype=np.int32)
    # no heavier infestation is thought of
    evening = inspected(belief, plants, plants % 3 == 0, LEARNING).settled()
    still = Spread(0.0)
    told, morning = evening.in_hindsight(still), evening.overnight(still)
    assert morning.chance.sum() > 1.3 * evening.chance.sum()
    assert told.chance.sum() == pytest.approx(morning.chance.sum(), rel=0.05)
    # with nothing new there is nothing to look back on
    for known in (belief, morning, told, replace(evening, ancestry=None)):
        assert known.in_hindsight(still) is known


@pytest.mark.parametrize("treated", [True, False])
def test_the_evening_and_the_next_morning_are_told_by_one_draw_a_night_apart(treated):
    """Another draw may believe twice as much: the number would jump without a new result."""
    plants, night = np.arange(40, dtype=np.int32), Spread(0.05)
    found = np.isin(plants, [3, 4, 18, 31])
    belief = replace(TracedPairs.of(GRID, FLAT), others=())
    evening = belief.learn(plants, found, Learning(0.84, treated=treated))
    told, morning = evening.in_hindsight(night), evening.overnight(night)
    assert told.ancestry.infested_at_start == morning.ancestry.infested_at_start
    grown = by_origins(evening, night, tells_apart=True).chance.sum() / evening.chance.sum()
    assert morning.chance.sum() / told.chance.sum() == pytest.approx(grown, rel=0.1)
    # only the night brings anything back to what was found and treated
    if treated:
        assert (told.chance[plants[found]] <= AS_GOOD_AS_CLEAN).all()


def test_the_wind_of_late_is_half_that_of_the_night_and_told_by_metres_a_second():
    assert _of_late((4.0, -2.0), (2.2, 3.0)) == (3.0, 0.0)
    assert _of_late((0.0, 0.0), (0.9, -0.9)) == (0.0, 0.0)
    assert _of_late((1.0, -7.0), (2.0, -6.0)) == (2.0, -6.0)


@pytest.mark.parametrize("tells_apart", [True, False])
def test_what_lands_anywhere_is_what_all_plants_that_move_send_there(tells_apart):
    belief, rng = mid_season(), np.random.default_rng(4)
    reach = replace(belief.reach, anywhere=0.3)
    spread = PestSpread(0.2, arrivals_per_day=0.01)
    moves = rng.random(12)
    for sends in (0.0, 0.4, 3.0):
        brought = brought_from_afar(belief, reach, (moves, sends), spread, tells_apart=tells_apart)
        from_outside = 0.01 * belief.counts.scale[ANYWHERE]
        landed = 0.3 * sum(sends * moves) / 12
        assert brought[ANYWHERE] == pytest.approx(np.full(12, from_outside + landed))


def test_both_maps_are_pooled():
    """By the ancestry most: where it says more than the other map the pool says more, too."""
    plants = np.arange(0, N, 3, dtype=np.int32)
    found = plants % 11 == 0
    belief = TracedPairs.of(GRID, FLAT).learn(plants, found, Learning())
    alone = replace(belief, ancestry=None).overnight(QUIET)
    _, chance = overnight(belief.ancestry, ToldNight(0.3))
    pooled = belief.overnight(QUIET).chance
    odds = [p / (1.0 - p) for p in (chance, alone.chance, pooled)]
    assert odds[2] == pytest.approx(1.15 * odds[0] ** 0.63 * odds[1] ** 0.42)
    assert np.corrcoef(chance, pooled)[0, 1] > 0.9
