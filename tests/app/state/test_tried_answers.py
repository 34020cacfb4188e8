"""Each answer to a question about a plot's file is tried: what it leads to can be looked at."""

import re

import numpy as np
import pytest

from app.state import brought_files, tried_answers
from fieldmon.errors import ChoiceNeeded, PlotError
from tests.app.driving import layer, map_of, opened, square, texts_of, upload, zipped


def test_other_problems_have_no_answers_to_try(session):
    assert tried_answers.tried(None) == ()
    assert tried_answers.tried(PlotError("It must not be so.")) == ()
    assert tried_answers.tried(ChoiceNeeded("Which?", "crs", ("EPSG:4326",))) == ()
    assert session is not None


@pytest.fixture(scope="module")
def asked(tmp_path_factory):
    """Return a session that is asked for a coordinate system."""
    grid = square().to_crs("EPSG:2039")
    data = zipped(tmp_path_factory.mktemp("plot"), grid, without=".prj")
    app = opened()
    return upload(app, plot=("plot.zip", data))


def test_all_candidates_are_drawn_and_named_by_where_they_lie(asked):
    assert not asked.exception
    places = layer(asked, "answer-places")["data"]
    picks = [button for button in asked.button if button.key.startswith("pick ")]
    assert len(places) == len(picks) > 4
    assert "EPSG:2039" in picks[0].label
    assert "Israel" in picks[0].label
    lon, lat = places[0]["m"]
    assert (lon, lat) == pytest.approx((35.1505, 30.3605), abs=1e-3)
    assert map_of(asked)["taps"]
    assert layer(asked, "zones")["data"], "borders show where on earth"


def test_one_answer_leads_to_the_plot(asked):
    assert "Which of these is your plot" in texts_of(asked)
    pick = next(b for b in asked.button if b.key.startswith("pick ") and "EPSG:2039" in b.label)
    pick.click().run()
    assert not asked.exception
    assert re.match(r"Map of plot .*square", map_of(asked)["alt"])
    file = asked.session_state["brought"][brought_files.PLOT]
    assert asked.session_state[f"answers {file.asked}"] == (("crs", "EPSG:2039"),)


def test_answers_about_records_are_drawn_around_the_plot_and_say_how_many_lie_on_it(tmp_path):
    east, north = np.array(square().to_crs(2039).centroid[0].coords[0])
    lines = [f"{east + k};{north + k};2026-11-0{k + 1};{k % 2}" for k in range(4)]
    app = upload(opened(), plot=("plot.zip", zipped(tmp_path, square())))
    app.file_uploader(key="record_file").upload(
        "r.csv", "\n".join(["x;y;date;count", *lines]).encode()
    )
    app.run()
    assert not app.exception
    assert "are not used on this plot" in texts_of(app)
    pick = next(b for b in app.button if b.key.startswith("pick ") and "EPSG:2039" in b.label)
    assert "4 of 4 on the plot, 2 finds" in pick.label
    number = int(pick.label.split(" · ")[0]) - 1
    assert len(layer(app, f"answer-dots-{number}")["data"]) == 4
    assert layer(app, "boundary")
    assert map_of(app)["taps"]
    pick.click().run()
    assert not app.exception
    assert len(layer(app, "records")["data"]) == 4
    assert layer(app, f"answer-dots-{number}") is None
