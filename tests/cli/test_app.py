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

from fieldmon.cli import app as app_command


def test_a_port_in_use_is_a_sentence(run):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        code, _, err, _ = run("app", "--port", taken.getsockname()[1])
    assert code == 2
    assert "must be free" in err


@pytest.fixture
def started(monkeypatch):
    """Let the command start nothing; return what it would have told the server."""
    told = []
    monkeypatch.setattr(app_command, "_run", lambda _, env: told.append(env) or 0)
    monkeypatch.setenv("FIELDMON_ADDRESS", "")
    return told


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as free:
        return free.getsockname()[1]


def test_other_devices_come_only_where_it_is_said(run, started):
    for words, wanted in (
        ((), {}),
        (("--lan",), {"FIELDMON_LAN": ""}),
        (("--lan", "--address", "192.168.1.5"), {"FIELDMON_LAN": "192.168.1.5"}),
        (("--lan", "--address", "[fd00::2]"), {"FIELDMON_LAN": "fd00::2"}),
        (("--reached-at", "https://a.example/"), {"FIELDMON_ADDRESS": "https://a.example"}),
    ):
        run("app", "--no-browser", "--port", free_port(), *words)
        env = started.pop()
        assert env["STREAMLIT_SERVER_ADDRESS"] == "127.0.0.1"
        assert ("a.example" in env["FIELDMON_NAMES"]) == ("--reached-at" in words)
        named = {name: env[name] for name in ("FIELDMON_LAN", "FIELDMON_ADDRESS") if env.get(name)
                 or name in wanted}  # fmt: skip
        assert named == wanted


@pytest.mark.parametrize(
    ("address", "said"),
    [("http://a.example", "must begin with https://"), ("https://a.example/field", "a path")],
)
def test_others_come_to_an_encrypted_address_of_its_own_only(address, said, run, started):
    code, _, err, _ = run("app", "--port", free_port(), "--reached-at", address)
    assert code == 2
    assert said in " ".join(err.split())
    assert started == []


@pytest.mark.parametrize("address", ["127.0.0.1", "[::1]"])
def test_phones_do_not_come_to_this_machine_s_own_address(address, run, started):
    words = "app", "--port", free_port(), "--lan", "--address", address
    code, _, err, _ = run(*words)
    assert (code, started) == (2, [])
    assert "at which phones reach this machine" in " ".join(err.split())


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("office.local", "must be a number"),
        ("10.255.254.253", "must be this machine's"),
    ],
)
def test_an_address_that_is_not_this_machine_s_is_a_sentence(address, said, tmp_path):
    command = [sys.executable, "-m", "fieldmon", "app", "--no-browser", "--lan", "--port",
               str(free_port()), "--address", address]  # fmt: skip
    env = os.environ | {"FIELDMON_AUTHORITY": str(tmp_path)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=env)
    assert done.returncode == 1
    assert said in done.stderr
    assert "fieldmon is at" not in done.stdout, "it is not"
    assert "Traceback" not in done.stderr


def answers(url):
    try:
        with urllib.request.urlopen(url, timeout=1) as answer:  # noqa: S310 - our own
            return answer.read() == b"ok"
    except OSError:
        return False


def until(is_so, within_s=180.0):
    end = time.monotonic() + within_s
    while not is_so():
        assert time.monotonic() < end, "it did not come about in time"
        time.sleep(0.05)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_a_signal_ends_the_server_and_all_that_it_started_and_requests_are_not_listed(tmp_path):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "fieldmon", "app", "--no-browser", "--port", str(port),
               "--seasons", str(tmp_path)]  # fmt: skip
    said = tmp_path / "said.txt"
    with said.open("w") as out, subprocess.Popen(command, stdout=out, stderr=out) as app:
        until(lambda: answers(f"http://127.0.0.1:{port}/_stcore/health"))
        started = psutil.Process(app.pid).children(recursive=True)
        assert len(started) >= 2, "the server and its reader of files"
        os.kill(app.pid, signal.SIGTERM)
        assert app.wait(30) == 128 + signal.SIGTERM
    until(lambda: not any(one.is_running() for one in started))
    # the line that says where it is, and how it ends, is not lost among requests
    assert "HTTP/1.1" not in said.read_text()
