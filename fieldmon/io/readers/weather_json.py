"""Weather as the platform IPM Decisions exchanges it.

Its JSON (weatherDataSchema.json, version 0.1, github.com/H2020-IPM-Decisions/WeatherService) has
``timeStart``, an ``interval`` in seconds, ``weatherParameters`` by number, and for each place rows
of values in their order.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import ImportMessage, doubtful
from fieldmon.io.parse.clock import zone_of
from fieldmon.io.readers.weather_rows import WeatherRows
from fieldmon.pests.weather import DAY_S

if TYPE_CHECKING:
    from fieldmon.io.readers.weather_options import WeatherOptions

#: numbers of parameters in weather_parameters_draft_v2.yaml; of several the first is taken
PARAMETERS = {
    "temperature_c": (1002, 1001, 1022, 1021),
    "low_c": (1003, 1023),
    "high_c": (1004, 1024),
    "rain_mm": (2001,),
    "humidity_pct": (3002, 3001, 3022, 3021),
    "wind_speed_m_s": (4003, 4002, 4013, 4012),
    "wind_from_deg": (4001, 4011),
}
_LEAST_STEP_S = 60
# quality control: 1 and 2 passed, from 4 on bits of tests that failed
_FAILED = ~3


def is_weather_json(head: bytes) -> bool:
    """Return whether a file begins as IPM Decisions' weather does."""
    return head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") and (
        b'"weatherParameters"' in head or b'"timeStart"' in head
    )


def rows_of_json(
    data: bytes, name: str, options: WeatherOptions
) -> tuple[WeatherRows, list[ImportMessage]]:
    """Return the measurements of a file; raise `FileProblem` where it is not of that format."""
    try:
        told = json.loads(data)
        at = datetime.fromisoformat(told["timeStart"])
        step, numbers = _step(told["interval"]), [int(one) for one in told["weatherParameters"]]
        place = _place(told["locationWeatherData"] or [], name, options)
        rows = place["data"] or []
        table = np.array(
            [[np.nan if v is None else float(v) for v in row] for row in rows], float
        ).reshape(len(rows), len(numbers))
    except (ValueError, KeyError, TypeError, IndexError, OverflowError, RecursionError) as error:
        raise FileProblem(
            worded(
                "{name} must be weather as IPM Decisions writes it (timeStart, interval, "
                "weatherParameters, locationWeatherData), but it is not ({error}).",
                name=name,
                error=f"{type(error).__name__}: {error}",
            )
        ) from error
    zone = zone_of(options.zone) if options.zone else UTC
    begins = int((at if at.tzinfo else at.replace(tzinfo=zone)).timestamp())
    times = (begins + step * np.arange(len(table))).astype("datetime64[s]")
    measured = {
        measure: table[:, numbers.index(known[0])]
        for measure, ids in PARAMETERS.items()
        if (known := [one for one in ids if one in numbers])
    }
    forecast = np.zeros(len(table), bool)
    rows = WeatherRows(times, measured, forecast, zone, options.zone or "")
    return rows, _about_quality(place, told, numbers)


def _step(told: str | float) -> int:
    """Return the seconds from one value to the next."""
    step = int(told)
    if not _LEAST_STEP_S <= step <= DAY_S:
        raise ValueError(f"an interval of {step} s")
    return step


def _place(places: list[dict[str, Any]], name: str, options: WeatherOptions) -> dict[str, Any]:
    """Return the place that is meant."""
    choices = tuple(str(i + 1) for i in range(len(places)))
    if len(places) == 1 and options.location is None:
        return places[0]
    if options.location in choices:
        return places[int(options.location or 1) - 1]
    if not places:
        raise FileProblem(worded("{name} must hold a place's weather, but holds none.", name=name))
    shown = "; ".join(f"{i + 1}: {p['latitude']}, {p['longitude']}" for i, p in enumerate(places))
    raise ChoiceNeeded(
        worded(
            "{name} holds the weather of {n} places ({shown}). Choose one.",
            name=name,
            n=len(places),
            shown=shown,
        ),
        "location",
        choices,
    )


def _about_quality(
    place: dict[str, Any], told: dict[str, Any], numbers: list[int]
) -> list[ImportMessage]:
    marks = place.get("qc") or told.get("qc") or []
    failed = [
        number
        for number, mark in zip(numbers, marks, strict=False)
        if isinstance(mark, int) and mark & _FAILED
    ]
    if not failed:
        return []
    shown = ", ".join(map(str, failed))
    said = worded("Its own quality control doubts the parameters {shown}.", shown=shown)
    return [doubtful(said)]
