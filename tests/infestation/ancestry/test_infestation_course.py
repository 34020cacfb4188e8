"""When infestations can be seen and send something out, by the morning on which they begin."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.infestation_course import BEFORE, Course
from fieldmon.pests.pest import Pest, Stage

EGG = Stage("egg", 5.0, 10.0, visible=False, mobile=False)
LARVA = Stage("larva", 5.0, 10.0, visible=True, mobile=False)


def nights(*warmth, stages=2):
    """Return nights of a day each, as warm for every stage."""
    return np.array([[1.0, *[each] * stages] for each in warmth])


def test_nobody_named_a_pest_all_send_at_once_and_may_hide():
    course = Course.that_may_hide(BEFORE + 6, np.array([0.4, 0.3, 0.2, 0.1]))
    assert not course.delays
    assert course.grown.tolist() == course.grown_by.tolist() == list(range(BEFORE + 6))
    # for 0, 2, 4 and 7 nights, but for what was there before the season; at most until now
    later = course.shows[:, BEFORE + 1 :] - BEFORE
    assert later.tolist() == [[1, 2, 3, 4, 5], [3, 4, 5, 5, 5], [5] * 5, [5] * 5]
    assert (course.shows[:, : BEFORE + 1] == np.arange(BEFORE + 1)).all()
    so_far = np.arange(12.0)[:, None]
    assert course.sending(so_far) is so_far


def test_a_pest_s_stages_say_it_by_how_warm_nights_were():
    """Eggs of 10 degree-days, larvae of 10 more: 5, 5, 10, 20 and 1 came."""
    course = Course.of_pest(Pest("mite", stages=(EGG, LARVA)), nights(5.0, 5.0, 10.0, 20.0, 1.0))
    assert course.delays
    shows, grown = course.shows[0] - BEFORE, course.grown - BEFORE
    # there before: grown; the first night's: eggs on mornings 1 and 2, as two nights bring 10
    assert shows[BEFORE:].tolist() == [0, 3, 3, 4, 5, 5]
    assert grown[BEFORE:].tolist() == [0, 4, 4, 5, 5, 5]
    assert (course.grown_by[BEFORE:] - BEFORE).tolist() == [0, 0, 0, 0, 2, 5]
    so_far = np.arange(12.0)[:, None]
    assert course.sending(so_far)[BEFORE + 3 :, 0].tolist() == [6.0, 8.0, 11.0]


@pytest.mark.parametrize("days", [2, 4])
def test_a_pest_s_days_say_it_where_it_has_no_stages(days):
    pest = Pest("rot", latency_days=days, hidden_days=1.0)
    course = Course.of_pest(pest, nights(*[0.0] * 5, stages=0))
    assert (course.shows[0, BEFORE + 1 :] - BEFORE).tolist() == [2, 3, 4, 5, 5]
    grown = [min(begins + days, 5) for begins in range(1, 6)]
    assert (course.grown[BEFORE + 1 :] - BEFORE).tolist() == grown
    assert repr(course) == "<Course of 12 mornings>"
