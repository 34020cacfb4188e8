"""A plan says how many metres of it lie outside, and where a robot's body does."""

import re

import pytest
import shapely
from shapely import box

from fieldmon.plot.travel import Aisles
from tests.plot.test_clear_lanes import WIDE, driven, measured


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
def test_where_no_row_end_has_room_for_a_robot_it_turns_outside_which_is_said(bend_m):
    tight, _, _ = measured(bend_m, box(28.85, -9, 40, 40), box(-9, -9, -0.85, 40))
    aisles = Aisles.of(tight).for_robot(WIDE)
    told = aisles.said_of(shapely.get_coordinates(driven(aisles)))
    assert "lie outside the plot's boundary" in told[0]


@pytest.mark.parametrize("bend_m", [0.0, 6.0])
def test_a_body_that_reaches_over_the_boundary_is_said(bend_m):
    roomy, _, _ = measured(bend_m)
    tight, _, _ = measured(bend_m, box(29.1, -9, 40, 40))
    for grid, said in ((roomy, False), (tight, True)):
        aisles = Aisles.of(grid).for_robot(WIDE)
        told = aisles.said_of(shapely.get_coordinates(driven(aisles)))
        assert any("body reaches up to" in one for one in told) == said
        assert not any("outside" in one for one in told)
        assert not Aisles.of(grid).said_of(shapely.get_coordinates(driven(Aisles.of(grid))))


def test_metres_outside_the_boundary_are_said_but_not_those_to_a_gate_outside():
    grid, _, _ = measured(0.0)
    aisles = Aisles.of(grid, tuple(grid.stop_m[0] + [0.0, -15.0]))
    assert not aisles.said_of(shapely.get_coordinates(driven(aisles)))
    # a canal parts the plot
    split, _, _ = measured(0.0, box(-9, 6.4, 40, 6.8))
    aisles = Aisles.of(split)
    told = aisles.said_of(shapely.get_coordinates(driven(aisles)))
    assert len(told) == 1
    assert re.match(r"[\d.]+ m of the way lie outside the plot's boundary, up to [\d.]+ m", told[0])


def test_where_only_a_way_too_near_to_holes_leads_it_is_said():
    # a row between a wall across its lane at either end of it
    walls = box(-1.4, 4.2, -1.0, 7.8), box(29.0, 4.2, 29.4, 7.8)
    grid, _, _ = measured(0.0, *walls)
    aisles = Aisles.of(grid).for_robot(WIDE)
    told = " ".join(aisles.said_of(shapely.get_coordinates(driven(aisles))))
    assert "of the way the robot comes nearer than 0.65 m to a hole" in told
    roomy, _, _ = measured(0.0, walls[0])
    aisles = Aisles.of(roomy).for_robot(WIDE)
    assert not aisles.said_of(shapely.get_coordinates(driven(aisles)))
