"""What a process does in a season until it is done, or killed."""

import os
from datetime import timedelta
from multiprocessing import get_context

import numpy as np

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from tests.monitoring.seasons import BEGINS


def started(task, *words):
    """Start a process that is warm already, so that it is at work within milliseconds."""
    process = get_context("fork").Process(target=task, args=words)
    process.start()
    return process


def one_by_one(path, who, rounds):
    """Record one result after another, each of its own plant."""
    season = Season(path)
    n = len(season.plot.grid)
    for k in range(rounds):
        plant = np.array([(k * 2 + who) % n])
        on = np.datetime64(BEGINS + timedelta(days=1), "D")
        season.record(
            Inspections.of(plant, np.array([0]), on, who=np.array([str(who)])), f"{who}-{k}"
        )


def day_by_day(path):
    """Plan and record day after day, without end; what one scout saw, nobody saw before."""
    season = Season(path)
    day, scout = 0, str(os.getpid())
    while True:
        on = BEGINS + timedelta(days=day % 300)
        plants = season.plan(on).route.plant[:20]
        who = np.full(len(plants), scout, object)
        found = (plants % 7 == 0).astype(np.int8)
        done = Inspections.of(plants, found, np.datetime64(on, "D"), who=who)
        season.record(done, f"scout {scout}, day {day}")
        day += 1


def team_day_by_day(path):
    """Plan for a team and record what each did, day after day, without end."""
    season = Season(path)
    day = 0
    while True:
        on = BEGINS + timedelta(days=day % 300)
        for member, plan in zip(season.settings.team, season.plan_each(on), strict=True):
            plants = plan.route.plant[:10]
            who = np.full(len(plants), member.name, object)
            found = (plants % 7 == 0).astype(np.int8)
            done = Inspections.of(plants, found, np.datetime64(on, "D"), who=who)
            season.record(done, f"{member.name}, day {day}")
        day += 1
