"""What is known of one plant."""

import shutil
from dataclasses import replace
from datetime import time, timedelta

import numpy as np
import pytest
import streamlit as st

from app.show import plant_history
from app.show.map_view import MapContent
from app.state import chosen_day
from app.words import texts
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Application, Season
from fieldmon.plot.grid import plant_at, plant_numbers
from tests.app.chosen import a_plot, chosen, in_season
from tests.app.driving import apart
from tests.monitoring.seasons import BEGINS, a_season

PLANT = 17
SOAP = texts.isolated("Soap")


@pytest.fixture
def said(session, monkeypatch):  # noqa: ARG001 - said within it
    lines = []
    monkeypatch.setattr(st, "markdown", lines.append)
    monkeypatch.setattr(st, "caption", lambda _: None)
    monkeypatch.setattr(st, "number_input", boxed)
    monkeypatch.setattr(st, "text_input", boxed)
    return lines


def boxed(_label, _least=0, *, key, value):  # noqa: ARG001 - as Streamlit's
    return st.session_state[key]


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("history") / "s.gpkg")
    day = np.datetime64(BEGINS)
    for k, (result, second) in enumerate([(CLEAN, np.nan), (SKIPPED, 30_000.0), (FOUND, 36_060.0)]):
        season.record(Inspections.of(np.array([PLANT]), np.array([result]), day + k,
                                     second=np.array([second])), "test")  # fmt: skip
    return season


def tap(choices, plant):
    plant_history.take_plant(choices, "plants-chance", plant)


@pytest.mark.usefixtures("said")
def test_the_map_that_is_wanted_hears_taps_and_rings_the_plant(monkeypatch):
    wanted = []
    monkeypatch.setattr(plant_history.field_map, "want", lambda *what: wanted.append(what))
    choices = chosen(a_plot())
    content = MapContent("here", [0, 0, 1, 1], "a map", [])
    plant_history.want(choices, content)
    assert wanted[-1][0].layers == []
    wanted[-1][1].tapped("plants-state", PLANT)
    plant_history.want(choices, content)
    ring = wanted[-1][0].layers[-1].data[0]["p"]
    assert ring == pytest.approx(choices.plot.grid.lonlat()[PLANT].tolist(), abs=1e-6)
    assert content.layers == [], "what is kept for all is not changed"


@pytest.mark.usefixtures("said")
def test_nothing_is_told_before_a_plant_is_tapped(said):
    choices = chosen(a_plot())
    plant_history.show_chosen(choices)
    assert said == []
    tap(choices, PLANT)
    plant_history.show_chosen(choices)
    assert said


def test_a_plant_that_is_gone_is_said_to_be_so_once_with_what_else_was_noted(said, tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    for plant, note, words in ((PLANT, "gone", "**gone** · "), (18, "gone: burnt", "burnt")):
        one = Inspections.of([plant], [SKIPPED], np.datetime64(BEGINS), notes=[note], who=["Ann"])
        season.record(one, "test")
        choices = in_season(season, BEGINS)
        tap(choices, plant)
        plant_history.show_chosen(choices)
        assert said[-1].count("gone") == 1
        assert words in said[-1]
        assert "Ann" in said[-1]


def test_every_inspection_of_the_plant_is_told_in_order_with_its_time_if_it_has_one(said, season):
    choices = in_season(season, BEGINS)
    tap(choices, PLANT)
    plant_history.show(choices)
    days = ["Mon 6 Apr", "Tue 7 Apr", "Wed 8 Apr"]
    assert said[-1].splitlines() == [
        f"- {days[0]}: **clean**",
        f"- {days[1]} 08:20: **could not inspect**",
        f"- {days[2]} 10:01: **found**",
    ]
    now, first = (chance[PLANT] for chance in (chosen_day.chance(choices), season.morning(BEGINS)))
    assert f"{100 * now:.1f} %" in apart(said[1])
    assert f"{100 * first:.1f} %" in apart(said[1])


def test_treatments_stand_among_the_inspections_of_the_plant(said, season, tmp_path):
    copy = Season(shutil.copy(season.path, tmp_path))
    soap = Application("Soap", began=time(10), ended=time(10, 30))
    n = np.arange(len(copy.plot.grid))
    copy.treat(BEGINS + timedelta(days=2), 0.8, application=soap)
    copy.treat(BEGINS + timedelta(days=1), 0.8, plants=n == PLANT)
    copy.treat(BEGINS + timedelta(days=1), 0.8, plants=n == PLANT + 1)
    choices = in_season(copy, BEGINS)
    tap(choices, PLANT)
    plant_history.show(choices)
    found_at_10_01, lines = 2, apart(said[-1]).splitlines()
    assert lines[found_at_10_01 + 1 :] == [
        "- Wed 8 Apr 10:01: **found**",
        f"- Wed 8 Apr 10:30: **treated with {SOAP}**",
    ]
    assert lines[found_at_10_01] == "- Tue 7 Apr: **treated**"
    assert len(lines) == 5
    tap(choices, PLANT + 1)
    plant_history.show(choices)
    assert apart(said[-1]).splitlines() == [
        "- Tue 7 Apr: **treated**",
        f"- Wed 8 Apr 10:30: **treated with {SOAP}**",
        "Never inspected.",
    ]


def test_a_chance_of_nothing_after_a_find_is_explained(said, season, monkeypatch):
    why = []
    monkeypatch.setattr(st, "caption", why.append)
    for day, explained in ((0, False), (1, False), (2, True)):
        choices = in_season(season, BEGINS + timedelta(days=day))
        tap(choices, PLANT)
        plant_history.show(choices)
        assert (texts.HISTORY_TREATED in why) == explained
    assert any("**under 0.1 %**" in apart(line) for line in said[-5:])
    why.clear()
    tap(choices, PLANT + 1)
    plant_history.show(choices)
    assert texts.HISTORY_TREATED not in why


def test_a_line_of_a_box_is_the_same_facts_without_the_marks_of_a_list(said, season):
    choices = in_season(season, BEGINS)
    tap(choices, PLANT)
    plant_history.show(choices)
    plain = plant_history.line_of(choices, BEGINS + timedelta(days=2), 36_060.0, "found")
    assert "*" not in plain
    when, _, result = plain.rpartition(" ")
    assert f"- {when} **{result}**" in said[-1].splitlines()


def test_a_plant_never_inspected_says_so(said, season):
    choices = in_season(season, BEGINS)
    tap(choices, PLANT + 1)
    plant_history.show(choices)
    assert said[-1] == "Never inspected."
    plot = a_plot()
    tap(chosen(plot), PLANT)
    plant_history.show(chosen(plot))
    assert said[-1] == "Never inspected."


@pytest.mark.usefixtures("said")
def test_the_plant_tapped_is_ringed_and_what_is_no_plant_changes_nothing():
    plot = a_plot()
    choices = chosen(plot)
    tap(choices, PLANT)
    plant_history.take_plant(choices, "hot", 3)
    rings = plant_history.layers(choices)
    assert rings[0].data[0]["p"] == pytest.approx(plot.grid.lonlat()[PLANT].tolist(), abs=1e-6)
    numbered = plant_numbers(plot.grid, np.array([PLANT]))
    assert st.session_state["history row"] == numbered.line[0]
    st.session_state["history row"] = 9999
    assert plant_history.layers(choices) == []


def test_what_is_shown_first_is_a_plant_also_where_rows_and_plants_have_numbers_of_their_file(said):
    plot = a_plot()
    called = np.arange(len(plot.grid.line_number))[::-1] + 101
    grid = replace(
        plot.grid, line_called=np.stack([called, called], axis=1),
        plant_called=plant_numbers(plot.grid).number * 5,
    )  # fmt: skip
    plant_history.show(chosen(replace(plot, aisles=replace(plot.aisles, grid=grid))))
    assert said[-1] == "Never inspected."
    assert (st.session_state["history row"], st.session_state["history plant"]) == (101, 5)


@pytest.mark.usefixtures("said")
def test_the_plant_shown_may_be_typed_by_the_name_of_its_row():
    plot = a_plot()
    called = np.arange(len(plot.grid.line_number)) + 1
    called[2] = 101
    names = np.where(called > 100, "5A", called.astype(np.str_))
    grid = replace(plot.grid, line_called=np.stack([called, called], axis=1), line_named=names)
    choices = chosen(replace(plot, aisles=replace(plot.aisles, grid=grid)))
    tap(choices, plant_at(grid, 101, 2))
    assert plant_history.tapped(choices) == (plant_at(grid, 101, 2),)
    st.session_state["history row called"] = "5a"
    assert plant_history.tapped(choices) == (plant_at(grid, 101, 2),)
    st.session_state["history row called"] = "Top"
    assert plant_history.tapped(choices) == ()


def test_a_row_typed_that_may_be_another_by_its_name_is_refused_unless_its_plant_was_tapped(
    said, season_named
):
    choices = in_season(season_named, season_named.settings.begins)
    grid = season_named.plot.grid
    tap(choices, plant_at(grid, 2, 5))
    plant_history.show(choices)
    assert said[-1] == "Never inspected."
    st.session_state["history plant"] = 6
    with pytest.raises(SettingError, match="2 may be any of rows 2–3 here"):
        plant_history.show(choices)
    st.session_state["history row called"], st.session_state["history plant"] = "5A", 4
    with pytest.raises(SettingError, match="4 may be any of plants 3–4 of row 1 · 5a here"):
        plant_history.show(choices)


def test_what_was_counted_and_noted_and_by_whom_stands_with_each_inspection(said, season, tmp_path):
    copy = Season(shutil.copy(season.path, tmp_path))
    day = np.datetime64(BEGINS)
    for who, note in (("Ada", "webs"), ("נועה", "two\n**lines** of <b>https://x.y</b> :home:")):
        copy.record(
            Inspections.of(
                np.array([PLANT]), np.array([FOUND]), day + 4, count=np.array([3.0]),
                who=np.array([who], object), notes=np.array([note], object),
            )
        )  # fmt: skip
    choices = in_season(copy, BEGINS)
    tap(choices, PLANT)
    plant_history.show(choices)
    note = r"webs; two \*\*lines\*\* of \<b\>https:|//x.y\</b\> :|home: (נועה)".replace(
        "|", "\u2060"
    )
    assert said[-1].splitlines()[-1] == (
        f"- Fri 10 Apr: **found, count 3** · \u2068{note}\u2069 · \u2068Ada\u2069"
    )
