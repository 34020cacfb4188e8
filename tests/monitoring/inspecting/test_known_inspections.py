"""What a season knows already of inspections that are brought, and of those that it holds."""

import numpy as np

from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring.inspecting import known_inspections
from tests.monitoring.seasons import BEGINS


def told(plants, results, **more):
    return Inspections.of(plants, results, np.datetime64(BEGINS), **more)


def test_what_was_taken_back_is_new_again_but_was_recorded(season):
    now = told([1, 2], [CLEAN, FOUND])
    assert known_inspections.count_new(season, now) == 2
    assert known_inspections.count_never_recorded(season, now) == 2
    season.record(told([1], [CLEAN]), "x")
    season.record(told([2], [FOUND]), "y")
    season.undo()
    assert known_inspections.count_new(season, now) == 1
    assert known_inspections.count_never_recorded(season, now) == 0


def test_the_last_of_some_inspections_is_known_by_its_number_and_who_corrected_it(season):
    done = told([1, 2, 1], [CLEAN, CLEAN, FOUND], second=[100.0, 200.0, 300.0])
    season.record(done, "x", confirmed=True)
    number = known_inspections.number_of(season, season.inspections)
    assert number == max(one.number for one in season.numbered(plant=1))
    assert known_inspections.corrected_by(season) == {}
    season.record_instead(told([2], [FOUND], count=[3.0]), "me", "Ben")
    (who,) = known_inspections.corrected_by(season).values()
    assert who == "Ben"
