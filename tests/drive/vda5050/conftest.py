"""A broker of one's own, for a session of tests."""

import os
import shutil
import socket
import subprocess
import time
from contextlib import contextmanager

import pytest

from fieldmon.drive.vda5050.mqtt import Broker, RobotName

ROBOT = RobotName("fieldmon", "robot1")


@pytest.fixture(scope="session")
def broker_program(tmp_path_factory):
    """Return what starts a broker with settings besides, until it is left."""
    path = f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin"
    program = shutil.which("mosquitto", path=path)
    if program is None:
        if os.environ.get("FIELDMON_REQUIRE_BROKER"):
            pytest.fail("the MQTT broker mosquitto must be here, but it is not")
        pytest.skip("the MQTT broker mosquitto (Debian's package) is not on this machine")

    @contextmanager
    def started(settings, port=0):
        if not port:
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                port = free.getsockname()[1]
        told = tmp_path_factory.mktemp("broker") / "mosquitto.conf"
        told.write_text(f"listener {port} 127.0.0.1\nset_tcp_nodelay true\n{settings}")
        with subprocess.Popen([program, "-c", str(told)], stderr=subprocess.DEVNULL) as running:
            until = time.monotonic() + 180
            while True:
                try:
                    socket.create_connection(("127.0.0.1", port), timeout=1).close()
                    break
                except OSError:
                    assert time.monotonic() < until
            yield Broker("127.0.0.1", port)
            running.terminate()

    return started


@pytest.fixture(scope="session")
def broker(broker_program):
    with broker_program("allow_anonymous true\n") as found:
        yield found


@pytest.fixture(autouse=True)
def _soon(monkeypatch):
    """Seek a lost connection again at once."""
    monkeypatch.setattr("fieldmon.drive.vda5050.mqtt._SEEK_S", 0.02)
