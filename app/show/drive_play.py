"""A driven day on the map: sent once, played by the browser (see `map_view/src/drive.js`)."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from fieldmon.drive.trace import Trace

from ..state.driving import DayInTime
from ..state.map_store import JSON, STORE
from ..words import texts
from . import field_map, map_layers
from .map_view import MapContent
from .maps import colours, legends, plant_layers
from .maps.plant_layers import PlantNotes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.samplers.base import Scene

    from ..state.choices import Choices
    from ..state.live_drive import LiveDrive

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
    """Return the plot, and where the browser asks every second how a robot's day goes."""

    def now() -> bytes:
        return json.dumps(as_live(live), separators=(",", ":")).encode()

    scene = live.scene
    nothing = as_data(scene, DayInTime(Trace(np.empty((0, 4)), ()), []))
    begins = _standing_at_gate(scene) | {"poll": STORE.attach(key, now)}
    first = STORE.publish(json.dumps(nothing | begins, separators=(",", ":")).encode(), JSON)
    alt = texts.DRIVE_ALT.format(name=choices.plot.field.name)
    return replace(content(choices, scene, None), drive=first, alt=alt)


def as_live(live: LiveDrive) -> dict[str, object]:
    """Return a day so far as `as_data` does, the way ordered, and how long ago it was heard."""
    day, (way, released), heard = live.seen()
    standing = heard.standing if live.running else "ended"
    scene, data = live.scene, as_data(live.scene, day)
    if len(day.trace.poses) < 2:  # nothing to move between
        data |= _standing_at_gate(scene, day.trace)
    return data | {
        "way": np.round(way, 7).tolist(),
        "released": released,
        "heard": {
            "standing": standing,
            "lag": None if heard.lag_s is None else round(heard.lag_s, 1),
            "said": heard.said,
        },
    }


def _standing_at_gate(scene: Scene, trace: Trace | None = None) -> dict[str, object]:
    """Return two poses at one place: the one that is known, or the gate."""
    if trace is not None and len(trace.poses):
        _, lon, lat, heading = trace.poses[0].tolist()
    else:
        (lon, lat), heading = scene.grid.frame.lonlat(scene.aisles.gate_m[None])[0].tolist(), 0.0
    return {"at": [0, 0.1], "lon": [lon] * 2, "lat": [lat] * 2, "heading": [heading] * 2}


def published(scene: Scene, day: DayInTime) -> str:
    """Return the address at which the browser finds a day."""
    if day not in _WRITTEN:
        _WRITTEN[day] = json.dumps(as_data(scene, day), separators=(",", ":")).encode()
    return STORE.publish(_WRITTEN[day], JSON)


def as_data(scene: Scene, day: DayInTime) -> dict[str, object]:
    """Return poses, stops and changes of the chance classes, each at its second of the day."""
    at_s, lon, lat, heading = day.trace.poses.T
    changes, before = [], _classes(scene.chance)
    for second, chance in day.believed:
        now = _classes(chance)
        plants = np.flatnonzero(now != before)
        changes.append([round(second, 1), plants.tolist(), now[plants].tolist()])
        before = now
    robot, spacing_m = scene.robot, min(scene.grid.plant_spacing_m, scene.grid.row_spacing_m)
    return {
        "at": np.round(at_s, 1).tolist(),
        "lon": np.round(lon, 7).tolist(),
        "lat": np.round(lat, 7).tolist(),
        "heading": np.round(heading, 1).tolist(),
        "stops": [[round(s.done_s, 1), s.plant, s.found] for s in day.trace.stops],
        "changes": changes,
        "end": round(day.trace.end_s, 1),
        "size": [robot.length_m or 0.8, robot.width_m or 0.6],
        "plant": [0.35 * spacing_m, _TALL_M],
        "found": list(colours.FOUND),
        "clean": list(colours.CLEAN),
    }


def _classes(chance: NDArray[np.float64]) -> NDArray[np.int64]:
    return colours.by_chance(chance).rank.astype(np.int64)
