"""Whether a treatment worked, as plants tell that were looked at before and after."""

from datetime import date, time, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate, stats

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.estimates.treatment_effect import (
    PRIOR_PLANTS,
    FoundShare,
    effects,
    learnt_efficacy,
)
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.treatments import KeptTreatment, TreatedPlace
from fieldmon.monitoring.treating.waiting_periods import end_of
from fieldmon.plot.local_clock import LocalClock
from tests.monitoring.seasons import BEGINS, a_plot

GRID = a_plot().grid
HERE = np.arange(len(GRID)) < 50


def history(*looks, detection=0.84):
    """Return a history of looks: day, plants, result of each."""
    made = Inspections.none()
    for day, plants, results in looks:
        on = np.datetime64(BEGINS, "D") + day
        made = made.and_those(Inspections.of(np.array(plants), np.array(results), on))
    return History(GRID, BEGINS, None, made, detection=detection)


def treated(day, plants=HERE, said=0.8, product="soap", **times):
    on, clock = BEGINS + timedelta(day), LocalClock("UTC")
    place = TreatedPlace(None, plants, 1.0)
    return KeptTreatment(day, day, day, on, place, said, Application(product, **times),
                         end_of(clock, on, None), clock)  # fmt: skip


def effect(past, treatments, on=60):
    return effects(treatments, past, on)


def test_plants_seen_before_and_after_are_counted_and_no_others():
    past = history(
        (1, [0, 1, 2, 3, 4, 60, 61], [FOUND, FOUND, FOUND, CLEAN, FOUND, FOUND, CLEAN]),
        (2, [5], [SKIPPED]),
        (5, [0, 1, 3, 5, 60, 61, 70], [CLEAN, FOUND, CLEAN, CLEAN, FOUND, FOUND, FOUND]),
    )
    (one,) = effect(past, [treated(3)])
    assert (one.before, one.after) == (FoundShare(2, 3), FoundShare(1, 3))
    assert one.elsewhere == (FoundShare(1, 2), FoundShare(2, 2))
    assert one.cured_of == 2
    assert effect(past, [treated(3)], on=4)[0].before.inspected == 0  # not known yet
    assert effect(past, [treated(3)], on=2) == ()


def test_results_from_beyond_another_treatment_or_three_weeks_tell_nothing():
    past = history((0, [0, 1], [FOUND] * 2), (4, [1], [FOUND]), (8, [0, 1], [CLEAN] * 2),
                   (40, [2], [CLEAN]))  # fmt: skip
    both = [treated(2), treated(6)]
    first, second = effect(past, both)
    assert (first.before, first.after) == (FoundShare(1, 1), FoundShare(1, 1))
    assert (second.before, second.after) == (FoundShare(1, 1), FoundShare(0, 1))
    late = history((0, [2], [FOUND]), (40, [2], [CLEAN]))
    assert effect(late, [treated(2)])[0].before.inspected == 0


def test_a_treatment_works_after_its_days_inspections_and_the_last_before_counts():
    past = history((1, [0], [CLEAN]), (3, [0], [FOUND]), (4, [0], [CLEAN]), (5, [0], [FOUND]))
    (one,) = effect(past, [treated(3)])
    assert (one.before, one.after) == (FoundShare(1, 1), FoundShare(0, 1))


def test_what_was_inspected_later_on_the_day_of_a_treatment_tells_of_it():
    done = Inspections.of(
        np.array([0, 1, 2, 0, 1, 2]), np.array([FOUND] * 5 + [CLEAN]),
        np.datetime64(BEGINS, "D") + np.array([1] * 3 + [3] * 3),
        second=np.array([np.nan] * 4 + [20_000.0, 40_000.0]),
    )  # fmt: skip
    past = History(GRID, BEGINS, None, done)
    (one,) = effect(past, [treated(3, ended=time(8))])
    assert (one.before, one.after) == (FoundShare(1, 1), FoundShare(0, 1))
    assert effect(past, [treated(3)])[0].before.inspected == 0
    # of two treatments of a day, what lies between them tells of the first
    first, second = effect(past, [treated(3, ended=time(8)), treated(3, ended=time(12))])
    assert (first.cured_of, second.cured_of) == (1, 0)
    first, second = effect(past, [treated(2, ended=time(8)), treated(3, began=time(8))])
    assert (first.cured_of, second.cured_of) == (2, 0)


def test_without_a_plant_that_tells_it_is_what_was_said():
    (one,) = effect(history(), [treated(3, said=0.8)])
    assert one.efficacy == pytest.approx(0.8, abs=0.01)
    assert "not known yet" in one.sentence()
    assert learnt_efficacy([one], "soap") is None


@given(st.floats(0.05, 0.95), st.integers(0, 40), st.data())
def test_what_is_learnt_lies_between_what_was_said_and_what_was_seen(said, n, data):
    still = data.draw(st.integers(0, n))
    plants = list(range(n))
    past = history(
        (1, plants, [FOUND] * n), (5, plants, [FOUND] * still + [CLEAN] * (n - still))
    ) if n else history()  # fmt: skip
    (one,) = effect(past, [treated(3, said=said)])
    seen = np.clip(1 - still / n / 0.84, 0, 1) if n else said
    # a truncated or overlooked share bends the mean a little: by less than a plant or two
    slack = 0.02 + 1.0 / (n + PRIOR_PLANTS)
    assert min(said, seen) - slack <= one.efficacy <= max(said, seen) + slack
    assert one.low <= one.efficacy <= one.high


def test_many_plants_overrule_what_was_said():
    plants = list(range(50))
    looks = (1, plants, [FOUND] * 50), (5, plants, [FOUND] * 34 + [CLEAN] * 16)
    (one,) = effect(history(*looks, detection=1.0), [treated(3, said=0.95)])
    # nothing is overlooked: a beta prior and a binomial, whose mean is known
    worth = PRIOR_PLANTS
    assert one.efficacy == pytest.approx((16 + 0.95 * worth) / (50 + worth), abs=1e-3)
    # what is overlooked looks cured
    assert effect(history(*looks), [treated(3, said=0.95)])[0].efficacy < one.efficacy
    assert learnt_efficacy([one], " SOAP ").efficacy == one.efficacy
    assert "told by 50 plants; 95 % was said beforehand, which counts as 4 plants" in one.sentence()


@pytest.mark.parametrize(
    ("found", "n", "low", "high"),
    # Clopper and Pearson at 90 %, as R's binom.test(..., conf.level = 0.9) gives them
    [(0, 10, 0.0, 0.2589), (2, 10, 0.0368, 0.5069), (10, 10, 0.7411, 1.0), (5, 50, 0.0402, 0.1990)],
)
def test_the_interval_of_a_share_is_the_exact_one(found, n, low, high):
    assert FoundShare(found, n).interval == pytest.approx((low, high), abs=2e-4)


def test_it_is_said_in_words():
    past = history((1, [0, 1, 60], [FOUND] * 3), (5, [0, 1, 60], [CLEAN, FOUND, FOUND]))
    said = effect(past, [treated(3)])[0].sentence()
    assert said.startswith(
        "After soap on 2026-04-09: of 2 plants inspected before and after, 100 %"
    )
    assert "Elsewhere 100 % (1 of 1" in said
    assert date(2026, 4, 9) == BEGINS + timedelta(3)
    # nor is an end of an interval said to be nothing or all
    assert FoundShare(1, 400).sentence() == "under 1 % (1 of 400; under 1 % to 1 %)"
    assert FoundShare(1100, 1687).sentence().startswith("65 % (1,100 of 1,687; ")


@pytest.mark.parametrize("seed", range(12))
def test_who_is_compared_is_told_by_asking_each_plant_alone(seed):
    """The rule read out, plant by plant: the last look before, the first after, none between."""
    rng = np.random.default_rng(seed)
    plants = np.arange(12)
    treatments = [
        treated(
            int(day), np.isin(np.arange(len(GRID)), rng.permutation(plants)[:7]), product=str(k)
        )
        for k, day in enumerate(sorted(rng.integers(0, 40, 5)))
    ]
    treatments.append(treated(treatments[2].day, np.arange(len(GRID)) == 3))
    days = sorted(rng.integers(0, 64, 30).tolist())
    looks = [(day, rng.permutation(plants)[:5], rng.integers(0, 3, 5)) for day in days]
    on = int(rng.integers(20, 64))
    told = effect(history(*looks), treatments, on)
    assert len(told) == sum(one.day <= on for one in treatments)
    for one, said in zip([t for t in treatments if t.day <= on], told, strict=True):
        rows = {"here": [], "elsewhere": []}
        for plant in plants:
            others = [t.day for t in treatments if t is not one and t.place.plants[plant]]
            seen = [
                (day, result)
                for day, some, results in looks
                for p, result in zip(some.tolist(), results.tolist(), strict=True)
                if p == plant and result != SKIPPED
            ]
            before = [
                result for day, result in seen
                if one.day - 21 <= day <= one.day
                and not any(day <= other < one.day for other in others)
            ]  # fmt: skip
            after = [
                result for day, result in seen
                if one.day < day <= min(one.day + 21, on)
                and not any(one.day < other < day for other in others)
            ]  # fmt: skip
            if not before or not after:
                continue
            if one.place.plants[plant]:
                rows["here"].append((before[-1], after[0]))
            elif one.day not in others:
                rows["elsewhere"].append((before[-1], after[0]))
        pairs = [
            tuple(
                FoundShare(sum(row[k] == FOUND for row in rows[of]), len(rows[of])) for k in (0, 1)
            )
            for of in ("here", "elsewhere")
        ]
        assert ((said.before, said.after), said.elsewhere) == (pairs[0], pairs[1])
        assert said.cured_of == said.before.found


@pytest.mark.parametrize(("said", "still", "n"), [(0.8, 0, 3), (0.6, 4, 9), (0.95, 12, 20)])
@pytest.mark.parametrize("detection", [1.0, 0.84, 0.5])
def test_what_is_learnt_is_the_integral_over_how_well_it_may_work(said, still, n, detection):
    plants = list(range(n))
    past = history(
        (1, plants, [FOUND] * n), (5, plants, [FOUND] * still + [CLEAN] * (n - still)),
        detection=detection,
    )  # fmt: skip
    (one,) = effect(past, [treated(3, said=said)])
    prior = stats.beta(PRIOR_PLANTS * said, PRIOR_PLANTS * (1 - said))

    def weight(works):
        return prior.pdf(works) * stats.binom.pmf(still, n, (1 - works) * detection)

    def integral(of, to=1.0):
        return integrate.quad(of, 0.0, to, limit=200)[0]

    whole = integral(weight)
    assert one.efficacy == pytest.approx(integral(lambda x: x * weight(x)) / whole, abs=3e-3)
    for end, share in ((one.low, 0.05), (one.high, 0.95)):
        assert integral(weight, end) / whole == pytest.approx(share, abs=0.01)


def test_only_the_last_effect_of_a_product_that_a_plant_tells_of_is_learnt():
    past = history((1, [0, 1], [FOUND] * 2), (5, [0, 1], [FOUND] * 2), (8, [1], [FOUND]),
                   (11, [1], [CLEAN]))  # fmt: skip
    days = {3: "soap", 6: "Soap", 9: "oil", 12: "soap"}
    told = effect(past, [treated(day, product=name) for day, name in days.items()])
    assert [one.cured_of for one in told] == [2, 1, 1, 0]
    assert learnt_efficacy(told, "SOAP") is told[1]
    assert learnt_efficacy(told, "oil") is told[2]
    assert learnt_efficacy(told) is told[2]  # the last that is named
    assert learnt_efficacy(effect(past, [treated(3, product="")]), "") is None


def test_a_place_where_nothing_was_found_before_says_that_it_is_not_known_how_well_it_works():
    past = history((1, [0, 1], [CLEAN] * 2), (5, [0, 1], [CLEAN] * 2))
    said = effect(past, [treated(3, product="")])[0].sentence()
    assert said.startswith("After a product that nobody named on 2026-04-09: of 2 plants")
    assert said.endswith("None of those found infested before was inspected again: how well it "
                         "works is not known yet.")  # fmt: skip
    assert "Elsewhere" not in said
    assert np.isnan(FoundShare(0, 0).share)
