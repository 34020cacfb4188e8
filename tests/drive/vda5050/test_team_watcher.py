"""Several robots are followed by one clock, whatever their own say."""

import numpy as np
import pytest

from fieldmon.drive.vda5050.team_watcher import TeamWatcher
from tests.drive.vda5050.test_watcher import Heard, state


def test_places_of_all_are_by_one_clock_and_others_may_come(plot, monkeypatch):
    now = [1000.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    boxes = {"a": Heard()}
    team = TeamWatcher(boxes, plot.grid)
    team.take()
    assert team.robots["a"].heard().standing == "waiting"
    boxes["a"].put("state", state((0.0, 0.0)), 5.0)
    team.take()
    now[0] += 100.0
    boxes["b"] = Heard()
    boxes["b"].put("state", state((1.0, 0.0)), "50:00.000")  # its clock is three quarters ahead
    boxes["a"].put("state", state((0.2, 0.0)), "01:45.000")
    team.take()
    now[0] += 10.0
    boxes["b"].put("state", state((1.2, 0.0)), "50:10.000")
    boxes["a"].put("state", state((0.4, 0.0)), "59:00.000")  # put to a time that has not come yet
    team.take()
    seconds = {name: one.trace().poses[:, 0] for name, one in team.robots.items()}
    assert seconds["a"] == pytest.approx([0.0, 100.0, 110.0])
    np.testing.assert_allclose(seconds["b"], [100.0, 110.0])
