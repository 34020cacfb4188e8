"""Which species a file names, and what is said where they are mixed."""

from fieldmon.io.import_report import Severity
from fieldmon.io.readers.species import mixed_species, species_in


def test_no_species_and_nothing_known_are_none():
    assert species_in(["mite", "none", "n/a", "", "mite"]) == ["mite"]
    assert mixed_species("pest", ["mite", "none"]) == []


def test_each_of_several_species_can_be_chosen():
    (doubt,) = mixed_species("pest", ["thrips", "mite"])
    assert doubt.remedy.choices == ("pest=mite", "pest=thrips")


def test_one_pest_in_several_spellings_is_no_mixture_and_that_is_said():
    cells = ["spider mite", "Spider Mite", "spider mite", "spider_mites", "none"]
    (said,) = mixed_species("pest", cells)
    assert said.severity == Severity.GUESSED
    assert "Spider Mite, spider_mites and spider mite were taken for one pest" in said.sentence
    said, doubt = mixed_species("pest", [*cells, "thrips"])
    assert doubt.remedy.choices == ("pest=spider mite", "pest=thrips")
