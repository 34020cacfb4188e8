"""A driven day on the map: sent once, played by the browser (see `map_view/src/drive.js`)."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np

from ..state.class_changes import ClassChanges
from ..state.map_store import JSON, STORE
from ..state.news_since import NewsSince
from ..words import texts
from . import field_map, map_layers
from .map_view import MapContent
from .maps import colours, legends, plant_layers
from .maps.plant_layers import PlantNotes

if TYPE_CHECKING:
    from fieldmon.drive.trace import Trace
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Scene

    from ..state.choices import Choices
    from ..state.class_changes import ClassChange
    from ..state.driving import DayInTime
    from ..state.live_drive import LiveDrive, SeenRobot

#: how tall plants are drawn
_TALL_M = 1.5
# days are not changed once driven; their texts go when they do
_WRITTEN: WeakKeyDictionary[DayInTime, bytes] = WeakKeyDictionary()


def content(choices: Choices, scene: Scene, day: DayInTime | None) -> MapContent:
    """Return the plot in the morning of a day, and the day to play once it is driven."""
    grid, dark = scene.grid, choices.dark
    shade = colours.by_chance(scene.chance, dark=dark)
    notes = PlantNotes(scene.chance)
    seen = legends.by_state()
    seen["items"] = seen["items"][:2]  # of the others their chances are shown
    common = field_map.of_plot(choices)
    if day is not None:
        common["alt"] = texts.DRIVE_ALT.format(name=choices.plot.field.name)
    return MapContent(
        **common,
        layers=[
            *map_layers.plan(choices), plant_layers.plants(grid, shade, notes, "plants-chance"),
            map_layers.gate(choices),
        ],
        legend=[{**legends.by_chance(dark=dark), "of": ""}, {**seen, "of": "", "title": ""},
                legends.gate()],
        labels=map_layers.words(choices),
        drive=None if day is None else published(scene, day),
    )  # fmt: skip


def live_content(choices: Choices, live: LiveDrive, key: str) -> MapContent:
    """Return the plot, and where the browser asks every second what is new of the robots' day."""
    news = live.news = live.news or NewsSince(partial(as_live, live))
    begins = news.whole() | {"poll": STORE.attach(key, news.since)}
    first = STORE.publish(json.dumps(begins, separators=(",", ":")).encode(), JSON)
    alt = texts.DRIVE_ALT.format(name=choices.plot.field.name)
    return replace(content(choices, live.scene, None), drive=first, alt=alt)


def as_live(live: LiveDrive) -> dict[str, object]:
    """Return the days so far as `as_data` does, and of each robot its way ordered and its standing.

    ``link`` says whether the robots are listened to.
    """
    seen, scene = live.seen(), live.scene
    robots = [
        _robot(k, one.name, one.trace, live.works_as(one.name)) | _ordered(one)
        for k, one in enumerate(seen)
    ]
    link = "unheard" if live.is_cut_off else "live" if live.running else "ended"
    return _data(scene, robots, live.changes(seen, colours.classes)) | {"link": link}


def _ordered(one: SeenRobot) -> dict[str, object]:
    (way, released), heard = one.way, one.heard
    lag = None if heard.lag_s is None else round(heard.lag_s, 1)
    told = {"standing": heard.standing, "lag": lag, "said": heard.said}
    return {"way": np.round(way, 7).tolist(), "released": released, "heard": told}


def published(scene: Scene, day: DayInTime) -> str:
    """Return the address at which the browser finds a day."""
    if day not in _WRITTEN:
        _WRITTEN[day] = json.dumps(as_data(scene, day), separators=(",", ":")).encode()
    return STORE.publish(_WRITTEN[day], JSON)


def as_data(scene: Scene, day: DayInTime) -> dict[str, object]:
    """Return a day as the browser plays it: of one robot, which needs no name."""
    changes = ClassChanges(colours.classes(scene.chance))
    for at_s, chance in day.believed:
        changes.add(at_s, colours.classes(chance))
    return _data(scene, [_robot(0, "", day.trace, scene.robot)], changes.so_far)


def _robot(k: int, name: str, trace: Trace, robot: Robot) -> dict[str, Any]:
    """Return a robot's poses and stops, each at its second of the day."""
    at_s, lon, lat, heading = trace.poses.T
    return {
        "name": texts.isolated(name) if name else "",
        "colours": colours.of_robot(k),
        "size": [robot.length_m or 0.8, robot.width_m or 0.6],
        "at": np.round(at_s, 1).tolist(),
        "lon": np.round(lon, 7).tolist(),
        "lat": np.round(lat, 7).tolist(),
        "heading": np.round(heading, 1).tolist(),
        "unseen": list(trace.unseen),
        "stops": [[round(s.done_s, 1), s.plant, s.found] for s in trace.stops],
        "end": round(trace.end_s, 1),
    }


def _data(
    scene: Scene, robots: list[dict[str, Any]], changes: list[ClassChange]
) -> dict[str, object]:
    """Return the days of robots by one clock, and the changes of the chance classes."""
    spacing_m = min(scene.grid.plant_spacing_m, scene.grid.row_spacing_m)
    stops = [[*stop, k] for k, one in enumerate(robots) for stop in one["stops"]]
    return {
        "robots": [{name: one[name] for name in one if name not in {"stops", "end"}}
                   for one in robots],
        "stops": sorted(stops, key=lambda one: one[0]),
        "changes": [[round(one.at_s, 1), one.plants.tolist(), one.classes.tolist()]
                    for one in changes],
        "end": max([0.0, *(one["end"] for one in robots)]),
        "plant": [0.35 * spacing_m, _TALL_M],
        "found": list(colours.FOUND),
        "clean": list(colours.CLEAN),
    }  # fmt: skip
