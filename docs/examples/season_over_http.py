"""A robot that asks a season for plants and tells what it found, over plain HTTP.

Nothing but Python is needed on the robot. What could not be sent is sent again: each finding has
an id of its own, and the season takes it once.
"""

import json
import uuid
from contextlib import closing
from datetime import UTC, datetime
from http.client import HTTPConnection, HTTPException
from time import monotonic
from time import sleep as wait
from urllib.parse import urlsplit


class RefusedError(Exception):
    """The season will never take what was asked, as it is: the status, and why."""


class SeasonOverHttp:
    """A season at an address such as ``http://127.0.0.1:8501/api/v1/seasons/gate``, and its key."""

    def __init__(self, address, key):
        self.at, self.key = urlsplit(address), key

    def ask(self, what, body=None):
        """Get a document, or send one; tried until the season answers."""
        data = None if body is None else json.dumps(body).encode()
        headers = {"Authorization": f"Bearer {self.key}", "Content-Type": "application/json"}
        method, path = "GET" if data is None else "POST", f"{self.at.path}/{what}"
        while True:
            try:
                with closing(HTTPConnection(self.at.netloc, timeout=60)) as line:
                    line.request(method, path, data, headers)
                    answer = line.getresponse()
                    told = answer.read()
            except (OSError, HTTPException):
                wait(1.0)
                continue
            if answer.status == 200:
                return json.loads(told)
            if answer.status in {400, 401, 403, 404, 413, 422}:
                raise RefusedError(answer.status, told.decode())
            wait(1.0)

    def tell(self, plant, found):
        """Say what was seen at a plant; None: it could not be looked at."""
        now = datetime.now(UTC).isoformat()
        result = {True: "found", False: "clean", None: "skipped"}[found]
        finding = {"id": str(uuid.uuid4()), "at": now, "plant": plant, "result": result}
        return self.ask("findings", {"sent": now, "findings": [finding]})


def drive_day(season, go_and_look, hours=4.0, most=10_000):
    """Drive some hours: `go_and_look` is told a place (lon, lat), and returns what it saw there."""
    over = monotonic() + 3600 * hours
    plot, day = season.ask("plot"), season.ask("day")
    left = day["route"]["plants"]
    told = []
    while left and len(told) < most:
        plant = left.pop(0)
        place = plot["plants"]["lon"][plant], plot["plants"]["lat"][plant]
        found = go_and_look(place)
        season.tell(plant, found)
        told.append(plant)
        if found:  # the rest of the day, from all that is known now
            seconds = max(0, int(over - monotonic()))
            left = season.ask("route", {"seconds_left": seconds})["route"]["plants"]
    return told
