"""Weather out of tables as stations write them, and of IPM Decisions' JSON.

Decisions
---------
- A column is known by its name in several languages, its unit by brackets or the end of the name
  (``Temp (°C)``, ``wind_km_h``), or by a line of units below the names. A unit of something else
  is refused. Without one, temperatures tell theirs if they can; a wind is left out until its unit
  is told, for nothing tells it; rain is taken as mm, and it is said.
- Values that no weather on earth has are left out if they are few. If they are many, the unit or
  the column is wrong, and the file is refused.
- Times that name no zone are the plot's. A time is when its hour begins.
"""

from __future__ import annotations

import re
from datetime import UTC
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import text
from fieldmon.io.formats.open_layer import open_layer
from fieldmon.io.import_report import Imported, ImportMessage, Remedy, dropped, guessed, seen
from fieldmon.io.parse.clock import clock_time, is_clock_alone, local_time, zone_of
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.parse.values import dates, numbers
from fieldmon.io.parse.weather_columns import (
    KIND_OF,
    UNITS,
    WRITTEN,
    WeatherColumn,
    weather_columns,
)
from fieldmon.io.readers.weather_json import is_weather_json, rows_of_json
from fieldmon.io.readers.weather_rows import WeatherRows, utc_times
from fieldmon.io.sandbox.unpack import members
from fieldmon.pests.weather import MEASURED

if TYPE_CHECKING:
    from datetime import tzinfo

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import Source
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.io.sandbox.workroom import Workroom
    from fieldmon.pests.weather import Floats, Weather

# as a share of what was measured: more than so much nonsense is a wrong unit
_MOST_NONSENSE = 0.05
# without a unit: no place is warmer than this on average, or ever
_WARMEST_MEAN_C, _WARMEST_C, _SURELY_F = 35.0, 50.0, 60.0
# no station measured before, and nobody forecasts so far
_FIRST_DAY, _LAST_DAY = np.datetime64("1850-01-01"), np.datetime64("2150-01-01")
_CALM = frozenset({"calm", "---", "windstill", "רגוע"})
_POINTS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
           "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")  # fmt: skip
_FORECAST_COLUMN = re.compile(r"forecast|prognos|vorhersage|prevision|pronostico|תחזית|توقع")
_FORECAST_WORDS = re.compile(r"^(1|true|yes|y|f|fc|forecast.*|prognos.*|vorhersage.*|pr[eé]v.*)$")


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
    layer, units = _without_units(layer)
    names = [*layer.columns]
    columns = weather_columns(names, units)
    timed = _times(layer, options, {one.name for one in columns})
    measured, messages = {}, list(timed.messages)
    for column in columns:
        if column.measure == "wind_from_deg":
            measured[column.measure] = _directions(layer, column)
            continue
        values = numbers(layer.columns[column.name], options.decimal)
        unit, said = _unit_of(column, values, options)
        messages += said
        if unit:
            own = UNITS[unit]
            measured[column.measure] = values * own.factor + own.offset
    names_read = ", ".join(one.name for one in columns) or "none"
    messages.insert(0, seen(worded("Columns of weather: {names}.", names=names_read)))
    forecast = _forecast(layer)
    return WeatherRows(timed.at, measured, forecast, timed.zone, options.zone or ""), messages


class _TimesRead(NamedTuple):
    """Times ``(n,)`` UTC, the zone of the place, and what there is to say."""

    at: NDArray[np.datetime64]
    zone: tzinfo
    messages: list[ImportMessage]


def _times(layer: Layer, options: WeatherOptions, taken: set[str]) -> _TimesRead:
    zone = zone_of(options.zone) if options.zone else UTC
    cells, is_utc = _time_cells(layer, frozenset(taken))
    distinct = np.array(cells, dtype=object)
    read = dates(distinct, options.date_order)
    if read.is_ambiguous:
        raise ChoiceNeeded(
            worded(
                "Dates of {name} could be day or month first ({example}). Which is it?",
                name=layer.name,
                example=cells[0],
            ),
            "date_order",
            ("dmy", "mdy"),
        )
    clocks = {cell: clock_time(cell) for cell in set(cells)}
    local = np.full(len(cells), "NaT", "datetime64[s]")
    stated = np.zeros(len(cells), bool)
    for i, cell in enumerate(cells):
        clock = clocks[cell]
        if np.isnat(read.day[i]) or not _FIRST_DAY <= read.day[i] < _LAST_DAY:
            continue
        local[i] = read.day[i] if clock is None else local_time(read.day[i], clock, UTC)
        stated[i] = clock is not None and clock.offset is not None
    by_day = all(clock is None for clock in clocks.values())
    is_utc = is_utc and not by_day
    at = np.where(stated | is_utc, local, utc_times(local, zone))
    messages = []
    if not by_day and not options.zone and not (stated.all() or is_utc):
        remedy = Remedy("zone", "+02:00", worded("Name the time zone"))
        messages.append(guessed(worded("Times name no zone; read as UTC."), None, remedy))
    if read.n_broken:
        shown = ", ".join(repr(cell) for cell in read.broken[:3])
        messages.append(
            dropped(
                worded("{n} {n:time is|times are} none ({shown}).", n=read.n_broken, shown=shown)
            )
        )
    return _TimesRead(at, zone, messages)


def _time_cells(layer: Layer, taken: frozenset[str]) -> tuple[list[str], bool]:
    """Return the text of each row's time, put together from two columns or three, and if UTC."""
    free = [name for name in layer.columns if name not in taken]
    clock = next((name for name in free if plain(name) in _CLOCKS), None)
    day = next((name for name in free if plain(name) in _DAYS), None)
    day = day or find("date", [name for name in free if name != clock])
    if day is None and clock is None:
        parts = [find(part, free) for part in ("year", "month", "day")]
        parts = parts if all(parts) else [next((n for n in free if plain(n) == p), None)
                                          for p in ("year", "mo", "dy")]  # fmt: skip
        if all(parts):
            columns = [[text(v) for v in layer.columns[str(name)]] for name in parts]
            hours = [text(v) for v in layer.columns[h]] if (h := _hour_column(free)) else None
            return [_put_together(cells, hours, i) for i, cells in
                    enumerate(zip(*columns, strict=True))], False  # fmt: skip
        raise FileProblem(
            worded(
                "{name} must have a column of dates or times, but has {columns}.",
                name=layer.name,
                columns=", ".join(layer.columns) or "none",
            )
        )
    days = [text(v) for v in layer.columns[day]] if day else [""] * len(layer)
    clocks = [text(v) for v in layer.columns[clock]] if clock else [""] * len(layer)
    is_utc = any(re.search(r"utc|gmt|zulu", name or "", re.IGNORECASE) for name in (day, clock))
    cells = [
        f"{one} {at}".strip() if one and at and is_clock_alone(at) else (one or at)
        for one, at in zip(days, clocks, strict=True)
    ]
    return cells, is_utc


_CLOCKS = frozenset(
    {"time", "hour", "hora", "heure", "uhrzeit", "zeit", "ora", "uur", "שעה", "الوقت", "الساعة"}
    | {"timeutc", "hourutc", "hhmm", "tijd"}
)
_DAYS = frozenset(
    {"datetime", "timestamp", "date", "dateutc", "datetimeutc", "timestamputc", "datumzeit"}
    | {"messdatum", "valid", "validutc", "zeitstempel", "fechahora", "dateheure", "datahora"}
    | {"dataora", "תאריךושעה", "تاريخ", "التاريخ", "observationtime", "localtime", "yyyymmdd"}
)


def _hour_column(names: list[str]) -> str | None:
    return next(
        (name for name in names if plain(name) in {"hour", "hr", "hh", "hora", "שעה"}), None
    )


def _put_together(cells: tuple[str, ...], hours: list[str] | None, row: int) -> str:
    """Return a date of three cells, and its hour if there is one."""
    try:
        year, month, day = (int(float(cell)) for cell in cells)
        at = f" {int(float(hours[row])):02d}:00" if hours else ""
    except ValueError:
        return ""
    return f"{year:04d}-{month:02d}-{day:02d}{at}"


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


def _unit_of(
    column: WeatherColumn, values: Floats, options: WeatherOptions
) -> tuple[str, list[ImportMessage]]:
    """Return the unit of a column, empty where it must be left out, and what is to be said."""
    kind = KIND_OF[column.measure]
    told = column.unit.casefold() or options.unit(kind)
    if told:
        if told not in UNITS or UNITS[told].kind != kind:
            raise FileProblem(
                worded(
                    "The column {name!r} must be in {known}, but its unit is {told!r}. Correct "
                    "the name of the column, or its unit.",
                    name=column.name,
                    known=WRITTEN[kind],
                    told=told,
                )
            )
        return told, []
    if kind == "temperature":
        return _temperature_unit(column, values)
    if kind == "speed":
        remedy = Remedy("wind_unit", "km/h", worded("Name the unit"), ("m/s", "mph", "kn"))
        said = worded("{name} has no unit, so the wind was left out.", name=column.name)
        return "", [dropped(said, None, remedy)]
    if kind == "rain":
        remedy = Remedy("rain_unit", "in", worded("Read as inches"))
        said = worded("{name} has no unit; read as millimetres.", name=column.name)
        return "mm", [guessed(said, None, remedy)]
    return "%", []


def _temperature_unit(column: WeatherColumn, values: Floats) -> tuple[str, list[ImportMessage]]:
    """Return the unit that temperatures tell; ask where they could be either."""
    known = values[~np.isnan(values)]
    most = float(known.max()) if len(known) else 0.0
    if most > _SURELY_F:
        said = worded(
            "{name} has no unit; read as Fahrenheit, for it goes up to {most:g}.",
            name=column.name,
            most=most,
        )
        remedy = Remedy("temperature_unit", "C", worded("Read as Celsius"))
        return "f", [guessed(said, None, remedy)]
    if most > _WARMEST_C or (len(known) and float(known.mean()) > _WARMEST_MEAN_C):
        raise ChoiceNeeded(
            worded(
                "{name} has no unit, and its values could be Celsius or Fahrenheit. Which is it?",
                name=column.name,
            ),
            "temperature_unit",
            ("F", "C"),
        )
    remedy = Remedy("temperature_unit", "F", worded("Read as Fahrenheit"))
    said = worded("{name} has no unit; read as Celsius.", name=column.name)
    return "c", [guessed(said, None, remedy)]


def _directions(layer: Layer, column: WeatherColumn) -> Floats:
    """Return where the wind came from, degrees; compass points are read too, calm is none."""
    cells = [text(v) for v in layer.columns[column.name]]
    named = {point: 22.5 * i for i, point in enumerate(_POINTS)}
    values = numbers(np.array(cells, object))
    for i, cell in enumerate(cells):
        if cell.casefold() in _CALM:
            values[i] = np.nan
        elif cell.upper() in named:
            values[i] = named[cell.upper()]
    return values


def _forecast(layer: Layer) -> NDArray[np.bool_]:
    """Return which rows a column calls forecast."""
    column = next((n for n in layer.columns if _FORECAST_COLUMN.search(plain(n))), None)
    if column is None:
        return np.zeros(len(layer), bool)
    return np.array(
        [bool(_FORECAST_WORDS.match(text(v).casefold())) for v in layer.columns[column]], bool
    )


def _possible(rows: WeatherRows, name: str) -> tuple[WeatherRows, list[ImportMessage]]:
    """Return rows without values that no weather has; refuse them where those are many."""
    messages, measured = [], {}
    for measure, values in rows.measured.items():
        low, high = MEASURED[measure]
        wrong = ~np.isnan(values) & ((values < low) | (values > high))
        n, of = int(np.count_nonzero(wrong)), int(np.count_nonzero(~np.isnan(values)))
        if n > max(_MOST_NONSENSE * of, 1):
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
