"""A season that is served without Streamlit, and a phone's browser that can be killed."""

import asyncio
import io
import os
import socket
import threading
from contextlib import suppress
from types import SimpleNamespace

import numpy as np
import psutil
import uvicorn
from PIL import Image
from playwright.sync_api import Error as PlaywrightError

from app.startup.serve import Server
from tests.app.driving import until
from tests.conftest import CHROMIUM, FLAGS

PHONE = {
    "viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True,
    "permissions": ["geolocation"],
}  # fmt: skip


class Line:
    """The server on its port: there, or gone."""

    def __init__(self):
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        self.address = f"http://127.0.0.1:{self.port}"
        self.server = None

    def come(self):
        """Serve the page and the interface, nothing of Streamlit."""
        config = uvicorn.Config(Server(), port=self.port, lifespan="off", log_level="critical",
                                timeout_graceful_shutdown=0)  # fmt: skip
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=lambda: asyncio.run(self.server.serve()))
        self.thread.start()
        until(lambda: self.server.started)

    def go(self):
        """End at once, whatever was being answered."""
        if self.server is not None:
            self.server.should_exit = self.server.force_exit = True
            self.thread.join(30)
            self.server = None


class PhoneBrowser:
    """A browser with a disk of its own, which outlives it."""

    def __init__(self, browser, folder, **more):
        self.kind, self.folder, self.more = browser.browser_type, folder, PHONE | more
        self.window = None
        self.open()

    def open(self):
        """Start it anew on the same disk."""
        self.window = self.kind.launch_persistent_context(
            self.folder, executable_path=CHROMIUM, args=FLAGS, **self.more
        )
        self.page = self.window.pages[0]

    def kill(self):
        """End it as a phone does that runs out of battery: no goodbye."""
        mine = f"--user-data-dir={self.folder}"
        for one in psutil.process_iter(["pid", "cmdline"]):
            if mine in (one.info["cmdline"] or []):
                with suppress(ProcessLookupError):
                    os.kill(one.info["pid"], 9)
        with suppress(PlaywrightError):
            self.window.close()
        self.open()

    def crash_tab(self):
        """End the page alone, as phones do with pages out of sight."""
        with suppress(PlaywrightError):
            self.page.goto("chrome://crash", timeout=2000)
        with suppress(PlaywrightError):
            self.page.close()
        self.page = self.window.new_page()

    def close(self):
        self.window.close()


def a_picture(seed):
    """Return a photo's bytes: noise, which does not compress."""
    noise = np.random.default_rng(seed).integers(0, 255, (400, 300, 3), np.uint8)
    out = io.BytesIO()
    Image.fromarray(noise).resize((1200, 900)).save(out, "JPEG", quality=80)
    return {"name": f"{seed}.jpg", "mimeType": "image/jpeg", "buffer": out.getvalue()}


def kept(page):
    """Return what the phone holds: records, and digests of photos by their ids."""
    said = page.evaluate(_KEPT)
    return SimpleNamespace(**said)


_KEPT = """async () => {
  const db = await new Promise((done, failed) => {
    const asked = indexedDB.open("fieldmon");
    asked.onsuccess = () => done(asked.result); asked.onerror = () => failed(asked.error);
  });
  const all = (name) => new Promise((done) => {
    const asked = db.transaction(name).objectStore(name).getAll();
    asked.onsuccess = () => done(asked.result);
  });
  const records = await all("records"), photos = {};
  for (const one of await all("photos")) {
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", one.bytes));
    const hex = [...digest].map((b) => b.toString(16).padStart(2, "0")).join("");
    photos[one.id] = [one.finding, one.state, hex];
  }
  db.close();
  return { records, photos };
}"""
