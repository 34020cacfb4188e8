"""Who works on a plot, and how long, as the columns of a plot file say."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import Imported, ImportMessage
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers
from fieldmon.io.readers.known_rows import left_aside

if TYPE_CHECKING:
    from fieldmon.io.formats.layer import Layer

_WHO = ("robot", "crew", "who", "worker", "inspector")
_NUMBERS = {
    "hours": ("hours", "hours_per_day", "working_hours", "work_hours", "day_hours", "hours_day"),
    "speed_km_h": ("speed_km_h", "speed_kmh", "speed", "speed_km_per_h"),
    "look_s": ("look_s", "look", "look_seconds", "seconds_per_plant"),
}


class Crew(NamedTuple):
    """Who works on one plot; None where the file does not say.

    Parameters
    ----------
    who
        As the file has it: ``robot``, ``scout``, or anything else.
    hours
        Working hours a day.
    speed_km_h, look_s
        Driving speed, and seconds spent looking at a plant.
    """

    who: str | None = None
    hours: float | None = None
    speed_km_h: float | None = None
    look_s: float | None = None


def crews_of(layer: Layer, names: list[str]) -> Imported[dict[str, Crew]]:
    """Return who works on each of a layer's plots; `names` are those of its features."""
    wrong: list[ImportMessage] = []
    called = {plain(column): column for column in layer.columns}
    columns: dict[str, list[str | float | None]] = {"who": [None] * len(names)}
    who = next((called[name] for name in _WHO if name in called), None)
    if who is not None:
        columns["who"] = [text(value) or None for value in layer.column(who)]
    for setting, synonyms in _NUMBERS.items():
        column = next((called[plain(s)] for s in synonyms if plain(s) in called), None)
        stated = np.full(len(names), np.nan) if column is None else numbers(layer.column(column))
        if column is not None:
            wrong += left_aside(column, layer.column(column), ~np.isnan(stated), names)
        columns[setting] = [None if np.isnan(value) else float(value) for value in stated]
    rows = zip(*columns.values(), strict=True)
    crews = {name: Crew(*row) for name, row in zip(names, rows, strict=True)}
    return Imported(crews, tuple(wrong))
