"""What the browser is sent of a driven day."""

import json

import numpy as np
import pytest

from app.show import drive_play
from app.show.maps import colours
from app.state.driving import DriveRun
from app.state.map_store import STORE
from fieldmon.drive.simulated_robots import MadeUp
from fieldmon.samplers import sampler
from tests.app.chosen import a_plot, chosen


@pytest.fixture(scope="module")
def driven():
    choices = chosen(a_plot())
    scene = choices.plan().scene
    run = DriveRun("charged", choices.plot, scene, sampler("adaptive"), MadeUp(0.1))
    run._work()
    return choices, scene, run.day


def test_the_changes_of_a_day_lead_from_the_mornings_classes_to_the_evenings(driven):
    _, scene, day = driven
    data = drive_play.as_data(scene, day)
    rank = colours.by_chance(scene.chance).rank.copy()
    for second, plants, classes in data["changes"]:
        assert 0 < second <= data["end"]
        rank[plants] = classes
    assert rank.tolist() == colours.by_chance(day.believed[-1][1]).rank.tolist()
    assert [one[2:] for one in data["stops"]] == [[one.found, 0] for one in day.trace.stops]
    (robot,) = data["robots"]
    assert len({len(robot[name]) for name in ("at", "lon", "lat", "heading")}) == 1


def test_a_day_is_written_once_and_found_under_its_address(driven):
    choices, scene, day = driven
    address = drive_play.content(choices, scene, day).drive
    assert address == drive_play.published(scene, day)
    kept = json.loads(STORE.get(address)[1])
    assert np.array(kept["robots"][0]["lon"]) == pytest.approx(day.trace.poses[:, 1], abs=1e-7)
    assert drive_play.content(choices, scene, None).drive is None
