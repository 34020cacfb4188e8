"""Who has which aisle as a team's day goes."""

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.independent import IndependentPlants
from fieldmon.planning.members import Teamwork
from fieldmon.planning.sections import even_sections
from fieldmon.planning.team_news import TeamNews
from fieldmon.planning.team_sections import TeamSections
from fieldmon.planning.team_worker import Posted, TeamWorker
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.base import NEVER, Scene

AISLES = Aisles.of(rectangle(12, 16))
GRID = AISLES.grid
N = len(GRID)
EVEN = even_sections(GRID, np.ones(2))


def sections(chance, teamwork=None, *, by_worth=True, learn=None):
    """Return the sections of two whose days begin, and the two."""
    robot = Robot(hours=0.5)
    scene = Scene(AISLES, robot, chance, np.full(N, NEVER, np.int32), seconds_left=robot.day_s)
    workers = [TeamWorker.of(k, Posted(scene, 0.0, np.zeros(N, bool))) for k in range(2)]
    news = TeamNews(workers, learn or belief(chance))
    return TeamSections(workers, teamwork or Teamwork(), news, by_worth=by_worth), workers


def belief(chance):
    return lambda plants, found, detects: IndependentPlants(GRID, chance).learn(
        plants, found, Learning(detects)
    )


def uneven():
    """Return chances that are high in the first four of twelve aisles."""
    return np.where(GRID.row < 4, 0.5, 0.001)


def test_aisles_are_given_out_evenly_where_what_they_hold_does_not_count():
    made, _ = sections(uneven(), by_worth=False)
    made.begin(None)
    assert (made.owner == EVEN).all()


def test_aisles_are_given_out_by_what_they_hold():
    made, _ = sections(uneven())
    made.begin(None)
    assert set(made.owner[:4].tolist()) == {0, 1} != set(EVEN[:4].tolist())


@pytest.mark.parametrize(("least", "stays"), [(0.0, False), (1e9, True)])
def test_what_is_given_out_stays_unless_another_way_gains_enough(least, stays):
    made, _ = sections(uneven(), Teamwork(least_gain=least))
    before = np.zeros_like(EVEN)
    made.begin(before)
    assert (made.owner == before).all() == stays


def test_who_is_in_an_aisle_keeps_it():
    for k, aisle in ((0, 0), (1, 0), (0, len(EVEN) - 1), (1, len(EVEN) - 1)):
        for by_worth in (False, True):
            made, workers = sections(uneven(), by_worth=by_worth)
            workers[k].claims = aisle
            made.begin(1 - np.full_like(EVEN, k))
            assert made.owner[aisle] == k


def test_aisles_are_shared_out_anew_for_those_who_are_still_at_work():
    made, workers = sections(uneven())
    made.begin(None)
    assert made.share_anew(0.0) == []
    workers[0].over = True
    assert made.share_anew(1.0) == [0, 1]
    assert (made.owner[:4] == 1).all()
    assert made.share_anew(1.0) == []
