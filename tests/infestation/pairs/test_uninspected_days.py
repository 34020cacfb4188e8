"""Days without inspections make a number more doubtful; inspections tell it again."""

from dataclasses import replace
from itertools import accumulate, repeat

import numpy as np
import pytest

from fieldmon.decisions.map_verdict import AskedVerdict, verdict_of, zone_verdicts
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.forecast import forecast
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.uninspected_days import LEVEL_DOUBT, RATE_DOUBT, UninspectedDays
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
NIGHT = Spread(0.05)
EVERY_PLANT = np.arange(0, 400, 7, dtype=np.int32)


def inspected(belief, finds=3):
    found = np.arange(len(EVERY_PLANT)) < finds
    return belief.learn(EVERY_PLANT, found, Learning(0.8, treated=True))


def told(belief):
    return estimate_of(GRID, belief)


@pytest.fixture(scope="module")
def evening():
    return inspected(TracedPairs.of(GRID, np.full(400, 0.05)), 8)


@pytest.fixture(scope="module")
def mornings(evening):
    """Return what is believed after no night without inspections, after one, and so on."""
    return after_each(evening, 90)


def width(interval, night=...):
    low, high = np.asarray(interval.low)[night], np.asarray(interval.high)[night]
    return float(np.log((high + 3.0) / (low + 3.0)))


def after_each(belief, number):
    """Return what is believed at first, after a night, and so on."""
    return [*accumulate(repeat(NIGHT, number), type(belief).overnight, initial=belief)]


def nights(belief, number):
    return after_each(belief, number)[-1]


def test_a_season_that_is_inspected_daily_is_in_no_more_doubt(evening):
    belief = evening
    for _ in range(3):
        morning = belief.overnight(NIGHT)
        assert morning.uninspected.variance() == 0.0
        assert morning.since_inspected is None
        belief = inspected(morning)


def test_nothing_is_learnt_from_no_inspections(evening):
    morning = evening.overnight(NIGHT)
    nobody = np.zeros(0, np.int32), np.zeros(0, np.bool_)
    assert morning.learn(*nobody, Learning(0.8, treated=True)) is morning


def test_each_day_without_inspections_makes_the_number_more_doubtful(mornings):
    mornings = mornings[1:6]
    more = [one.uninspected.variance() for one in mornings]
    grown = [np.log(one.chance.sum() / mornings[0].chance.sum()) for one in mornings]
    assert more[0] == 0.0
    shares = [one.uninspected.arrived for one in mornings]
    assert more[1:] == pytest.approx(
        [
            LEVEL_DOUBT**2 + (RATE_DOUBT * g) ** 2 + share**2 / 0.35
            for g, share in zip(grown[1:], shares[1:], strict=True)
        ]
    )
    assert np.all(np.diff(shares) > 0.0)
    assert shares[-1] < 0.2
    wide = [width(told(one)) for one in mornings]
    assert wide[0] < wide[2] < wide[4]


@pytest.mark.parametrize(("found", "left"), [(0.0, 1.0), (1 / 0.13, 0.5), (1e9, 0.0)])
def test_inspections_take_the_doubt_as_far_as_finds_were_to_be_expected(found, left):
    idle = UninspectedDays(days=1, grown=0.4)
    assert idle.variance() == pytest.approx(0.13)
    after = idle.inspected(found, idle.variance())
    assert after.variance() == pytest.approx(0.13 * left, abs=1e-6)
    assert after.overnight(2.0, 3.0).variance() == after.left


def test_a_look_at_one_plant_hardly_narrows_the_interval_and_a_day_does(mornings):
    morning = mornings[6]
    one = morning.learn(EVERY_PLANT[:1], np.zeros(1, np.bool_), Learning(0.8, treated=True))
    day = inspected(morning, 14)
    wide = [width(told(each)) for each in (morning, one, day)]
    assert wide[1] > 0.8 * wide[0]
    assert wide[2] < 0.9 * wide[1]


@pytest.mark.parametrize("idle", [3, 7])
def test_days_without_inspections_come_as_doubtful_as_the_forecast_had_them(
    evening, mornings, idle
):
    ahead = forecast(evening, GRID, [NIGHT] * 10, now=told(evening.in_hindsight(NIGHT)))
    morning = mornings[idle]
    now = told(morning)
    assert now.expected == pytest.approx(ahead.expected[idle], rel=1e-3)
    assert width(now) == pytest.approx(width(ahead, idle), rel=0.2)
    later = forecast(morning, GRID, [NIGHT] * (10 - idle), now=now)
    assert width(later, -1) == pytest.approx(width(ahead, -1), rel=0.2)


def test_plants_that_are_known_to_be_infested_tell_nothing_of_the_number(evening):
    known = evening.learn(EVERY_PLANT[:9], np.ones(9, np.bool_), Learning(0.8, treated=False))
    morning = nights(known, 3)
    again = morning.learn(EVERY_PLANT[:9], np.ones(9, np.bool_), Learning(0.8, treated=False))
    before, after = (each.uninspected.variance() for each in (morning, again))
    assert after == before > LEVEL_DOUBT**2
    unknown = known.chance < 0.99
    first = nights(known, 1)
    grown = np.log(morning.chance[unknown].sum() / first.chance[unknown].sum())
    # what the known sent out is none of what others became
    own = morning.uninspected.grown
    assert own - np.log(1.0 - morning.uninspected.sent) == pytest.approx(grown, rel=0.05)
    assert 0.5 * grown < own < 0.95 * grown


@pytest.mark.parametrize("others", [0.0, 1e-4, 1e-3, 1e-2])
def test_of_plants_that_are_told_to_be_infested_only_what_they_send_out_is_in_doubt(others):
    chance = np.full(400, others)
    chance[::20] = 1.0
    ahead = forecast(TracedPairs.of(GRID, chance), GRID, [NIGHT] * 14)
    assert ahead.low[0] == 20
    assert (ahead.low <= ahead.expected + 0.5).all()
    assert (ahead.expected <= ahead.high + 0.5).all()
    assert (np.diff(ahead.low) >= 0).all()
    assert (np.diff(ahead.high) >= 0).all()
    assert ahead.high[-1] < 4 * ahead.expected[-1]


def test_of_a_plot_that_is_told_to_be_infested_nothing_is_in_doubt():
    ahead = forecast(TracedPairs.of(GRID, np.full(400, 0.995)), GRID, [NIGHT] * 3)
    assert ahead.low.tolist() == ahead.high.tolist() == [400] * 4
    assert verdict(TracedPairs.of(GRID, np.ones(400)), 0.9).chance_above == 1.0


def test_it_is_kept_with_a_morning(mornings):
    morning = mornings[3]
    again = replace(morning, uninspected=UninspectedDays.of_array(morning.uninspected.array))
    assert told(again) == told(morning)
    assert again.since_inspected is not None


def test_on_a_plot_that_was_clean_it_may_be_that_nothing_came():
    clean = TracedPairs.of(GRID, np.full(400, 1e-5))
    clean = clean.learn(
        np.arange(400, dtype=np.int32), np.zeros(400, np.bool_), Learning(0.8, treated=True)
    )
    morning = nights(clean, 25)
    now = told(morning)
    assert morning.uninspected.arrived > 0.85
    assert now.expected > 3.0
    assert now.low == 0 < 4 * now.expected < now.high
    assert now.chance_clean > 0.05


def test_while_nobody_inspects_the_plot_becomes_no_cleaner(mornings):
    few = after_each(inspected(TracedPairs.of(GRID, np.full(400, 0.002)), 0), 30)
    for after in (mornings, few):
        each = [after[0].in_hindsight(NIGHT)]
        each += [after[number] for number in (1, 2, 3, 5, 8, 30, 90) if number < len(after)]
        clean, low = zip(*((one.chance_clean, one.low) for one in map(told, each)), strict=True)
        assert np.all(np.diff(clean) <= 1e-3)
        assert np.all(np.diff(low) >= -1)


def verdict(belief, level=0.5):
    return verdict_of(GRID, belief, level)


@pytest.mark.parametrize("idle", [2, 7, 30])
def test_a_verdict_on_days_without_inspections_is_as_sure_as_the_number(evening, mornings, idle):
    morning = mornings[idle]
    now, then, said = told(morning), verdict(evening), verdict(morning)
    # of rates alone, and so a little surer than the number; but nothing heals
    assert now.low - 1 <= 400 * said.low
    assert 400 * said.high <= now.high
    assert then.low < said.low + 0.01
    assert np.log(said.high / said.low) > 0.5 * np.log(now.high / now.low)
    assert verdict(morning, min(said.high + 0.01, 0.999)).chance_above <= 0.05 or said.high == 1.0
    assert verdict(morning, said.low - 0.01).chance_above >= 0.95


def test_of_its_zones_it_is_in_the_same_doubt(mornings):
    morning = mornings[7]
    asked = AskedVerdict.on(morning, 0.1)
    believed = morning.chance, morning.pair_chance
    (all_of_it,) = zone_verdicts(GRID, believed, np.zeros(400, np.int64), asked, 0.8).zones
    alike = verdict(morning, 0.1)
    assert all_of_it.chance_above == alike.chance_above
    assert (all_of_it.low, all_of_it.high) == pytest.approx((alike.low, alike.high))
    halves = zone_verdicts(GRID, believed, np.repeat([0, 1], 200), asked, 0.8).zones
    wide = [(one.high - one.low) / one.share for one in (*halves, all_of_it)]
    assert min(wide) > 0.9 * wide[-1]


def test_where_nothing_was_left_a_verdict_counts_what_may_have_arrived():
    clean = TracedPairs.of(GRID, np.full(400, 1e-5))
    clean = clean.learn(
        np.arange(400, dtype=np.int32), np.zeros(400, np.bool_), Learning(0.8, treated=True)
    )
    said = verdict(nights(clean, 25), 0.01)
    assert said.low == 0.0 < said.chance_above < 1.0
    assert said.high > said.share


def test_where_hardly_any_is_expected_it_is_hardly_likely_that_there_is_one():
    evening = inspected(TracedPairs.of(GRID, np.full(400, 0.05)), 8)
    treated = nights(evening, 2).treated(np.full(400, 1e-4))
    for belief in (treated, nights(treated, 1)):
        now = told(belief)
        assert now.expected < 0.5
        assert now.chance_clean >= 1.0 - now.expected


def test_a_month_without_inspections_brings_no_jump(mornings):
    each = [told(one) for one in mornings[26:36]]
    low, clean = zip(*((one.low, one.chance_clean) for one in each), strict=True)
    assert np.all(np.diff(low) >= 0)
    assert np.all(np.diff(clean) <= 1e-9)


def test_where_every_plant_was_found_none_is_left_to_find():
    found = np.ones(400, np.bool_)
    belief = TracedPairs.of(GRID, np.full(400, 0.05))
    belief = belief.learn(np.arange(400, dtype=np.int32), found, Learning(0.8, treated=False))
    for now in (estimate_of(GRID, each, found=found) for each in (belief, nights(belief, 3))):
        assert (now.expected, now.low, now.high, now.chance_clean) == (0.0, 0, 0, 1.0)
