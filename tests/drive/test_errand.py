"""What is asked for and what is told."""

import numpy as np

from fieldmon.drive.errand import Errand, Visit
from fieldmon.monitoring.estimates.asked_day import PlantToInspect


def test_an_errand_says_itself_as_people_count():
    stop = PlantToInspect(7, 2, 3, (0.0, 0.0), 10.0, 40.0, 0.84)
    assert repr(Errand(1, stop, np.zeros((2, 2)))) == "<Errand 1: row 2, plant 3>"


def test_whoever_drives_looks_as_long_as_is_charged_without_the_stopping():
    stop = PlantToInspect(7, 2, 3, (0.0, 0.0), 10.0, 41.13, 0.84)
    assert round(Errand(1, stop, np.zeros((2, 2)), stop_s=1.13).look_s, 9) == 40.0
    assert Errand(1, stop, np.zeros((2, 2)), stop_s=50.0).look_s == 0.0


def test_a_visit_that_only_says_what_was_found_is_as_charged():
    stop, visit = PlantToInspect(7, 2, 3, (0.0, 0.0), 10.0, 40.0, 0.84), Visit(found=True)
    assert visit.done_at_s(stop) == stop.done_s == 50.0
    assert visit._replace(done_s=0.0).done_at_s(stop) == 0.0
    assert visit.done_s is None
    assert not visit.touched
    assert visit.stuck == ""
