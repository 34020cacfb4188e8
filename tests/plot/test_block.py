"""A block is an area, and what is said of it counts in digests."""

import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.block import Block

AREA = MultiPolygon([shapely.box(8.0, 47.0, 8.001, 47.001)])


def test_a_block_without_area_is_refused():
    with pytest.raises(PlotError, match="Block 'north' must be a valid, non-empty area"):
        Block("north", MultiPolygon())


def test_all_that_is_said_of_a_block_is_told():
    told = Block("north", AREA).content
    others = [Block("south", AREA), Block("north", AREA, 20.0), Block("north", AREA, None, 3.0)]
    assert all(other.content != told for other in others)
    assert Block("north", AREA, None, None, 1.5).content != told


@pytest.mark.parametrize(
    ("name", "area"), [("north", 1), ("north", None), (3, shapely.box(0, 0, 1, 1))]
)
def test_a_block_is_a_name_and_an_area_and_nothing_else(name, area):
    with pytest.raises(SettingError, match=r"A block's (name|area) must be"):
        Block(name, area)
