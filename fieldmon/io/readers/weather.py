"""Weather out of tables as stations write them, and of IPM Decisions' JSON.

Decisions
---------
- A column is known by its name in several languages, its unit by brackets or the end of the name
  (``Temp (°C)``, ``wind_km_h``), or by a line of units below the names.
- Values that no weather on earth has are left out if they are few. If they are many, the unit or
  the column is wrong, and the file is refused.
- What services leave unsaid of their tables is in `weather_services`, times are in
  `weather_times`, units in `weather_units`, what was forecast in `weather_forecast`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import text
from fieldmon.io.formats.open_layer import open_layer
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    doubtful,
    dropped,
    seen,
)
from fieldmon.io.parse.values import numbers
from fieldmon.io.parse.weather_columns import (
    KIND_OF,
    UNITS,
    WeatherColumn,
    half_days,
    weather_columns,
)
from fieldmon.io.readers.running_rain import what_fell
from fieldmon.io.readers.weather_forecast import column_of_forecast, forecast_lines, is_forecast
from fieldmon.io.readers.weather_json import is_weather_json, rows_of_json
from fieldmon.io.readers.weather_rows import WeatherRows
from fieldmon.io.readers.weather_services import columns_of_service, service_of
from fieldmon.io.readers.weather_stations import must_be_one_station
from fieldmon.io.readers.weather_times import is_time_name, time_columns, times_of
from fieldmon.io.readers.weather_units import MOST_NONSENSE, is_rate, units_of
from fieldmon.io.sandbox.unpack import members
from fieldmon.pests.weather import HOUR_S, MEASURED

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import Source
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.io.readers.weather_services import WeatherService
    from fieldmon.io.readers.weather_times import TimesRead
    from fieldmon.io.sandbox.workroom import Workroom
    from fieldmon.pests.weather import Floats, Weather

# numbers that stand for what is missing: no weather is ever so
_MARKS = (-99999.0, -9999.9, -9999.0, -999.9, -999.0, -99.9, -99.0, 999.0, 999.9, 9999.0, 9999.9,
          99999.0)  # fmt: skip
_MARKS_OF_TENTHS = (-99999.0, -9999.0, -999.0, 9999.0, 99999.0)
_CALM = frozenset({"calm", "---", "windstill", "רגוע", "vrb"})
# a direction that turned all the time
_VARIABLE = 990.0
_POINTS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
           "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")  # fmt: skip


def weather_in(source: Source, options: WeatherOptions, workroom: Workroom) -> Imported[Weather]:
    """Return the weather of a source.

    Raises
    ------
    FileProblem
        If it holds no temperatures with times, or units or values that make no sense.
    ChoiceNeeded
        If it leaves open which unit, order of dates or place is meant.
    """
    found = members(source, workroom)
    if len(found) == 1 and is_weather_json(found[0].entries[0].head()):
        member = found[0]
        data = workroom.stage(member).read_bytes()
        rows, messages = rows_of_json(data, member.name, options)
        name = member.name
    else:
        layer = open_layer(source, options, workroom)
        rows, messages = rows_of_table(layer, options)
        messages = [*layer.messages, *messages]
        name = layer.name
    rows, more = _possible(rows, name)
    _must_have_temperatures(rows, name)
    weather, about = rows.gathered(name, options.now)
    return Imported(weather, (*messages, *more, *about))


def rows_of_table(layer: Layer, options: WeatherOptions) -> tuple[WeatherRows, list[ImportMessage]]:
    """Return the measurements of a table, in our units."""
    layer, messages = _first_table(layer)
    layer, units = _without_units(layer)
    service = service_of(layer)
    when = time_columns(layer, {one.name for one in weather_columns([*layer.columns], units)})
    names = [name for name in layer.columns if name not in when.names]
    columns, said = columns_of_service(layer, names, service, options)
    measures = {one.measure for one in columns}
    others = weather_columns([n for n in names if n not in {one.name for one in columns}], units)
    columns += [one for one in others if one.measure not in measures]
    _must_tell_whole_days(half_days(names), columns)
    names_read = ", ".join(one.name for one in columns) or "none"
    messages += [seen(worded("Columns of weather: {names}.", names=names_read)), *said]
    timed = times_of(layer, when, options, service)
    taken = {*when.names, *(one.name for one in columns)}
    telling = column_of_forecast(layer, taken)
    taken |= {*filter(is_forecast, layer.columns), *([telling] if telling else [])}
    must_be_one_station(layer, timed.at, taken)
    messages += timed.messages
    if _step_s(timed.at) > HOUR_S:
        messages += _about_one_extreme(columns)
    measured, said = _measured(layer, columns, timed, service, options)
    messages += said
    forecast, said = forecast_lines(layer, telling)
    messages += said
    return WeatherRows(timed.at, measured, forecast, timed.zone, options.zone or ""), messages


def _measured(
    layer: Layer,
    columns: list[WeatherColumn],
    timed: TimesRead,
    service: WeatherService,
    options: WeatherOptions,
) -> tuple[dict[str, Floats], list[ImportMessage]]:
    """Return what columns measure, in our units, by our names; and what to say of it."""
    measured: dict[str, Floats] = {}
    cells: dict[WeatherColumn, Floats] = {}
    messages: list[ImportMessage] = []
    for column in columns:
        if column.measure == "wind_from_deg":
            measured[column.measure] = _directions(layer, column, options)
            continue
        values = numbers(layer.columns[column.name], options.decimal)
        cells[column], said = _without_marks(values, column)
        messages += said
        if column.measure == "rain_mm" and not (service.title or is_rate(column, options)):
            cells[column], said = what_fell(
                column.name, cells[column], timed.at, options.rain_is, timed.zone
            )
            messages += said
    unit_of, said = units_of(cells, options)
    messages += said
    for column, unit in unit_of.items():
        measured[column.measure] = UNITS[unit].ours(cells[column], _step_s(timed.at))
    if service.tenths and "rain_mm" in measured:
        # -1 is less than could be measured
        measured["rain_mm"] = np.maximum(measured["rain_mm"], 0.0)
    return measured, messages


def _first_table(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return a table without names that stand again in it, until those of another begin."""
    named = np.zeros(len(layer), bool)
    for name in layer.columns:
        if is_time_name(name):
            named |= np.array([is_time_name(text(v)) for v in layer.columns[name]], bool)
    if not named.any():
        return layer, []
    rows = zip(*layer.columns.values(), strict=True)
    again = np.array([
        one and all(text(v) in {name, ""} for name, v in zip(layer.columns, row, strict=True))
        for one, row in zip(named, rows, strict=True)
    ])  # fmt: skip
    other = named & ~again
    end = int(np.argmax(other)) if other.any() else len(layer)
    kept = layer.take(np.flatnonzero(~again[:end]))
    if not other.any():
        return kept, []
    said = worded("Another table begins after record {n}; it was left out.", n=len(kept))
    return kept, [dropped(said)]


def _about_one_extreme(columns: list[WeatherColumn]) -> list[ImportMessage]:
    """Return a doubt about lows without highs, or highs without lows: one was not recognised."""
    name_of = {one.measure: one.name for one in columns}
    low, high = name_of.get("low_c"), name_of.get("high_c")
    if (mean := name_of.get("temperature_c")) is None or (low is None) == (high is None):
        return []
    if high is None:
        said = worded("{name} was read as the low and {mean} as the mean, but no column as the "
                      "high.", name=low, mean=mean)  # fmt: skip
    else:
        said = worded("{name} was read as the high and {mean} as the mean, but no column as the "
                      "low.", name=high, mean=mean)  # fmt: skip
    return [doubtful(said)]


def _must_tell_whole_days(halves: tuple[str, ...], columns: list[WeatherColumn]) -> None:
    """Refuse a table whose only temperatures are those of the day and of the night."""
    if halves and not any(KIND_OF[one.measure] == "temperature" for one in columns):
        raise FileProblem(
            worded(
                "Temperatures must be of whole days or hours, or highs and lows, but here they are "
                "of the day or the night alone ({names}). Name highs and lows Tmax and Tmin.",
                names=", ".join(halves),
            )
        )


def _step_s(at: NDArray[np.datetime64]) -> float:
    """Return how many seconds lie between measurements; of one, an hour."""
    steps = np.diff(np.unique(at[~np.isnat(at)])).astype(np.int64)
    return float(np.median(steps)) if len(steps) else 3600.0


def _without_marks(values: Floats, column: WeatherColumn) -> tuple[Floats, list[ImportMessage]]:
    """Return values without numbers that mark what is missing, and what is to be said."""
    marks = _MARKS_OF_TENTHS if column.unit.startswith("0.1") else _MARKS
    missing = np.isin(values, marks)
    if not missing.any():
        return values, []
    said = worded(
        "{n} {n:value|values} of {name} {n:is|are} missing, marked by {marks}.",
        n=int(np.count_nonzero(missing)),
        name=column.name,
        marks=", ".join(f"{mark:g}" for mark in np.unique(values[missing])),
    )
    return np.where(missing, np.nan, values), [seen(said)]


def _without_units(layer: Layer) -> tuple[Layer, dict[str, str]]:
    """Return a table without a line of units below its names, and what that line says."""
    if not len(layer):
        return layer, {}
    first = {name: text(values[0]) for name, values in layer.columns.items()}
    units = {name: cell for name, cell in first.items() if cell.strip("()[] ").casefold() in UNITS}
    some_number = any(np.isfinite(numbers(np.array([cell], object))[0]) for cell in first.values())
    if len(units) < 2 or some_number:
        return layer, {}
    bare = {name: cell.strip("()[] ") for name, cell in units.items()}
    return layer.take(np.arange(1, len(layer))), bare


def _directions(layer: Layer, column: WeatherColumn, options: WeatherOptions) -> Floats:
    """Return where the wind came from, degrees; compass points are read too, calm is none."""
    cells = [text(v) for v in layer.columns[column.name]]
    named = {point: 22.5 * i for i, point in enumerate(_POINTS)}
    values = numbers(np.array(cells, object), options.decimal)
    values[np.isin(values, (*_MARKS, _VARIABLE))] = np.nan
    if (unit := UNITS.get(column.unit)) is not None and unit.kind == "direction":
        values *= unit.factor
    for i, cell in enumerate(cells):
        if cell.casefold() in _CALM:
            values[i] = np.nan
        elif cell.upper() in named:
            values[i] = named[cell.upper()]
    return values


def _possible(rows: WeatherRows, name: str) -> tuple[WeatherRows, list[ImportMessage]]:
    """Return rows without values that no weather has; refuse them where those are many."""
    messages, measured = [], {}
    for measure, values in rows.measured.items():
        low, high = MEASURED[measure]
        wrong = ~np.isnan(values) & ((values < low) | (values > high))
        n, of = int(np.count_nonzero(wrong)), int(np.count_nonzero(~np.isnan(values)))
        # nothing needs the humidity
        if n > max(MOST_NONSENSE * of, 1) and measure != "humidity_pct":
            worst = float(values[wrong][0])
            raise FileProblem(
                worded(
                    "{name} must hold a {measure} of {low:g} to {high:g}, but {n} of {of} values "
                    "are beyond it (the first is {worst:g}). Is the unit right?",
                    name=name,
                    measure=measure,
                    low=low,
                    high=high,
                    n=n,
                    of=of,
                    worst=worst,
                )
            )
        if n:
            said = worded("{n} {n:value|values} of {measure} {n:is|are} impossible; left out.", n=n,
                          measure=measure)  # fmt: skip
            messages.append(dropped(said))
        measured[measure] = np.where(wrong, np.nan, values)
    kept = WeatherRows(rows.at, measured, rows.forecast, rows.zone, rows.zone_name)
    return kept, messages


def _must_have_temperatures(rows: WeatherRows, name: str) -> None:
    known = [rows.measured.get(one) for one in ("temperature_c", "low_c", "high_c")]
    if not any(values is not None and np.isfinite(values).any() for values in known):
        raise FileProblem(
            worded(
                "{name} must hold temperatures, but no column of them was found. Name one "
                "Temperature (C), or Tmin (C) and Tmax (C).",
                name=name,
            )
        )
    low, high = rows.measured.get("low_c"), rows.measured.get("high_c")
    if low is not None and high is not None and (low > high).any():
        row = int(np.flatnonzero(low > high)[0])
        raise FileProblem(
            worded(
                "{name} must have no low above its high, but in record {row} they are {low:g} and "
                "{high:g} °C.",
                name=name,
                row=row + 1,
                low=float(low[row]),
                high=float(high[row]),
            )
        )
