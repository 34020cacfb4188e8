"""Which aisles are driven through on the way from one plant to another."""

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon

from fieldmon.errors import PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.passing import legs_of
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.travel import GATE, Aisles
from tests.crooked import crooked_fields

_M = 1.0 / 111_320.0


def inside(aisles, line):
    """Return the aisles in whose lanes a line lies for more than a metre, seen from its shape."""
    grid = aisles.grid
    found = set()
    for row in range(grid.n_rows):
        (low, high), y = grid.lane_x_m[row], grid.lane_y_m[row]
        lane = shapely.box(low + 0.2, y - 0.05, high - 0.2, y + 0.05)
        if shapely.length(shapely.intersection(shapely.LineString(line), lane)) > 1.0:
            found.add(int(grid.corridor[row]))
    return found


def test_on_an_even_plot_no_other_aisle_is_driven_through():
    aisles = Aisles.of(rectangle(5, 8))
    plants = [(i, j) for i in range(-1, 40, 7) for j in range(0, 40, 3)]
    for i, j in plants:
        if i < 0 or aisles.grid.row[i] != aisles.grid.row[j]:
            assert legs_of(aisles).leg(i, j).through == ()


def test_beyond_a_notch_the_whole_row_below_it_is_driven_through():
    corners = [(-24, -12), (24, -12), (24, 16), (8, 16), (8, 0), (-8, 0), (-8, 16), (-24, 16)]
    notched = Field("notched", MultiPolygon([Polygon([(x * _M, y * _M) for x, y in corners])]))
    aisles = Plot.of(notched, Planting(row_bearing_deg=90.0)).aisles
    grid = aisles.grid
    left, right = (
        int(np.flatnonzero((grid.xy_m[:, 1] > 5) & (side * grid.xy_m[:, 0] > 8))[-1])
        for side in (-1, 1)
    )
    whole = set(grid.corridor[np.ptp(grid.lane_x_m, axis=1) > 40.0].tolist())
    assert set(legs_of(aisles).leg(left, right).through) & whole


@pytest.mark.parametrize("parts", [2, 3])
def test_a_way_to_a_part_in_line_lies_in_the_aisles_of_all_parts_before(parts):
    squares = [shapely.box(x, 0.0, x + 30.0, 14.0) for x in 100.0 * np.arange(parts)]
    boundary = shapely.transform(MultiPolygon(squares), lambda xy: xy * _M)
    # it begins where the first aisle does, and drives straight on
    aisles = Plot.of(Field("in line", boundary), Planting(row_bearing_deg=90.0)).aisles
    grid, last = aisles.grid, len(aisles.grid) - 1
    line = aisles.path(GATE, last)
    through = legs_of(aisles).leg(GATE, last).through
    assert len(set(through)) >= parts - 1
    assert inside(aisles, line) <= {*through, int(grid.corridor[grid.row[last]])}


@given(crooked_fields(max_radius_m=60.0), st.data())
def test_a_leg_is_as_long_as_the_way_and_knows_every_aisle_that_its_line_lies_in(field, data):
    try:
        aisles = Plot.of(field).aisles
    except PlotError:
        assume(False)
    n = len(aisles.grid)
    i = data.draw(st.integers(GATE, n - 1))
    j = data.draw(st.integers(0, n - 1))
    aisle = aisles.grid.corridor[aisles.grid.row]
    assume(i < 0 or aisle[i] != aisle[j])
    leg = legs_of(aisles).leg(i, j)
    assert leg.length_m == pytest.approx(float(aisles.distance_m(i, j)))
    assert 0.0 <= leg.out_m <= leg.length_m + 1e-9
    ends = {int(aisle[k]) for k in (i, j) if k >= 0}
    assert inside(aisles, aisles.path(i, j)) <= {*leg.through, *ends}
    if i >= 0:
        back = legs_of(aisles).leg(j, i)
        assert back.length_m == pytest.approx(leg.length_m)
