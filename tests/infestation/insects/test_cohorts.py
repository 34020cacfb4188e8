"""What a chance map takes for young grows as the insects do, and hides as they do."""

import numpy as np
import pytest

from fieldmon.infestation.insects.cohorts import Age, Cohorts
from fieldmon.infestation.insects.pest_in_weather import PestSpread
from fieldmon.pests.pest import Pest, Stage

MITE = Pest(
    "mite",
    stages=(
        Stage("egg", 10.0, 30.0, visible=False, mobile=False),
        Stage("young", 10.0, 30.0, mobile=False),
    ),
)
WARM = PestSpread(warmth=(10.0, 10.0))


def grown_up(nights, chance=0.2, gain=0.1):
    cohorts, before = Cohorts.none(MITE, 1), np.array([chance])
    for night in range(nights):
        more = gain if night == 0 else 0.0
        after = before + more
        cohorts = cohorts.overnight(before, np.array([more]), after, WARM)
        before = after
    return cohorts


def test_what_a_night_brought_is_hidden_then_seen_then_moves():
    hidden = [float(grown_up(n).hidden[0]) for n in range(1, 9)]
    still = [float(grown_up(n).still[0]) for n in range(1, 9)]
    # a third of the chance is of that night; it hatches after three more, moves after six
    assert hidden == pytest.approx([1 / 3] * 3 + [0.0] * 5, abs=1e-6)
    assert still == pytest.approx([1 / 3] * 6 + [0.0] * 2, abs=1e-6)


def test_grown_cohorts_are_forgotten():
    assert len(grown_up(1).ages) == 1
    later = grown_up(40)
    assert len(later.ages) == 6
    assert later.shares.sum() == pytest.approx(0.0, abs=1e-6)


def test_a_clean_inspection_leaves_rather_what_it_could_not_see():
    """Bayes by hand: of 0.3, 0.1 is of eggs; a look that finds 80 % of the rest finds nothing."""
    cohorts = grown_up(1)
    after = cohorts.inspected(np.array([0]), np.array([False]), np.array([0.8]))
    eggs, seen = 0.1, 0.2 * 0.2
    assert after.hidden[0] == pytest.approx(eggs / (eggs + seen), abs=1e-6)


def test_a_find_is_of_what_can_be_seen():
    after = grown_up(1).inspected(np.array([0]), np.array([True]), np.array([0.8]))
    assert after.hidden[0] == 0.0


def test_a_disease_ages_by_days():
    disease = Pest("disease", latency_days=2.0, hidden_days=3.0)
    age = Age()
    for _ in range(2):
        age = age.older(disease, (), 1.0)
    assert age.mobile(disease)
    assert not age.visible(disease)
    assert age.older(disease, (), 1.0).visible(disease)


@pytest.mark.parametrize(
    ("latency_days", "hidden_days"), [(3.0, 0.0), (0.0, 3.0), (2.0, 3.0), (0.0, 0.0)]
)
def test_what_a_night_brought_is_young_as_long_as_it_hides_or_stays(latency_days, hidden_days):
    pest = Pest("disease", latency_days=latency_days, hidden_days=hidden_days)
    cohorts, chance = Cohorts.none(pest, 1), np.array([0.2])
    for night in range(5):
        gain = np.array([0.1]) if night == 0 else np.zeros(1)
        cohorts = cohorts.overnight(chance, gain, chance + gain, PestSpread(days=1.0))
        chance = chance + gain
        told = [1 / 3 if night < days else 0.0 for days in (hidden_days, latency_days)]
        assert [cohorts.hidden[0], cohorts.still[0]] == pytest.approx(told, abs=1e-6)


@pytest.mark.parametrize("warmth", [3.1, 9.6, 10.0, 29.5, 45.0])
def test_who_comes_into_a_stage_begins_it_and_takes_all_its_degree_days(warmth):
    age, days = Age(), 0
    for stage in range(2):
        nights = int(np.ceil(30.0 / warmth))
        for night in range(nights):
            assert age == Age(stage, pytest.approx(night * warmth), days)
            age, days = age.older(MITE, (warmth, warmth), 1.0), days + 1
    assert age == Age(2, 0.0, days)
    assert age.older(MITE, (warmth, warmth), 0.5) == Age(2, 0.0, days + 0.5)
