from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from pyproj import Geod
from shapely import MultiLineString, MultiPolygon

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN, Observations
from fieldmon.infestation.prior import (
    PriorSettings,
    edge_chance,
    outside_m,
    path_chance,
    prior_chance,
    record_chance,
    scaled,
    start_infested,
    usable,
)
from fieldmon.plot.field import Field
from fieldmon.plot.layout import Planting, rectangle
from tests.crooked import crooked_grids

TODAY = np.datetime64("2026-05-20")
USUAL = PriorSettings()
GRID = rectangle(21, 25)
MIDDLE = len(GRID) // 2


def field_of(grid, paths=()):
    lines = [grid.frame.lonlat(np.asarray(path, float)) for path in paths]
    return Field("plot", grid.frame.geometry_lonlat(grid.drivable_m), paths=MultiLineString(lines))


def records(xy_m, present, age_days=0.0, grid=GRID, **columns):
    xy_m = np.asarray(xy_m, float).reshape(-1, 2)
    m = len(xy_m)
    ages = np.broadcast_to(np.asarray(age_days), m).astype(int)
    full = {name: np.broadcast_to(np.asarray(v, float), m).copy() for name, v in columns.items()}
    return Observations.of(
        grid.frame.lonlat(xy_m), np.broadcast_to(present, m).copy(), TODAY - ages, **full
    )


def together(*several):
    names = vars(several[0])
    return Observations(**{n: np.concatenate([getattr(o, n) for o in several]) for n in names})


def heard(observations, grid=GRID, prior=USUAL, base=0.01):
    return record_chance(grid, np.full(len(grid), base), observations, TODAY, prior)


def at_middle(present, age_days=0, **columns):
    return records(GRID.xy_m[MIDDLE], present, age_days, **columns)


some_records = st.lists(
    st.tuples(
        st.floats(-45, 45),
        st.floats(-45, 45),
        st.sampled_from((ABSENT, PRESENT)),
        st.integers(0, 60),
        st.sampled_from((np.nan, 0.0, 1.0, 30.0, 1e4)),
        st.sampled_from((np.nan, 0.0, 0.02, 3.0, 40.0)),
        st.sampled_from((np.nan, 0.0, 1.0, 20.0, 1e5)),
    ),
    min_size=1,
    max_size=12,
).map(
    lambda rows: records(
        [row[:2] for row in rows],
        np.array([row[2] for row in rows], np.int8),
        [row[3] for row in rows],
        count=[row[4] for row in rows],
        accuracy_m=[row[5] for row in rows],
        leaves_sampled=[row[6] for row in rows],
    )
)


# --- without records


def test_without_records_the_ways_of_being_infested_are_independent():
    path = [(-40.0, -60.0), (35.0, 60.0)]
    field = field_of(GRID, [path])
    risk = np.linspace(0.0, 0.5, len(GRID))
    points = shapely.points(GRID.xy_m)
    edge = 0.05 * np.exp(-shapely.distance(points, shapely.boundary(GRID.drivable_m)) / 10.0)
    from_path = 0.05 * np.exp(-shapely.distance(points, shapely.LineString(path)) / 10.0)
    expected = 1.0 - 0.99 * (1.0 - edge) * (1.0 - from_path) * (1.0 - risk)
    chance = prior_chance(GRID, field, Observations.none(), TODAY, USUAL, risk)
    # both are cut where they would say less than 1e-4
    np.testing.assert_allclose(chance, expected, rtol=0, atol=2e-4)


@settings(max_examples=30, deadline=None)
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
    chance = prior_chance(GRID, field, Observations.none(), TODAY, quiet)
    np.testing.assert_allclose(chance, 0.02)


# --- a single record


def test_a_find_says_less_the_farther_a_plant_is():
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    order = np.argsort(metres, kind="stable")
    chance = heard(at_middle(PRESENT))[order]
    assert (np.diff(chance) <= 1e-6).all()
    assert chance[0] > chance[5] > chance[20] > 0.01


def test_a_clean_look_says_less_the_farther_a_plant_is():
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    order = np.argsort(metres, kind="stable")
    chance = heard(at_middle(ABSENT), base=0.3)[order]
    assert (np.diff(chance) >= -1e-6).all()
    assert chance[0] < chance[5] < chance[20] < 0.3


@given(st.integers(0, 400), st.integers(1, 400), st.sampled_from((PRESENT, ABSENT)))
def test_a_record_says_less_the_older_it_is(age, more, present):
    newer, older = (heard(at_middle(present, a), base=0.2) for a in (age, age + more))
    moved = 1.0 if present == PRESENT else -1.0
    assert (moved * (newer - older) >= -1e-15).all()
    assert moved * (newer - older)[MIDDLE] > 0
    assert (moved * (older - 0.2) >= 0).all()


def test_after_a_half_life_a_record_counts_half():
    fresh, half = (heard(at_middle(PRESENT, age)) for age in (0, 14))
    np.testing.assert_allclose(half - 0.01, (fresh - 0.01) / 2, atol=1e-15)


@given(st.floats(0.0, 1e6), st.floats(0.01, 1e6))
def test_a_find_says_more_the_more_was_counted(count, more):
    few, many = (heard(at_middle(PRESENT, count=c)) for c in (count, count + more))
    assert (many >= few).all()


def test_counting_more_and_more_says_ever_less_more():
    at = [heard(at_middle(PRESENT, count=c))[MIDDLE + 1] for c in (0, 10, 20, 30, 40, np.inf)]
    steps = np.diff(at)
    assert (steps[:4] > 0).all()
    assert (np.diff(steps[:4]) < 0).all()
    assert at[-1] > at[-2]


@given(st.integers(0, 100), st.integers(1, 100))
def test_a_clean_look_says_more_the_more_leaves_were_looked_at(leaves, more):
    few, many = (
        heard(at_middle(ABSENT, leaves_sampled=k), base=0.2) for k in (leaves, leaves + more)
    )
    assert (many <= few).all()
    assert many[MIDDLE] < few[MIDDLE]


def test_a_clean_look_at_a_plant_itself_is_bayes_rule():
    sharp = PriorSettings(beside_one=0.0, detection=0.84)
    after = heard(at_middle(ABSENT, accuracy_m=0.0), prior=sharp, base=0.3)
    assert after[MIDDLE] == pytest.approx(0.3 * 0.16 / (1.0 - 0.3 * 0.84))


def test_a_find_with_a_sharp_position_is_sure_of_its_plant_and_less_so_of_the_next():
    chance = heard(at_middle(PRESENT, accuracy_m=0.0))
    assert chance[MIDDLE] > 0.95
    assert chance[MIDDLE + 1] < 0.6


def test_a_find_with_a_vague_position_says_less_here_and_more_there():
    sharp, vague = (heard(at_middle(PRESENT, accuracy_m=a)) for a in (1.0, 15.0))
    metres = np.hypot(*(GRID.xy_m - GRID.xy_m[MIDDLE]).T)
    assert vague[MIDDLE] < sharp[MIDDLE] / 3
    far = (metres > 18) & (metres < 25)
    assert (vague[far] > sharp[far]).all()


def test_a_vague_position_spreads_what_is_said_without_adding_to_it():
    """The infested plants that a record points at stay as many, wherever they are."""
    wide = rectangle(61, 81)
    spot = wide.xy_m[len(wide) // 2]
    quiet = PriorSettings(beside_one=0.01, beside_many=0.01, at_record=0.01)
    sums = [
        (heard(records(spot, PRESENT, grid=wide, accuracy_m=a), wide, quiet, 0.0)).sum()
        for a in (2.0, 6.0)
    ]
    assert sums[0] == pytest.approx(sums[1], rel=0.15)


def test_an_unknown_accuracy_is_the_usual_one():
    np.testing.assert_array_equal(
        heard(at_middle(PRESENT)), heard(at_middle(PRESENT, accuracy_m=USUAL.accuracy_m))
    )


# --- several records


def one_by_one(base, observations, prior):
    """Hear records slowly, plant by plant, with nothing left out for being far."""
    area = GRID.row_spacing_m * GRID.plant_spacing_m / (2 * np.pi)
    xy = GRID.frame.xy_m(observations.lonlat)
    ages = (TODAY - observations.day) / np.timedelta64(1, "D")
    finds = observations.present == PRESENT
    chance = np.full(len(GRID), base)
    clock = None
    for r in sorted(range(len(ages)), key=lambda r: (-ages[r], not finds[r])):
        if clock is not None:
            chance = base + (chance - base) * 0.5 ** ((clock - ages[r]) / prior.half_life_days)
        clock = ages[r]
        accuracy, count, leaves = (
            getattr(observations, name)[r] for name in ("accuracy_m", "count", "leaves_sampled")
        )
        accuracy = prior.accuracy_m if np.isnan(accuracy) else accuracy
        count = prior.half_count if np.isnan(count) else count
        share = count / (count + prior.half_count) if finds[r] else 0.0
        beside = prior.beside_one + share * (prior.beside_many - prior.beside_one)
        square = ((GRID.xy_m - xy[r]) ** 2).sum(axis=1)
        own = area / (area + accuracy**2) * np.exp(-square / 2 / (area + accuracy**2))
        wide = prior.reach_m**2 + accuracy**2
        near = beside * prior.reach_m**2 / wide * np.exp(-square / 2 / wide)
        if finds[r]:
            chance = 1 - (1 - chance) * (1 - prior.at_record * own) * (1 - near)
        else:
            seen = 1 - (1 - prior.leaf_detection) ** leaves
            d = (prior.detection if np.isnan(leaves) else seen) * (1 - (1 - own) * (1 - near))
            chance = chance * (1 - d) / (1 - chance * d)
    return base + (chance - base) * 0.5 ** (clock / prior.half_life_days)


@settings(max_examples=60, deadline=None)
@given(some_records, st.floats(0.0, 0.5))
def test_records_add_up_as_they_do_when_heard_one_by_one_on_all_plants(observations, base):
    # each is cut where it would say less than 1e-4
    np.testing.assert_allclose(
        heard(observations, base=base),
        one_by_one(base, observations, USUAL),
        rtol=0,
        atol=3e-4 * len(observations),
    )


@given(some_records, st.randoms(use_true_random=False))
def test_the_order_of_the_records_does_not_matter(observations, random):
    order = list(range(len(observations)))
    random.shuffle(order)
    np.testing.assert_array_equal(heard(observations), heard(observations.take(np.array(order))))


@given(some_records, some_records)
def test_one_more_find_never_lowers_and_one_more_clean_look_never_raises(observations, others):
    before = heard(observations, base=0.1)
    for present, sign in ((PRESENT, 1.0), (ABSENT, -1.0)):
        more = replace(others, present=np.full(len(others), present, np.int8))
        after = heard(together(observations, more), base=0.1)
        assert (sign * (after - before) >= -1e-12).all()


@given(some_records, st.sampled_from((PRESENT, ABSENT)))
def test_a_record_far_from_all_plants_changes_nothing(observations, present):
    far = records([[5_000.0, 0.0], [0.0, -90_000.0]], present, accuracy_m=5.0)
    np.testing.assert_array_equal(heard(observations), heard(together(observations, far)))


def test_a_record_changes_nothing_far_from_itself():
    chance = heard(records(GRID.xy_m[0], PRESENT))
    assert chance[0] > 0.1
    assert chance[-1] == 0.01


def test_newer_evidence_outweighs_older_at_the_same_place():
    sharp = {"accuracy_m": 0.0, "leaves_sampled": 20.0}
    old_find = at_middle(PRESENT, 10, **sharp)
    old_look = at_middle(ABSENT, 10, **sharp)
    find, look = (at_middle(present, 0, **sharp) for present in (PRESENT, ABSENT))
    lately_clean = heard(together(old_find, look), base=0.1)[MIDDLE]
    lately_found = heard(together(old_look, find), base=0.1)[MIDDLE]
    assert lately_clean < 0.3
    assert lately_found > 0.9


@given(some_records, some_records)
def test_of_one_day_the_finds_are_heard_before_the_clean_looks(first, second):
    finds = replace(
        first, present=np.full(len(first), PRESENT, np.int8), day=TODAY.repeat(len(first))
    )
    looks = replace(
        second, present=np.full(len(second), ABSENT, np.int8), day=TODAY.repeat(len(second))
    )
    after_finds = heard(finds, base=0.1)
    np.testing.assert_allclose(
        heard(together(looks, finds), base=0.1),
        record_chance(GRID, after_finds, looks, TODAY, USUAL),
        rtol=1e-9,
    )


def test_even_a_risk_of_one_can_be_undone_by_clean_looks():
    looks = together(*[at_middle(ABSENT, accuracy_m=0.0, leaves_sampled=20.0)] * 10)
    chance = prior_chance(GRID, field_of(GRID), looks, TODAY, USUAL, np.ones(len(GRID)))
    assert chance[MIDDLE] < 0.05
    assert chance[-1] > 0.99


@settings(max_examples=40, deadline=None)
@given(crooked_grids(40.0, max_plants=3000), st.data())
def test_every_chance_is_a_chance_on_any_plot(grid, data):
    n = len(grid)
    which = data.draw(st.lists(st.integers(0, n - 1), min_size=1, max_size=8))
    m = len(which)
    observations = records(
        grid.xy_m[which] + data.draw(st.floats(-5, 5)),
        np.array(data.draw(st.lists(st.integers(-1, 1), min_size=m, max_size=m)), np.int8),
        data.draw(st.lists(st.integers(-5, 50), min_size=m, max_size=m)),
        grid=grid,
    )
    risk = np.where(np.arange(n) % 3 == 0, np.nan, (np.arange(n) % 2).astype(float))
    chance = prior_chance(grid, field_of(grid), observations, TODAY, USUAL, risk)
    assert chance.shape == (n,)
    assert ((chance >= 0.0) & (chance <= 1.0)).all()


@settings(deadline=None)
@given(some_records, st.floats(-80.0, 80.0))
def test_the_direction_of_the_frame_does_not_matter(observations, turn_deg):
    frame = GRID.frame.turned(GRID.frame.bearing_deg + turn_deg)
    xy_m = frame.xy_m(GRID.lonlat())
    boundary = field_of(GRID).boundary
    turned = replace(GRID, frame=frame, xy_m=xy_m, drivable_m=frame.geometry_m(boundary))
    field = field_of(GRID, [[(-30.0, -90.0), (50.0, 90.0)]])
    there, here = (prior_chance(g, field, observations, TODAY, USUAL) for g in (turned, GRID))
    np.testing.assert_allclose(there, here, rtol=0, atol=1.01e-4)
    assert np.mean(np.abs(there - here) < 1e-8) > 0.95  # but for plants on the rim of a reach


# --- which records speak


def test_records_that_say_neither_and_those_of_tomorrow_are_left_out_and_told_of():
    observations = together(
        at_middle(PRESENT, 3),
        at_middle(UNKNOWN, 3),
        at_middle(UNKNOWN, -3),
        at_middle(PRESENT, -1),
        Observations.of(GRID.lonlat()[:2], [PRESENT, ABSENT]),
    )
    kept = usable(observations, TODAY)
    assert len(kept.observations) == 3
    assert (kept.undecided, kept.future, kept.undated) == (2, 1, 2)
    assert [remark.split()[0] for remark in kept.remarks()] == ["2", "1", "2"]
    assert not usable(at_middle(PRESENT), TODAY).remarks()


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
        prior_chance(GRID, field, Observations.none(), TODAY, USUAL),
    )


def test_a_record_of_today_speaks_today_at_any_hour():
    assert usable(at_middle(PRESENT), np.datetime64("2026-05-20T05:00")).future == 0
    np.testing.assert_array_equal(
        heard(at_middle(PRESENT)),
        record_chance(
            GRID,
            np.full(len(GRID), 0.01),
            at_middle(PRESENT),
            np.datetime64("2026-05-20T17:00"),
            USUAL,
        ),
    )


def test_a_record_without_a_date_counts_as_the_settings_say():
    undated = replace(at_middle(PRESENT), day=np.array(["NaT"], "datetime64[D]"))
    np.testing.assert_array_equal(heard(undated), heard(at_middle(PRESENT, 14)))
    np.testing.assert_array_equal(
        heard(undated, prior=PriorSettings(undated_days=30.0)), heard(at_middle(PRESENT, 30))
    )


@pytest.mark.parametrize(
    ("xy_m", "distance"), [((0.0, 542.0), "500 m away"), ((-3_040.0, 0.0), "3 km away")]
)
def test_records_that_are_all_elsewhere_are_refused_with_the_distance(xy_m, distance):
    observations = records([xy_m, (0.0, 20_000.0)], PRESENT)
    with pytest.raises(ObservationError, match=f"of 2 the nearest is {distance}") as refused:
        heard(observations)
    assert "coordinate system" in str(refused.value)


def test_records_on_another_continent_are_refused_with_the_distance():
    observations = Observations.of([[-72.0, -41.0]], [PRESENT])
    km = Geod(ellps="WGS84").inv(-72.0, -41.0, GRID.frame.lon, GRID.frame.lat)[2] / 1000
    with pytest.raises(ObservationError) as refused:
        heard(observations)
    said = float(str(refused.value).split("nearest is ")[1].split(" km")[0])
    assert said == pytest.approx(km, rel=0.01)


def test_exchanged_longitude_and_latitude_are_recognised():
    exchanged = Observations.of(GRID.lonlat()[:5, ::-1].copy(), [PRESENT] * 5)
    with pytest.raises(ObservationError, match="longitude and latitude exchanged"):
        heard(exchanged)


def test_metres_taken_for_degrees_are_recognised():
    with pytest.raises(ObservationError, match="must be in degrees"):
        heard(Observations.of([[735_000.0, 3_360_000.0], [np.nan, np.nan]], [PRESENT, ABSENT]))


def test_a_record_just_outside_the_plot_still_speaks_of_the_plants_next_to_it():
    corner = GRID.xy_m.min(axis=0)
    chance = heard(records(corner - 6.0, PRESENT))
    assert chance[0] > 0.02


@settings(max_examples=30, deadline=None)
@given(st.floats(0.0, 360.0), st.floats(200.0, 5_000.0))
def test_the_distance_outside_a_plot_is_the_geodesic_one(bearing_deg, metres):
    plot = rectangle(1, 1, Planting(row_spacing_m=0.1, plant_spacing_m=0.1, headland_m=0.05))
    geod = Geod(ellps="WGS84")
    lon, lat, _ = geod.fwd(plot.frame.lon, plot.frame.lat, bearing_deg, metres)
    off_m = outside_m(plot, np.array([[lon, lat], [plot.frame.lon, plot.frame.lat]]))
    assert off_m[0] == pytest.approx(metres, abs=0.1)
    assert off_m[1] == 0.0


# --- risk maps and settings


def test_a_risk_map_raises_chances_where_it_speaks():
    field = field_of(GRID)
    risk = np.full(len(GRID), np.nan)
    risk[:10] = 0.4
    with_risk, without = (
        prior_chance(GRID, field, Observations.none(), TODAY, USUAL, r) for r in (risk, None)
    )
    np.testing.assert_array_equal(with_risk[10:], without[10:])
    np.testing.assert_allclose(with_risk[:10], 1 - 0.6 * (1 - without[:10]))


@pytest.mark.parametrize(
    ("risk", "says"), [(np.zeros(3), "one entry a plant"), (np.full(len(GRID), 87.0), "87")]
)
def test_a_risk_map_that_does_not_fit_is_refused(risk, says):
    with pytest.raises(ObservationError, match=says):
        prior_chance(GRID, field_of(GRID), Observations.none(), TODAY, USUAL, risk)


@pytest.mark.parametrize(
    "wrong",
    [
        {"background_chance": 1.5},
        {"edge_chance": -0.1},
        {"edge_depth_m": 0.0},
        {"reach_m": np.nan},
        {"half_life_days": np.inf},
        {"accuracy_m": -1.0},
        {"undated_days": np.nan},
        {"detection": 84.0},
        {"beside_one": 0.5, "beside_many": 0.4},
    ],
)
def test_a_setting_out_of_range_is_refused_by_name(wrong):
    with pytest.raises(SettingError, match=list(wrong)[-1]):
        PriorSettings(**wrong)


# --- a season's start

some_chances = st.lists(
    st.floats(1e-6, 1 - 1e-6) | st.sampled_from((0.0, 1.0)), min_size=2, max_size=200
).map(np.array)


@given(some_chances, st.floats(0.001, 0.999))
def test_chances_are_scaled_to_the_share_exactly_with_one_factor_on_the_odds(chance, share):
    certain, free = chance == 1.0, (chance > 0) & (chance < 1)
    if not certain.sum() < share * len(chance) < certain.sum() + free.sum():
        with pytest.raises(SettingError, match="strictly between"):
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
