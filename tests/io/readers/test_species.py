"""Which species a file names, and what is said where they are mixed."""

from fieldmon.io.readers.species import mixed_species, species_in


def test_no_species_and_nothing_known_are_none():
    assert species_in(["mite", "none", "n/a", "", "mite"]) == ["mite"]
    assert mixed_species("pest", ["mite", "none"]) == []


def test_each_of_several_species_can_be_chosen():
    (doubt,) = mixed_species("pest", ["thrips", "mite"])
    assert doubt.remedy.choices == ("pest=mite", "pest=thrips")
