"""The day's route: the seconds charged, on a line that crosses no row."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.errors import PlotError
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.route import route_of, with_forecast
from fieldmon.planning.workday import Workday, plan_work
from fieldmon.plot.layout import lay
from fieldmon.plot.passing import legs_of
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import GATE
from fieldmon.samplers import SAMPLERS, sampler
from tests.crooked import crooked_fields
from tests.crossing import crosses_rows
from tests.scenes import GRIDS, charged_s, scene_on


def check(scene, work):
    """Check what every route promises."""
    route = route_of(scene, work)
    assert route.leave_s == pytest.approx(route.arrive_s + work.stop_s)
    assert route.expected_finds == pytest.approx((route.chance * work.detects).sum())
    assert route.line_s[route.line_stop] == pytest.approx(route.arrive_s)
    assert (np.diff(route.line_s) >= -1e-9).all()
    here = route.line_m[route.line_stop]
    plants = scene.grid.xy_m[route.plant]
    assert here[:, 0] == pytest.approx(plants[:, 0], abs=1e-6)
    assert np.abs(here[:, 1] - plants[:, 1]).max(initial=0) < scene.grid.row_spacing_m
    assert not crosses_rows(scene.grid, route.line_m)
    charged = route.drive_m / scene.robot.speed_m_s + work.stop_s.sum()
    rows = scene.grid.corridor[scene.grid.row[route.plant]]
    charged += scene.robot.row_change_s * np.count_nonzero(np.diff(rows))
    assert route.end_s == pytest.approx(charged, abs=1e-3)


@pytest.mark.parametrize("name", sorted(SAMPLERS))
@pytest.mark.parametrize("grid", GRIDS.values(), ids=GRIDS)
@pytest.mark.parametrize("seed", range(2))
def test_the_route_is_the_day_as_charged(name, grid, seed):
    scene = scene_on(grid, hours=1.0, seed=seed)
    check(scene, plan_work(scene, sampler(name)))


@given(field=crooked_fields(), seed=st.integers(0, 1000))
def test_on_crooked_fields_too(field, seed):
    try:
        scene = scene_on(lay(field, Planting()), hours=2.0, seed=seed)
    except PlotError:
        assume(False)
    check(scene, plan_work(scene, sampler("dynamic")))


def test_a_route_that_returns_ends_where_it_starts():
    scene = scene_on(GRIDS["rectangle"], seed=1)
    route = route_of(scene, plan_work(scene, sampler("naive")))
    assert route.line_m[0] == pytest.approx(route.line_m[-1])


def test_a_route_without_stops_is_empty():
    scene = scene_on(GRIDS["rectangle"], hours=0.005)
    route = route_of(scene, plan_work(scene, sampler("naive")))
    assert (len(route), route.drive_m, route.end_s) == (0, 0.0, 0.0)
    assert route.line_lonlat().shape == (0, 2)


def test_only_a_route_with_notes_has_room_for_what_is_ahead():
    scene = scene_on(GRIDS["rectangle"], seed=1)
    bare = route_of(scene, plan_work(scene, sampler("naive")))
    noted = replace(bare, notes=RouteNotes("Vines", "naive"))
    assert with_forecast(bare, list) is bare
    assert with_forecast(noted, list).notes.ahead is list
    assert noted.notes.ahead is None


@pytest.mark.parametrize("at", [GATE, 7])
@pytest.mark.parametrize("seed", range(4))
def test_who_waits_comes_to_the_end_of_the_aisle_and_drives_on_so_much_later(at, seed):
    """Everything else is the line of a day without waits, driven as fast, and so much later."""
    rng, grid = np.random.default_rng(seed), GRIDS["rectangle"]
    scene = replace(scene_on(grid, hours=1.0, seed=seed), at=at)
    plants = rng.permutation(len(grid))[:6].astype(np.int32)
    places = [at, *plants.tolist(), *([GATE] if scene.robot.returns else [])]
    ways_s = np.array([charged_s(scene, *leg) for leg in pairwise(places)])
    wait_s = rng.uniform(5.0, 90.0, 7) * (rng.random(7) < 0.6)
    stop_s = rng.uniform(10.0, 40.0, 6)

    def day(wait_s):
        come_s = np.cumsum(ways_s + wait_s[: len(ways_s)] + np.append(0.0, stop_s)[: len(ways_s)])
        times = come_s[:6], np.zeros(6, np.bool_), stop_s, np.full(6, 0.8)
        home_s = come_s[-1] if scene.robot.returns else come_s[5] + stop_s[-1]
        return Workday(plants, *times, float(home_s), wait_s)

    plain, late = route_of(scene, day(np.zeros(7))), route_of(scene, day(wait_s))
    waits = [leg for leg in range(len(ways_s)) if wait_s[leg] > 0.0]
    assert len(late.line_m) == len(plain.line_m) + 2 * len(waits)
    assert late.line_s[late.line_stop] == pytest.approx(late.arrive_s)
    assert late.drive_m == pytest.approx(plain.drive_m)
    here = late.line_m[late.line_stop]
    assert here == pytest.approx(plain.line_m[plain.line_stop])
    stands = np.flatnonzero((np.diff(late.line_m, axis=0) == 0.0).all(axis=1))
    stands = [v for v in stands if late.line_s[v + 1] - late.line_s[v] > 4.0
              and v not in late.line_stop]  # fmt: skip
    assert len(stands) == len(waits)
    legs = legs_of(scene.aisles)
    for v, leg in zip(stands, waits, strict=True):
        assert late.line_s[v + 1] - late.line_s[v] == pytest.approx(wait_s[leg])
        out_m = legs.leg(places[leg], places[leg + 1]).out_m
        if places[leg] >= 0 and out_m > 0.0:
            ends_m = grid.lane_x_m[grid.row[places[leg]]]
            assert np.abs(ends_m - late.line_m[v, 0]).min() < 1e-6
        begin = late.line_stop[leg - 1] if leg else 0
        gone_m = np.hypot(*np.diff(late.line_m[begin : v + 1], axis=0).T).sum()
        assert gone_m == pytest.approx(out_m, abs=1e-6)
        # at one speed before and after
        end = late.line_stop[leg] if leg < 6 else len(late.line_m) - 1
        leave_s = late.leave_s[leg - 1] if leg else 0.0
        whole_m = np.hypot(*np.diff(late.line_m[begin : end + 1], axis=0).T).sum()
        drive_s = late.line_s[end] - leave_s - wait_s[leg]
        assert late.line_s[v] - leave_s == pytest.approx(drive_s * gone_m / whole_m)
