"""What to beware of after treatments is said in the page's words."""

from datetime import UTC, datetime, time, timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from app.show import cautions, day
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates import figures_of_day
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.treating.applications import Application
from tests.app.chosen import in_season
from tests.monitoring.inspecting.test_drafts import add
from tests.monitoring.seasons import BEGINS, a_season


class Shown:
    """Keeps what was shown instead of showing it."""

    def __init__(self):
        self.said = []

    def __getattr__(self, name):
        return lambda text: self.said.append((name, text))


@pytest.fixture
def shown(monkeypatch):
    kept = Shown()
    monkeypatch.setattr(cautions, "st", kept)
    return kept.said


def choices(season, on=BEGINS):
    units = UnitsInLanguage()
    of = {} if season is None else {"key": f"{season.path}", "revision": season.revision}
    return SimpleNamespace(season=season, open_season=season, on=on, day=f"{on}", units=units,
                           today=None, **of)  # fmt: skip


def test_nothing_is_shown_without_a_season_or_treatments(shown, tmp_path):
    cautions.show(choices(None))
    cautions.show_today(choices(None), None)
    season = a_season(tmp_path / "season.gpkg")
    cautions.show(choices(season))
    cautions.show_treatments(choices(season))
    assert shown == []
    season.treat(BEGINS, 0.5, product="soap")
    cautions.show_treatments(choices(season))
    assert ("markdown", f"**{texts.EFFECTS}**") in shown
    assert shown[-1] == ("caption", texts.EFFECTS_TREATED)


def test_a_finding_of_qgis_of_a_day_to_come_is_told_in_the_language_of_the_page(
    shown, tmp_path, monkeypatch, speaking
):
    noon = datetime(2026, 11, 5, 12, tzinfo=UTC)
    monkeypatch.setattr("fieldmon.plot.local_clock.utc_now", lambda: noon)
    season = a_season(tmp_path / "season.gpkg")
    season.record(Inspections.of([1], [1], np.datetime64(BEGINS)), "x")
    add(season.path, date="2026-11-06")
    speaking("he")
    cautions.show(choices(Season(season.path)))
    ((kind, said),) = shown
    assert kind == "warning"
    assert "2026-11-06" in said
    assert "has not come" not in said
    assert "[English]" not in said


def test_finds_that_are_found_again_are_said_with_where_the_setting_is(
    shown, tmp_path, monkeypatch
):
    season = a_season(tmp_path / "season.gpkg")
    for seen in np.datetime64(BEGINS) + np.arange(2):
        season.record(Inspections.of(np.arange(20), np.ones(20), seen), f"{seen}")
    cautions.show(choices(season))
    assert shown == []
    cautions.show(choices(season, BEGINS + timedelta(days=1)))
    ((_, said),) = shown
    assert said.startswith("20 of 20 plants found before were infested again ")
    assert said.endswith(f"say so: {texts.FINDS_FLAGGED_HOW}")
    named = texts.FINDS_ARE, texts.FINDS_TREATED[False], texts.ASSUMED_ALL
    assert all(f"*{one}*" in said for one in named)
    shown.clear()
    today = in_season(season, BEGINS + timedelta(days=1))
    cautions.show_today(today, today.plan())
    assert [words for _, words in shown if words == said] == [said]
    # worked out once for all clicks
    monkeypatch.setattr(figures_of_day, "found_again", None)
    cautions.show(today)


def test_no_day_of_harvest_is_shown_where_the_wait_of_a_later_treatment_was_not_said(
    shown, tmp_path
):
    season = a_season(tmp_path / "season.gpkg")
    season.treat(BEGINS, 0.5, application=Application("Oil", waiting_days=3))
    cautions.show_treatments(choices(season))
    assert shown[0][1].startswith("After the treatments so far, harvest is allowed from **")
    season.treat(BEGINS, 0.5, product="soap")
    shown.clear()
    cautions.show(choices(season))
    cautions.show_treatments(choices(season))
    (_, warned), *others = shown
    assert warned.startswith("- How long to wait from soap on ")
    assert not [words for _, words in others if "wait" in words]  # said once
    assert not [words for _, words in shown if "harvest is allowed from" in words]


def test_today_tells_what_is_left_off_and_that_a_kept_plan_leads_there(
    shown, tmp_path, monkeypatch
):
    season = a_season(tmp_path / "season.gpkg")
    given = season.plan(BEGINS).route.plant
    line = season.plant_numbers.line
    row = int(line[given[0]])
    waits = Application("soap", reentry_hours=24.0, ended=time(5))
    season.treat(BEGINS, 0.0, plants=line == row, application=waits)
    today = SimpleNamespace(
        **vars(choices(season)), plot=season.plot, whose_day=None,
        plan=lambda: season.plan(BEGINS, keep=False),
    )  # fmt: skip
    cautions.show_today(today, today.plan())
    (_, off), (_, entry) = shown
    first, second = off.splitlines()
    assert first.startswith("- Closed until 05:00 on")
    n = int((line[given] == row).sum())
    assert second == f"- {texts.KEPT_CLOSED.format(n=n)}"
    assert "Do not enter before 05:00" in entry
    season.treat(BEGINS, 0.0, application=waits)
    monkeypatch.setattr(day, "st", cautions.st)
    shown.clear()
    today.revision = season.revision
    day.say_of_day(today, today.plan())
    assert shown == []  # not that hours are too short
    cautions.show_today(today, today.plan())
    assert shown[0][1].endswith(texts.KEPT_ALL_CLOSED.format(n=len(given)))


def test_where_every_plant_is_flagged_today_says_so_and_not_that_hours_are_too_short(
    shown, tmp_path, monkeypatch
):
    season = a_season(tmp_path / "season.gpkg", belief=BeliefSettings(treated=False))
    every = np.arange(len(season.plot.grid))
    season.record(Inspections.of(every, np.ones(len(every), int), np.datetime64(BEGINS)), "x")
    monkeypatch.setattr(day, "st", cautions.st)
    tomorrow = in_season(season, BEGINS + timedelta(days=1))
    day.say_of_day(tomorrow, season.plan(tomorrow.on, keep=False))
    ((_, said),) = shown
    told = f"{len(every)} plants were found and only flagged."
    assert said.startswith(f"Every plant is known: {told}")


def test_today_tells_how_many_plants_are_left_out_as_nobody_could_inspect_them(shown, tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    seen = Inspections.of(np.arange(4), np.full(4, SKIPPED), np.datetime64(BEGINS))
    season.record(seen)
    for days, said in ((1, 1), (2, 0)):
        on = BEGINS + timedelta(days=days)
        today = SimpleNamespace(**vars(choices(season, on)), plot=season.plot, whose_day=None)
        plan = season.plan(on, keep=False)
        today.plan = lambda plan=plan: plan
        shown.clear()
        cautions.show_today(today, plan)
        told = "Left out of this plan: 4 plants that nobody could inspect last time."
        assert shown == [("caption", told)] * said
