"""Every text of the app: used somewhere, and whole when its blanks are filled."""

import re
import string

import pytest

from app.words import texts
from app.words.language import LANGUAGES
from tests.paths import ROOT

NAMES = [name for name in vars(texts) if name.isupper()]
USED = "\n".join(
    path.read_text(encoding="utf-8") for path in (ROOT / "app").rglob("*.py")
    if path.name != "texts.py"
)  # fmt: skip


def sentences(value):
    """Yield the texts within a constant."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for one in value.values():
            yield from sentences(one)
    elif isinstance(value, tuple):
        for one in value:
            yield from sentences(one)


def test_every_text_is_shown_somewhere():
    used = set(re.findall(r"\btexts\.([A-Z_]+)\b", USED))
    within = (ROOT / "app" / "words" / "texts.py").read_text(encoding="utf-8")
    idle = [name for name in NAMES if name not in used]
    assert [name for name in idle if len(re.findall(rf"\b{name}\b", within)) < 2] == []


def test_blanks_of_a_text_have_names():
    for name in NAMES:
        for text in sentences(getattr(texts, name)):
            blanks = [field for _, field, _, _ in string.Formatter().parse(text)]
            assert "" not in blanks, name


@pytest.mark.parametrize(
    "word", [r"ways? of working", r"\blooks?\b(?!ed)", r"\barms?\b", "DayPlan"]
)
def test_words_that_mean_something_else_elsewhere_are_not_used(word):
    shown = [text for name in NAMES for text in sentences(getattr(texts, name))]
    assert [text for text in shown if re.search(word, text) and text != "Please look"] == []


def test_a_name_of_any_script_keeps_to_itself():
    assert texts.isolated("מטע") == "\u2068מטע\u2069"


@pytest.mark.parametrize("code", LANGUAGES)
def test_the_tabs_of_recording_fit_into_the_panel(speaking, code):
    """As many letters as stand side by side in 360 pixels: what does not fit is cut."""
    speaking(code)
    tabs = texts.RECORD_ONE, texts.RECORD_ROUTE, texts.RECORD_UPLOAD, texts.TREAT
    assert sum(map(len, tabs)) <= 50
