"""Zones: their areas add up, their outlines hold their plants, and what need not be is left out."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.decisions.rings import around
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.zones import Zones, best_zones, outline_of, outlines, ring_bound, whole_plot
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import plot_around
from fieldmon.plot.projection import Frame
from tests.bent import bent_grids
from tests.crooked import crooked_grids

ROW = rectangle(1, 9, Planting(90.0, 4.0, 2.0))
CHEAP = TreatmentCosts(per_ha=500.0, per_zone=0.3, infested_plant_day=0.2, days=10.0, works=1.0)


@given(crooked_grids(60), st.integers(0, 4), st.integers(0, 1000))
def test_areas_and_plants_add_up_on_any_plot(grid, rows, seed):
    chance = np.random.default_rng(seed).random(len(grid)) ** 8
    zones = best_zones(grid, chance, Sprayer(rows), TreatmentCosts(per_ha=300.0))
    once = grid.vine == np.arange(len(grid))
    assert zones.inside + zones.outside == pytest.approx(chance.sum())
    assert zones.inside == pytest.approx(chance[zones.treated].sum())
    assert zones.plot_m2 == pytest.approx(once.sum() * grid.row_spacing_m * grid.plant_spacing_m)
    assert ((zones.zone >= 0) == zones.treated).all()
    assert (zones.treated == zones.treated[grid.vine]).all()
    numbers = np.unique(zones.zone[zones.treated])
    assert numbers.tolist() == list(range(len(zones)))


def clustered(grid, seed=3):
    rng = np.random.default_rng(seed)
    chance = np.full(len(grid), 2e-4)
    for centre in rng.integers(0, len(grid), 6):
        apart = np.hypot(*(grid.xy_m - grid.xy_m[centre]).T)
        chance += 0.5 * np.exp(-apart / 4.0)
    return np.minimum(chance, 0.95)


@pytest.mark.parametrize("sprayer", [Sprayer(2, 6.0, 6.0), Sprayer(0), Sprayer(0, ring=2)])
def test_plants_that_are_spared_are_in_no_zone_though_all_else_pays(sprayer):
    grid = rectangle(20, 20, Planting(90.0, 4.0, 3.0))
    spared = (grid.xy_m - grid.xy_m.min(axis=0) < 20).all(axis=1)
    zones = best_zones(grid, np.full(len(grid), 0.9), sprayer, CHEAP, spared)
    assert zones.treated.any()
    assert not zones.treated[spared].any()
    assert zones.outside >= 0.9 * np.count_nonzero(spared) - 1e-9


def test_clusters_are_treated_with_less_than_two_fifths_of_the_area():
    """The goal: at most 40 % of the whole field, where infested plants stand in clusters."""
    grid = rectangle(60, 60, Planting(90.0, 4.0, 3.0))
    chance = clustered(grid)
    zones = best_zones(
        grid, chance, Sprayer(2, 6.0, 6.0), TreatmentCosts(per_ha=10.0, per_zone=0.1)
    )
    assert zones.inside > 0.8 * chance.sum()
    assert zones.m2 < 0.4 * zones.plot_m2


def test_a_knapsack_treats_the_plants_that_are_worth_it_one_by_one():
    grid = rectangle(5, 8, Planting(90.0, 4.0, 2.0))
    chance = np.zeros(40)
    chance[[3, 17, 18]] = 0.8
    zones = best_zones(grid, chance, Sprayer(0), CHEAP)
    assert np.flatnonzero(zones.treated).tolist() == [3, 17, 18]
    assert len(zones) == 3


@given(crooked_grids(50), st.integers(0, 3), st.integers(0, 2), st.floats(0.0, 0.95))
def test_the_share_for_predators_is_never_sprayed(grid, rows, ring, reserve):
    chance = np.random.default_rng(rows).random(len(grid)) ** 2
    costs = TreatmentCosts(per_ha=10.0, per_zone=0.0, reserve=reserve)
    zones = best_zones(grid, chance, Sprayer(rows, 0.0, 0.0, ring), costs)
    assert zones.m2 <= (1 - reserve) * zones.plot_m2 + 1e-6
    assert ((zones.zone >= 0) == zones.treated).all()
    assert zones.cost <= zones.whole_cost + costs.per_zone * len(zones)


def test_a_knapsack_sprays_the_ring_around_a_plant_and_rings_that_touch_are_one_zone():
    grid = rectangle(7, 9, Planting(90.0, 4.0, 2.0))
    chance = np.zeros(63)
    chance[[10, 30]] = 0.9
    cheaper = TreatmentCosts(per_ha=100.0, infested_plant_day=0.2, works=1.0)
    zones = best_zones(grid, chance, Sprayer(0, ring=1), cheaper)
    # two rings that share plants hold both, and take less than the two rings about them
    assert zones.treated[[10, 30]].all()
    assert zones.treated.sum() <= 10
    apart = best_zones(grid, np.where(np.arange(63) == 30, 0.9, 0.0), Sprayer(0, ring=1), cheaper)
    assert apart.treated.sum() == 5
    assert apart.treated[30]
    chance[20] = 0.9
    assert len(best_zones(grid, chance, Sprayer(0, ring=1), cheaper)) == 1


def test_the_whole_plot_is_one_zone_and_some_zones_may_be_left_out():
    chance = np.array([0.9, 0.9, 0, 0, 0, 0, 0, 0.9, 0.9])
    sprayer = Sprayer(1, 0.0, 0.0)
    zones = best_zones(ROW, chance, sprayer, CHEAP)
    assert len(zones) == 2
    kept = zones.only(ROW, chance, np.array([False, True]), CHEAP)
    assert np.flatnonzero(kept.treated).tolist() == [7, 8]
    assert (len(kept), kept.zone.max()) == (1, 0)
    whole = whole_plot(ROW, chance, CHEAP)
    assert (whole.m2, whole.outside) == (whole.plot_m2, 0.0)
    assert zones.whole_cost == pytest.approx(whole.cost)


def test_where_switching_costs_more_than_what_lies_between_the_plot_is_one_zone():
    """Three rows of which each pays: three zones, or one that is left on at their ends."""
    grid = rectangle(3, 9, Planting(90.0, 4.0, 2.0))
    chance = np.full(27, 0.5)
    chance[13] = 0.0
    zones = best_zones(grid, chance, Sprayer(1), TreatmentCosts(per_ha=1.0, per_zone=5.0))
    assert len(zones) == 1
    assert zones.treated.all()
    assert zones.cost == pytest.approx(zones.whole_cost)
    spared = TreatmentCosts(per_ha=1.0, per_zone=0.0, reserve=0.1)
    assert not best_zones(grid, chance, Sprayer(1), spared).treated.all()


@pytest.mark.parametrize("sprayer", [Sprayer(2, 6.0, 6.0), Sprayer(0), Sprayer(0, ring=1)])
@pytest.mark.parametrize("rule", [{}, {"reserve": 0.5}])
def test_what_is_infested_on_the_second_face_is_treated_as_on_the_first(sprayer, rule):
    grid = rectangle(5, 12, Planting(90.0, 4.0, 2.0, faces=2))
    costs = TreatmentCosts(per_ha=300.0, **rule)
    first = grid.vine == np.arange(len(grid))
    found = np.isin(grid.vine, np.flatnonzero(first)[26:32])
    small = np.full(len(grid), 1e-4)
    made = [
        best_zones(grid, np.where(found & which, 0.9, small), sprayer, costs)
        for which in (first, ~first, first | ~first)
    ]
    for zones in made:
        assert zones.treated[found].all()
        assert (zones.treated == made[0].treated).all()
        assert zones.m2 == made[0].m2
    assert made[0].saved == pytest.approx(made[1].saved)
    assert made[2].inside == pytest.approx(2 * 6 * 0.9, rel=0.01)
    assert whole_plot(grid, np.where(found, 0.9, 0.0), costs).inside == pytest.approx(12 * 0.9)
    bounds = [ring_bound(grid, np.where(found & one, 0.9, small), 1, costs)
              for one in (first, ~first)]  # fmt: skip
    assert bounds[0] == pytest.approx(bounds[1])
    assert bounds[0] > 0.0


def test_a_ring_on_two_faces_reaches_the_plants_of_the_rows_on_both_sides():
    one, two = (rectangle(5, 5, Planting(90.0, 4.0, 2.0, faces=k)) for k in (1, 2))
    vines = np.flatnonzero(two.vine == np.arange(50))
    for plant in range(25):
        for ring in (1, 2):
            reached = vines[around(one, plant, ring)]
            assert around(two, int(vines[plant]), ring).tolist() == reached.tolist()
    assert len(around(two, int(vines[12]), 1)) == 5


def test_a_plant_is_spared_whose_second_face_is():
    grid = rectangle(2, 4, Planting(90.0, 4.0, 2.0, faces=2))
    spared = np.arange(len(grid)) == np.flatnonzero(grid.vine != np.arange(len(grid)))[0]
    zones = best_zones(grid, np.full(len(grid), 0.9), Sprayer(0), CHEAP, spared)
    assert np.array_equal(~zones.treated, grid.vine == grid.vine[spared])


def test_where_nothing_is_worth_it_nothing_is_treated():
    zones = best_zones(ROW, np.full(9, 1e-6))
    assert len(zones) == 0
    assert zones.sentence().startswith("Treat nowhere")
    assert (
        "To treat 72 m² in 1 zone, 100 % of the 72 m² under plants"
        in best_zones(ROW, np.full(9, 0.9), Sprayer(1), CHEAP).sentence()
    )


@given(crooked_grids() | bent_grids(), st.data())
def test_an_outline_is_all_the_squares_of_its_plants_and_slits_between_them(grid, data):
    share = data.draw(st.sampled_from([0.0, 0.3, 0.8, 1.0]))
    plants = np.random.default_rng(len(grid)).random(len(grid)) < share
    half_m = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2 * 1.001
    corners = np.hstack([grid.xy_m - half_m, grid.xy_m + half_m])[plants]
    squares = shapely.union_all(shapely.box(*corners.T))
    outline = outline_of(grid, plants)
    assert outline.is_valid
    metres = shapely.make_valid(grid.frame.geometry_m(outline))
    assert squares.difference(metres).area < 1e-6 * max(squares.area, 1.0)
    slits = shapely.get_parts(metres.difference(squares.buffer(1e-6)))
    assert all(shapely.buffer(one, -0.12).is_empty for one in slits)


def test_plants_measured_a_little_apart_make_one_zone_without_slits():
    """As on real vines, where no distance is the mean one: it was drawn as a maze."""
    xy_m = np.stack(np.meshgrid(np.arange(12) * 1.4, np.arange(10) * 2.5), -1).reshape(-1, 2)
    xy_m += np.random.default_rng(3).normal(0.0, 0.04, xy_m.shape)
    plot = plot_around("Vines", Frame(5.0, 45.0).lonlat(xy_m))
    n = len(plot.grid)
    assert n == 120
    zones = whole_plot(plot.grid, np.full(n, 0.9))
    for area in (outline_of(plot.grid, np.ones(n, bool)), *outlines(plot.grid, zones)):
        (part,) = plot.grid.frame.geometry_m(area).geoms
        assert not part.interiors
        assert part.length < 1.2 * part.convex_hull.length


def test_outlines_hold_their_plants_and_no_other():
    grid = rectangle(6, 20, Planting(90.0, 4.0, 2.0))
    chance = np.zeros(120)
    chance[24:32] = 0.9
    zones = best_zones(grid, chance, Sprayer(1), CHEAP)
    (area,) = outlines(grid, zones)
    inside = shapely.contains_xy(area, *grid.lonlat().T)
    assert (inside == zones.treated).all()
    assert shapely.area(grid.frame.geometry_m(area)) == pytest.approx(zones.m2, rel=0.01)


def test_it_says_itself_in_a_line():
    assert isinstance(best_zones(ROW, np.full(9, 0.5)), Zones)
    assert repr(best_zones(ROW, np.zeros(9))) == "<Zones: 0 zones of 0 m2>"


def test_rings_save_nearly_what_the_best_of_all_choices_does_and_never_more_than_their_bound():
    """Beside every choice of plants of 3 x 4, with the ring of each."""
    grid, costs = rectangle(3, 4), TreatmentCosts(per_ha=300.0, per_zone=0.0, works=1.0)
    start, other = grid.adjacent
    rings = [{i, *other[start[i] : start[i + 1]].tolist()} for i in range(12)]
    for seed in range(3):
        chance = np.random.default_rng(seed).random(12)
        m2 = grid.row_spacing_m * grid.plant_spacing_m
        gain = chance * costs.per_infested_plant - costs.per_ha * m2 / 10_000
        best = max(
            gain[list(set().union(*(rings[i] for i in range(12) if chosen >> i & 1)))].sum()
            for chosen in range(1, 2**12)
        )
        zones = best_zones(grid, chance, Sprayer(rows=0, ring=1), costs)
        assert best > 0.0
        assert 0.9 * best <= zones.saved - zones.cost <= best + 1e-9
        assert best <= ring_bound(grid, chance, 1, costs) + 1e-9
    assert ring_bound(grid, np.full(12, 1e-4), 1, costs) == 0.0
