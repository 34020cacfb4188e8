"""Nouns for any number are said for the number that is there."""

from string import Formatter

import pytest

from app.words import catalogues, language
from app.words.counted_words import VERBS, in_numbers
from fieldmon.compute.wording import worded


@pytest.mark.parametrize(
    ("sentence", "said"),
    [
        ("3 record(s) lie on no plant.", "3 records lie on no plant."),
        ("1 record(s) lie on no plant.", "1 record lies on no plant."),
        ("1 of 998 record(s) lie outside Gate and were kept apart.",
         "1 of 998 records lies outside Gate and was kept apart."),
        ("2 closed line(s) were taken as outlines.", "2 closed lines were taken as outlines."),
        ("1 line(s) without a time were left out.", "1 line without a time was left out."),
        ("1 row(s) that lie on no plot were left out.", "1 row that lies on no plot was left out."),
        ("It holds 1 area(s) and 2 line(s).", "It holds 1 area and 2 lines."),
        ("Dates are in column(s) day.", "Dates are in column day."),
        ("Dates are in column(s) day, month.", "Dates are in columns day, month."),
        ("1,001 record(s) are of 1 other plot(s): A.", "1,001 records are of 1 other plot: A."),
    ],
)  # fmt: skip
def test_a_noun_and_its_verb_follow_the_number(sentence, said):
    assert in_numbers(sentence, "en") == said


def test_no_sentence_of_the_library_shows_a_noun_for_any_number():
    found = [one.words for one in catalogues.of_library() if "(s)" in one.words]
    assert len(found) > 50
    for words in found:
        blanks = [*Formatter().parse(words)]
        for count in ("1", "4"):
            filled = {name: "plot" if name == "what" else count for _, name, _, _ in blanks}
            said = "".join(
                literal + (filled[name] if name else "") for literal, name, _, _ in blanks
            )
            assert "(s)" not in in_numbers(said, "en")


def test_pages_say_it_so_and_commands_as_before(speaking):
    said = worded("{n} block(s) lie on none of the plots.", n=1)
    assert said == "1 block(s) lie on none of the plots."
    assert language.in_words(said) == "1 block lies on none of the plots."
    speaking("es")
    some = worded("{n} block(s) lie on none of the plots.", n=4)
    assert language.in_words(some) == "4 bloques no están en ninguna de las parcelas."


def test_verbs_of_one_differ_from_those_of_several():
    assert all(one != many and " " not in one for many, one in VERBS.items())
