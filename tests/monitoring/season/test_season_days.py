"""The days of a season: their hours, what was inspected in them, and what is closed to people."""

from dataclasses import replace
from datetime import time

import numpy as np

from fieldmon.infestation.inspections import CLEAN, Inspections
from tests.monitoring.seasons import ROBOT, a_season, on


def test_a_night_that_runs_over_takes_nothing_from_the_next(tmp_path):
    robot, starts = replace(ROBOT, hours=8.0), time(20)
    season = a_season(tmp_path / "over.gpkg", robot=robot, starts=starts)
    told = [(0, "21:00"), (1, "00:30"), (1, "03:50"), (1, "05:10"), (1, "12:30")]
    day, clocks = zip(*told, strict=True)
    second = [3600.0 * int(one[:2]) + 60.0 * int(one[3:]) for one in clocks]
    noted = Inspections.of(
        np.arange(len(told)), np.full(len(told), CLEAN),
        np.array([on(one) for one in day], "datetime64[D]"), second=np.array(second),
    )  # fmt: skip
    season.record(noted, "night")
    assert season.scene(on(1)).seconds_left == robot.day_s
    assert season.work(on(0)).inspections.plant.tolist() == [0, 1, 2, 3, 4]
    assert season.plan(on(1)).route.notes.start.time() == starts
