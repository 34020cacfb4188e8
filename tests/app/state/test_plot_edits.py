"""What a person draws on a plot changes it where it was drawn, or is refused in a sentence."""

import pytest

from app.state.plot_edits import Edit, edited, points_of
from app.words import language, texts
from fieldmon.errors import SettingError
from fieldmon.plot.field import Field
from tests.app.driving import SQUARE


def test_a_no_go_area_leaves_the_plot_and_a_gate_moves():
    field = Field("square", SQUARE)
    area = Edit("no_go", ((35.1502, 30.3602), (35.1504, 30.3602), (35.1504, 30.3604)))
    made = edited(field, (area, Edit("gate", ((35.15, 30.3603),))))
    assert made.gate == (35.15, 30.3603)
    assert made.drivable().area == pytest.approx(SQUARE.area - 0.5 * 0.0002 * 0.0002)
    path = Edit("path", ((35.15, 30.36), (35.1506, 30.3606)))
    assert len(edited(field, (path, path)).paths.geoms) == 2


@pytest.mark.parametrize("kind", ["gate", "path", "no_go", "row", "cut"])
def test_too_few_points_are_refused(kind):
    with pytest.raises(SettingError, match="needs"):
        Edit(kind, ())


@pytest.mark.parametrize("text", ["35", "x,y", "35.1,91", "200,3", "1,2,3"])
def test_typed_positions_that_are_none_are_refused(text):
    with pytest.raises(SettingError):
        points_of(text)


def test_typed_positions_are_read_in_any_layout():
    assert points_of("35.1,30.2 35.3,30.4;\n1, 2") == ((35.1, 30.2), (35.3, 30.4), (1.0, 2.0))


def test_where_fractions_have_a_comma_a_space_parts_longitude_and_latitude():
    language.use("es")
    try:
        assert points_of("35,15 30,36") == ((35.15, 30.36),)
        assert points_of("35,15 -30,36; 35 30,5") == ((35.15, -30.36), (35.0, 30.5))
        assert points_of(str(texts.DRAW_EXAMPLE)) == ((35.1503, 30.3601),)
        assert points_of("35.1503,30.3601") == ((35.1503, 30.3601),), "as another program copies it"
        with pytest.raises(SettingError, match="lon lat"):
            points_of("35,15 30,36 35,2")
    finally:
        language.use(language.ENGLISH)


def test_a_drawn_row_takes_the_place_of_the_one_before_in_its_block_only():
    field = Field("square", SQUARE)
    first = Edit("row", ((35.1501, 30.3601), (35.1505, 30.3602)))
    again = Edit("row", ((35.1501, 30.3603), (35.1505, 30.3602)))
    assert len(edited(field, (first, again)).row_lines.geoms) == 1
    cut = Edit("cut", ((35.1503, 30.359), (35.1503, 30.362)))
    west = Edit("row", ((35.1501, 30.3601), (35.15025, 30.3604)))
    east = Edit("row", ((35.1504, 30.3601), (35.15055, 30.3604)))
    made = edited(field, (cut, west, east, west))
    assert len(made.blocks) == 2
    assert len(made.row_lines.geoms) == 2
