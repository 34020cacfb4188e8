"""One pest, however its name is written."""

import pytest

from fieldmon.io.parse.pest_names import pest_key, usual_spellings


@pytest.mark.parametrize(
    "alike",
    [("Spider Mite", "spider  mites", "spider-mite"), ("T. urticae", "T.Urticae"),
     ("Frankliniella occidentalis", "FRANKLINIELLA OCCIDENTALIS"),
     # a file of a Mac writes letter and tilde apart
     ("Araña", "arañas", "ARAN\u0303A", "arana"), ("araña roja", "Arañas Rojas", "aranas rojas"),
     ("Läuse", "LAUSE", "Laus"), ("Tetranychus sp.", "Tetranychus spp.", "tetranychus spp"),
     ("l'araignée", "l\u2019araignée", "L\u00b4Araignées"), ("Spinnmilbe", "Spinnmilben"),
     ("pulgón", "Pulgones"), ("Rote Spinne", "rote Spinnen"), ("whitefly", "Whiteflies"),
     ("spintmijt", "spintmijten")],
)  # fmt: skip
def test_ways_of_writing_one_pest_have_one_key(alike):
    assert len({pest_key(name) for name in alike}) == 1


def test_other_pests_have_other_keys_and_latin_names_no_plural():
    assert pest_key("Tetranychus urticae") == "tetranychus urticae"
    others = (
        "Tetranychus", "Tetranychus sp. 1", "Tetranychus sp. 2", "Tetranychus ludeni",
        "Tetranychus urticae", "Thrips tabaci", "Thrips palmi", "thrips", "mite", "moth", "aphis",
        "aphid", "Liriomyza trifolii", "Liriomyza sativae", "Diaspis", "Scale", "bee", "Rost",
        "Frankliniella occidentalis", "Frankliniella tritici", "Eriophyes", "Eriophyidae",
    )  # fmt: skip
    assert len({pest_key(name) for name in others}) == len(others)


def test_the_spelling_that_is_most_often_written_is_taken():
    usual = usual_spellings(["Mite", "mite", "mite", "thrips"])
    assert usual == {"Mite": "mite", "mite": "mite", "thrips": "thrips"}
