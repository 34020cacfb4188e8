"""A live drive that is told to end, by Ctrl-C or as a service is: the robot drives home."""

import os
import signal

import pytest
from typer.testing import CliRunner

from fieldmon.cli.main import app
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.plot.local_clock import local_clock
from tests.drive.vda5050.conftest import ROBOT


@pytest.fixture
def heard():
    """Let Ctrl-C be heard, as where tests run in a terminal: in the background it is passed by."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("told", [["SIGINT"], ["SIGTERM"], ["SIGTERM", "SIGINT"]])
def test_a_robot_ends_the_plant_in_hand_and_drives_home(
    broker, plot, robot, tmp_path, monkeypatch, told
):
    monkeypatch.chdir(tmp_path)
    settings = MonitoringSettings(local_clock(plot.field).today(), robot=robot)
    season = Season.create(tmp_path / "season.gpkg", plot, None, settings)
    looked = []

    def look(plant):
        looked.append(plant)
        if len(looked) == 3:
            for one in told:
                os.kill(os.getpid(), getattr(signal, one))
        return False

    before = signal.getsignal(signal.SIGTERM)
    other = StandIn(broker, ROBOT, look, robot.speed_m_s, faster=1e6)
    other.start()
    address = f"{broker.host}:{broker.port}"
    words = ["drive", "season.gpkg", "--robot", "vda5050", "--broker", address, "-o", "day.csv"]
    try:
        done = CliRunner().invoke(app, words)
    finally:
        other.stop()
    assert done.exit_code == 130, done.output
    assert "the robot says that its clock is faster." in done.stderr
    assert f"of {settings.begins} in the season; the same command goes on" in done.stdout
    assert (tmp_path / "day.stops.csv").exists()
    assert signal.getsignal(signal.SIGTERM) == before
    if len(told) == 1:
        assert "ends the plant in hand and drives home" in done.stderr
        assert season.history.inspections.plant.tolist() == looked
        assert len(looked) == 3
        frame, aisles = plot.grid.frame, plot.aisles.for_robot(robot)
        gate_m = frame.turned(90.0).xy_m(frame.lonlat(aisles.gate_m[None]))[0]
        assert other.self.place == pytest.approx(tuple(gate_m), abs=0.01)
    else:
        assert "The robot still ends what it was ordered last." in done.stderr
