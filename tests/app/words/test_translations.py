"""A language's texts are those of its file, and nothing is said of what it has no words for."""

from app.words.language import LIBRARY
from app.words.translations import catalogue_of


def test_texts_of_a_file_are_read_and_unknown_ones_are_empty():
    held = catalogue_of("he")
    assert held.pgettext("MENU.today", "Today") == "היום"
    assert held.pgettext("MENU.today", "No such text") == ""
    assert held.npgettext(LIBRARY, "no such thing", "no such things", 2) == ""
    assert "היום" in held.words()
    assert "Today" in held.words_in("MENU.today")
