"""Which words a finished sentence was made of is told by what stands around their blanks."""

import pytest

from app.words import language
from app.words.kept_sentences import KnownSentences, sentences
from fieldmon.compute.wording import worded

KNOWN = KnownSentences([
    "{n} record(s) lie on {name}.", "{n} record(s) lie on {name}, {far} away.", "{a}, {b}",
    "Rows {name} and {name} cross each other.", "{n} {n:time stands|times stand} twice.",
])  # fmt: skip


@pytest.mark.parametrize(
    ("sentence", "words", "blanks"),
    [
        ("12 record(s) lie on Gate.", "{n} record(s) lie on {name}.", {"n": "12", "name": "Gate"}),
        ("3 record(s) lie on A, 26 m away.", "{n} record(s) lie on {name}, {far} away.",
         {"n": "3", "name": "A", "far": "26 m"}),
        ("Rows 3 and 3 cross each other.", "Rows {name} and {name} cross each other.",
         {"name": "3"}),
        ("1 time stands twice.", "{n} {n:time stands|times stand} twice.", {"n": "1"}),
        ("4 time(s) stand twice.", "{n} {n:time stands|times stand} twice.", {"n": "4"}),
        ("20 times stand twice.", "{n} {n:time stands|times stand} twice.", {"n": "20"}),
    ],
)  # fmt: skip
def test_the_words_with_the_most_letters_are_those_of_a_sentence(sentence, words, blanks):
    assert KNOWN.told(sentence) == (words, blanks)


@pytest.mark.parametrize("sentence", ["one, two", "Rows 3 and 4 cross each other.", ""])
def test_what_only_looks_alike_is_not_known(sentence):
    assert KNOWN.told(sentence) is None


def test_a_number_with_a_point_ends_no_sentence():
    assert sentences("It is 4.5 m. Look!") == ["It is 4.5 m.", "Look!"]


def test_a_sentence_kept_as_text_is_said_as_the_one_it_was_made_of(speaking):
    said = worded("{n} {n:block lies|blocks lie} on none of the plots.", n=3)
    one = worded("{n} {n:block lies|blocks lie} on none of the plots.", n=1)
    also = worded("On {bare} of {n} plots no rows were drawn; straight ones are laid.", bare=1, n=4)
    speaking("es")
    assert language.in_words(str(said)) == language.in_words(said)
    assert language.in_words(str(one)) == language.in_words(one) != language.in_words(said)
    assert language.in_words("3 block(s) lie on none of the plots.") == language.in_words(said)
    both = language.in_words(f"{said} {also}")
    assert both == f"{language.in_words(said)} {language.in_words(also)}"
    assert language.in_words(f"{said} Nobody knows it.").endswith("[English]")
