"""Numbers are written, and blanks filled, as each language does."""

import pytest

from app.words.blanks import filled, number_in, separated


@pytest.mark.parametrize(
    ("code", "number", "share"),
    [("en", "1,234.5", "12 %"), ("es", "1.234,5", "12 %"), ("he", "1,234.5", "12%")],
)
def test_numbers_have_the_signs_of_their_language(code, number, share):
    assert number_in(1234.5, ",.1f", code) == separated("1,234.5", code) == number
    said = filled("{n:,.1f}, {share:.0%}", code, (), {"n": 1234.5, "share": 0.12})
    assert said == f"{number}, {share}".replace(" %", "\u00a0%")


def test_words_chosen_by_a_number_are_chosen_in_each_language():
    assert [filled("{n:it|them}", "es", (), {"n": n}) for n in (1, 2)] == ["it", "them"]
