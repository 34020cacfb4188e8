"""One pest, however its name is written."""

import pytest

from fieldmon.io.parse.pest_names import pest_key, usual_spellings


@pytest.mark.parametrize(
    "alike",
    [("Spider Mite", "spider  mites", "spider-mite"), ("T. urticae", "T.Urticae"),
     ("Frankliniella occidentalis", "FRANKLINIELLA OCCIDENTALIS"),
     # a file of a Mac writes letter and tilde apart
     ("Araña", "arañas", "ARAN\u0303A", "arana"), ("araña roja", "Arañas Rojas", "aranas rojas"),
     ("Läuse", "LAUSE")],
)  # fmt: skip
def test_ways_of_writing_one_pest_have_one_key(alike):
    assert len({pest_key(name) for name in alike}) == 1


def test_other_pests_have_other_keys_and_latin_names_no_plural():
    assert pest_key("Tetranychus urticae") == "tetranychus urticae"
    assert len({pest_key(name) for name in ("Tetranychus", "mite", "moth", "aphis", "aphid")}) == 5


def test_the_spelling_that_is_most_often_written_is_taken():
    usual = usual_spellings(["Mite", "mite", "mite", "thrips"])
    assert usual == {"Mite": "mite", "mite": "mite", "thrips": "thrips"}
