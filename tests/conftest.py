"""Settings for all tests."""

import os
import shutil

import pytest
from hypothesis import HealthCheck, settings

# the first example of a property pays for compiling; a landing must not depend on luck
settings.register_profile(
    "fieldmon",
    deadline=None,
    derandomize="CI" in os.environ,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("fieldmon")

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
# software drawing: Mesa's, which keeps compiled shaders, or else the browser's own, some seconds
# slower for every map; and no name in the world but this machine's
FLAGS = [
    *["--no-sandbox", "--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"],
    *["--enable-unsafe-swiftshader", "--disable-smooth-scrolling"],
    *["--disable-background-networking", "--disable-component-update", "--no-first-run"],
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
]


@pytest.fixture(scope="session")
def browser():
    """Start a real browser, once: a process holds no two of them."""
    if CHROMIUM is None:
        if os.environ.get("FIELDMON_REQUIRE_BROWSER"):
            pytest.fail("Chromium must be installed here, but it was not found")
        pytest.skip("Chromium is not installed (Debian's package chromium)")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()
