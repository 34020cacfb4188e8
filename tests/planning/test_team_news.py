"""What a team knows: all that was told, and of oneself what was not told yet."""

from dataclasses import replace

import numpy as np

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.planning.team_news import TeamNews
from fieldmon.planning.team_worker import Posted, StopMade, TeamWorker
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.base import NEVER, Scene

AISLES = Aisles.of(rectangle(4, 16))
N = len(AISLES.grid)
BELIEF = IndependentPlants(AISLES.grid, np.full(N, 0.1))


def learn(plants, found, detects):
    return BELIEF.learn(plants, found, Learning(detects))


def a_team(*stops):
    """Return a team of which each has made one stop: plant, when left, whether it was a find."""
    last = np.full(N, NEVER, np.int32)
    robot = Robot(hours=1.0)
    scene = Scene(AISLES, robot, BELIEF.chance, last, seconds_left=robot.day_s)
    workers = [TeamWorker.of(k, Posted(scene, 0.0, np.zeros(N, bool))) for k in range(len(stops))]
    for worker, (plant, leave_s, found) in zip(workers, stops, strict=True):
        worker.done = [StopMade(plant, leave_s - 40.0, leave_s, found, 0.9, 0.0)]
    return workers


def test_all_hear_once_of_what_was_made_by_then_in_order_of_the_clock():
    news = TeamNews(a_team((30, 200.0, True), (5, 100.0, False), (50, 300.0, True)), learn)
    assert [(told.plant, told.k) for told in news.hear(250.0)] == [(5, 1), (30, 0)]
    assert [told.plant for told in news.hear(300.0)] == [50]
    assert [told.plant for told in news.known] == [5, 30, 50]
    said = learn(np.array([5, 30, 50], np.int32), np.array([False, True, True]), np.full(3, 0.9))
    assert (news.believed[0] == said.chance).all()


def test_each_of_many_stops_is_told_once():
    workers = a_team((30, 100.0, True), (5, 60.0, False))
    workers[0].done.append(StopMade(31, 105.0, 145.0, False, 0.9, 0.0))
    workers[0].done.append(StopMade(32, 150.0, 190.0, True, 0.9, 0.0))
    news = TeamNews(workers, learn)
    told = [[stop.plant for stop in news.hear(now_s)] for now_s in (100.0, 100.0, 145.0, 190.0)]
    assert told == [[5, 30], [], [31], [32]]
    assert [worker.told for worker in workers] == [3, 1]


def test_one_knows_its_own_stops_before_the_others_hear_of_them():
    workers = a_team((30, 100.0, True), (5, 100.0, True))
    news = TeamNews(workers, learn)
    own = learn(np.array([30], np.int32), np.array([True]), np.array([0.9]))
    assert (news.believed_by(workers[0], 100.0)[0] == own.chance).all()
    assert (news.believed[0] == BELIEF.chance).all()
    # what is yet to be found is known to nobody
    assert (news.believed_by(workers[0], 99.0)[0] == BELIEF.chance).all()


def test_without_contact_nobody_believes_anything_else_than_in_the_morning():
    workers = a_team((30, 100.0, True), (5, 100.0, True))
    news = TeamNews(workers, None)
    assert not news.heard
    assert (news.believed_by(workers[0], 100.0)[0] == BELIEF.chance).all()


def test_plants_inspected_today_and_those_driven_to_are_taken():
    workers = a_team((30, 100.0, True), (5, 100.0, False))
    workers[0].done += [StopMade(31, 110.0, 150.0, False, 0.9, 0.0),
                        StopMade(32, 160.0, 200.0, False, 0.9, 0.0)]  # fmt: skip
    last = np.full(N, NEVER, np.int32)
    last[40], last[41] = workers[0].scene.day, workers[0].scene.day - 1
    scene = replace(workers[0].scene, last_inspected=last)
    workers[0].post = Posted(scene, 0.0, np.zeros(N, bool))
    news = TeamNews(workers, learn)
    assert np.flatnonzero(news.taken(0.0)).tolist() == [5, 30, 40]
    assert np.flatnonzero(news.taken(100.0)).tolist() == [5, 30, 31, 40]
    assert np.flatnonzero(news.taken(200.0)).tolist() == [5, 30, 31, 32, 40]
