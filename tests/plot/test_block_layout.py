"""Plants laid in blocks, each with rows of its own."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, MultiPolygon, Polygon

from fieldmon.errors import PlotError
from fieldmon.plot.block import Block
from fieldmon.plot.block_cutting import blocks_from_outline, cut_blocks
from fieldmon.plot.field import Field
from fieldmon.plot.grid import block_number
from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.travel import Aisles
from tests.crooked import crooked_fields, plantings
from tests.crossing import crosses_rows

FRAME = Frame(8.0, 47.0)
PLANTING = Planting(row_spacing_m=2.5, plant_spacing_m=1.2)
L_SHAPE = Polygon([(0, 0), (120, 0), (120, 30), (30, 30), (30, 140), (0, 140)])


def field_of(area, **more):
    return Field("home", FRAME.geometry_lonlat(MultiPolygon([area])), **more)


def block_of(area, name="", **stated):
    return Block(name, FRAME.geometry_lonlat(MultiPolygon([area])), **stated)


@pytest.fixture(scope="module")
def in_blocks():
    """Return an L in its two arms, rows along each."""
    field = field_of(L_SHAPE)
    return replace(field, blocks=blocks_from_outline(field))


def test_rows_of_each_block_run_along_it_and_are_longer_than_in_one(in_blocks):
    grid = lay(in_blocks, PLANTING)
    assert grid.n_blocks == 2
    alone = lay(replace(in_blocks, blocks=()), PLANTING)
    assert grid.n_rows < 0.6 * alone.n_rows
    assert len(grid) > len(alone)
    xy_m = FRAME.xy_m(grid.lonlat())
    ways = []
    for block in (1, 2):
        step = np.diff(xy_m[block_number(grid) == block], axis=0)
        ways.append(np.median(np.abs(step), axis=0))
    assert sorted(way.round(2).tolist() for way in ways) == [[0.0, 1.2], [1.2, 0.0]]


def test_rows_stop_half_a_row_and_a_headland_before_the_edge_of_their_block(in_blocks):
    grid = lay(in_blocks, PLANTING)
    xy_m = FRAME.xy_m(grid.lonlat())
    for k, block in enumerate(in_blocks.blocks):
        area = FRAME.geometry_m(block.area)
        mine = shapely.points(xy_m[block_number(grid) == k + 1])
        assert shapely.contains(area, mine).all()
        assert shapely.distance(area.boundary, mine).min() == pytest.approx(1.25, abs=0.01)
    stops = shapely.points(FRAME.xy_m(grid.frame.lonlat(grid.stop_m)))
    assert shapely.covers(shapely.buffer(L_SHAPE, 0.01), stops).all()


def test_each_block_keeps_its_own_spacings_neighbours_and_bearing():
    halves = shapely.box(0, 0, 60.2, 50.2), shapely.box(60.2, 0, 130.4, 50.2)
    blocks = (
        block_of(halves[0], "close", row_bearing_deg=0.0, row_spacing_m=2.0, plant_spacing_m=1.0),
        block_of(halves[1], "wide", row_bearing_deg=90.0, row_spacing_m=5.0, plant_spacing_m=4.0),
    )
    grid = lay(field_of(shapely.union(*halves), blocks=blocks), PLANTING)
    block, n_along = block_number(grid), np.diff(grid.along_start)
    n_across = np.diff(grid.across_start)
    for number, (rows, plants) in enumerate([(30, 43), (10, 16)], 1):
        assert np.count_nonzero(block == number) == rows * plants
        assert n_along[block == number].sum() == 2 * rows * (plants - 1)
        assert n_across[block == number].sum() == 2 * (rows - 1) * plants


def test_a_drawn_row_bends_the_rows_of_its_own_block_only():
    halves = shapely.box(0, 0, 60, 60), shapely.box(60, 0, 120, 60)
    bow = LineString([(65, 20), (90, 30), (115, 20)])
    rows = MultiLineString([FRAME.geometry_lonlat(bow)])
    blocks = (block_of(halves[0], "straight", row_bearing_deg=90.0), block_of(halves[1], "bent"))
    grid = lay(field_of(shapely.union(*halves), blocks=blocks, row_lines=rows), PLANTING)
    xy_m, block = FRAME.xy_m(grid.lonlat()), block_number(grid)
    for number, bends in ((1, False), (2, True)):
        for row in np.unique(grid.row[block == number]):
            mine = xy_m[grid.row == row]
            if len(mine) > 20:
                assert (np.ptp(mine[:, 1]) > 3.0) == bends


def test_a_block_without_room_and_one_off_the_plot_are_refused_by_name():
    field = field_of(shapely.box(0, 0, 60, 50))
    narrow = (block_of(shapely.box(0, 0, 3, 50), "verge", row_bearing_deg=90.0),)
    with pytest.raises(PlotError, match="'home, block verge'"):
        lay(replace(field, blocks=narrow), PLANTING)
    away = (block_of(shapely.box(100, 0, 160, 50), "next door"),)
    with pytest.raises(PlotError, match="block 'next door' does not overlap 'home'"):
        lay(replace(field, blocks=away), PLANTING)


def test_both_faces_of_rows_in_blocks_are_inspected(in_blocks):
    one, two = (lay(in_blocks, replace(PLANTING, faces=faces)) for faces in (1, 2))
    assert len(two) == 2 * len(one)
    assert (two.twin >= 0).all()


@given(crooked_fields(), plantings(), st.floats(0.0, 180.0), st.integers(0, 2**32))
def test_what_is_driven_on_a_cut_plot_is_as_long_as_charged_and_crosses_no_row(
    field, planting, turn_deg, seed
):
    frame = field.frame()
    middle = np.array(frame.geometry_m(field.boundary).centroid.coords[0])
    far_m = 1000 * np.array([np.cos(np.deg2rad(turn_deg)), np.sin(np.deg2rad(turn_deg))])
    line = LineString(frame.lonlat([middle - far_m, middle + far_m]))
    try:
        parted = replace(field, blocks=cut_blocks(field, line))
        grid = lay(parted, planting)
        aisles = Aisles.of(grid)
    except PlotError:
        assume(False)
    area = shapely.buffer(grid.drivable_m, 0.01)
    assert shapely.covers(area, shapely.multipoints(grid.xy_m))
    rng = np.random.default_rng(seed)
    for _ in range(4):
        i, j = rng.integers(-1, len(grid), 2)
        path = aisles.path(i, j)
        length_m = float(np.hypot(*np.diff(path, axis=0).T).sum())
        assert length_m == pytest.approx(float(aisles.distance_m(i, j)), abs=1e-6)
        assert not crosses_rows(grid, path)
