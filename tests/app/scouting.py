"""A season that is served without Streamlit, and a phone's browser that can be killed."""

import asyncio
import io
import os
import random
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
            self.thread.join(180)
            self.server = None


_ENDLESS = 1 << 40


class BrokenLine:
    """A line to a port that breaks after a random number of bytes, whatever is being said."""

    def __init__(self, port, seed):
        self.to, self.chance, self.cuts, self.is_broken = port, random.Random(seed), 0, False
        self.ear = socket.create_server(("127.0.0.1", 0), backlog=64)
        self.address = f"http://127.0.0.1:{self.ear.getsockname()[1]}"
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        with suppress(OSError):
            while True:
                here, _ = self.ear.accept()
                threading.Thread(target=self._serve, args=(here,), daemon=True).start()

    def _serve(self, here):
        left = [self._bytes() if self.is_broken else _ENDLESS]
        with here:
            try:
                there = socket.create_connection(("127.0.0.1", self.to))
            except OSError:  # the server is gone
                self.cuts += self.is_broken
                return
            with there:
                ways = [threading.Thread(target=self._pass_on, args=(a, b, left), daemon=True)
                        for a, b in ((here, there), (there, here))]  # fmt: skip
                for way in ways:
                    way.start()
                for way in ways:
                    way.join()
        self.cuts += left[0] <= 0

    def _bytes(self):
        """From a few bytes of a request to all of it and half the answer; now and then a photo."""
        return int(10 ** self.chance.uniform(*((0, 3.5) if self.chance.random() < 0.8 else (3, 6))))

    def _pass_on(self, source, to, left):
        with suppress(OSError):
            while left[0] > 0 and (said := source.recv(4096)):
                if self.is_broken and left[0] > _ENDLESS / 2:
                    left[0] = self._bytes()
                to.sendall(said[: max(0, left[0])])
                left[0] -= len(said)
        for end in (source, to):
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def close(self):
        self.ear.close()


class PhoneWindow:
    """A phone's window in a browser that runs already, with what it keeps to itself."""

    def __init__(self, browser, **more):
        self.window = browser.new_context(**PHONE | more)
        self.window.set_default_timeout(180_000)  # others may have the machine
        self.page = self.window.new_page()

    def forget(self, address):
        """Forget where it is and what was done on the page at an address, which alone it keeps."""
        for page in self.window.pages:
            page.close()
        self.window.set_offline(False)
        self.window.set_geolocation(None)
        self.page = self.window.new_page()
        devtools = self.window.new_cdp_session(self.page)
        kept = {"origin": address, "storageTypes": "indexeddb,local_storage"}
        devtools.send("Storage.clearDataForOrigin", kept)
        devtools.detach()

    def close(self):
        self.window.close()


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
        self.window.set_default_timeout(180_000)  # others may have the machine
        self.page = self.window.pages[0]

    def kill(self):
        """End it as a phone does that runs out of battery: no goodbye."""
        mine, killed = f"--user-data-dir={self.folder}", []
        for one in psutil.process_iter(["pid", "cmdline"]):
            if mine in (one.info["cmdline"] or []):
                with suppress(ProcessLookupError):
                    os.kill(one.info["pid"], 9)
                    killed.append(one)
        # until it is gone its disk is locked for the next one
        psutil.wait_procs(killed, timeout=180)
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
