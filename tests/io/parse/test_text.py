"""Text is read by the evidence of its bytes, whatever the file says about itself."""

import codecs

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import Severity
from fieldmon.io.parse.text import Decoder, decode, evidence

HEBREW = "חלקה צפונית ליד הבריכה"
FRENCH = "Forêt près de l'église"
words = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), max_size=40)


@given(words)
def test_utf8_comes_back_and_nothing_is_said(text):
    assert decode(text.encode()) == (text, [])


@pytest.mark.parametrize("codec", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_settles_it(codec):
    assert decode(HEBREW.encode(codec)) == (HEBREW, [])


@pytest.mark.parametrize(
    ("text", "codec"), [(HEBREW, "cp1255"), (HEBREW, "cp862"), (FRENCH, "cp1252")]
)
def test_text_of_other_times_is_known_by_its_letters_and_the_guess_is_told(text, codec):
    data = text.encode(codec)
    assert evidence([data]) == codec
    read, (said,) = decode(data)
    assert read == text
    assert (said.severity, said.remedy.option) == (Severity.GUESSED, "encoding")
    assert codec not in said.remedy.choices


def test_what_is_told_by_hand_goes_before_all_evidence():
    assert decode(HEBREW.encode("cp1255"), "cp1252")[0] != HEBREW
    assert decode(codecs.BOM_UTF8 + b"a", "cp1252")[0].endswith("a")


@pytest.mark.parametrize(
    ("encoding", "says"), [("utf-8", "readable as utf-8"), ("klingon", "Python knows")]
)
def test_an_encoding_that_cannot_be_is_a_question(encoding, says):
    with pytest.raises(ChoiceNeeded, match=says) as asked:
        decode(HEBREW.encode("cp1255"), encoding)
    assert asked.value.option == "encoding"
    assert "cp1255" in asked.value.choices


# --- all text of a shapefile --------------------------------------------------------------------


def samples(codec):
    return [part.encode(codec) for part in (*HEBREW.split(), "name", "7")]


@pytest.mark.parametrize("stated", [None, "UTF-8", "ISO 88591", "1252", "no such"])
@pytest.mark.parametrize("codec", ["utf-8", "cp1255", "cp862"])
def test_hebrew_is_read_whatever_the_cpg_says(codec, stated):
    decoder = Decoder(samples(codec), stated, None)
    assert [decoder(sample) for sample in samples(codec)[:4]] == HEBREW.split()[:4]


def test_a_cpg_that_lies_about_utf8_is_said():
    (said,) = Decoder(samples("utf-8"), "1252", None).messages
    assert said.severity == Severity.REPAIRED
    assert "cp1252" in said.sentence


def test_a_cpg_that_is_right_is_believed_without_a_word():
    decoder = Decoder(samples("cp1255"), "ANSI 1255", None)
    assert (decoder.encoding, decoder.messages) == ("cp1255", [])


def test_plain_letters_say_nothing_of_their_encoding():
    assert Decoder([b"abc"], None, None).encoding == "utf-8"
    assert Decoder([b"abc"], "1255", None).encoding == "cp1255"


def test_a_letter_cut_in_half_at_the_end_of_a_field_is_left_out():
    cut = HEBREW.encode()[:9]  # four letters and half of the fifth, or a blank in between
    assert HEBREW.startswith(Decoder([cut], "utf-8", None)(cut))


def test_an_encoding_told_by_hand_must_fit_every_field():
    assert (
        Decoder(samples("cp1255"), "utf-8", "cp1255")(samples("cp1255")[0])
        == HEBREW.split(maxsplit=1)[0]
    )
    with pytest.raises(ChoiceNeeded, match="readable as utf-8"):
        Decoder(samples("cp1255"), None, "utf-8")
