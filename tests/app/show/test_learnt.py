"""What inspections tell of the insects, in words with intervals."""

from datetime import date
from types import SimpleNamespace

import pytest
import streamlit as st

from app.show import learnt
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.compute.wording import worded
from fieldmon.infestation.learnt import Learnt
from fieldmon.infestation.records import Records
from fieldmon.monitoring.estimates.told_detection import ToldOtherwise
from tests.app.driving import apart

DETECTION = Learnt("detection", 0.84, 0.71, 0.94)
ON = date(2026, 11, 2)
RECORDS = Records.of([[35.0, 30.0]], [1], "2024-06-03")


@pytest.fixture
def shown(monkeypatch):
    """Return what is shown of given estimates."""

    def show(*estimates, inspected=3, taught=None, said=()):
        lines = []
        monkeypatch.setattr(st, "markdown", lines.append)
        monkeypatch.setattr(st, "caption", lines.append)
        monkeypatch.setattr(learnt.chosen_day, "learnt", lambda _: estimates)
        progress = SimpleNamespace(inspected=inspected)
        monkeypatch.setattr(learnt.chosen_day, "progress", lambda _: progress)
        monkeypatch.setattr(learnt.chosen_day, "other_detections", lambda _: said)
        monkeypatch.setattr(learnt.chosen_day, "records_known", lambda _: RECORDS)
        monkeypatch.setattr(learnt, "earlier_season_note", lambda _: taught)
        units, on = UnitsInLanguage(), date(2026, 11, 16)
        learnt.show(SimpleNamespace(open_season=None, units=units, on=on))
        return apart("\n".join(lines[1:])).splitlines()

    return show


def test_it_is_the_sentence_that_the_status_prints(shown):
    estimates = DETECTION, Learnt("infested at the start", 306.04, 253.5, 1363.3)
    said = [f"- {one.sentence()}" for one in estimates]
    notes = f"{texts.LEARNT_COUNTS_FOR} {texts.LEARNT_INTERVALS}"
    assert shown(*estimates) == [apart(notes), *said]


def test_how_far_insects_jump_is_said_where_they_may(shown):
    length = Learnt("length of jumps", 3.4, 3.1, 3.8)
    for chance, lines in ((0.004, 1), (0.3, 2)):
        jumps = Learnt("jumps beyond neighbours", chance, chance, chance)
        assert len(shown(jumps, length)) == 1 + lines


def test_before_anything_was_inspected_it_is_said_to_be_believed_only(shown):
    for said in (
        texts.LEARNT_AT_FIRST,
        "Chances and hot spots begin with 1 record of Mon 3 Jun 2024.",
    ):
        assert said in shown(DETECTION, inspected=0)[0]
        assert said not in shown(DETECTION)[0]


def test_an_earlier_season_is_named(shown):
    assert shown(DETECTION, taught=worded("Begun with it."))[0].startswith("Begun with it. ")


def test_another_detection_that_was_said_with_inspections_is_shown_with_the_seasons_own(shown):
    said = [ToldOtherwise("Ben", 0.3, 0.84, ON, ON, 5), ToldOtherwise("", 0.6, 0.84, ON, ON, 1)]
    for estimates in ((DETECTION,), ()):
        *_, ben, nobody = shown(*estimates, said=said)
        assert ben.startswith("- Ben, ")
        assert ben.endswith(
            ": 5 inspections find 30 % of what is there, as was said with them; the season's own "
            "is 84 %."
        )
        assert nobody.startswith("- nobody named, ")
        assert ": 1 inspection finds 60 % of" in nobody


def test_a_season_that_traces_to_neighbours_only_says_so(shown):
    assert shown() == [texts.NOT_LEARNT]
