"""Notes of several people on one thing become one note, and none is lost."""

import pytest

from fieldmon.io.parse.joined_notes import in_both, joined_notes, note_of, parts
from fieldmon.io.parse.result_words import says_gone


@pytest.mark.parametrize(
    ("notes", "joined"),
    [
        (["webs", "eggs"], "webs; eggs"),
        (["webs", "", "webs"], "webs"),
        (["webs; eggs", "eggs; mites"], "webs; eggs; mites"),
        (["", "eggs"], "eggs"),
        (["as;it was", "it was"], "as;it was"),
        (["locked", "gone: burnt"], "gone: locked; burnt"),
        (["locked", "Missing."], "locked; Missing."),
    ],
)
def test_each_part_is_kept_once(notes, joined):
    assert joined_notes(notes) == joined
    assert says_gone(joined) == any(map(says_gone, notes))


@pytest.mark.parametrize(
    ("one", "other", "both"),
    [
        ("webs", "eggs", "eggs; webs"),
        ("webs; eggs", "eggs", "webs; eggs"),
        ("b; a", "a; b", "b; a"),
        ("", "eggs", "eggs"),
        ("gone", "burnt", "gone: burnt"),
    ],
)
def test_of_two_copies_of_a_note_it_does_not_matter_which_is_named_first(one, other, both):
    assert in_both(one, other) == in_both(other, one) == both
    assert in_both(both, one) == in_both(both, other) == both


def test_parts_become_the_note_that_they_are_of():
    assert note_of(parts("gone: cut; burnt")) == "gone: cut; burnt"
    assert parts("Gone") == ["gone"]
    assert parts(" ; ") == []
