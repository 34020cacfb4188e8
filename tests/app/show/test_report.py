"""The report of what is chosen: the library's, of the plot or the season that is open."""

from datetime import timedelta

import numpy as np
import pytest

from app.show import report
from app.state import chosen_day, widget_memory
from app.state.choices import WHOSE_DAY
from fieldmon.compute.units import Units
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot
from fieldmon.reports.content import KeyFigures
from fieldmon.reports.day import DayFacts, day_of_each, day_report
from fieldmon.reports.html import html_text
from fieldmon.reports.season import season_report
from tests.app.chosen import a_plot, chosen, in_season, records_at
from tests.monitoring.seasons import BEGINS, a_season, some_results
from tests.reports.reading import one, table


def test_a_plot_without_a_season_has_a_day_s_report():
    plot = a_plot()
    choices = chosen(plot, records_at(plot, [5, 6, 7], [1, 1, 1]))
    made = report.of_day(choices)
    route = chosen_day.route(choices).route
    figures = {each.label: each.value for each in one(made, KeyFigures).figures}
    assert figures["Plants to inspect"] == f"{len(route):,}"
    assert made.on == choices.on
    assert "Plants found are" not in {row[0] for row in table(made, "Settings").rows}


def test_in_a_season_app_and_command_write_the_same(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    season.record(some_results(season, 6, found=[2]))
    for day in (BEGINS, BEGINS + timedelta(days=1)):
        choices = in_season(season, day)
        own = day_report(DayFacts.of_season(season, day), Units())
        assert html_text(report.of_day(choices)) == html_text(own)
        whole = season_report(season, day, Units())
        assert html_text(report.of_season(choices)) == html_text(whole)


def test_a_day_that_was_worked_is_reported_as_worked(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    season.record(some_results(season, 6, found=[2]))
    season.plan(BEGINS + timedelta(days=2))
    made = report.of_day(in_season(season, BEGINS))
    plants = season.history.on(0).plant
    rows = table(made, "Stops by row, in order").rows
    assert sum(int(row[2]) for row in rows) == len(plants) == 6
    assert len(table(made, "Found that day, by row").rows) == 1


def test_what_is_recorded_is_in_the_next_report(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    before = report.of_season(in_season(season, BEGINS))
    assert len(table(before, "What was recorded").rows) == 1  # what was brought
    season.record(some_results(season, 6, found=[2]))
    after = report.of_season(in_season(season, BEGINS))
    assert np.array(table(after, "What was recorded").rows).shape == (2, 5)


@pytest.mark.usefixtures("session")
def test_a_team_s_day_has_a_page_of_each_or_that_of_the_one_who_is_chosen(tmp_path):
    team = tuple(TeamMember(name, Robot(hours=0.5)) for name in ("Ann", "Ben"))
    season = a_season(tmp_path / "s.gpkg", team=team)
    choices = in_season(season, BEGINS)
    each = day_of_each(DayFacts.each_of_season(season, BEGINS), Units())
    assert len(each.sheets) == 2
    for made in (report.of_day(choices), report.to_come(choices)()):
        assert html_text(made) == html_text(each)
    widget_memory.put(report.EACH, new=False)
    widget_memory.put(WHOSE_DAY, "Ben")
    for made in (report.of_day(choices), report.to_come(choices)()):
        assert [sheet.heading for sheet in made.sheets] == ["The day's work: \u2068Ben\u2069"]
