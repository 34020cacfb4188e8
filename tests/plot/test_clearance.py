"""A robot's width: ways keep off the canopies of plants, and narrow aisles are not entered."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.clearance import (
    STRAY_M,
    USUAL_HALF_CANOPY_M,
    Clearance,
    lane_room_m,
    narrow_sentence,
)
from fieldmon.plot.layout import grid_from_plants, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot, rover
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER, Scene
from tests.bent import bent_grids
from tests.crooked import crooked_grids

NARROW = Planting(row_spacing_m=1.2)


def narrow_in_the_middle(half_canopy_m=None):
    """Return eight rows 3 m apart, but two of them 1 m apart."""
    y = np.array([0, 3, 6, 9, 10, 13, 16, 19.0])
    grid = rectangle(8, 12, Planting(row_spacing_m=3.0, half_canopy_m=half_canopy_m))
    xy_m = grid.xy_m.copy()
    xy_m[:, 1] = y[grid.row]
    return replace(grid, xy_m=xy_m, lane_y_m=np.append((y[:-1] + y[1:]) / 2, 20.5))


def near_m(grid, line):
    """Return how near a line comes to the middle of any plant."""
    return float(shapely.distance(shapely.linestrings(line), shapely.points(grid.xy_m)).min())


def test_without_a_width_nothing_changes():
    aisles = Aisles.of(rectangle(4, 6))
    assert aisles.for_robot(Robot()) is aisles
    assert not aisles.too_narrow.any()
    assert aisles.narrow_sentence() == ""


def test_of_a_robot_with_room_everywhere_nothing_is_said():
    aisles = Aisles.of(rectangle(4, 6, Planting(row_spacing_m=4.0))).for_robot(Robot(width_m=0.5))
    assert aisles.clearance is not None
    assert not aisles.too_narrow.any()
    assert aisles.narrow_sentence() == ""


def test_half_the_width_the_canopy_and_a_little_are_kept_off_plants():
    grid = rectangle(4, 6, Planting(half_canopy_m=0.4))
    needs = Clearance.of(Robot(width_m=0.6, length_m=0.8), grid)
    assert needs.way_m == pytest.approx(0.3 + 0.4 + STRAY_M)
    assert needs.turn_m == pytest.approx(0.5 + 0.4 + STRAY_M)
    usual = Clearance.of(Robot(width_m=0.6), rectangle(4, 6))
    assert usual.way_m == pytest.approx(0.3 + USUAL_HALF_CANOPY_M + STRAY_M)


@pytest.mark.parametrize("grids", [crooked_grids, bent_grids])
@given(data=st.data())
def test_no_way_comes_nearer_to_a_plant_than_the_robot_can(grids, data):
    grid = data.draw(grids())
    width_m = data.draw(st.floats(0.3, 1.2))
    try:
        aisles = Aisles.of(grid).for_robot(Robot(width_m=width_m))
    except PlotError:
        assume(False)  # too narrow a plot, and said so
    open_ = np.flatnonzero(~aisles.too_narrow)
    some = data.draw(st.lists(st.sampled_from(open_.tolist()), min_size=2, max_size=6))
    for a, b in zip([GATE, *some], [*some, GATE], strict=True):
        line = aisles.path(a, b)
        assert near_m(grid, line) >= aisles.clearance.way_m - 1e-6
        length_m = np.hypot(*np.diff(line, axis=0).T).sum()
        assert length_m == pytest.approx(aisles.distance_m(a, b), abs=1e-6)


def test_a_headland_is_passed_further_out_by_a_wider_robot():
    grid = rectangle(6, 10)
    corner = (int(grid.row_start[1]) - 1, int(grid.row_start[4]) - 1)
    passing = [
        near_m(grid, Aisles.of(grid).for_robot(Robot(width_m=w)).path(*corner)) for w in (0.3, 1.5)
    ]
    assert passing[0] >= 0.5 - 1e-9
    assert passing[1] >= 1.1 - 1e-9


def test_a_plot_too_narrow_is_said_so_with_the_metres():
    with pytest.raises(PlotError, match=r"1\.64 m between.*widest here is 1\.20 m"):
        Aisles.of(rectangle(4, 6, NARROW)).for_robot(Robot(width_m=0.94))
    assert not Aisles.of(rectangle(4, 6, NARROW)).for_robot(Robot(width_m=0.4)).too_narrow.any()


@pytest.mark.parametrize("name", SAMPLERS)
def test_nobody_is_sent_into_an_aisle_that_is_too_narrow(name):
    grid = narrow_in_the_middle()
    assert lane_room_m(grid).round(2).tolist() == [1.5, 1.5, 1.5, 0.5, 1.5, 1.5, 1.5, 1.5]
    robot = Robot(width_m=0.6, hours=12)
    chance, never = np.full(len(grid), 0.1), np.full(len(grid), NEVER, np.int32)
    scene = Scene(Aisles.of(grid), robot, chance, never, seconds_left=robot.day_s)
    stops = sampler(name).walk(scene, np.zeros(len(grid), np.bool_))
    assert len(stops.plant) > 10
    assert 3 not in grid.row[stops.plant]
    assert "1 row of 8 cannot be inspected" in scene.aisles.narrow_sentence()
    assert "12 plants are not visited" in scene.aisles.narrow_sentence()
    assert "needs 0.65 m to the middle of any plant, but one stands 0.50 m" in (
        scene.aisles.narrow_sentence()
    )


def test_where_there_is_no_room_to_turn_that_is_said_and_not_that_aisles_are_narrow():
    grid = rectangle(4, 6, Planting(row_spacing_m=1.4, plant_spacing_m=1.0, headland_m=1.0))
    robot = Robot(width_m=0.6, length_m=0.8)
    needs = Clearance.of(robot, grid)
    room_m = lane_room_m(grid)
    assert (room_m >= needs.way_m).all()
    said = narrow_sentence(np.ones(grid.n_rows, np.bool_), grid, Clearance(needs.way_m, 2.0))
    ends_m = needs.end_room_m(grid).max(axis=1).min()
    assert "to turn at an end of their aisles the robot needs 2.00 m" in said
    assert f"one stands {ends_m:.2f} m from it" in said


def test_what_is_there_is_never_rounded_up_to_what_is_needed():
    grid = narrow_in_the_middle()
    rows = np.arange(8) == 3
    said = narrow_sentence(rows, grid, Clearance(0.5004, 0.5004))
    assert "needs 0.51 m to the middle of any plant, but one stands 0.50 m" in said


def test_a_canopy_that_was_said_opens_or_shuts_aisles():
    robot = Robot(width_m=0.6)
    assert not Aisles.of(narrow_in_the_middle(0.1)).for_robot(robot).too_narrow.any()
    assert Aisles.of(narrow_in_the_middle(0.2)).for_robot(robot).too_narrow.sum() == 12


def test_a_long_robot_does_not_turn_where_it_would_sweep_over_plants():
    grid = rectangle(4, 6, Planting(row_spacing_m=1.6, headland_m=1.6))
    assert not Aisles.of(grid).for_robot(Robot(width_m=0.6)).too_narrow.any()
    with pytest.raises(PlotError, match=r"room to turn.*1\.20 m"):
        Aisles.of(grid).for_robot(Robot(width_m=0.6, length_m=1.6))


def test_measured_plants_keep_what_was_said_of_their_canopy():
    grid = rectangle(4, 6)
    made = grid_from_plants(grid.lonlat(), Planting(half_canopy_m=0.3))
    assert made.half_canopy_m == 0.3


@pytest.mark.parametrize("size", [{"width_m": 0.0}, {"width_m": 11.0}, {"length_m": 1.0}])
def test_impossible_sizes_are_refused(size):
    with pytest.raises(SettingError, match="robot"):
        Robot(**size)
    with pytest.raises(SettingError, match="half_canopy_m"):
        Planting(half_canopy_m=-1.0)


def test_the_rover_turns_within_its_diagonal():
    assert rover().turning_m == pytest.approx(np.hypot(0.58, 0.8))
    assert Robot().turning_m is None
