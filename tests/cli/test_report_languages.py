"""Languages for paper: what is asked for counts, then what the season keeps, then English."""

import pytest

from fieldmon.cli.report_languages import checked_language, spoken
from fieldmon.errors import SettingError


@pytest.mark.parametrize(
    ("asked", "kept", "code"),
    [
        (None, "", "en"),
        (None, "he", "he"),
        ("es", "he", "es"),
        ("en", "he", "en"),
        (None, "of a later fieldmon", "en"),
    ],
)
def test_what_is_asked_for_counts_then_the_season_s_then_english(asked, kept, code):
    language, _ = spoken(asked, kept)
    assert language.code == code


def test_dates_and_areas_are_as_usual_where_a_language_is_spoken():
    _, units = spoken("he", "")
    assert units.day("2026-11-16") == "16.11.2026"
    assert units.square(1000.0) == "1.00 dunam"
    assert spoken(None, "")[1].day("2026-11-16") == "2026-11-16"


def test_a_language_nobody_translated_into_is_refused():
    assert checked_language(" HE ") == "he"
    with pytest.raises(SettingError, match="one of en, he, ar, es, but it is 'klingon'"):
        checked_language("klingon")
