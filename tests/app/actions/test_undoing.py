"""What was recorded is undone, and counts again."""

from datetime import date

import numpy as np

from app.words import texts
from fieldmon.infestation.inspections import Inspections
from tests.app.driving import go, press


def test_what_is_of_another_person_or_day_is_undone_after_a_question(season_app, season):
    for n, who, day, why in (
        (0, "Dana", 16, "Dana"), (2, "", 17, "17 Nov, and this page is about")
    ):  # fmt: skip
        phones = Inspections.of([n + 3, n + 4], [0, 1], date(2026, 11, day))
        season().record(phones, "phone", who)
        go(season_app, "record")
        press(season_app, "Undo")
        assert len(season().history.inspections) == n + 2
        assert why in season_app.warning[-1].value.replace("\u2068", "").replace("\u2069", "")
    press(season_app, "Leave it")
    press(season_app, "Undo")
    press(season_app, "Take it back")
    assert len(season().history.inspections) == 2
    press(season_app, "Redo")
    assert len(season().history.inspections) == 4


def test_what_was_recorded_long_ago_can_be_shown_and_undone(season_app, season):
    typed = [(Inspections.of([k], [0], date(2026, 11, 16)), "typed in") for k in range(22)]
    season().record_all(typed)
    go(season_app, "record")
    assert not [one for one in season_app.button if one.key == "undo 2"]
    press(season_app, "Show 2 more")
    season_app.button(key="undo 2").click().run()
    assert len(season().history.inspections) == 21


def test_what_was_taken_back_in_another_window_is_said_without_words_of_commands(
    season_app, season
):
    plants = np.arange(3)
    season().record(Inspections.of(plants, np.ones(3, int), np.datetime64("2026-11-16")), "file")
    go(season_app, "record")
    (undo,) = [one for one in season_app.button if one.label == "Undo"]
    season().undo()
    undo.click().run()
    assert season_app.error[0].value == texts.UNDONE_BEFORE
