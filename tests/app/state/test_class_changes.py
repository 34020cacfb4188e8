"""Changes lead from the morning's classes to the last ones, also where those came twice."""

import numpy as np

from app.state.class_changes import ClassChanges


def test_changes_lead_from_the_morning_to_the_last_and_what_came_late_takes_its_seconds_place():
    day = ClassChanges(np.array([0, 0, 1]))
    assert (day.so_far, day.last_s) == ([], 0.0)
    day.add(5.0, np.array([0, 2, 1]))
    day.add(9.0, np.array([1, 2, 1]))
    day.add(9.0, np.array([0, 2, 3]))
    day.add(12.0, np.array([0, 2, 3]))
    told = [(one.at_s, one.plants.tolist(), one.classes.tolist()) for one in day.so_far]
    assert told == [(5.0, [1], [2]), (9.0, [2], [3]), (12.0, [], [])]
    assert day.last_s == 12.0
