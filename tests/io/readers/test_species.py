"""Which pest a file names, and what is asked where it names several."""

import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import Severity
from fieldmon.io.readers.species import one_pest


def test_no_species_and_nothing_known_are_none_and_a_kind_of_visit_is_no_pest():
    cells = ["mite", "none", "n/a", "", "mite", "2.0", "Nachkontrolle"]
    assert one_pest("pest", cells) == ({"mite": "mite"}, [])


def test_of_several_species_each_can_be_chosen():
    with pytest.raises(ChoiceNeeded) as asked:
        one_pest("pest", ["thrips", "mite"])
    assert (asked.value.option, asked.value.choices) == ("where", ("pest=mite", "pest=thrips"))


def test_one_pest_in_several_spellings_is_one_and_that_is_said():
    cells = ["spider mite", "Spider Mite", "spider mite", "spider_mites", "none"]
    usual, (said,) = one_pest("pest", cells)
    assert said.severity == Severity.GUESSED
    assert "Spider Mite, spider_mites and spider mite were taken for one pest" in said.sentence
    assert {*usual.values()} == {"spider mite"}
    with pytest.raises(ChoiceNeeded) as asked:
        one_pest("pest", [*cells, "thrips"])
    assert asked.value.choices == ("pest=spider mite", "pest=thrips")
