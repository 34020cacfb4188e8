"""Along which direction rows are laid is said where it was guessed, and doubted where unsure."""

from dataclasses import replace

import pytest
import shapely
from shapely import LineString, MultiLineString, MultiPolygon

from fieldmon.io.guessed_bearing import doubts_of_bearing, guessed_bearing
from fieldmon.io.import_report import gathered
from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources
from fieldmon.io.prepare import prepare, prepare_estate
from fieldmon.plot.block import Block
from fieldmon.plot.field import Field
from tests.walked import FRAME, walked, write_corners

USUAL = PlantingChoices()
CORNERS = [(0, 0), (160, 10), (150, 110), (-5, 100)]


def field_of(ring_m, **known):
    return Field("north", MultiPolygon([FRAME.geometry_lonlat(shapely.Polygon(ring_m))]), **known)


CLEAN = field_of(CORNERS)
SURE = field_of(walked(CORNERS, 3, 0.5))
ROUGH = field_of(walked(CORNERS, 8, 3))


def said(field, choices=USUAL):
    return [one.sentence for one in doubts_of_bearing(field, choices)]


def test_a_guessed_bearing_is_said_and_doubted_where_a_rows_end_moves_by_a_row():
    assert said(CLEAN) == said(SURE) == []
    (doubt,) = said(ROUGH)
    off = guessed_bearing(ROUGH, USUAL).off_deg
    assert f"It may be off by {off:.0f} degrees: say the rows' bearing." in doubt
    assert said(ROUGH, PlantingChoices(row_spacing_m=40.0)) == []
    told = gathered([*doubts_of_bearing(ROUGH, USUAL), *doubts_of_bearing(ROUGH, USUAL)])
    assert "Of 2 plots the rows' bearing is in doubt; the first is north: Rows" in str(told[0])


def test_where_another_side_is_as_long_that_is_the_doubt():
    square = field_of(walked([(0, 0), (100, 0), (100, 98), (0, 98)], 3, 1))
    (doubt,) = said(square)
    assert "is about as long: say the rows' bearing." in doubt


@pytest.mark.parametrize(
    "known",
    [
        {"row_bearing_deg": 80.0},
        {"row_lines": MultiLineString([FRAME.geometry_lonlat(LineString([(5, 50), (140, 50)]))])},
        {"plants": FRAME.lonlat(walked(CORNERS, 8, 3))},
        {"blocks": (Block("a", ROUGH.boundary),)},
        {"in_rows": False},
    ],
)
def test_what_is_known_is_neither_guessed_nor_doubted(known):
    field = replace(ROUGH, **known)
    assert (guessed_bearing(field, USUAL), said(field)) == (None, [])
    assert guessed_bearing(ROUGH, PlantingChoices(row_bearing_deg=10.0)) is None


def test_a_file_of_a_walk_says_its_bearing_and_the_doubt(tmp_path):
    fixes = walked(CORNERS, 8, 2.5, seed=2)[:-1]
    sources = PlotSources(write_corners(tmp_path / "walk.csv", fixes))
    made = prepare(PlotRequest(sources, USUAL))
    bearing = made.plot.grid.frame.bearing_deg
    assert bearing % 180 == pytest.approx(86.4, abs=3)
    assert f"guessed: row bearing {bearing:.1f} degrees, along the longest side" in [
        str(one) for one in made.assumed
    ]
    doubts = [one.message.sentence for one in made.messages if "ragged" in one.message.sentence]
    assert len(doubts) == 1
    estate = prepare_estate(PlotRequest(sources, USUAL))
    assert doubts[0] in [one.message.sentence for one in estate.messages]
