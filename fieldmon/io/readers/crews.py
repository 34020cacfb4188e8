"""Who works on a plot, and how long, as the columns of a plot file say."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import Imported, ImportMessage
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import is_missing, numbers, told_number
from fieldmon.io.readers.known_rows import left_aside
from fieldmon.io.readers.team import MOST, SETTINGS
from fieldmon.plot.robot import broken_rule

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
    wrong
        What no robot can be set to, a sentence by its setting of `Robot`; None where nothing is.
    left_aside
        Settings of `Robot` of which a column says no number, with what is wrong there; empty: it is
        left open. None where each says one.
    """

    who: str | None = None
    hours: float | None = None
    speed_km_h: float | None = None
    look_s: float | None = None
    wrong: dict[str, str] | None = None
    left_aside: dict[str, str] | None = None


def crews_of(layer: Layer, names: list[str]) -> Imported[dict[str, Crew]]:
    """Return who works on each of a layer's plots; `names` are those of its features."""
    wrong: list[ImportMessage] = []
    called = {plain(column): column for column in layer.columns}
    columns: dict[str, list[Any]] = {"who": [None] * len(names)}
    broken: list[dict[str, str]] = [{} for _ in names]
    aside: list[dict[str, str]] = [{} for _ in names]
    who = next((called[name] for name in _WHO if name in called), None)
    if who is not None:
        columns["who"] = [text(value) or None for value in layer.column(who)]
    for setting, synonyms in _NUMBERS.items():
        column = next((called[plain(s)] for s in synonyms if plain(s) in called), None)
        stated = np.full(len(names), np.nan)
        if column is not None:
            stated = _stated(layer.column(column), setting)
            wrong += left_aside(column, layer.column(column), ~np.isnan(stated), names)
            of_robot = SETTINGS[setting]
            for k, value in enumerate(stated.tolist()):
                if np.isnan(value):
                    aside[k][of_robot] = _unused(column, layer.column(column)[k])
                elif rule := broken_rule(of_robot, value, with_unit=True):
                    broken[k][of_robot] = worded(
                        "Column {column!r} must be {rule}, but it is {value:g}.",
                        column=column,
                        rule=rule,
                        value=value,
                    )
        columns[setting] = [None if np.isnan(value) else float(value) for value in stated]
    columns["wrong"] = [each or None for each in broken]
    columns["left_aside"] = [each or None for each in aside]
    rows = zip(*columns.values(), strict=True)
    crews = {name: Crew(*row) for name, row in zip(names, rows, strict=True)}
    return Imported(crews, tuple(wrong))


def _stated(cells: NDArray[np.object_], setting: str) -> NDArray[np.float64]:
    """Return a column's numbers; where one has another decimal mark than the rest, its own."""
    read = numbers(cells)
    for k in np.flatnonzero(np.isnan(read)).tolist():
        if not is_missing(cells[k]):
            with suppress(SettingError):
                read[k] = told_number(text(cells[k]), setting, MOST[setting])
    return read


def _unused(column: str, cell: object) -> str:
    """Return what of a cell was left aside, in a sentence; empty: it holds nothing."""
    if is_missing(cell):
        return ""
    return worded(
        "Column {column!r} was left aside: it says {cell!r}.", column=column, cell=text(cell)
    )
