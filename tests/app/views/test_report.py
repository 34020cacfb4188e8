"""The report on its page."""

from dataclasses import replace
from datetime import date

import numpy as np

from app.show import report
from app.show.report import html
from fieldmon.infestation.inspections import Inspections
from tests.app.driving import go, texts_of
from tests.pages import Page


def test_the_report_holds_map_figures_settings_and_stops(app):
    go(app, "report")
    assert not app.exception
    assert "Save as PDF" in texts_of(app)
    assert app.get("download_button")


def test_after_the_work_the_report_is_about_what_was_done(season_app, season, monkeypatch):
    pages = []
    monkeypatch.setattr(report, "html", lambda *facts: pages.append(html(*facts)) or pages[-1])
    project, settings = season(), season().settings
    project.change(replace(settings, robot=settings.robot.with_hours(0.5)), settings)
    plants = project.plan(settings.begins, keep=False).route.plant
    project.record(Inspections.of(plants, np.arange(len(plants)) % 2, settings.begins), "route")
    go(season_app, "report")
    assert not season_app.exception
    figures = Page(pages[-1]).tables[0]
    assert figures[0][1].startswith(f"{len(plants)} / ")
    assert figures[1] != ["Hours", "0.0 h"]
    assert figures[3] == ["Found that day", str(len(plants) // 2)]


def test_the_season_says_why_days_sum_to_more_than_the_plants_found(season_app, season):
    for day in (0, 1):
        on = np.datetime64("2026-11-16") + day
        season().record(Inspections.of(np.arange(3), np.ones(3, int), on), f"day {day}")
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 17)).run()
    go(season_app, "season")
    assert "6 finds on 3 plants: 3 of them on plants that had been found" in texts_of(season_app)
