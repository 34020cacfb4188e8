"""Measure ten people at once on one server: seconds a click, and what the server holds meanwhile.

Run it from the repository's root: ``python tests/app/ten_sessions.py [people] [clicks]``. It starts
the app by its command on the sample estate; each person turns pages in an order of their own,
over the protocol that browsers speak, all at the same time.

A long day made short: ``python tests/app/ten_sessions.py 10 --minutes 20`` turns pages without a
pause for so long, and everybody leaves and comes back each fifty pages.
"""

import argparse
import asyncio
import os
import random
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from contextlib import suppress
from pathlib import Path

import numpy as np
import websockets
from streamlit.proto.BackMsg_pb2 import BackMsg
from streamlit.proto.ForwardMsg_pb2 import ForwardMsg
from streamlit.util import calc_hash

# people look at a page before they click again; mean seconds
PAUSE_S = 2.0
# of a long day made short: how often one turns a page who also works, and pages of one visit
PAGE_EACH_S, PAGES_A_VISIT = 30.0, 50
PAGES = ["", "plots", "season", "ahead", "plot"]


async def click(line, page):
    """Turn to a page; return the seconds until it is all there."""
    message = BackMsg()
    message.rerun_script.page_script_hash = calc_hash(page)
    start = time.perf_counter()
    await line.send(message.SerializeToString())
    while True:
        answer = ForwardMsg()
        answer.ParseFromString(await line.recv())
        if answer.WhichOneof("type") == "script_finished":
            return time.perf_counter() - start


async def person(port, number, clicks, pages=None):
    rng = random.Random(number)
    address = f"ws://127.0.0.1:{port}/_stcore/stream"
    async with websockets.connect(
        address, subprotocols=["streamlit"], max_size=None, ping_interval=None
    ) as line:
        first = await click(line, "")
        taken = []
        for page in pages or rng.choices(PAGES, k=clicks):
            await asyncio.sleep(rng.uniform(0, 2 * PAUSE_S))
            taken.append(await click(line, page))
        return first, taken


async def hurried(port, number, until):
    """Turn pages without a pause until a moment, leaving and coming back; return how many."""
    turned, visit = 0, 0
    while time.monotonic() < until:
        address = f"ws://127.0.0.1:{port}/_stcore/stream"
        rng, visit = random.Random(f"{number} {visit}"), visit + 1
        async with websockets.connect(
            address, subprotocols=["streamlit"], max_size=None, ping_interval=None
        ) as line:
            for page in ["", *rng.choices(PAGES, k=PAGES_A_VISIT - 1)]:
                await click(line, page)
                turned += 1
                if time.monotonic() > until:
                    break
    return turned


async def compressed(port, server, people, minutes):
    """Say what the server holds in the quarters of a day without pauses, and after it."""
    await person(port, 0, 0, PAGES)
    watch = asyncio.create_task(watched(server.pid, 5.0))
    until = time.monotonic() + 60.0 * minutes
    turned = sum(await asyncio.gather(*(hurried(port, k, until) for k in range(people))))
    watch.cancel()
    quarters = np.array_split(await watch, 4)
    hours = turned / people * PAGE_EACH_S / 3600
    lines = [
        f"{turned} pages turned by {people} in {minutes:.0f} minutes",
        f"as many as in {hours:.1f} h with a page each {PAGE_EACH_S:.0f} s",
        *quarters_said(quarters),
    ]
    await asyncio.sleep(10.0)
    after, files, threads = held_by(server.pid)
    lines.append(f"after all have left: {after:.0f} MB, {files} open files, {threads} threads")
    sys.stdout.write("\n".join(lines) + "\n")


def quarters_said(quarters):
    """Return a line for each quarter of a run: means, and what stood at its end."""
    return [
        f"quarter {k} of the run: {mb:.0f} MB, {files:.0f} open files, {threads:.0f} threads; "
        f"at its end {notes[-1][0]:.0f} MB, {notes[-1][1]:.0f}, {notes[-1][2]:.0f}"
        for k, notes in enumerate(quarters, 1)
        if len(notes)
        for mb, files, threads in [notes.mean(axis=0)]
    ]


def held_by(pid):
    """Return what a process and its children hold: MB of memory, open files, threads."""
    mb, files, threads = 0.0, 0, 0
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            text = dict(
                line.split(":", 1) for line in status.read_text().splitlines() if ":" in line
            )
        except OSError:
            continue
        if int(text["Pid"]) == pid or int(text["PPid"]) == pid:
            mb += int(text.get("VmRSS", "0 kB").split()[0]) / 1024
            threads += int(text.get("Threads", "0"))
            with suppress(OSError):
                files += len([*(status.parent / "fd").iterdir()])
    return mb, files, threads


async def watched(pid, every_s):
    """Note what a server holds until this is cancelled; return its notes."""
    notes = []
    with suppress(asyncio.CancelledError):
        while True:
            notes.append(held_by(pid))
            await asyncio.sleep(every_s)
    return np.array(notes)


async def measure(port, server, people, clicks):
    await person(port, 0, 0, PAGES)
    alone = await person(port, 1, clicks)
    before = held_by(server.pid)[0]
    watch = asyncio.create_task(watched(server.pid, 5.0))
    every = await asyncio.gather(*(person(port, k, clicks) for k in range(people)))
    watch.cancel()
    quarters = np.array_split(await watch, 4)
    await asyncio.sleep(10.0)  # all have left
    after, files, threads = held_by(server.pid)
    seconds = np.concatenate([one for _, one in every])
    lines = [
        f"alone:      median {np.median(alone[1]):.2f} s, slowest {max(alone[1]):.2f} s a click",
        (
            f"{people} at once: median {np.median(seconds):.2f} s, slowest {seconds.max():.2f} s a "
            f"click, first page {max(f for f, _ in every):.2f} s"
        ),
        (
            f"server:     {before:.0f} MB with one, {after:.0f} MB after {people}: "
            f"{(after - before) / people:.1f} MB a person"
        ),
        *quarters_said(quarters),
        f"after all have left: {after:.0f} MB, {files} open files, {threads} threads",
        f"load of this machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores",
    ]
    sys.stdout.write("\n".join(lines) + "\n")


def main():
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("people", type=int, nargs="?", default=10)
    asked.add_argument("clicks", type=int, nargs="?", default=12)
    asked.add_argument("--minutes", type=float, help="a long day made short: no pauses")
    told = asked.parse_args()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "fieldmon", "app", "--no-browser", "--port",
                   str(port), "--seasons", folder]  # fmt: skip
        server = subprocess.Popen(command, stdout=subprocess.DEVNULL, process_group=0)
        try:
            for _ in range(600):
                try:
                    urllib.request.urlopen(f"http://127.0.0.1:{port}/_stcore/health", timeout=1)
                    break
                except OSError:
                    time.sleep(0.1)
            if told.minutes is None:
                asyncio.run(measure(port, server, told.people, told.clicks))
            else:
                asyncio.run(compressed(port, server, told.people, told.minutes))
        finally:
            os.killpg(server.pid, 15)
            server.wait(20)


if __name__ == "__main__":
    main()
