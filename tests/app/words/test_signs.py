"""Signs in texts of files lead nowhere, format nothing, and stay with their numbers."""

import pytest

from app.words import signs


@pytest.mark.parametrize("text", ["[a](b)", "![a](b)", "http://x.il", "www.x.il", "a@x.il"])
def test_what_leads_into_the_internet_is_parted_by_a_sign_that_nobody_sees(text):
    said = signs.leading_nowhere(text)
    assert said != text
    assert said.replace("\u2060", "") == text


def test_signs_that_turn_the_direction_are_left_out_where_they_must_not_turn():
    assert signs.leading_nowhere("a\u202eb", turning=False) == "ab"
    assert signs.leading_nowhere("a\u202eb") == "a\u202eb"


def test_each_sign_of_markdown_is_shown():
    assert signs.unformatted("*a* :red[b]") == r"\*a\* :" + "\u2060" + r"red\[b\]"


def test_no_line_ends_between_a_number_and_its_unit():
    assert signs.together("3 ha, 5 % of 2 rows") == "3\u00a0ha, 5\u00a0% of 2 rows"
