"""A pest and the weather it meets, as JSON in a season's settings and back."""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.pests.pest import Citation, Entry, Increase, Movement, Pest, Stage
from fieldmon.pests.weather import MEASURED, Weather, weather_of
from fieldmon.plot.robot import Viewpoints

if TYPE_CHECKING:
    from collections.abc import Sequence

#: a hundredth of a degree, a millimetre or a metre a second is less than any station tells
_DECIMALS = 2


def pest_json(pest: Pest | None) -> dict[str, Any] | None:
    """Return a pest as plain values."""
    return None if pest is None else asdict(pest)


def pest_of_json(plain: dict[str, Any] | None) -> Pest | None:
    """Return the pest that `pest_json` wrote."""
    if plain is None:
        return None
    stages = tuple(Stage(**one) for one in plain["stages"])
    movement = {**plain["movement"], "hours": tuple(plain["movement"]["hours"])}
    made: dict[str, Any] = {
        "stages": stages,
        "movement": Movement(**movement),
        "entry": Entry(**plain["entry"]),
        "citations": tuple(Citation(**one) for one in plain["citations"]),
    }
    if plain["increase"] is not None:
        made["increase"] = Increase(**{name: tuple(v) for name, v in plain["increase"].items()})
    if plain["generation"] is not None:
        made["generation"] = Stage(**plain["generation"])
    if plain["viewpoints"] is not None:
        steps = tuple((float(s), float(p)) for s, p in plain["viewpoints"]["steps"])
        made["viewpoints"] = Viewpoints(steps, plain["viewpoints"]["longer"])
    return Pest(**{**plain, **made})


def weather_json(weather: Weather | None) -> dict[str, Any] | None:
    """Return weather as plain values: times in seconds, what was not measured as null."""
    if weather is None:
        return None
    measured = {
        name: _plain(values)
        for name in MEASURED
        if np.isfinite(values := getattr(weather, name)).any()
    }
    return {
        "at": weather.at.astype("datetime64[s]").astype(np.int64).tolist(),
        "step_s": weather.step_s,
        "zone": weather.zone,
        "forecast": np.flatnonzero(weather.forecast).tolist(),
        "measured": measured,
    }


def weather_of_json(plain: dict[str, Any] | None) -> Weather | None:
    """Return the weather that `weather_json` wrote."""
    if plain is None:
        return None
    at = np.array(plain["at"], np.int64).astype("datetime64[s]")
    forecast = np.zeros(len(at))
    forecast[plain["forecast"]] = 1.0
    # None becomes NaN
    measured = {name: np.array(values, float) for name, values in plain["measured"].items()}
    return weather_of(at, plain["step_s"], plain["zone"], forecast=forecast, **measured)


@lru_cache(maxsize=4)
def kept_weather(text: str) -> Weather | None:
    """Return the weather of a season file's JSON, which is read at every look into the file."""
    return weather_of_json(json.loads(text))


def _plain(values: Sequence[float]) -> list[float | None]:
    rounded = np.round(np.asarray(values, float), _DECIMALS)
    return [None if np.isnan(one) else float(one) for one in rounded]
