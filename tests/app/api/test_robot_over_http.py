"""The documentation's robot asks a season and tells it, over HTTP, as it stands there."""

import importlib.util

import pytest

from fieldmon.infestation.inspections import FOUND
from tests.app.scouting import Line
from tests.paths import ROOT

EXAMPLE = ROOT / "docs" / "examples" / "season_over_http.py"


@pytest.fixture
def example():
    spec = importlib.util.spec_from_file_location("season_over_http", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def line():
    made = Line()
    made.come()
    yield made
    made.go()


def test_a_robot_drives_a_day_over_http_and_a_lost_line_loses_nothing(
    served, example, line, monkeypatch
):
    season = served.season
    known = len(season.history.inspections)
    robot = example.SeasonOverHttp(f"{line.address}/api/v1/seasons/season", served.key)
    waits = iter(range(5))

    def wait(_s):
        assert next(waits, None) is not None, "it is not reached any more"
        if line.server is None:
            line.come()

    monkeypatch.setattr(example, "wait", wait)
    looked = []

    def go_and_look(place):
        looked.append(place)
        if len(looked) == 3:
            line.go()  # behind a hill
        return len(looked) % 4 == 0

    told = example.drive_day(robot, go_and_look, most=9)
    assert len(told) == len(set(told)) == 9
    new = season.history.inspections.take(slice(known, None))
    assert new.plant.tolist() == told
    assert (new.result == FOUND).tolist() == [(k + 1) % 4 == 0 for k in range(9)]
    lonlat = season.plot.grid.lonlat(new.plant)
    assert [pytest.approx(place) for place in lonlat.tolist()] == [list(p) for p in looked]
    assert set(new.who) == {"Ann"}


def test_a_key_that_does_not_hold_is_said_at_once(served, example, line):  # noqa: ARG001
    robot = example.SeasonOverHttp(f"{line.address}/api/v1/seasons/season", "no key")
    with pytest.raises(example.RefusedError, match="401"):
        robot.ask("day")
