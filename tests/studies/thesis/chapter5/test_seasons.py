"""Seasons of chapter 5: the frame, the nights against a plain simulation, the counting."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from shapely import MultiPolygon, Polygon

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.pests.pest import Movement, Pest
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, OpenChoices
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.seasons import (
    AT_LEVEL,
    EVER,
    EVER_FOUND,
    FOUND,
    INFESTED,
    LEVELS_PCT,
    NEW,
    VISITED,
    PriorTrial,
    SeedKeys,
    detection_pct,
    play,
    play_from,
)
from fieldmon.studies.thesis.chapter5.sites import Site, first_morning, square
from tests.thorough import times

PRODUCT = OpenChoices(ends="season", sources="left", counts="infestations", map_follows=True)


@pytest.fixture(scope="module")
def ragged():
    """Return a crooked plot with a hole."""
    d = 1 / 111_000
    shell = [(35.0, 30.0), (35.0 + 90 * d, 30.0), (35.0 + 60 * d, 30.0 + 60 * d), (35, 30 + 40 * d)]
    hole = [(35 + x * d, 30 + y * d) for x, y in [(30, 15), (45, 15), (45, 30), (30, 30)]]
    field = Field("ragged", MultiPolygon([Polygon(shell, [hole])]))
    return Site("ragged", Aisles.of(lay(field, Planting(row_bearing_deg=90.0, headland_m=2.0))))


def beside(grid, i):
    """Return who is next to a plant, told from positions alone."""
    dx, dy = np.abs(grid.xy_m - grid.xy_m[i]).T
    along = (dx > 0.1) & (dx < 1.5 * grid.plant_spacing_m) & (dy < 0.1)
    across = (dx < 0.1) & (dy > 0.1) & (dy < 1.5 * grid.row_spacing_m)
    return np.flatnonzero(along | across)


def plain_night(grid, infested, sources, spread, rng):
    """Spread by the rule's words, plant by plant, in an order of its own."""
    after = infested.copy()
    for i in rng.permutation(np.flatnonzero(sources)):
        others = beside(grid, i)
        if spread.to == "each":
            others = others[rng.random(len(others)) < spread.rate_per_day]
        elif rng.random() >= spread.rate_per_day or not len(others):
            others = others[:0]
        elif spread.to == "one":
            others = rng.choice(others, 1)
        after[others] = True
    return after


def plain_season(site, plants_a_day, start, choices, rng, n_days):
    """Walk a fixed round of plants, so many a day; return infested each morning and found."""
    infested, at, rows = start.copy(), 0, []
    robot = choices.robot()
    for _ in range(n_days):
        round_ = site.grid.snake[(at + np.arange(plants_a_day)) % len(site.grid)]
        at += plants_a_day
        found = infested[round_] & (rng.random(len(round_)) < robot.detects)
        rows.append((infested.sum(), found.sum()))
        missed = np.zeros(len(infested), bool)
        missed[round_[~found & infested[round_]]] = True
        infested[round_[found]] = False
        sources = infested if choices.sources == "left" else missed
        infested = plain_night(site.grid, infested, sources, choices.spread, rng)
    return np.array(rows)


@pytest.mark.parametrize("sources", ["left", "missed"])
@pytest.mark.parametrize("to", ["each", "one", "all"])
def test_seasons_agree_in_distribution_with_a_plain_simulation(ragged, to, sources):
    choices = replace(PRODUCT, spread=Spread(0.4, to), sources=sources)
    trial = PriorTrial("naive", choices)
    infested = np.zeros(len(ragged.grid), bool)
    infested[[5, 20, 21, 75, 76, 77]] = True
    # Naive has time for the whole plot here: its round is the snake, every day from its start
    start = Start(infested, np.full(len(infested), 0.01))
    n = times(150, 400)
    ours = np.array(
        [play_from(ragged, trial, start, SeedKeys.of(RandomStreams(s), 4)) for s in range(n)]
    )
    assert (ours[..., VISITED] == len(ragged.grid)).all()
    rng = np.random.default_rng(8)
    plain = np.array(
        [plain_season(ragged, len(ragged.grid), infested, choices, rng, 4) for _ in range(n)]
    )
    for column, other in ((INFESTED, 0), (FOUND, 1)):
        for day in range(1, 4):
            a, b = ours[:, day, column], plain[:, day, other]
            assert stats.ks_2samp(a, b, method="asymp").pvalue > 1e-3
            assert abs(a.mean() - b.mean()) <= 4.5 * np.sqrt((a.var() + b.var()) / n) + 1e-12


@pytest.mark.parametrize("name", SAMPLERS)
def test_under_the_product_s_rules_a_season_is_the_product_s(name):
    site, chance = square(1.0), RandomStreams(7)
    trial = PriorTrial(name, PRODUCT)
    start = first_morning(site, PRODUCT.start, chance)
    settings = SimulationSettings(n_days=6, spread=PRODUCT.spread, believe=IndependentPlants)
    theirs = list(simulated_days(site.aisles, trial.robot, sampler(name), start, settings, chance))
    ours = play(site, trial, SeedKeys.of(chance, 6))
    assert ours[:, VISITED].tolist() == [len(day.work) for day in theirs]
    assert ours[:, FOUND].tolist() == [day.found for day in theirs]
    assert detection_pct(ours, PRODUCT) == pytest.approx([day.detection_pct for day in theirs])


@pytest.mark.parametrize("name", SAMPLERS)
def test_looks_of_less_than_20_s_find_nothing_all_season(name):
    short = play(
        square(1.0), PriorTrial(name, OpenChoices(), look_s=19.9), SeedKeys.of(RandomStreams(1), 5)
    )
    longer = play(
        square(1.0), PriorTrial(name, OpenChoices(), look_s=20.0), SeedKeys.of(RandomStreams(1), 5)
    )
    assert short[:, VISITED].min() > 300
    assert short[:, FOUND].sum() == 0
    assert longer[:, FOUND].sum() > 0


@pytest.mark.parametrize("choices", [PRODUCT, OpenChoices(sources="missed", missed_known=True)])
@pytest.mark.parametrize("name", SAMPLERS)
def test_the_columns_of_a_season_add_up(name, choices):
    table = play(square(1.0), PriorTrial(name, choices), SeedKeys.of(RandomStreams(3)))
    left = table[:, INFESTED] - table[:, FOUND]
    assert (left[:-1] + table[1:, NEW] == table[1:, INFESTED]).all()
    assert table[0, NEW] == table[0, INFESTED] == round(0.02 * 784)
    assert (table[:, EVER_FOUND] <= table[:, FOUND].cumsum()).all()
    assert (table[:, EVER] <= table[:, NEW].cumsum()).all()
    for counts in ("infestations", "plants"):
        percent = detection_pct(table, replace(choices, counts=counts))
        assert ((percent >= 0) & (percent <= 100)).all()


def test_all_samplers_meet_the_same_insects():
    seasons = [
        play(
            square(1.0), PriorTrial(name, PRODUCT, detection=0.0), SeedKeys.of(RandomStreams(5), 8)
        )
        for name in SAMPLERS
    ]
    assert all((season[:, INFESTED] == seasons[0][:, INFESTED]).all() for season in seasons)


@pytest.mark.parametrize("name", SAMPLERS)
def test_work_ends_with_the_last_find(name):
    choices = replace(PRODUCT, ends="find", spread=Spread(0.3, "one"))
    table = play(square(1.0), PriorTrial(name, choices), SeedKeys.of(RandomStreams(2)))
    whole = play(
        square(1.0),
        PriorTrial(name, replace(choices, ends="season")),
        SeedKeys.of(RandomStreams(2)),
    )
    last = int(np.flatnonzero(table[:, FOUND])[-1])
    assert table[last, INFESTED] == table[last, FOUND]
    assert table[last, VISITED] < whole[last, VISITED]
    assert np.isnan(table[last + 1 :, VISITED]).all()
    assert np.array_equal(table[:last], whole[:last], equal_nan=True)
    assert detection_pct(table, choices)[-1] == 100.0


@pytest.mark.parametrize("counts", ["infestations", "plants"])
@pytest.mark.parametrize("name", SAMPLERS)
def test_levels_are_reached_on_the_day_that_the_curve_says(name, counts):
    choices = replace(PRODUCT, counts=counts, spread=Spread(0.3, "one"))
    season = run_trials([PriorTrial(name, choices, 1.0)], seed_keys(6)).runs[
        PriorTrial(name, choices, 1.0)
    ]
    for level in LEVELS_PCT:
        first, days_to = season.first_day(level), season.days_to(level)
        never = first > 25
        assert (np.ceil(days_to[~never]) == first[~never]).all()
        assert (days_to[never] == 25).all()
    assert (season.days_to(50.0) <= season.days_to(80.0)).all()
    assert (season.days_to(80.0) <= season.days_to(100.0)).all()


def test_the_last_find_of_a_cleared_field_is_when_all_are_found():
    # every second plant of the first row: looking is sure, 44.32 s from plant to plant
    site, infested = square(1.0), np.zeros(784, bool)
    infested[[0, 2, 4, 6]] = True
    choices = replace(PRODUCT, stop_s=0.0)
    start = Start(infested, np.full(784, 0.01))
    table = play_from(
        site, PriorTrial("naive", choices, detection=1.0), start, SeedKeys.of(RandomStreams(1), 1)
    )
    to_gate_s = site.aisles.distance_m(-1, 0) * 3.6 / 2.5
    step_s = 40.0 + 3.0 * 3.6 / 2.5
    at = [to_gate_s + 40.0 + k * step_s for k in (2, 6, 6)]
    assert table[0, AT_LEVEL:] * 43200 == pytest.approx(at)


def test_bouncy_rests_after_half_the_plants():
    rests = play(
        square(1.0),
        PriorTrial("bouncy", replace(PRODUCT, bouncy_rests=True)),
        SeedKeys.of(RandomStreams(2)),
    )
    goes_on = play(square(1.0), PriorTrial("bouncy", PRODUCT), SeedKeys.of(RandomStreams(2)))
    assert (rests[:, VISITED] == 392).all()
    assert (goes_on[:, VISITED] > 392).all()


def test_knowing_what_was_missed_finds_it_sooner():
    def found(known):
        choices = replace(PRODUCT, missed_known=known, spread=Spread(0.0))
        seasons = [
            play(
                square(5.0),
                PriorTrial("dynamic", choices, detection=0.4),
                SeedKeys.of(RandomStreams(s), 3),
            )
            for s in range(8)
        ]
        return np.sum(seasons, axis=0)[:, FOUND].sum()

    assert found(known=True) > found(known=False)


@pytest.mark.parametrize("kernel", ["adjacent", "exponential"])
@pytest.mark.parametrize("name", ["dynamic", "naive"])
def test_a_pest_lives_on_the_plot_instead_of_the_thesiss_rule(name, kernel):
    """A pest that does not spread brings nothing new; one that does, brings what its kernel has."""
    quiet = Pest("quiet", movement=Movement(kernel, 0.0, reach_m=4.0))
    rate = 0.9 if kernel == "adjacent" else 5.0
    busy = Pest("busy", movement=Movement(kernel, rate, reach_m=4.0))
    made = []
    for pest in (quiet, busy):
        choices = replace(PRODUCT, pest=PestInWeather(pest), ends="season")
        table = play(square(1.0), PriorTrial(name, choices), SeedKeys.of(RandomStreams(5), 4))
        assert (np.diff(table[:, EVER]) >= 0).all()
        assert f"pest: {pest.name}" in choices.sentences()
        made.append(table[1:, NEW].sum())
    assert made[0] == 0
    assert made[1] > 0
    assert not any(said.startswith("pest") for said in PRODUCT.sentences())
