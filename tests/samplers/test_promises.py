"""The promises that every sampler keeps, on any plot; a new one is found here by itself."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.errors import PlotError
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import GATE
from fieldmon.samplers import SAMPLERS, kind_of, sampler
from fieldmon.samplers.base import NEVER
from tests.bent import bent_grids
from tests.crooked import crooked_fields
from tests.scenes import GRIDS, charged_s, scene_on
from tests.thorough import seeds

NAMES = sorted(SAMPLERS)


def promises_hold(scene, work):
    """Check one day against what every sampler promises."""
    n = len(scene.chance)
    assert ((work.plant >= 0) & (work.plant < n)).all()
    assert len(set(work.plant.tolist())) == len(work), "a plant was visited twice in a day"
    assert not (scene.last_inspected[work.plant] == scene.day).any()
    assert work.end_s <= scene.seconds_left + 1e-6, "the day is longer than its hours"
    # a lane's end is known to some 1e-7 m, and a day has hundreds of legs
    close, now, at = 1e-4, 0.0, scene.at
    stops = zip(work.plant.tolist(), work.arrive_s.tolist(), work.stop_s.tolist(), strict=True)
    for plant, arrive_s, stop_s in stops:
        now += charged_s(scene, at, plant)
        assert arrive_s == pytest.approx(now, abs=close), "time charged is not time driven"
        now += stop_s
        at = plant
    if scene.robot.returns and len(work):
        now += charged_s(scene, at, GATE)
    assert work.end_s == pytest.approx(now, abs=close)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("grid", GRIDS.values(), ids=GRIDS)
@pytest.mark.parametrize("seed", seeds(2, 4))
def test_a_day_keeps_its_hours_and_visits_no_plant_twice(name, grid, seed):
    scene = scene_on(grid, hours=0.5 + seed, seed=seed)
    found = np.random.default_rng(seed).random(len(grid)) < 0.2
    work = work_day(scene, sampler(name), found)
    promises_hold(scene, work)
    assert len(work) > 0


@given(field=crooked_fields(), seed=st.integers(0, 1000), faces=st.sampled_from([1, 2]))
def test_the_promises_hold_on_crooked_fields_of_one_face_or_two(field, seed, faces):
    try:
        grid = lay(field, Planting(faces=faces))
        scene = scene_on(grid, hours=2.0, seed=seed)
    except PlotError:
        assume(False)
    found = np.random.default_rng(seed).random(len(grid)) < 0.1
    for name in NAMES:
        work = work_day(scene, sampler(name), found)
        promises_hold(scene, work)
        again = work_day(scene, sampler(name), found)
        assert (work.plant == again.plant).all(), "the same seed gave another day"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", seeds(2, 4))
def test_no_sampler_peeks_at_plants_it_has_not_inspected(name, seed):
    scene = scene_on(GRIDS["rectangle"], seed=seed)
    rng = np.random.default_rng(seed)
    found = rng.random(len(scene.chance)) < 0.3
    work = work_day(scene, sampler(name), found)
    for k in (0, 1, len(work) // 2):
        elsewhere = found.copy()
        later = np.setdiff1d(np.arange(len(found)), work.plant[:k])
        elsewhere[later] = rng.random(len(later)) < 0.5
        again = work_day(scene, sampler(name), elsewhere)
        assert (again.plant[: k + 1] == work.plant[: k + 1]).all()


@pytest.mark.parametrize("name", NAMES)
def test_the_same_scene_gives_the_same_day(name):
    one, other = (plan_work(scene_on(GRIDS["rectangle"], seed=5), sampler(name)) for _ in "ab")
    assert (one.plant == other.plant).all()
    assert (one.arrive_s == other.arrive_s).all()


@pytest.mark.parametrize("name", NAMES)
def test_with_time_for_all_every_plant_is_inspected(name):
    scene = scene_on(GRIDS["rectangle"], hours=24.0)
    visited = sorted(plan_work(scene, sampler(name)).plant)
    if (kind := kind_of(name)).draws_share:  # it is all that it ever takes
        assert len(visited) == len(scene.chance) // kind.every
    else:
        assert visited == list(range(len(scene.chance)))


@pytest.mark.parametrize("name", NAMES)
def test_a_sampler_reads_the_chances_if_it_says_so(name):
    # in an hour: who has three for this plot may well sweep it, whatever the chances
    scene = scene_on(GRIDS["rectangle"], hours=1.0, seed=3)
    other = replace(scene, chance=scene.chance[::-1] / 3)
    one, two = (plan_work(each, sampler(name)).plant for each in (scene, other))
    assert np.array_equal(one, two) != sampler(name).reads_chance


@pytest.mark.parametrize("name", NAMES)
def test_a_day_goes_on_though_the_first_plants_were_all_inspected_today(name):
    grid = GRIDS["rectangle"]
    last = np.full(len(grid), NEVER, np.int32)
    # the first of the sweep, and every second of the others
    last[np.append(grid.snake[:4], grid.snake[::2])] = 0
    work = plan_work(scene_on(grid, hours=12.0, last_inspected=last), sampler(name))
    assert set(work.plant.tolist()) <= set(np.flatnonzero(last == NEVER).tolist())


@pytest.mark.parametrize("name", NAMES)
def test_a_day_without_time_has_no_stops(name):
    scene = scene_on(GRIDS["rectangle"], hours=0.005)
    work = plan_work(scene, sampler(name))
    assert (len(work), work.end_s) == (0, 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_a_plant_inspected_earlier_today_is_left_out_when_planning_again(name):
    last = np.full(187, NEVER, np.int32)
    last[40:120] = 0
    scene = scene_on(GRIDS["rectangle"], last_inspected=last, at=119)
    work = plan_work(scene, sampler(name))
    assert len(work) > 0
    promises_hold(scene, work)


@given(grid=bent_grids(), seed=st.integers(0, 1000))
def test_the_promises_hold_where_rows_bend_and_blocks_turn(grid, seed):
    scene = scene_on(grid, hours=1.0, seed=seed)
    found = np.random.default_rng(seed).random(len(grid)) < 0.2
    for name in NAMES:
        promises_hold(scene, work_day(scene, sampler(name), found))
