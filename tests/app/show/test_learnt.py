"""What inspections tell of the insects, in words with intervals."""

import pytest
import streamlit as st

from app.show import learnt
from app.words import texts
from fieldmon.infestation.learnt import Learnt
from tests.app.driving import apart


@pytest.fixture
def shown(monkeypatch):
    """Return what is shown of given estimates."""

    def show(*estimates):
        lines = []
        monkeypatch.setattr(st, "markdown", lines.append)
        monkeypatch.setattr(st, "caption", lines.append)
        monkeypatch.setattr(learnt.chosen_day, "learnt", lambda _: estimates)
        learnt.show(None)
        return apart("\n".join(lines[1:])).splitlines()

    return show


def test_shares_are_in_percent_and_plants_are_numbers(shown):
    detection, *others = shown(
        Learnt("detection", 0.84, 0.71, 0.94),
        Learnt("arrivals a night", 1.24, 0.3, 4.0),
        Learnt("infested at the start", 306.04, 253.5, 1363.3),
    )
    assert detection.startswith(
        "- An inspection finds 84 % of what is there (71 % to 94 %). Chances"
    )
    assert others == [
        "- 1.2 plants a night are infested from outside (0.3 to 4.0).",
        "- 306 plants were infested at the start (254 to 1,363).",
    ]


def test_how_far_insects_jump_is_said_where_they_may(shown):
    length = Learnt("length of jumps", 3.4, 3.1, 3.8)
    for chance, lines in ((0.004, 1), (0.3, 2)):
        assert (
            len(shown(Learnt("jumps beyond neighbours", chance, chance, chance), length)) == lines
        )


def test_a_season_that_traces_to_neighbours_only_says_so(shown):
    assert shown() == [texts.NOT_LEARNT]
