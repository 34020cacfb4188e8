"""A planting with rows several ways: each is drawn over the plants, and one is chosen."""

import numpy as np
import pytest

from app.actions import editing_plot, turning_rows
from fieldmon.plot.plot import plot_around
from fieldmon.plot.projection import Frame
from tests.app.chosen import a_plot, chosen
from tests.app.driving import go, layer, map_of, metric, press, row_box, upload

FRAME = Frame(35.15, 30.36, 20.0)


def planted(*, triangular=False):
    """Return the plants of ten rows of 24, in squares or in triangles of 3 m."""
    k, j = np.divmod(np.arange(240), 24)
    shift, apart = (0.5, np.sqrt(0.75)) if triangular else (0.0, 1.0)
    return FRAME.lonlat(3.0 * np.stack([j + shift * (k % 2), apart * k], axis=1))


def bearings(app):
    """Return the ways named on the buttons."""
    return [one.label.split(" · ")[1] for one in app.button if one.key.startswith("direction ")]


@pytest.fixture
def square(app):
    """Bring plants that stand in squares; return the session."""
    rows = "\n".join(f"{lon:.9f},{lat:.9f}" for lon, lat in planted())
    upload(app, plant=("trees.csv", f"lon,lat\n{rows}\n".encode(), "text/csv"))
    assert not app.exception
    return app


def test_both_ways_of_a_square_planting_are_drawn_and_the_one_chosen_is_kept(square):
    assert bearings(square) == ["20°", "110°"]
    assert metric(square, "Row direction") == "20.0°"
    assert len(layer(square, "direction-1")["data"]) == 10
    assert len(layer(square, "direction-2")["data"]) > 2 * 24, "its rows are broken lines"
    press(square, "2 · 110° · 24 rows, 3.0 m apart")
    assert metric(square, "Row direction") == "110.0°"
    assert row_box(square, "row_bearing").value == pytest.approx(110.0, abs=0.2)
    # what was, in its own colour, beside what is
    assert len(layer(square, "rows-before")["data"]) == 10
    assert layer(square, "direction-1") is None
    assert len(layer(square, "row-lines")["data"]) == 24
    go(square, "today")
    go(square, "plot")
    assert metric(square, "Row direction") == "110.0°", "it is kept from page to page"
    press(square, "Show every way again")
    assert metric(square, "Row direction") == "20.0°"
    assert len(layer(square, "direction-2")["data"]) > 2 * 24


def test_lines_buttons_legend_and_numbers_tell_ways_apart_alike(square):
    sent = map_of(square)
    drawn = [one for one in sent["layers"] if one["id"].startswith("direction-")]
    assert len({tuple(one["getColor"]) for one in drawn}) == 2
    labels = [one.label for one in square.button if one.key.startswith("direction ")]
    assert [one["data"][0]["t"] for one in drawn] == labels
    assert [words for _, _, words in sent["legend"][0]["items"]] == labels
    assert [one["t"] for one in sent["labels"][:2]] == ["1", "2"]


@pytest.mark.usefixtures("session")
def test_a_triangular_planting_has_three_ways_to_choose_from():
    choices = chosen(plot_around("trees", planted(triangular=True)))
    found = turning_rows.directions(choices)
    assert sorted(round(one.bearing_deg) for one in found) == [20, 80, 140]
    made, _ = editing_plot.content(choices, choices.records)
    ids = [one.id for one in made.layers if one.id.startswith("direction-")]
    assert ids == ["direction-1", "direction-2", "direction-3"]


@pytest.mark.usefixtures("session")
def test_where_there_is_one_way_only_or_plants_were_laid_nothing_is_asked():
    k, j = np.divmod(np.arange(200), 20)
    rows = FRAME.lonlat(np.stack([1.0 * j, 3.0 * k], axis=1))
    for plot in (a_plot(), plot_around("vines", rows)):
        assert turning_rows.directions(chosen(plot)) == ()
