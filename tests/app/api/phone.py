"""A phone as its page behaves, for tests: it forgets only what the server says it has on disk."""

import asyncio
import json
import random
import uuid
from datetime import UTC, datetime

from app.api.season_api import application
from fieldmon.monitoring.file import connections
from tests.app.api.asking import Cut, exchange, of_season, scope_of

#: how a request may end
ENDINGS = ("cut before", "cut in mid-body", "answer lost", "stopped", "full disk", "500", "well")


class Phone:
    """Records made offline, each with its id, and what the server has not confirmed yet."""

    def __init__(self, key, seed=0):
        self.key, self.chance = key, random.Random(seed)
        self.findings, self.photos = {}, {}
        self.waiting, self.waiting_photos = {}, {}
        self.disconnects = 0

    def record(self, plant, result="clean", *, photo=False):
        name, now = str(uuid.UUID(int=self.chance.getrandbits(128))), datetime.now(UTC).isoformat()
        one = {"id": name, "plant": plant, "at": now, "result": result, "on": "2026-04-06"}
        self.findings[one["id"]] = self.waiting[one["id"]] = one
        if photo:
            name = str(uuid.UUID(int=self.chance.getrandbits(128)))
            data = b"\xff\xd8\xff" + self.chance.randbytes(30_000)
            self.photos[name] = self.waiting_photos[name] = (one["id"], data)
        return one["id"]

    async def send(self, ending):
        """Send something that waits; it ends as told. Photos may go before their findings."""
        if self.waiting_photos and (not self.waiting or self.chance.random() < 0.4):
            name = self.chance.choice([*self.waiting_photos])
            of, data = self.waiting_photos[name]
            query = f"finding={of}&at=2026-04-06T06:00:00Z"
            parts = [data[k : k + 8000] for k in range(0, len(data), 8000)]
            answer = await self._ask("PUT", f"photos/{name}", (query, parts), ending)
            if answer:
                self.waiting_photos.pop(name)
            return
        some = self.chance.sample([*self.waiting.values()], min(len(self.waiting), 7))
        body = json.dumps({"sent": datetime.now(UTC).isoformat(), "findings": some}).encode()
        parts = [body[k : k + 300] for k in range(0, len(body), 300)]
        answer = await self._ask("POST", "findings", ("", parts), ending)
        for one in answer["taken"] if answer else ():
            assert one["problem"] == ""
            self.waiting.pop(one["id"], None)

    async def _ask(self, method, path, sent, ending):
        """Return the server's answer, or None where it did not come."""
        query, parts = sent
        scope = scope_of(method, of_season(path), {"authorization": f"Bearer {self.key}"}, query)
        cut = {"cut before": 0, "cut in mid-body": self.chance.randrange(1, len(parts) + 1)}
        cut_after = cut.get(ending)
        if cut_after == len(parts):
            cut_after -= 1
        self.disconnects += ending != "well"
        if ending == "500":
            return None
        with _at_the_server(ending, self.chance):
            try:
                answer = await exchange(application(), scope, parts, cut_after=cut_after)
            except (Cut, asyncio.CancelledError):
                return None
        if ending == "answer lost" or answer.status in {499, 500, 503}:
            return None
        assert answer.status == 200, answer.body
        return answer.json


class _at_the_server:  # noqa: N801 - reads as what it is
    """What happens to the server: its disk is full, or it is stopped within a statement."""

    def __init__(self, ending, chance):
        self.ending, self.steps = ending, chance.randrange(1, 60)

    def __enter__(self):
        self.kept = connections.connect
        if self.ending in {"full disk", "stopped"}:
            connections.connect = self._connect

    def __exit__(self, *_):
        connections.connect = self.kept

    def _connect(self, *of):
        db = self.kept(*of)
        if self.ending == "full disk":
            pages = db.execute("PRAGMA page_count").fetchone()[0]
            db.execute(f"PRAGMA max_page_count = {pages}")
        else:
            # as kill -9 leaves it: whatever was not committed is rolled back by who opens it next
            db.set_progress_handler(lambda: 1, self.steps * 50)
        return db
