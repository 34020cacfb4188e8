"""Some days of a season over a broker, with connections lost and messages doubled."""

import contextlib
import socket
import time
from datetime import timedelta

import numpy as np
import pytest

from fieldmon.drive.day import drive_day
from fieldmon.drive.season_day import SeasonDay
from fieldmon.drive.vda5050.fleet import live_robot
from fieldmon.drive.vda5050.stand_in import StandIn
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.plot.robot import Robot
from tests.drive.test_season_day import ON
from tests.drive.vda5050.conftest import ROBOT
from tests.thorough import times

#: ten days with 200 of them where somebody asks for many
DAYS, LOSSES = times(3, 10), times(60, 200)


@pytest.fixture
def season(plot, tmp_path):
    settings = MonitoringSettings(ON, robot=Robot(hours=0.07))
    return Season.create(tmp_path / "season.gpkg", plot, None, settings)


def cut(wire):
    """Cut a line as a hill does, as soon as there is one: nobody says farewell."""
    until = time.monotonic() + 180
    while (line := wire.client.socket()) is None or not wire.client.is_connected():
        assert time.monotonic() < until
        time.sleep(0.002)
    with contextlib.suppress(OSError):  # it was lost just now by itself
        line.shutdown(socket.SHUT_RDWR)
    return 1


class Mishaps:
    """Cuts both ends' lines, and says and orders things twice, some of it late."""

    def __init__(self, other, fleet):
        self.other, self.fleet, self.lost, self.stops = other, fleet, 0, 0
        self.orders = []
        send = fleet._wire.send

        def remembered(kind, data, **how):
            if kind == "order":
                self.orders.append(data)
            send(kind, data, **how)

        fleet._wire.send = remembered

    def __call__(self, _stop, _errand):
        while self.lost < min(LOSSES / DAYS, 7 * (self.stops + 1)):
            self.lost += cut(self.other.wire)
            self.other.tell()
            self.lost += cut(self.fleet._wire)
        self.stops += 1
        self.fleet._wire.client.publish(f"{ROBOT.topic}/order", self.orders[0], qos=1)
        self.fleet._wire.client.publish(f"{ROBOT.topic}/order", self.orders[-1], qos=1)


def test_in_days_of_many_lost_connections_nothing_is_lost_and_nothing_twice(broker, season):
    lost = 0
    for k in range(DAYS):
        looked, on = [], ON + timedelta(days=k)

        def look(plant, looked=looked):
            looked.append(plant)
            return plant % 5 == 0

        other = StandIn(broker, ROBOT, look, season.settings.robot.speed_m_s, faster=1e6)
        other.start()
        day = SeasonDay(season, on, "rough")
        with live_robot(broker, ROBOT, str(on), lambda _: None) as live:
            mishaps = Mishaps(other, live)
            driven = drive_day(day, season.plot.aisles, (season.settings.robot, live), mishaps)
        other.stop()
        lost += mishaps.lost
        told = season.history.inspections.on(on)
        assert driven.stuck == []
        assert len(looked) == len(set(looked)) >= 3
        assert told.plant.tolist() == looked
        assert (told.result == FOUND).tolist() == [plant % 5 == 0 for plant in looked]
        assert (np.diff(told.second) > 0).all()
    assert lost >= LOSSES
    assert len(season.batches()) == DAYS
