"""All plots with their state: of the seasons, else of the files at hand, else the sample's."""

from datetime import timedelta

import numpy as np
import pytest
import streamlit as st

from app.show import estate_map
from app.state import estate, menu, seasons_folder
from app.state.estate import PlotState
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.estimates.figures_of_day import day_figures, flagged
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.local_clock import local_clock
from tests.app.chosen import a_plot
from tests.app.driving import broken, go, map_of


def areas(app):
    areas, marks = map_of(app)["layers"]
    assert len({area["n"] for area in areas["data"]}) == len(marks["data"])
    return areas["data"]


def test_without_seasons_the_sample_estate_is_shown(app):
    go(app, "plots")
    assert not app.exception
    assert len(areas(app)) >= 9
    assert all("no season yet" in area["t"] for area in areas(app))


def test_a_season_says_when_it_was_seen_and_what_is_expected(season_app, season):
    today = local_clock(season().plot.field).today()
    go(season_app, "plots")
    (area,) = areas(season_app)
    assert "never seen" in area["t"]
    seen = np.datetime64(max(today - timedelta(days=4), season().settings.begins))
    n = len(season().plot.grid)
    for plants, said in (np.array([5]), "less than half a day done"), (np.arange(n // 2), "seen"):
        season().record(Inspections.of(plants, np.zeros(len(plants), int), seen), said)
        go(season_app, "plots")
        (area,) = areas(season_app)
        assert said in area["t"]
    days = (today - seen.item()).days
    assert (f"seen {days} days ago" if days else "seen today") in area["t"]
    left, _ = estate.plots()
    assert left[0].expected > 0
    assert left[0].is_begun


@pytest.mark.usefixtures("session")
def test_plants_that_were_only_flagged_are_infested_too(tmp_path, monkeypatch):
    monkeypatch.setenv(seasons_folder.FOLDER, str(tmp_path))
    here = a_plot()
    today = local_clock(here.field).today()
    flags = BeliefSettings(treated=False)
    settings = MonitoringSettings(today, belief=flags)
    kept = Season.create(tmp_path / "s.gpkg", here, Records.none(), settings)
    kept.record(Inspections.of(np.arange(20), np.ones(20, int), np.datetime64(today)))
    (left,), _ = estate.plots()
    not_found = day_figures(kept, today).expected
    assert left.expected == pytest.approx(not_found + flagged(kept, today))
    assert flagged(kept, today) > 10


def test_a_season_that_cannot_be_opened_is_said_and_hides_no_other(season_app):
    broken(seasons_folder.path_of("Broken"))
    go(season_app, "plots")
    assert not season_app.exception
    assert len(areas(season_app)) == 1
    (said,) = season_app.warning
    assert said.value.count("Broken") == 1, "its file's name says which it is"
    assert "newer" in said.value


def test_a_plot_is_opened_by_a_tap(app):
    plots, _ = estate.plots()
    pond = next(plot for plot in plots if plot.name == "Pond")
    told = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(st, "session_state", told)
        estate.open_plot(pond)
    for key, value in told.items():
        app.session_state[key] = value
    app.run()
    assert not app.exception
    assert map_of(app)["alt"].startswith("Map of plot Pond")


def test_states_tell_how_long_ago_a_plot_was_seen():
    made = {
        days: estate_map.state_of(PlotState("x", "x", None, None, days, 3.0))
        for days in (0, 2, 3, 6, 7, None)
    }
    assert made == {0: "fresh", 2: "fresh", 3: "due", 6: "due", 7: "late", None: "late"}
    assert estate_map.state_of(PlotState("x", "x", None)) == "new"


def test_every_part_of_a_plot_opens_it():
    plots, _ = estate.plots()
    assert menu.MENU["plots"].pages == ("plots",)
    content = estate_map.content(plots)
    areas, marks = content.layers
    for index, row in enumerate(areas.data):
        assert estate_map.plot_tapped(plots, index) is plots[row["n"]]
    assert estate_map.plot_tapped(plots, len(areas.data)) is None
    for index in range(len(marks.data)):
        assert estate_map.plot_tapped(plots, index, marks.id) is plots[index]
    assert estate_map.plot_tapped(plots, 0, "another") is None
