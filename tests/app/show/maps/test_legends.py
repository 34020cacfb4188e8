"""Legends name every class with its colour."""

import re

from app.show.maps import colours, legends
from app.words import texts


def signs(html):
    """Return colour and text of each sign."""
    return re.findall(r"rgb(\(\d+, \d+, \d+\)).*?</svg>(.*?)</span>", html)


def test_every_class_of_chance_has_its_edges_and_its_colour():
    made = signs(legends.chance_legend())
    assert [colour for colour, _ in made] == [str(colour) for colour in colours.CHANCE_COLOURS]
    dark = signs(legends.chance_legend(dark=True))
    assert [colour for colour, _ in dark] == [str(colour) for colour in colours.CHANCE_IN_DARK]
    assert [text for _, text in dark] == [text for _, text in made]
    assert [text for _, text in made] == [
        "0-1 %", "1-2 %", "2-5 %", "5-10 %", "10-25 %", "25-50 %", "over 50 %"
    ]  # fmt: skip


def test_the_three_states_differ_by_shape_too():
    html = legends.state_legend(texts.LEGEND_STATES)
    assert [text for _, text in signs(html)] == ["found", "looked clean", "never inspected"]
    shapes = re.findall(r"<svg.*?>(.*?)</svg>", html)
    assert len({re.sub(r"\d+", "", shape) for shape in shapes}) == 3


def test_ages_are_whole_days_without_a_gap():
    texts_ = [text for _, text in signs(legends.age_legend("never", "{n} days"))]
    assert texts_ == ["0 days", "1-2 days", "3-6 days", "7-13 days", "14+ days", "never"]
