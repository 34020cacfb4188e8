"""Every text of a report stands in one place, and is used."""

import re

from fieldmon.reports import words
from tests.paths import ROOT

NAMES = [name for name in vars(words) if name.isupper()]


def test_every_text_is_used():
    room = ROOT / "fieldmon" / "reports"
    code = "".join(path.read_text("utf-8") for path in room.glob("*.py") if path.name != "words.py")
    assert [name for name in NAMES if not re.search(rf"\bwords\.{name}\b", code)] == []


def test_a_name_set_apart_reads_right_inside_any_sentence():
    assert words.isolated("ענבים") == "\u2068ענבים\u2069"


def test_how_often_intervals_hold_is_said_without_a_number_that_ages():
    (said,) = (one for one in words.MEANINGS if "simulated" in one)
    assert re.findall(r"\d+", said) == ["90"]
