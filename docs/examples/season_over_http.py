"""A robot that asks a season for plants and tells what it found, over plain HTTP.

Nothing but Python is needed on the robot. What could not be sent is sent again: each finding has
an id of its own, and the season takes it once.
"""

import json
import uuid
from datetime import UTC, datetime
from time import sleep as wait
from urllib.error import URLError
from urllib.request import Request, urlopen


class SeasonOverHttp:
    """A season at an address such as ``http://127.0.0.1:8501/api/v1/seasons/gate``, and its key."""

    def __init__(self, address, key):
        self.address, self.key = address, key

    def ask(self, what, body=None):
        """Get a document, or send one; tried until the season answers."""
        data = None if body is None else json.dumps(body).encode()
        headers = {"Authorization": f"Bearer {self.key}", "Content-Type": "application/json"}
        while True:
            try:
                with urlopen(
                    Request(f"{self.address}/{what}", data, headers), timeout=60
                ) as answer:
                    return json.load(answer)
            except URLError as error:
                if getattr(error, "code", 503) in {401, 403, 404, 413, 422}:
                    raise  # it will never be taken as it is
                wait(1.0)

    def tell(self, plant, found):
        """Say what was seen at a plant; None: it could not be looked at."""
        now = datetime.now(UTC).isoformat()
        result = {True: "found", False: "clean", None: "skipped"}[found]
        finding = {"id": str(uuid.uuid4()), "at": now, "plant": plant, "result": result}
        return self.ask("findings", {"sent": now, "findings": [finding]})


def drive_day(season, go_and_look, most=10_000):
    """Drive a day: `go_and_look` is told a place (lon, lat), and returns what was seen there."""
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
            left = season.ask("route", {})["route"]["plants"]
    return told
