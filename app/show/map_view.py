"""The map on the page: which layers, what can be switched, what is written on it; one component.

What the person does on the map alone (zooming, switching layers, pointing, playing, drawing) is
the browser's; the server hears of taps, of finished drawings and of selections.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from itertools import chain, islice
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.compute.arrays import run_ends

from ..state import browser, chosen_units
from ..state.map_file import ADDRESS
from ..words import language, texts
from .ground import GroundShown
from .maps import deck

if TYPE_CHECKING:
    from collections.abc import Callable

    from pydeck import Layer

    from .maps.labels import Label
    from .maps.legends import LegendPart

    #: takes the layer's name and the number in it of what was tapped
    Tapped = Callable[[str, int], None]
    #: takes the kind of what was drawn and its corners, lon/lat
    Drawn = Callable[[str, tuple[tuple[float, float], ...]], None]
    #: takes the plants that were selected
    Selected = Callable[[tuple[int, ...]], None]

#: the one map of a page
KEY = "map"
# as many as the browser offers
_MOST_PICKED = 20_000
# The script is fetched once; the component is called with every answer of the server. The last
# call alone decides: Streamlit may end one that was overtaken after the next has begun, and may
# begin it after the next: Chromium brings a script that two ask for to either of them first. It is
# ended at once then, and what it overtook is shown. A fetch that fails is tried again, at another
# address, as a browser may remember the failure.
LOADER = """const load = (address, ms) => import(address).catch(async () => {
  await new Promise((done) => setTimeout(done, ms));
  return load(address.replace(/[?].*|$/, `?after=${ms}`), Math.min(2 * ms, 8000));
});
const show = async (place, component) => {
  const { mount } = await load(new URL("%s", location.href).href, 200);
  if (place.last === component) place.end = mount(component);
};
export default (component) => {
  const place = component.parentElement, before = place.last;
  place.last = component;
  show(place, component);
  return () => {
    if (place.last !== component) return;
    place.last = place.isConnected ? before : null;
    if (place.last) show(place, place.last);
    else place.end?.();
  };
}"""
_component = st.components.v2.component("fieldmon_map", html="", js=LOADER % ADDRESS)


@dataclass(frozen=True)
class Switch:
    """Layers that are switched together: name, words, their ids, and whether they are on first."""

    key: str
    label: str
    layers: tuple[str, ...]
    on: bool = True


@dataclass(frozen=True)
class Drawable:
    """What clicks draw: its kind (``point``, ``line``, ``area``), name, a hint, where it snaps.

    Of the kind ``bent`` it is a line that is there, `points`, and each change of it is heard.
    """

    kind: str
    name: str
    hint: str = ""
    snap: tuple[tuple[float, float], ...] = ()
    points: tuple[tuple[float, float], ...] = ()
    #: of an outline: how the lengths of its edges are written, see `UnitsInLanguage`
    lengths: tuple[tuple[float, float, str, str], ...] = ()


@dataclass(frozen=True, eq=False)
class Frames:
    """Days to slide over: a key for all of it, their names, each one's layers, the one shown first.

    A day's layers take the place of the map's layers of the same names.
    """

    key: str
    names: tuple[str, ...]
    layers: tuple[list[Layer], ...]
    now: int


@dataclass(frozen=True, eq=False)
class MapContent:
    """What a map shows.

    Parameters
    ----------
    place
        Names what is shown: the view stays as long as it is the same.
    bounds
        West, south, east, north of what must be in view.
    alt
        What the map says to those who do not see it.
    layers
        From below to above.
    switches, shades
        What can be switched; of the shades, one is on.
    legend, labels
        Signs with their meanings; words on the map, the most important first.
    play
        What plays a day, or None.
    frames
        The days of a season, to be slid over and played, or None.
    drive
        Where the browser finds a driven day (see `drive_play`); the map is then seen aslant.
    draw
        What clicks draw, or None.
    ground
        What lies under all of it.
    title, when
        What a picture of it is headed with.
    """

    place: str
    bounds: list[float]
    alt: str
    layers: list[Layer]
    switches: tuple[Switch, ...] = ()
    shades: tuple[Switch, ...] = ()
    legend: list[LegendPart] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)
    play: dict[str, object] | None = None
    frames: Frames | None = None
    drive: str | None = None
    draw: Drawable | None = None
    ground: GroundShown = field(default_factory=GroundShown)
    title: str = ""
    when: str = ""


@dataclass(frozen=True, eq=False)
class MapAnswers:
    """Who hears of what is done on the map; where nobody does, it cannot be done.

    `picked` are the plants that are selected by now.
    """

    tapped: Tapped | None = None
    drawn: Drawn | None = None
    selected: Selected | None = None
    picked: tuple[int, ...] = ()


def show(content: MapContent, answers: MapAnswers | None = None) -> None:
    """Show the map, or what has changed of it."""
    answers = answers or MapAnswers()
    _component(
        key=KEY, data=as_bytes(as_data(content, answers)), height="stretch",
        on_tapped_change=lambda: _heard(answers),
        on_drawn_change=lambda: _heard(answers),
        on_selected_change=lambda: _heard(answers),
        # the server had let go of something: the run that follows publishes it again
        on_missing_change=lambda: None,
        # the device turned dark or light: the run that follows draws in its colours
        on_turned_change=lambda: None,
    )  # fmt: skip


def as_bytes(data: dict[str, object]) -> bytes:
    """Return what the browser is sent as JSON of few bytes, written once.

    Streamlit writes what is no bytes twice: to send it, and to tell whether it is the same.
    """
    return json.dumps(data, ensure_ascii=False, separators=(",", ":")).encode()


def as_data(content: MapContent, answers: MapAnswers) -> dict[str, object]:
    """Return what the browser is sent."""
    below = content.ground
    return {
        "place": content.place,
        "bounds": content.bounds,
        "alt": content.alt,
        "layers": [deck.published(layer) for layer in (*below.layers, *content.layers)],
        "switches": [
            {"key": s.key, "label": s.label, "layers": [*s.layers], "off": not s.on}
            for s in (*content.switches, *_of_ground(below))
        ],
        "shades": [
            {"key": s.key, "label": s.label, "layers": [*s.layers]} for s in content.shades
        ],
        "ground": {"ids": [layer.id for layer in below.layers], "credit": below.credit,
                   "picture": below.is_picture, "worker": below.worker},
        "legend": content.legend,
        "labels": content.labels,
        "play": content.play,
        "frames": None if content.frames is None else _days(content.frames),
        "drive": content.drive,
        "draw": None if content.draw is None else _to_draw(content.draw),
        "taps": answers.tapped is not None,
        "select": answers.selected is not None,
        "picked": run_ends(np.unique(answers.picked)).tolist(),
        "title": content.title,
        "when": content.when,
        "dark": browser.is_dark(),
        "lengths": chosen_units.units().lengths(),
        "words": texts.MAP_WORDS,
        "working": texts.WORKING,
        "language": language.current(),
        "direction": "rtl" if language.is_right_to_left() else "ltr",
    }  # fmt: skip


def _of_ground(below: GroundShown) -> tuple[Switch, ...]:
    ids = tuple(layer.id for layer in below.layers)
    return (Switch("ground", texts.MAP_LAYERS["ground"], ids),) if ids else ()


def _to_draw(draw: Drawable) -> dict[str, object]:
    return {"id": draw.name, "kind": draw.kind, "hint": draw.hint,
            "snap": [list(p) for p in draw.snap], "points": [list(p) for p in draw.points],
            "lengths": [list(one) for one in draw.lengths]}  # fmt: skip


def _days(frames: Frames) -> dict[str, object]:
    days = [[deck.published(layer) for layer in layers] for layers in frames.layers]
    return {"key": frames.key, "names": [*frames.names], "layers": days, "now": frames.now}


def _heard(answers: MapAnswers) -> None:
    state = st.session_state[KEY]
    if (hit := state.get("tapped")) and answers.tapped:
        answers.tapped(str(hit["layer"]), int(hit["index"]))
    if (made := state.get("drawn")) and answers.drawn:
        points = tuple((float(lon), float(lat)) for lon, lat in made["points"])
        answers.drawn(str(made["kind"]), points)
    if (some := state.get("selected")) and answers.selected:
        runs = ((int(first), int(last)) for first, last in some["runs"])
        plants = chain.from_iterable(range(first, last + 1) for first, last in runs)
        answers.selected(tuple(islice(plants, _MOST_PICKED)))
