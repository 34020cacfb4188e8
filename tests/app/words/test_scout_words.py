"""The scout's page speaks every language of the app, with the same blanks."""

import json
import re

import pytest

from app.words import language
from app.words.scout_words import page_words
from tests.paths import ROOT


@pytest.mark.parametrize("name", [one for one in language.LANGUAGES if one != language.ENGLISH])
def test_every_text_is_said_with_the_same_blanks(name):
    english, said = json.loads(page_words("en")), json.loads(page_words(name))
    assert english.keys() == said.keys()
    blanks = lambda text: sorted(re.findall(r"\{\w+\}", text))  # noqa: E731
    assert [key for key in said if blanks(said[key]) != blanks(english[key])] == []
    same = [key for key in said if said[key] == english[key] and key != "who_says"]
    assert len(same) < 3


def test_it_knows_the_languages_by_their_names_and_which_are_read_from_the_right():
    script = (ROOT / "app" / "scout_page" / "src" / "words.js").read_text(encoding="utf-8")
    said = re.search(r"LANGUAGES = \{(.*?)\};\s*const RIGHT_TO_LEFT = \[(.*?)\];", script)
    assert dict(re.findall(r'(\w+): "([^"]+)"', said[1])) == language.LANGUAGES
    assert set(re.findall(r'"(\w+)"', said[2])) == language.RIGHT_TO_LEFT


def test_asking_changes_no_sessions_language():
    before = language.current()
    page_words("he")
    assert language.current() == before
