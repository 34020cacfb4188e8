"""All plots that can be opened, with their state."""

from datetime import timedelta

import numpy as np
import pytest

from app.state import estate, plot_source, seasons_folder
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from tests.app.driving import broken, opened
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def a_kept_season(seasons_folder):
    return a_season(seasons_folder / "Pond.gpkg")


@pytest.mark.usefixtures("session")
def test_before_anything_is_kept_the_sample_s_plots_are_there():
    found, problems = estate.plots(BEGINS)
    assert problems == []
    assert len(found) > 1
    assert {plot.source for plot in found} == {texts.SAMPLE}
    assert [plot.number for plot in found] == list(range(len(found)))
    assert {plot.expected for plot in found} == {None}, "nobody asked yet"


@pytest.mark.usefixtures("session")
def test_a_season_says_how_long_ago_it_was_seen_and_what_is_expected(a_kept_season):
    (plot,), _ = estate.plots(BEGINS)
    assert (plot.name, plot.source, plot.number) == ("Pond", "Pond", None)
    assert plot.days_since is None
    assert plot.expected == pytest.approx(a_kept_season.morning(BEGINS).sum(), rel=0.05)
    looked = Inspections.of(np.arange(5), np.zeros(5, np.int8), np.datetime64(BEGINS))
    a_kept_season.record(looked, "test")
    for days in (0, 4):
        (plot,), _ = estate.plots(BEGINS + timedelta(days=days))
        assert plot.days_since == days


@pytest.mark.usefixtures("session", "a_kept_season")
def test_a_season_that_cannot_be_opened_is_said_and_hides_no_other():
    broken(seasons_folder.path_of("Broken"))
    found, problems = estate.plots(BEGINS)
    assert [plot.name for plot in found] == ["Pond"]
    (said,) = problems
    assert said.startswith("Broken: ")
    assert "newer" in said


def test_a_plot_that_is_opened_is_the_one_that_is_planned():
    app = opened()
    app.session_state[plot_source.KEY] = texts.SAMPLE
    app.session_state["feature sample/paran_estate.zip"] = 1
    app.run()
    assert app.selectbox(key="feature sample/paran_estate.zip").value == 1
