"""The day's route: the seconds charged, on a line that crosses no row."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldmon.errors import PlotError
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.route import route_of, with_forecast
from fieldmon.planning.workday import plan_work
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import crosses_rows
from fieldmon.samplers import SAMPLERS, sampler
from tests.crooked import crooked_fields
from tests.scenes import GRIDS, scene_on


def check(scene, work):
    """Check what every route promises."""
    route = route_of(scene, work)
    assert route.leave_s == pytest.approx(route.arrive_s + work.stop_s)
    assert route.expected_found == pytest.approx((route.chance * work.detects).sum())
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
    scene = scene_on(grid, hours=2.0, seed=seed)
    check(scene, plan_work(scene, sampler(name)))


@given(field=crooked_fields(), seed=st.integers(0, 1000))
@settings(max_examples=25)
def test_on_crooked_fields_too(field, seed):
    try:
        scene = scene_on(lay(field, Planting()), hours=2.0, seed=seed)
    except PlotError:
        return
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
