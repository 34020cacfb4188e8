"""Asking the interface of a season as a phone would, without a network; and losing the line."""

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from datetime import UTC, datetime
from urllib.parse import quote

from app.api.description import PATH
from app.api.season_api import application


@dataclass(frozen=True)
class Answered:
    status: int
    headers: dict
    body: bytes

    @property
    def json(self):
        return json.loads(self.body)


class Cut(Exception):  # noqa: N818 - what it is
    """The line was cut."""


async def exchange(app, scope, parts, *, cut_after=None):
    """Send a request part by part; `cut_after` parts the sender is gone."""
    sent, waiting = [], list(parts)

    async def receive():
        if cut_after is not None and len(parts) - len(waiting) >= cut_after:
            return {"type": "http.disconnect"}
        if not waiting:
            return {"type": "http.disconnect"}
        body = waiting.pop(0)
        return {"type": "http.request", "body": body, "more_body": bool(waiting)}

    async def send(message):
        sent.append(message)

    await app(scope, receive, send)
    if not sent:
        raise Cut
    body = b"".join(m.get("body", b"") for m in sent if m["type"] == "http.response.body")
    headers = {k.decode(): v.decode() for k, v in sent[0]["headers"]}
    return Answered(sent[0]["status"], headers, body)


def scope_of(method, path, headers, query=""):
    raw = {"host": "127.0.0.1:8501"} | {k.lower(): v for k, v in headers.items()}
    return {
        "type": "http", "method": method, "path": path, "raw_path": quote(path).encode(),
        "query_string": query.encode(), "root_path": "", "scheme": "http", "http_version": "1.1",
        "headers": [(k.encode(), v.encode()) for k, v in raw.items()],
        "server": ("127.0.0.1", 8501), "client": ("127.0.0.1", 5000),
    }  # fmt: skip


def in_own_loop(make):
    """Run a coroutine in a thread of its own: a browser's tests leave a loop running here."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(lambda: asyncio.run(make())).result()


def ask(method, path, *, key="", body=b"", query="", **headers):
    """Return what the interface answers."""
    if not isinstance(body, bytes):
        body = json.dumps(body).encode()
    named = {k.replace("_", "-"): v for k, v in headers.items()}
    if key:
        named["authorization"] = f"Bearer {key}"
    scope = scope_of(method, path, named, query)
    return in_own_loop(lambda: exchange(application(), scope, [body]))


def of_season(what, season="season"):
    return f"{PATH}/seasons/{season}/{what}"


def as_sent(*findings, sent=None):
    """Return findings as a phone sends them."""
    names = {0: "clean", 1: "found", 2: "skipped", None: None}
    return {
        "sent": (sent or datetime.now(UTC)).isoformat(),
        "findings": [
            {
                "id": one.id, "at": one.at.isoformat(), "plant": one.plant,
                "result": names[one.result], "count": one.count, "notes": one.notes,
                "on": None if one.on is None else str(one.on), "undoes": one.undoes,
            }
            for one in findings
        ],
    }  # fmt: skip
