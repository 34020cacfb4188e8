"""Settings for all tests."""

import gc
import logging
import os
import shutil
import tempfile
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import psutil
import pytest
from hypothesis import HealthCheck, is_hypothesis_test, settings

from fieldmon.compute.cores import cores
from tests.thorough import EXAMPLES
from tests.xdist_order import BothEnds, in_order, workers

# a season waits for the disk before a record counts, several times for each: tests keep their files
# in memory where there is plenty, and let go of them as they pass (pyproject.toml)
MEMORY, PLENTY = Path("/dev/shm"), 8e9  # noqa: S108 - as the folder is called on Linux


def has_plenty():
    """Tell whether files can be kept in memory."""
    if "TMPDIR" in os.environ or not os.access(MEMORY, os.W_OK):
        return False
    return min(shutil.disk_usage(MEMORY).free, psutil.virtual_memory().available) > PLENTY


if has_plenty():
    os.environ["TMPDIR"], tempfile.tempdir = str(MEMORY), None

# a million objects come while tests are collected, and stay: see `pytest_collection_finish`
gc.disable()

# the first example of a property pays for compiling; a landing must not depend on luck
settings.register_profile(
    "fieldmon",
    max_examples=12,
    deadline=None,
    derandomize="CI" in os.environ,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "thorough",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    print_blob=True,
)
settings.load_profile("thorough" if EXAMPLES else "fieldmon")


def thorough(test):
    """Let a property be tried on `EXAMPLES` examples, for as long as it takes.

    A profile alone does not do: what a test states itself comes first.
    """
    own = test.obj._hypothesis_internal_use_settings
    test.obj._hypothesis_internal_use_settings = settings(own, max_examples=EXAMPLES)
    test.add_marker(pytest.mark.timeout(0))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    return workers(cores(), psutil.virtual_memory().available)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    return BothEnds(config, log) if config.getoption("dist") == "loadfile" else None


def pytest_sessionstart(session):
    """Let each worker begin with other files: others read the bytecode that it makes of them."""
    config = session.config
    told = getattr(config, "workerinput", None)
    if told is None or config.args_source is not pytest.Config.ArgsSource.TESTPATHS:
        return
    files = sorted(Path(__file__).parent.rglob("test_*.py"))
    begins = int(told["workerid"][2:]) * len(files) // told["workercount"]
    for file in files[begins:] + files[:begins]:
        name = file.relative_to(config.rootpath).with_suffix("").parts
        with suppress(Exception, pytest.skip.Exception):  # it is said when it is collected
            import_module(".".join(name))


def pytest_collection_modifyitems(items):
    in_order(items)
    if EXAMPLES:
        for test in items:
            if is_hypothesis_test(getattr(test, "obj", None)):
                thorough(test)


def pytest_collection_finish():
    """Look for garbage among what tests make, not among the tests themselves: a tenth of all.

    Let logs pass on what they are told: pytest goes to each that does not, six times a test, and
    Streamlit has a hundred.
    """
    for name in logging.root.manager.loggerDict:
        logging.getLogger(name).propagate = True
    gc.freeze()
    gc.set_threshold(60_000, 10, 50)
    gc.enable()


def within(call, **given):
    """Call something in a frame with room for 8 MB of frames below it.

    Python 3.11 asks the system for the memory of frames in pieces of 16 kB, and hands a piece back
    as its first frame returns: where calls go to and fro at the edge of a piece, each costs some
    10 us. The compiler's do by the million.
    """
    return call(**given)


within.__code__ = within.__code__.replace(co_stacksize=1 << 20)
RUNNING = []


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session):
    if RUNNING:
        return None  # whoever runs tests otherwise
    RUNNING.append(session)
    return within(session.config.hook.pytest_runtestloop, session=session)


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
# software drawing: Mesa's, which keeps compiled shaders, or else the browser's own, some seconds
# slower for every map, and for maps alone: put together without it, a page takes half the processor
# time; and no name in the world but this machine's
FLAGS = [
    *["--no-sandbox", "--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"],
    *["--enable-unsafe-swiftshader", "--disable-gpu-rasterization", "--disable-gpu-compositing"],
    *["--disable-smooth-scrolling"],
    *["--disable-background-networking", "--disable-component-update", "--no-first-run"],
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    # pages of the app share a process and what it has made of their scripts: a tenth of all
    "--process-per-site",
    # and what it has made of them is kept whole at the first load, not part by part as they come
    # again: later loads and turns take a tenth less
    "--blink-settings=v8CacheOptions=4",
]


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Start a real browser, once: a process holds no two of them.

    Its first window keeps on disk, for its tabs, what it makes of scripts: a fifth of what a page
    of the app takes. Other windows keep nothing.
    """
    if CHROMIUM is None:
        if os.environ.get("FIELDMON_REQUIRE_BROWSER"):
            pytest.fail("Chromium must be installed here, but it was not found")
        pytest.skip("Chromium is not installed (Debian's package chromium)")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        window = playwright.chromium.launch_persistent_context(
            tmp_path_factory.mktemp("chromium"),
            executable_path=CHROMIUM,
            args=FLAGS,
            # maps are drawn by the processor, as all that moves
            reduced_motion="reduce",
        )
        yield window.browser
        window.close()
