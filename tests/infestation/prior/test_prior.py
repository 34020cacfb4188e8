"""From edges, paths, rasters and records to a chance for every plant."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiLineString, MultiPolygon

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.prior.prior import (
    edge_chance,
    path_chance,
    prior_chance,
    scaled,
    start_infested,
)
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN, Records
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from tests.crooked import crooked_grids
from tests.infestation.prior.placed_records import (
    GRID,
    MIDDLE,
    TODAY,
    USUAL,
    at_middle,
    records,
    some_records,
    together,
)


def field_of(grid, paths=()):
    lines = [grid.frame.lonlat(np.asarray(path, float)) for path in paths]
    return Field("plot", grid.frame.geometry_lonlat(grid.drivable_m), paths=MultiLineString(lines))


# --- without records


def test_without_records_the_ways_of_being_infested_are_independent():
    path = [(-40.0, -60.0), (35.0, 60.0)]
    field = field_of(GRID, [path])
    risk = np.linspace(0.0, 0.5, len(GRID))
    points = shapely.points(GRID.xy_m)
    edge = 0.05 * np.exp(-shapely.distance(points, shapely.boundary(GRID.drivable_m)) / 10.0)
    from_path = 0.05 * np.exp(-shapely.distance(points, shapely.LineString(path)) / 10.0)
    expected = 1.0 - 0.99 * (1.0 - edge) * (1.0 - from_path) * (1.0 - risk)
    chance = prior_chance(GRID, field, Records.none(), TODAY, USUAL, risk)
    # both are cut where they would say less than 1e-4
    np.testing.assert_allclose(chance, expected, rtol=0, atol=2e-4)


@given(crooked_grids(50.0), st.floats(1.0, 30.0))
def test_the_edge_is_the_boundary_of_every_part_and_hole(grid, depth_m):
    chance = edge_chance(grid, PriorSettings(edge_chance=1.0, edge_depth_m=depth_m))
    metres = shapely.distance(shapely.points(grid.xy_m), shapely.boundary(grid.drivable_m))
    far = metres > depth_m * np.log(1e4)
    np.testing.assert_allclose(chance[~far], np.exp(-metres[~far] / depth_m), rtol=1e-6)
    assert not chance[far & (metres > depth_m * np.log(1e4) * (1 + 1e-9))].any()


def test_insects_enter_round_a_hole_too():
    hole = shapely.box(-9.0, -9.0, 9.0, 9.0)
    holed = replace(GRID, drivable_m=MultiPolygon([shapely.difference(GRID.drivable_m, hole)]))
    beside = np.argmin(np.hypot(GRID.xy_m[:, 0] - 12.0, GRID.xy_m[:, 1]))
    assert edge_chance(holed, USUAL)[beside] > 3 * edge_chance(GRID, USUAL)[beside]


def test_a_plot_without_paths_has_no_chance_from_paths():
    assert not path_chance(GRID, field_of(GRID), USUAL).any()


def test_roads_of_a_whole_continent_may_come_along():
    near = [(-40.0, -60.0), (35.0, 60.0)]
    lines = MultiLineString(
        [GRID.frame.lonlat(np.array(near)), [(-120.0, 60.0), (140.0, -30.0)], [(0, 0), (35.15, 20)]]
    )
    field = replace(field_of(GRID), paths=lines)
    expected = path_chance(GRID, field_of(GRID, [near]), USUAL)
    np.testing.assert_allclose(path_chance(GRID, field, USUAL), expected, atol=1e-9)


def test_a_chance_of_zero_at_edges_and_paths_is_allowed():
    quiet = PriorSettings(background_chance=0.02, edge_chance=0.0, path_chance=0.0)
    field = field_of(GRID, [[(0.0, -60.0), (0.0, 60.0)]])
    chance = prior_chance(GRID, field, Records.none(), TODAY, quiet)
    np.testing.assert_allclose(chance, 0.02)


# --- with records


def test_what_is_left_out_changes_nothing():
    field = field_of(GRID)
    clear = at_middle(PRESENT, 3)
    mixed = together(clear, at_middle(UNKNOWN, 1), at_middle(PRESENT, -1))
    np.testing.assert_array_equal(
        prior_chance(GRID, field, mixed, TODAY, USUAL),
        prior_chance(GRID, field, clear, TODAY, USUAL),
    )
    only = together(at_middle(UNKNOWN), at_middle(ABSENT, -9))
    np.testing.assert_array_equal(
        prior_chance(GRID, field, only, TODAY, USUAL),
        prior_chance(GRID, field, Records.none(), TODAY, USUAL),
    )


def test_even_a_risk_of_one_can_be_undone_by_clean_looks():
    looks = together(*[at_middle(ABSENT, accuracy_m=0.0, leaves_sampled=20.0)] * 10)
    chance = prior_chance(GRID, field_of(GRID), looks, TODAY, USUAL, np.ones(len(GRID)))
    assert chance[MIDDLE] < 0.05
    assert chance[-1] > 0.99


@given(crooked_grids(40.0, max_plants=3000), st.data())
def test_every_chance_is_a_chance_on_any_plot(grid, data):
    n = len(grid)
    which = data.draw(st.lists(st.integers(0, n - 1), min_size=1, max_size=8))
    m = len(which)
    given = records(
        grid.xy_m[which] + data.draw(st.floats(-5, 5)),
        np.array(data.draw(st.lists(st.integers(-1, 1), min_size=m, max_size=m)), np.int8),
        data.draw(st.lists(st.integers(-5, 50), min_size=m, max_size=m)),
        grid=grid,
    )
    risk = np.where(np.arange(n) % 3 == 0, np.nan, (np.arange(n) % 2).astype(float))
    chance = prior_chance(grid, field_of(grid), given, TODAY, USUAL, risk)
    assert chance.shape == (n,)
    assert ((chance >= 0.0) & (chance <= 1.0)).all()


@settings(deadline=None)
@given(some_records, st.floats(-80.0, 80.0))
def test_the_direction_of_the_frame_does_not_matter(given, turn_deg):
    frame = GRID.frame.turned(GRID.frame.bearing_deg + turn_deg)
    xy_m = frame.xy_m(GRID.lonlat())
    boundary = field_of(GRID).boundary
    turned = replace(GRID, frame=frame, xy_m=xy_m, drivable_m=frame.geometry_m(boundary))
    field = field_of(GRID, [[(-30.0, -90.0), (50.0, 90.0)]])
    there, here = (prior_chance(g, field, given, TODAY, USUAL) for g in (turned, GRID))
    np.testing.assert_allclose(there, here, rtol=0, atol=1.01e-4)
    assert np.mean(np.abs(there - here) < 1e-8) > 0.95  # but for plants on the rim of a reach


# --- risk maps and settings


def test_a_risk_map_raises_chances_where_it_speaks():
    field = field_of(GRID)
    risk = np.full(len(GRID), np.nan)
    risk[:10] = 0.4
    with_risk, without = (
        prior_chance(GRID, field, Records.none(), TODAY, USUAL, r) for r in (risk, None)
    )
    np.testing.assert_array_equal(with_risk[10:], without[10:])
    np.testing.assert_allclose(with_risk[:10], 1 - 0.6 * (1 - without[:10]))


@pytest.mark.parametrize(
    ("risk", "says"),
    [
        (np.zeros(3), "one entry a plant"),
        (np.zeros((len(GRID), 1)), f"has {len(GRID)} x 1"),
        (np.full(len(GRID), 87.0), "87"),
    ],
)
def test_a_risk_map_that_does_not_fit_is_refused(risk, says):
    with pytest.raises(ObservationError, match=says):
        prior_chance(GRID, field_of(GRID), Records.none(), TODAY, USUAL, risk)


# --- a season's start


some_chances = st.lists(
    st.floats(1e-6, 1 - 1e-6) | st.sampled_from((0.0, 1.0)), min_size=2, max_size=200
).map(np.array)


@given(some_chances, st.floats(0.001, 0.999))
def test_chances_are_scaled_to_the_share_exactly_with_one_factor_on_the_odds(chance, share):
    certain, free = chance == 1.0, (chance > 0) & (chance < 1)
    if not certain.sum() < share * len(chance) < certain.sum() + free.sum():
        with pytest.raises(SettingError, match="strictly between" if free.any() else "at 0 or 1"):
            scaled(chance, share)
        return
    after = scaled(chance, share)
    assert after.mean() == pytest.approx(share, rel=1e-9)
    np.testing.assert_array_equal(after[~free], chance[~free])
    before, after = (c[free & (after > 1e-9) & (after < 1 - 1e-6)] for c in (chance, after))
    factor = after / (1 - after) * (1 - before) / before
    np.testing.assert_allclose(factor, factor[:1].repeat(len(factor)), rtol=1e-5)


def test_a_start_holds_the_expected_share_where_the_chance_is_high():
    chance = edge_chance(rectangle(91, 91), USUAL) + 0.001
    share = np.mean([start_infested(chance, 0.02, np.random.default_rng(s)) for s in range(50)], 0)
    assert share.mean() == pytest.approx(0.02, rel=0.05)
    high = chance > np.median(chance)
    assert share[high].mean() > 2 * share[~high].mean()


def test_a_start_without_a_share_takes_the_chances_as_they_are():
    chance = np.repeat([0.0, 0.25, 1.0], 4000)
    infested = start_infested(chance, None, np.random.default_rng(3))
    none, some, all_ = infested.reshape(3, 4000).mean(axis=1)
    assert (none, all_) == (0.0, 1.0)
    assert some == pytest.approx(0.25, abs=0.03)


def test_more_chance_infests_the_same_plants_and_others_besides():
    chance = np.random.default_rng(1).random(500) * 0.5
    few, many = (start_infested(chance, s, np.random.default_rng(7)) for s in (0.1, 0.3))
    assert (few <= many).all()
    assert few.sum() < many.sum()


@pytest.mark.parametrize("odd", [-0.1, 1.1])
def test_a_risk_that_is_no_chance_is_refused_below_as_above(odd):
    risk = np.full(len(GRID), 0.5)
    risk[7] = odd
    with pytest.raises(ObservationError, match=r"chances in 0\.\.1"):
        prior_chance(GRID, field_of(GRID), Records.none(), TODAY, USUAL, risk)


@pytest.mark.parametrize("sure", [0.0, 1.0])
def test_where_all_is_settled_nothing_is_left_to_draw(sure):
    with pytest.raises(SettingError, match="all are at 0 or 1"):
        scaled(np.full(10, sure), 0.3)
