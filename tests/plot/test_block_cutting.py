"""Blocks of a plot: cut by a line, guessed from the outline."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import LineString, MultiPolygon, Polygon

from fieldmon.errors import PlotError
from fieldmon.plot.block_cutting import blocks_from_outline, cut_blocks
from fieldmon.plot.field import Field
from fieldmon.plot.projection import Frame
from tests.bent import turned

FRAME = Frame(8.0, 47.0)


def plot(*corners, turn_deg=0.0):
    shapes = [Polygon(turned(np.array(part, float), turn_deg)) for part in corners]
    return Field("home", FRAME.geometry_lonlat(MultiPolygon(shapes)))


def line(*corners):
    return LineString(FRAME.lonlat(corners))


def areas_m2(blocks):
    return [FRAME.geometry_m(block.area).area for block in blocks]


BOX = [(0, 0), (100, 0), (100, 60), (0, 60)]


def test_a_line_across_parts_a_plot_into_two_blocks_that_make_it_up():
    field = plot(BOX)
    blocks = cut_blocks(field, line((40, -5), (40, 65)))
    assert sorted(areas_m2(blocks)) == pytest.approx([2400, 3600], rel=1e-6)
    whole = shapely.union_all([block.area for block in blocks])
    assert shapely.symmetric_difference(whole, field.boundary).area < 1e-11


def test_only_the_blocks_a_line_passes_through_are_cut_and_keep_their_spacings():
    field = plot(BOX)
    first = cut_blocks(field, line((40, -5), (40, 65)))
    named = tuple(
        replace(block, name=name, row_bearing_deg=10.0, row_spacing_m=2.0)
        for block, name in zip(first, ("west", "east"), strict=True)
    )
    through = cut_blocks(replace(field, blocks=named), line((-5, 20), (40, 20)))
    assert {block.name for block in through} == {"west 1", "west 2", "east"}
    assert [block.row_spacing_m for block in through] == [2.0] * len(through)
    cut_ones = [block for block in through if block.name.startswith("west ")]
    assert [block.row_bearing_deg for block in cut_ones] == [None, None]


def test_a_bent_line_cuts_and_one_drawn_to_the_edge_reaches_it():
    field = plot(BOX)
    bent = cut_blocks(field, line((30, 0.5), (45, 30), (30, 59.5)))
    assert len(bent) == 2
    assert sum(areas_m2(bent)) == pytest.approx(6000, rel=1e-6)


def test_a_line_that_parts_nothing_is_refused_in_a_sentence():
    with pytest.raises(PlotError, match="from one side to the other, but this line parts nothing"):
        cut_blocks(plot(BOX), line((10, 10), (50, 50)))


def test_lines_one_after_the_other_part_a_plot_into_three():
    field = plot(BOX)
    cuts = [[(30, -5), (30, 65)], [(70, -5), (70, 65)]]
    for cut in cuts:
        field = replace(field, blocks=cut_blocks(field, line(*cut)))
    assert sorted(areas_m2(field.blocks)) == pytest.approx([1800, 1800, 2400], rel=1e-5)


def test_parts_that_a_cut_does_not_touch_go_with_the_nearer_side():
    far = [(110, 0), (150, 0), (150, 60), (110, 60)]
    blocks = cut_blocks(plot(BOX, far), line((40, -5), (40, 65)))
    assert sorted(areas_m2(blocks)) == pytest.approx([2400, 6000], rel=1e-6)


L_SHAPE = [(0, 0), (120, 0), (120, 30), (30, 30), (30, 140), (0, 140)]


@pytest.mark.parametrize("turn_deg", [0.0, 17.0, 130.0])
def test_an_l_is_guessed_to_be_two_blocks_each_as_narrow_as_an_arm(turn_deg):
    blocks = blocks_from_outline(plot(L_SHAPE, turn_deg=turn_deg))
    assert len(blocks) == 2
    for block in blocks:
        around = FRAME.geometry_m(block.area).minimum_rotated_rectangle
        sides = np.hypot(*np.diff(shapely.get_coordinates(around)[:3], axis=0).T)
        assert sides.min() == pytest.approx(30.0, abs=0.1)


def test_parts_turned_to_each_other_are_guessed_to_be_blocks():
    long = [(0, 0), (150, 0), (150, 30), (0, 30)]
    away = np.array([250.0, 0.0])
    thin = [tuple(xy) for xy in turned(np.array(long, float), 60.0) + away]
    assert len(blocks_from_outline(plot(long, thin))) == 2


@pytest.mark.parametrize("corners", [BOX, [(0, 0), (100, 0), (90, 50), (5, 60)]])
def test_a_plain_outline_is_one_block(corners):
    assert blocks_from_outline(plot(corners)) == ()


def test_a_ragged_outline_is_looked_at_in_time_and_not_parted():
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    reach = 60 + np.random.default_rng(0).uniform(-3, 3, 400)
    ragged = np.stack([reach * np.cos(turn), reach * np.sin(turn)], axis=1)
    assert blocks_from_outline(plot(ragged)) == ()


def test_what_is_said_of_blocks_is_told_to_digests():
    field = plot(BOX)
    told = field.content
    parted = replace(field, blocks=cut_blocks(field, line((40, -5), (40, 65))))
    assert parted.content[: len(told)] == told
    assert len(parted.content) == len(told) + 10
