"""Whether a weather table holds one station, or several that must be told apart."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import text
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.pests.weather import Times

_STATIONS = frozenset(
    {"stn", "station", "stationid", "stationsid", "stationname", "stationcode", "stationno"}
    | {"site", "siteid", "locationid", "estacion", "stazione", "תחנה", "محطة"}
    | {"sensor", "sensorid", "logger", "loggerid", "device", "deviceid"}
)
# more of the times than this stand twice: that is no double line of a logger
_MANY = 0.05
# of those a column leaves fewer than this if it tells them apart
_FEW = 0.1
_MOST_OFFERED = 50


def must_be_one_station(layer: Layer, at: Times, taken: Collection[str]) -> None:
    """Ask for one of several stations whose times stand side by side.

    Stations of which one begins after the other has ended are one that got another name.

    Parameters
    ----------
    layer
        The table.
    at
        ``(n,)`` when each of its rows was measured.
    taken
        Columns that hold times, the weather, or what was forecast.

    Raises
    ------
    ChoiceNeeded
        If the table holds several stations.
    """
    timed = ~np.isnat(at)
    for column in (name for name in layer.columns if plain(name) in _STATIONS):
        names = _names(layer, column)
        # what a sensor measured is no name
        is_reading = (numbers(layer.columns[column]) % 1 > 0).any()
        if not is_reading and _overlap(names[timed], at[timed]):
            said = worded(
                "{name} holds {n} stations ({shown}). Which is it?",
                name=layer.name,
                n=len(_counted(names)),
                shown=", ".join(_counted(names)[:5]),
            )
            raise _asked(said, column, names)
    free = [name for name in layer.columns if name not in taken]
    if (telling := _telling_apart(layer, at, timed, free)) is not None:
        names = _names(layer, telling)
        said = worded(
            "Many times of {name} stand more than once, told apart by {column} ({shown}). Which "
            "is it?",
            name=layer.name,
            column=telling,
            shown=", ".join(_counted(names)[:5]),
        )
        raise _asked(said, telling, names)


def _asked(said: str, column: str, names: NDArray[np.str_]) -> ChoiceNeeded:
    """Return the question which of the names in a column is meant."""
    offers = tuple(f"{column}={name}" for name in _counted(names)[:_MOST_OFFERED])
    return ChoiceNeeded(said, "where", offers)


def _names(layer: Layer, column: str) -> NDArray[np.str_]:
    return np.array([text(v) for v in layer.columns[column]], str)


def _counted(names: NDArray[np.str_]) -> list[str]:
    """Return the names that there are, the most frequent first."""
    return [name for name, _ in Counter(names.tolist()).most_common() if name]


def _overlap(names: NDArray[np.str_], at: Times) -> bool:
    """Return whether one of several names begins before another ends."""
    of: dict[str, list[int]] = {}
    for name, moment in zip(names.tolist(), at.astype(np.int64).tolist(), strict=True):
        of.setdefault(name, []).append(moment)
    spans = sorted((min(moments), max(moments)) for name, moments in of.items() if name)
    # by beginning: if any two overlap, two that follow each other do
    return any(begins <= end for (_, end), (begins, _) in pairwise(spans))


def _telling_apart(
    layer: Layer, at: Times, timed: NDArray[np.bool_], free: list[str]
) -> str | None:
    """Return the column that tells apart many times that stand more than once; None: none does."""
    when = at[timed]
    n_again = len(when) - len(np.unique(when))
    if n_again <= _MANY * len(when):
        return None
    fits = []
    for column in free:
        names = _names(layer, column)
        rows = set(zip(names[timed].tolist(), when.tolist(), strict=True))
        n_names = len(_counted(names))
        # names that do not come again tell rows apart, not stations
        if 2 <= n_names <= len(when) / 2 and len(when) - len(rows) < _FEW * n_again:
            is_number = bool(np.isfinite(numbers(layer.columns[column])).all())
            fits.append((is_number, n_names, column))
    return min(fits, key=lambda one: one[:2])[2] if fits else None
