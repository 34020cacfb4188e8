"""Who has which aisle as a team's day goes."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.planning.members import Teamwork
from fieldmon.planning.sections import aisle_heights, even_sections
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


@pytest.mark.parametrize("by_worth", [True, False])
def test_what_nobody_had_is_given_out_and_the_rest_stays(by_worth):
    teamwork = Teamwork(least_gain=0.01)
    made, _ = sections(uneven(), teamwork, by_worth=by_worth)
    made.begin(None)
    anew, other = made.owner.copy(), 1 - made.owner
    # as good as it was: nothing is gained
    made.begin(other)
    assert (made.owner == other).all()
    some = np.arange(len(anew)) % 3 == 0
    made, _ = sections(uneven(), Teamwork(least_gain=1e9), by_worth=by_worth)
    made.begin(np.where(some, -1, other))
    assert (made.owner == np.where(some, anew, other)).all()
    # all to one: who has none would have nothing to do
    made, _ = sections(uneven(), teamwork, by_worth=by_worth)
    made.begin(np.zeros_like(anew))
    assert (made.owner == (anew if by_worth else 0)).all()


@pytest.mark.parametrize("speed_m_s", [0.3, 1.0, 2.0])
def test_the_way_to_a_section_is_that_across_the_plot_to_the_nearest_of_its_aisles(speed_m_s):
    made, workers = sections(uneven())
    scene = replace(workers[0].scene, robot=Robot(hours=0.5, speed_m_s=speed_m_s))
    workers[0].post = Posted(scene, 0.0, np.zeros(N, bool))
    workers[0].at = 16 * 2 + 5
    by_height = np.argsort(np.argsort(aisle_heights(GRID)))
    owner = np.where(np.isin(by_height, [7, 9]), 0, 1)
    nearest_m = np.sort(aisle_heights(GRID))[7] - GRID.lane_y_m[2]
    # who is at the gate yet may begin anywhere
    way_s = made._way_s(owner, made._stands())
    assert way_s.tolist() == pytest.approx([nearest_m / speed_m_s, 0.0])
    assert made._way_s(np.ones_like(owner), made._stands()).tolist() == [0.0, 0.0]
