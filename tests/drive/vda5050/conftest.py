"""A broker of one's own, for a session of tests."""

import os
import shutil
import socket
import subprocess
import time

import pytest

from fieldmon.drive.vda5050.wire import Broker

ROBOT = ("fieldmon", "robot1")


@pytest.fixture(scope="session")
def broker():
    path = f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin"
    program = shutil.which("mosquitto", path=path)
    if program is None:
        if os.environ.get("FIELDMON_REQUIRE_BROKER"):
            pytest.fail("the MQTT broker mosquitto must be here, but it is not")
        pytest.skip("the MQTT broker mosquitto (Debian's package) is not on this machine")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with subprocess.Popen([program, "-p", str(port)], stderr=subprocess.DEVNULL) as running:
        until = time.monotonic() + 20
        while True:
            try:
                socket.create_connection(("127.0.0.1", port), timeout=1).close()
                break
            except OSError:
                assert time.monotonic() < until
        yield Broker("127.0.0.1", port)
        running.terminate()
