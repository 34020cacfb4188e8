"""A line a robot: how it stands, its battery, what it found, its planned end."""

import numpy as np

from app.show import robots_watched
from app.state.live_drive import SeenRobot
from app.words import texts
from fieldmon.drive.trace import Trace, TracedStop
from fieldmon.drive.vda5050.watcher import Heard
from tests.app.driving import apart


def seen(name, heard, *stops):
    trace = Trace(np.empty((0, 4)), tuple(TracedStop(9.0, k, one) for k, one in enumerate(stops)))
    return SeenRobot(name, trace, (np.empty((0, 2)), 0), heard)


def test_each_robot_has_a_line_and_what_nobody_may_overlook_is_said_with_its_name():
    team = [
        seen("<b>zoe</b>", Heard("live", 1.2, battery=79.9), True, False, None),
        seen("lost", Heard("lost", 34.0, battery=50.0)),
        seen("never", Heard("waiting", None)),
        seen("old", Heard("off", None)),
        seen("there", Heard("elsewhere", 1.0)),
        seen("two", Heard("double", 1.0)),
        seen("ill", Heard("failed", 1.0, "left wheel")),
    ]
    lines = apart(robots_watched.as_html(team, {"lost": "14:30"}, dark=True)).split("</p>")[:-1]
    assert "&lt;b&gt;zoe&lt;/b&gt;" in lines[0]
    assert lines[0].endswith("live, 1 s ago · battery 79 % · 2 inspected, 1 found")
    assert "<b>connection lost, last heard 34 s ago</b>" in lines[1]
    assert lines[1].endswith("planned until 14:30")
    assert lines[2].endswith("<b>not heard yet</b>")
    assert "inspected" not in lines[4]
    said = robots_watched.cautions(team)
    assert [any(name in one for one in said) for name in ("never", "there", "two", "ill")]
    assert not any("zoe" in one or texts.isolated("lost") in one for one in said)
    assert any("left wheel" in one for one in said)


def test_every_standing_has_words():
    for standing in ("idle", "live", "held", "done", "paused", "failed", "lost", "off", "double"):
        assert robots_watched.stands(Heard(standing, 1.0))
    assert robots_watched.stands(Heard("lost", None)) == texts.MAP_WORDS["lost_before"]
