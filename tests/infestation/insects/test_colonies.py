"""Insects on plants: eggs wait, adults move, and a plant's coins are its own."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.pest_in_weather import Spell
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.pests.pest import Entry, Movement, Pest, Stage
from fieldmon.plot.layout import rectangle
from tests.thorough import seeds

EGG = Stage("egg", 10.0, 30.0, visible=False, mobile=False)
YOUNG = Stage("young", 10.0, 30.0, mobile=False)
GRID = rectangle(9, 9)


def key(seed, day=0):
    return RandomStreams(seed).key("spread", day)


def at(*plants):
    infested = np.zeros(81, bool)
    infested[list(plants)] = True
    return infested


def warm(sends=0.0, by=10.0, days=1.0):
    return Spell(days, (by, by), sends)


def landed_on(colonies, *plants):
    much = np.zeros(81)
    much[list(plants)] = 50.0
    return colonies.settled(much, key(1))


def test_eggs_are_not_seen_and_do_not_move_young_are_seen_and_adults_do_both():
    mite = Pest("mite", stages=(EGG, YOUNG), movement=Movement("adjacent", 0.5))
    colonies = landed_on(Colonies.grown(GRID, mite, at()), 40)
    seen, moving = [], []
    for _ in range(7):
        seen.append(bool(colonies.visible[40]))
        moving.append(bool(colonies.mobile[40]))
        colonies = colonies.older(warm())
    assert seen == [False] * 3 + [True] * 4
    assert moving == [False] * 6 + [True]


def test_who_does_not_move_infests_nobody():
    mite = Pest("mite", stages=(EGG, YOUNG), movement=Movement("adjacent", 1.0))
    egg = landed_on(Colonies.grown(GRID, mite, at()), 40)
    assert egg.after(warm(50.0), key(1)).infested.sum() == 1
    adult = Colonies.grown(GRID, mite, at(40))
    assert np.flatnonzero(adult.after(warm(50.0), key(1)).infested).tolist() == [31, 39, 40, 41, 49]


def test_a_disease_waits_for_its_latency_and_hides_for_its_days():
    disease = Pest("disease", latency_days=2.0, hidden_days=3.0)
    colonies = landed_on(Colonies.grown(GRID, disease, at()), 40)
    seen = []
    for _ in range(5):
        seen.append((bool(colonies.mobile[40]), bool(colonies.visible[40])))
        colonies = colonies.older(Spell(1.0, (), 0.0))
    assert seen == [(False, False)] * 2 + [(True, False)] + [(True, True)] * 2


def test_the_adjacent_kernel_infests_as_often_as_the_thesis_s_rule_says():
    """Each plant next to an infested one with the chance, whoever else infests it."""
    pest = Pest("rule", movement=Movement("adjacent", 0.3))
    start, grid = at(40, 42), GRID
    sends, drawn = -np.log1p(-0.3), seeds(500, 1500)
    ours = [Colonies.grown(grid, pest, start).after(Spell(1.0, (), sends), key(s)).infested
            for s in drawn]  # fmt: skip
    rule = [night(grid, start, Spread(0.3), key(s)) for s in drawn]
    one, other = np.mean(ours, axis=0), np.mean(rule, axis=0)
    assert (np.flatnonzero(one) == np.flatnonzero(other)).all()
    assert np.abs(one - other).max() < 4.5 * np.sqrt(2 * 0.25 / len(drawn))
    assert one[41] == pytest.approx(1 - 0.7**2, abs=0.05)


def test_a_hotter_day_and_the_same_coins_infest_the_same_plants_and_others_besides():
    pest = Pest("mite", movement=Movement("exponential", 0.5, reach_m=6.0))
    start = Colonies.grown(GRID, pest, at(30, 50))
    cool, hot = (start.after(Spell(1.0, (), sends), key(3)).infested for sends in (0.5, 2.0))
    assert (hot >= cool).all()
    assert hot.sum() > cool.sum()


def test_hours_come_to_the_same_number_as_the_day():
    pest = Pest("disease", latency_days=2.0, movement=Movement("exponential", 2.0, reach_m=6.0))
    by_day, by_hour, drawn = [], [], seeds(130, 400)
    for seed in drawn:
        start = colonies = Colonies.grown(GRID, pest, at(40))
        by_day.append(start.after(Spell(1.0, (), 2.0), key(seed)).infested.sum())
        for hour in range(24):
            colonies = colonies.after(Spell(1 / 24, (), 2.0 / 24), key(seed), hour)
        by_hour.append(colonies.infested.sum())
    error = np.sqrt((np.var(by_day) + np.var(by_hour)) / len(drawn))
    assert abs(np.mean(by_day) - np.mean(by_hour)) < 4 * error


def test_predators_end_infestations_as_often_as_they_are_said_to():
    pest = Pest("mite", mortality_per_day=0.2)
    start = Colonies.grown(rectangle(60, 60), pest, np.ones(3600, bool))
    left = start.after(Spell(0.5, (), 0.0), key(1)).infested.mean()
    assert left == pytest.approx(np.sqrt(0.8), abs=0.02)


def test_what_enters_comes_by_the_edge_more_than_inside():
    pest = Pest("fly", entry=Entry(edge_per_day=0.3, anywhere_per_day=0.01, depth_m=3.0))
    grid = rectangle(30, 30)
    start = Colonies.grown(grid, pest, np.zeros(900, bool))
    came = np.mean([start.after(Spell(1.0, (), 0.0), key(s)).infested for s in range(60)], axis=0)
    rows = came.reshape(30, 30)
    assert rows[0].mean() > 5 * rows[10:20, 10:20].mean()
    assert rows[10:20, 10:20].mean() == pytest.approx(0.01, abs=0.008)


def test_destroyed_colonies_are_gone_and_the_others_stay():
    start = Colonies.grown(GRID, Pest("mite"), at(3, 4))
    assert np.flatnonzero(start.without(np.array([3])).infested).tolist() == [4]
    assert start.infested.sum() == 2


def test_a_new_colony_begins_at_the_beginning_also_where_an_older_one_died():
    mite = Pest("mite", stages=(EGG, YOUNG), movement=Movement("adjacent", 0.5))
    old = landed_on(Colonies.grown(GRID, mite, at(3)), 40, 41).older(warm(by=4.0))
    left = old.treated(np.where(at(40), 1.0, 0.0), key(1))
    assert left.infested.sum() == 2
    new = left.entered(at(3, 40, 60))
    for plant in (40, 60):
        told = new.infested[plant], new.stage[plant], new.progress[plant], new.age_days[plant]
        assert told == (True, 0, 0.0, 0.0)
    # those that were there go on
    for plant in (3, 41):
        assert new.stage[plant] == old.stage[plant]
        assert new.progress[plant] == old.progress[plant]
        assert new.age_days[plant] == old.age_days[plant]
    assert new.progress[41] == 4.0


@pytest.mark.parametrize("seed", range(3))
def test_each_plant_s_insects_grow_by_themselves_and_are_seen_and_move_by_stage_and_age(seed):
    rng = np.random.default_rng(seed)
    mite = Pest("mite", stages=(EGG, YOUNG), latency_days=2.0, hidden_days=3.0,
                movement=Movement("adjacent", 0.5))  # fmt: skip
    infested = rng.random(81) < 0.6
    stage, progress = rng.integers(0, 3, 81).astype(np.int8), rng.uniform(0.0, 29.0, 81)
    age, free = rng.uniform(0.0, 6.0, 81).round(), rng.uniform(0.0, 2.0, 81)
    colonies = Colonies(GRID, mite, infested, stage, progress, age, free)
    older = colonies.older(Spell(0.5, (7.0, 16.0), 0.0))
    for k in range(81):
        told = older.stage[k], older.progress[k]
        warmth = (7.0, 16.0, 0.0)[stage[k]]
        if not infested[k] or stage[k] == 2:
            assert told == (stage[k], progress[k])
        elif stage[k] == 0 and progress[k] + warmth >= 30.0:
            # whether the spell that ends a stage counts for the next one, too, is left open
            assert told in ((1, 0.0), (1, 16.0))
        elif progress[k] + warmth >= 30.0:
            assert told == (2, 0.0)
        else:
            assert told == pytest.approx((stage[k], progress[k] + warmth))
        assert colonies.mobile[k] == (infested[k] and stage[k] == 2 and age[k] >= 2.0)
        assert colonies.visible[k] == (infested[k] and stage[k] >= 1 and age[k] >= 3.0)
    assert older.age_days.tolist() == (age + 0.5).tolist()
    assert older.protected_days.tolist() == np.maximum(free - 0.5, 0.0).tolist()
    assert (older.infested == infested).all()


@pytest.mark.parametrize("protects_days", [0.0, 3.0])
def test_a_treatment_works_as_often_as_it_is_said_to_and_protects_where_it_works(protects_days):
    """The same coins: what works by less works by more, too."""
    mite = Pest("mite", movement=Movement("adjacent", 0.5))
    before = Colonies.grown(GRID, mite, np.ones(81, bool))
    before = replace(before, protected_days=np.arange(81) % 5.0)
    weak, strong = (before.treated(np.full(81, dies), key(2), protects_days) for dies in (0.3, 0.8))
    assert not (strong.infested & ~weak.infested).any()
    for after, dies in ((weak, 0.3), (strong, 0.8)):
        assert np.mean(~after.infested) == pytest.approx(dies, abs=0.15)
        longer = np.where(after.infested, 0.0, protects_days)
        assert after.protected_days.tolist() == np.maximum(np.arange(81) % 5.0, longer).tolist()
    lands = Spell(60.0, (), 0.0)
    everywhere = Pest("mite", entry=Entry(anywhere_per_day=1.0))
    entered = replace(strong, pest=everywhere).after(lands, key(3))
    assert (entered.infested == (strong.infested | (strong.protected_days <= 0.0))).all()
