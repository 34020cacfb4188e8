"""Every text of a report stands in one place, and is used."""

import re
from string import Formatter

import pytest

from app.words.language import for_reports
from fieldmon.compute.wording import worded
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


# what is said of an estimate ("1.0 plants"), of two or more, and of three or more
NEVER_ONE = {
    *(words.STANDS, words.FOUND_TWICE, words.HOT_MEANS, words.OF_INFESTED, words.OF_HIDDEN),
    words.MISSED_OF,  # a name
}
SAYS = r"\b1 (?!(?:is|stands|counts|antes|inspeccionadas)\b)"


@pytest.mark.parametrize(
    ("code", "many"), [("en", rf"{SAYS}[a-z]+s\b"), ("es", rf"{SAYS}[a-zíóá]+[aeo]s\b")]
)
def test_of_one_thing_no_text_speaks_as_of_many(code, many):
    said = []
    for text in of_texts(words.TEXTS.values()):
        blanks = {name for _, name, _, _ in Formatter().parse(text) if name}
        if blanks and text not in NEVER_ONE:
            one = worded(text, **dict.fromkeys(blanks, 1))
            said.append(str(for_reports(code).say(one)))
    assert len(said) > 40
    assert [one for one in said if re.search(many, one)] == []


def of_texts(texts):
    """Yield every text of a page, also those in tuples and dicts."""
    for text in texts:
        if isinstance(text, dict | tuple):
            yield from of_texts(text.values() if isinstance(text, dict) else text)
        else:
            yield text
