"""Sessions of the app without a browser; a real server and a real browser, on this machine only."""

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import tomllib
import urllib.request
from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta
from itertools import count
from pathlib import Path

import numpy as np
import pytest
import streamlit as st
from shapely import MultiPolygon, box
from streamlit import config
from streamlit.components.v2 import manifest_scanner
from streamlit.runtime.scriptrunner.script_cache import ScriptCache
from streamlit.runtime.state.safe_session_state import SafeSessionState
from streamlit.testing.v1 import local_script_runner

from app.state import sample_estate
from app.words import language
from fieldmon.infestation.records import Records
from fieldmon.io import plot_records, read
from fieldmon.io.plot_request import RecordSource
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.plot import local_clock
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.plot import Plot, plot_around
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot
from tests.app.driving import opened
from tests.app.map_in_browser import dressed, picture
from tests.paths import ROOT, SHARED

SHOTS = Path(__file__).with_name("screenshots")
#: whether a test has failed
FAILED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    report = yield
    if report.failed:
        item.stash[FAILED] = True
    return report


@pytest.fixture(scope="session", autouse=True)
def components():
    """Look for no components among all installed packages: the app's own is none of those.

    A server looks, see `address`.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(manifest_scanner, "scan_component_manifests", list)
        yield


@pytest.fixture(scope="session", autouse=True)
def harness():
    """Compile the script once, not for each run; wait for it asleep, not a thousand looks a second.

    Each look takes the interpreter from the script's own thread.
    """
    scripts, look = ScriptCache(), local_script_runner.require_widgets_deltas

    def wait(runner, timeout=3):
        runner._script_thread.join(timeout)
        if not runner.script_stopped():
            look(runner, 0)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(local_script_runner, "ScriptCache", lambda: scripts)
        patch.setattr(local_script_runner, "require_widgets_deltas", wait)
        yield


class AsAsked(Mapping):
    """A session's state of which only what is asked for is looked up.

    Most boxes of Streamlit ask for one value, for which it puts together those of all others.
    """

    def __init__(self, safe, whole):
        self.safe, self.whole = safe, whole

    def __getitem__(self, key):
        with self.safe._lock:
            return self.safe._state[key]

    def __iter__(self):
        return iter(self.whole(self.safe))

    def __len__(self):
        return len(self.whole(self.safe))


@pytest.fixture(scope="session", autouse=True)
def looks():
    """Let a box look its own value up in the session's state, without all others."""
    whole = SafeSessionState.filtered_state.fget
    with pytest.MonkeyPatch.context() as patch:
        of = property(lambda safe: AsAsked(safe, whole))
        patch.setattr(SafeSessionState, "filtered_state", of)
        yield


@pytest.fixture(scope="session", autouse=True)
def as_served():
    """Run pages by the app's own settings, which a session without a server does not read."""
    told = tomllib.loads((ROOT / "app" / ".streamlit" / "config.toml").read_text(encoding="utf-8"))
    for part in ("global", "runner", "browser"):
        for name, value in told[part].items():
            config.set_option(f"{part}.{name}", value)


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """Let it be the morning of the sample estate's last day; each look at the clock takes 5 s."""
    begins, looks = datetime(2026, 11, 16, 4, tzinfo=UTC), count()
    now = lambda: begins + timedelta(seconds=5 * next(looks))  # noqa: E731
    monkeypatch.setattr(local_clock, "utc_now", now)


@pytest.fixture(scope="session")
def of_each_test(tmp_path_factory):
    """Return the folder in which each test has folders of its own.

    Beside the others pytest would look at thousands to number the next, for these and `tmp_path`.
    """
    return tmp_path_factory.mktemp("of_each_test")


@pytest.fixture(autouse=True)
def files_folder(of_each_test, monkeypatch):
    """Let each test keep files of its own."""
    monkeypatch.setattr(tempfile, "tempdir", tempfile.mkdtemp(prefix="files", dir=of_each_test))
    return tempfile.gettempdir()


@pytest.fixture
def app():
    """Return a new session on the sample estate."""
    return opened()


@pytest.fixture(scope="session")
def begun_file(tmp_path_factory):
    """Begin a season as the app does, on the part of the sample plot Gate at its gate, once."""
    gate = sample_estate.plots()[0]
    grid = Plot.of(gate).grid
    x, y = grid.xy_m[0]
    # 16 rows from the gate on, of 50 plants each
    corner = box(x - 9.0, y - 9.0, x + 151.5, y + 62.0)
    boundary = gate.boundary & grid.frame.geometry_lonlat(corner)
    paths = read.read_lines(sample_estate.FOLDER / sample_estate.PATHS).value
    plot = Plot.of(replace(gate, boundary=MultiPolygon([boundary]), paths=paths))
    source = RecordSource(sample_estate.FOLDER / sample_estate.RECORDS)
    records = plot_records.records_on(plot, source, sample_estate.plots, None).value
    robot = Robot(hours=2.0)  # a day is a fifth of the plot, as eight hours are of the whole one
    settings = MonitoringSettings(sample_estate.LAST_DAY, robot=robot, language=language.ENGLISH)
    path = tmp_path_factory.mktemp("begun") / "Gate 2026.gpkg"
    return Season.create(path, plot, records, settings).path


@pytest.fixture
def season_app(begun_file, seasons_folder):
    """Return a new session in a season of its own that has just begun."""
    shutil.copy(begun_file, seasons_folder)
    return opened("Gate 2026")


@pytest.fixture
def season(seasons_folder):
    """Return what opens that season, as another program would."""
    return lambda: Season(seasons_folder / "Gate 2026.gpkg")


@pytest.fixture(scope="session")
def named_file(tmp_path_factory):
    """Begin a season of rows 1 to 4 that their file calls 5a, C, 2, D, once; return its file.

    Of the plants of row 1 the third has the name of the fourth.
    """
    row, plant = np.divmod(np.arange(80), 20)
    lonlat = Frame(35.0, 30.0, 90.0).lonlat(np.stack([2.0 * plant, 3.0 * row], axis=1))
    called = np.where((row == 0) & (plant == 2), 4, plant + 1)
    names = PlantNames(np.array(["5a", "C", "2", "D"])[row], None, called.astype(np.str_))
    plot = plot_around("own", lonlat, names=names)
    settings = MonitoringSettings(date(2026, 11, 16), robot=Robot(hours=1.0))
    path = tmp_path_factory.mktemp("named") / "Own 2026.gpkg"
    return Season.create(path, plot, Records.none(), settings).path


@pytest.fixture
def season_named(named_file, seasons_folder):
    """Return a season with names of rows and plants, a copy for each test."""
    return Season(shutil.copy(named_file, seasons_folder / named_file.name))


@pytest.fixture
def session(monkeypatch):
    """Return a session's state without a page."""
    state = {}
    monkeypatch.setattr(st, "session_state", state)
    return state


@pytest.fixture(scope="session")
def served_seasons(tmp_path_factory):
    """Return the folder in which the server of this run keeps its seasons."""
    return tmp_path_factory.mktemp("served")


@pytest.fixture(scope="session")
def address(browser, served_seasons, tmp_path_factory):  # noqa: ARG001 - no browser, no server
    """Start the app by its command; return where it is."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "fieldmon", "app", "--no-browser", "--port", str(port),
               "--seasons", str(served_seasons)]  # fmt: skip
    log = tmp_path_factory.mktemp("app") / "log"
    with log.open("wb") as out:
        server = subprocess.Popen(command, stdout=out, stderr=out, start_new_session=True)
    url = f"http://127.0.0.1:{port}"
    try:
        wait_for(f"{url}/_stcore/health", server)
        yield url
    finally:
        os.killpg(server.pid, 15)
        server.wait(180)


def wait_for(url, server):
    for _ in range(1800):
        assert server.poll() is None, "the app ended"
        try:
            with urllib.request.urlopen(url, timeout=1) as answer:  # noqa: S310 - our own
                if answer.read() == b"ok":
                    return
        except OSError:
            time.sleep(0.1)
    pytest.fail("the app did not answer within 180 s")


@pytest.fixture(scope="session")
def new_tab(browser):
    """Return what opens a tab of some size and kind of browser: all share what was loaded."""
    (window,) = browser.contexts
    # another program may have the machine's processors
    window.set_default_timeout(180_000)

    def of(size=(1200, 800), agent=None):
        page = window.new_page()
        if agent is not None:
            page.told = window.new_cdp_session(page)
            page.told.send("Emulation.setUserAgentOverride", {"userAgent": agent})
        page.set_viewport_size({"width": size[0], "height": size[1]})
        page.requests, page.complaints = [], []
        page.on("request", lambda sent: page.requests.append(sent.url))
        page.on(
            "console", lambda one: page.complaints.append(one.text) if one.type == "error" else None
        )
        return page

    return of


@pytest.fixture
def page(new_tab, request):
    """Return a new tab of the asked size that remembers every request and complaint.

    Of a test that failed it keeps a picture.
    """
    page = new_tab(*getattr(request, "param", ()))
    yield page
    if FAILED in request.node.stash:
        SHOTS.mkdir(exist_ok=True)
        dressed(page)
        (SHOTS / f"{request.node.name.replace('/', '_')}.png").write_bytes(picture(page))
    page.close()


@pytest.fixture(autouse=True)
def seasons_folder(of_each_test, monkeypatch):
    """Let each test have a folder of seasons of its own."""
    folder = Path(tempfile.mkdtemp(prefix="seasons", dir=of_each_test))
    monkeypatch.setenv("FIELDMON_SEASONS", str(folder))
    return folder


@pytest.fixture(scope="session")
def shared():
    """Return the folder of real files beside the repository."""
    folder = SHARED / "data"
    if not folder.is_dir():
        if os.environ.get("FIELDMON_REQUIRE_DATA"):
            pytest.fail(f"the real data folder {folder} must be here, but it is not")
        pytest.skip(f"the real data folder {folder} is not on this machine")
    return folder


@pytest.fixture
def speaking():
    """Let the texts speak a language, and English again at the end."""

    def speak(code):
        language.use(code)

    yield speak
    language.use(language.ENGLISH)
