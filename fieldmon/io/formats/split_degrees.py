"""Degrees, minutes and seconds that stand in columns of their own, put together."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import seen
from fieldmon.io.parse.values import numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_AXES = {
    "lat": "lat latitude latitud latitudine breite breitengrad",
    "lon": "lon long lng longitude longitud longitudine laenge länge längengrad laengengrad",
}
_UNITS = {
    "degrees": "d deg degs degree degrees grad grado grados gradi graus",
    "minutes": "m min mins minute minutes minuten minuto minutos minuti",
    "seconds": "s sec secs second seconds sek sekunden seg segundo segundos secondi",
    "letter": "dir direction hem hemi hemisphere ns ew nsew card",
}
_SIGNS = {"°": "deg", "º": "deg", "'": "min", "′": "min", "’": "min", '"': "sec", "″": "sec"}
_AXIS_OF = {word: axis for axis, words in _AXES.items() for word in words.split()}
_UNIT_OF = {word: unit for unit, words in _UNITS.items() for word in words.split()}
_ALL = 60.0
_FARTHEST = {"lat": 90.0, "lon": 180.0}


def with_degrees(layer: Layer) -> Layer:
    """Return a table with degrees, minutes and seconds of two places put into columns lat and lon.

    As it is where not both have a column of whole degrees and one of minutes.
    """
    parts = _parts(list(layer.columns))
    each = ((axis, _together(layer, axis, own)) for axis, own in parts.items())
    made = {axis: values for axis, values in each if values is not None}
    if set(made) != set(_AXES):
        return layer
    used = [name for axis in parts for name in parts[axis].values()]
    said = seen(
        worded(
            "Degrees and minutes in columns of their own were put together: {names}.",
            names=", ".join(map(repr, used)),
        )
    )
    columns = {name: values for name, values in layer.columns.items() if name not in used}
    return replace(layer, columns={**made, **columns}, messages=(*layer.messages, said))


def names_degrees(name: str) -> bool:
    """Return whether a column's name says that it holds degrees, minutes or seconds of an axis."""
    axis, unit = _meant(name)
    return axis is not None and unit is not None


def _parts(names: list[str]) -> dict[str, dict[str, str]]:
    """Return the columns of each axis by their units; those of no axis follow the one before."""
    found: dict[str, dict[str, str]] = {}
    current = None
    for name in names:
        axis, unit = _meant(name)
        current = axis or (current if unit is not None else None)
        if current is not None and unit is not None:
            found.setdefault(current, {}).setdefault(unit, name)
    return {axis: own for axis, own in found.items() if {"degrees", "minutes"} <= own.keys()}


def _meant(name: str) -> tuple[str | None, str | None]:
    """Return which axis and which unit a column's name says; None: neither, or not that."""
    bare = re.sub(r"_\d+$", "", name.casefold())
    for sign, word in _SIGNS.items():
        bare = bare.replace(sign, word)
    plain = "".join(c for c in bare if c.isalnum())
    if plain in _AXIS_OF:
        return _AXIS_OF[plain], "degrees"
    if plain in _UNIT_OF and len(plain) > 1:
        return None, _UNIT_OF[plain]
    for k in range(1, len(plain)):
        for one, other in ((plain[:k], plain[k:]), (plain[k:], plain[:k])):
            if one in _AXIS_OF and other in _UNIT_OF:
                return _AXIS_OF[one], _UNIT_OF[other]
    return None, None


def _together(layer: Layer, axis: str, own: dict[str, str]) -> NDArray[np.object_] | None:
    """Return the degrees of an axis ``(n,)``, or what is written where that is none.

    None where they are no whole ones: minutes are none of theirs.
    """
    cells = [text(value) for value in layer.columns[own["degrees"]]]
    degrees = _numbers(cells)
    there = np.isfinite(degrees)
    if not there.any() or (degrees[there] != np.round(degrees[there])).any():
        return None
    written = {unit: [text(value) for value in layer.columns[name]] for unit, name in own.items()}
    minutes = _numbers(written["minutes"])
    seconds = _numbers(written["seconds"]) if "seconds" in own else np.zeros(len(cells))
    value = np.abs(degrees) + (minutes + seconds / _ALL) / _ALL
    good = (minutes >= 0) & (minutes < _ALL) & (seconds >= 0) & (seconds < _ALL)
    good &= value <= _FARTHEST[axis]
    negative = np.array([cell.startswith(("-", "−")) for cell in cells])
    if "letter" in own:
        letters = [cell[:1].upper() for cell in written["letter"]]
        good &= np.isin(letters, ["N", "S"] if axis == "lat" else ["E", "W"])
        negative |= np.isin(letters, ["S", "W"])
    made = np.array([" / ".join(each) for each in zip(*written.values(), strict=True)], object)
    made[[not each.strip(" /") for each in made]] = None
    made[good] = np.where(negative, -value, value)[good]
    return made


def _numbers(cells: list[str]) -> Floats:
    return numbers(np.array([cell.strip("°º'′’\"″ ") for cell in cells], object))
