"""Places of infestations, taken and free."""

import numpy as np

from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.infestations import Infestations
from fieldmon.infestation.cell_squares import NOBODY


def three(last):
    """Return one that was not found, one that was found and left, and one that was destroyed."""
    made = Infestations.empty(5)
    made.plant[:3], made.there[:3] = [4, 2, 6], True
    made.found[1:3], made.seen[:3] = True, [last, 1, 3]
    made.ends[:3] = [last, last, 3]
    return made


def test_what_was_not_found_or_was_left_goes_on_at_its_plant():
    assert three(5).places(8, 5).tolist() == [*[NOBODY] * 2, 1, NOBODY, 0, *[NOBODY] * 3]


def test_finds_are_told_by_when_they_were_seen_when_they_ended_and_where():
    seen, ends, plant = three(5).finds
    assert (seen.tolist(), ends.tolist(), plant.tolist()) == ([1, 3], [5, 3], [2, 6])
    assert repr(three(5)) == "<Infestations: 2 found, 1 not>"


def test_what_was_left_is_known_from_the_first_morning_on_and_has_room_beside_it():
    left = Infestations.left_on(np.arange(40))
    assert left.finds.plant.tolist() == list(range(40))
    assert (left.ends == BEFORE).all()
    assert len(Infestations.left_on(np.array([3])).plant) > 1
    assert not Infestations.left_on(np.array([3])).copied(2).there[1:].any()
