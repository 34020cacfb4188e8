"""Which words a finished sentence was made of is told by what stands around their blanks."""

import pytest

from app.words import language
from app.words.kept_sentences import KnownSentences, sentences
from fieldmon.compute.wording import KeptText, counted, share_figure, worded

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


def test_a_sentence_that_begins_with_a_blank_does_not_take_the_one_before_for_it(speaking):
    zones = counted(7, "zone")
    treat = worded(
        "Treat {area} in {zones}, {share} of the {of} under plants.",
        area="1 ha", zones=zones, share=share_figure(0.15), of="7 ha",
    )  # fmt: skip
    believed = worded(
        "{share:.1%} of the plants are believed infested. Treating pays if it is {level:.1%} or "
        "more; the chance of that is {chance:.0%}.", share=0.024, level=0.02, chance=0.95,
    )  # fmt: skip
    kept = KeptText(f"{treat} {believed}")
    speaking("es")
    assert "7 zonas" in language.in_words(treat)
    for code in ("es", "he", "ar"):
        speaking(code)
        both = " ".join(language.in_words(one) for one in (treat, believed))
        assert language.in_words(kept) == both
    speaking("es")
    both = " ".join(language.in_words(one) for one in (treat, believed))
    assert language.in_words(worded("{what}: {said}", what="x", said=kept)) == f"x: {both}"


@pytest.mark.parametrize(
    ("blank", "said"),
    [("26 m to 100 m", "26\u00a0m a 100\u00a0m"), ("0.8 m to 1.25 km", "0,8\u00a0m a 1,25\u00a0km"),
     ("26 m", "26\u00a0m"), ("Gate to Pond", "Gate to Pond")],
)  # fmt: skip
def test_distances_that_stood_in_a_blank_are_said_again(monkeypatch, blank, said):
    monkeypatch.setattr(language, "current", lambda: "es")
    kept = f"669 of 998 records lie outside Gate and were kept apart: {blank} away."
    assert f"a una distancia de {said}." in language.in_words(KeptText(kept))


def test_columns_that_an_earlier_version_named_with_and_are_listed(monkeypatch):
    monkeypatch.setattr(language, "current", lambda: "he")
    kept = KeptText("Positions were read from 'longitude' and 'latitude'.")
    assert "'longitude', 'latitude'" in language.in_words(kept)
