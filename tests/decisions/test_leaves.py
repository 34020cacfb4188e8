"""What leaves say, in a sentence."""

import pytest

from fieldmon.decisions.leaves import of_leaves
from fieldmon.decisions.thresholds import threshold_of
from fieldmon.errors import SettingError

ALMOND, MINT = threshold_of("almond"), threshold_of("peppermint")


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ((ALMOND, 40, 20), "treat (Iwao"),
        ((ALMOND, 40, 1), "do not treat"),
        ((ALMOND, 5, 1), "keep inspecting; after"),
        ((ALMOND, 0, 0), "look at"),
        ((MINT, 30, 600), "treat (Iwao"),
    ],
)
def test_the_sentence_has_the_verdict(asked, said):
    assert said in of_leaves(*asked)


@pytest.mark.parametrize(
    ("infested", "said"),
    [(49, "treat."), (2, "do not treat."), (35, "keep inspecting, or count the animals.")],
)
def test_presence_is_a_band_of_means_and_not_one(infested, said):
    sentence = of_leaves(MINT, 50, infested, presence=True)
    assert sentence.endswith(said)
    assert " to " in sentence


def test_more_infested_leaves_than_leaves_are_refused():
    with pytest.raises(SettingError, match="No more leaves can be infested"):
        of_leaves(ALMOND, 4, 5)
    with pytest.raises(SettingError, match="some must be infested and some clean"):
        of_leaves(MINT, 4, 4, presence=True)


@pytest.mark.parametrize(("asked", "presence"), [(ALMOND, False), (MINT, True)])
def test_a_part_of_a_leaf_is_no_infested_leaf(asked, presence):
    with pytest.raises(SettingError, match=r"must be a whole number, but 4\.5 of 25"):
        of_leaves(asked, 25, 4.5, presence=presence)
