"""`fieldmon app`: the app in the browser."""

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request

import psutil
import pytest


def test_a_port_in_use_is_a_sentence(run):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        code, _, err, _ = run("app", "--port", taken.getsockname()[1])
    assert code == 2
    assert "must be free" in err


def answers(url):
    try:
        with urllib.request.urlopen(url, timeout=1) as answer:  # noqa: S310 - our own
            return answer.read() == b"ok"
    except OSError:
        return False


def until(is_so, within_s=60.0):
    end = time.monotonic() + within_s
    while not is_so():
        assert time.monotonic() < end, "it did not come about in time"
        time.sleep(0.05)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_a_signal_to_the_command_ends_the_server_and_all_that_it_started(tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "fieldmon.cli", "app", "--no-browser", "--port", str(port),
               "--seasons", str(tmp_path)]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as app:
        until(lambda: answers(f"http://127.0.0.1:{port}/_stcore/health"))
        started = psutil.Process(app.pid).children(recursive=True)
        assert len(started) >= 2, "the server and its reader of files"
        os.kill(app.pid, signal.SIGTERM)
        assert app.wait(30) == 128 + signal.SIGTERM
    until(lambda: not any(one.is_running() for one in started))
