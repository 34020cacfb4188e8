"""The unit of each column of weather: stated, chosen, told by its values, or asked for.

Decisions
---------
- A unit of something else is refused. Without one, temperatures tell theirs if they can; a wind is
  left out until its unit is told, for nothing tells it; rain is taken as mm, and it is said.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Remedy, doubtful, dropped, guessed
from fieldmon.io.parse.weather_columns import KIND_OF, UNITS, WRITTEN

if TYPE_CHECKING:
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.parse.weather_columns import WeatherColumn
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.pests.weather import Floats

# as a share of what was measured: more than so much nonsense is a wrong unit
MOST_NONSENSE = 0.05
# without a unit: no place is warmer than this on average, or ever
_WARMEST_MEAN_C, _WARMEST_C, _SURELY_F, _WARMEST_F = 35.0, 50.0, 60.0, 135.0
# nowhere are days so much warmer than their nights, month by month
_FARTHEST_APART_F = 54.0
# no weather without a unit lies beyond in Kelvin: -40 to 60 °C
_KELVIN = (233.15, 333.15)


def is_rate(column: WeatherColumn, options: WeatherOptions) -> bool:
    """Return whether a column says how much fell in some time."""
    unit = UNITS.get(column.unit or options.unit("rain"))
    return unit is not None and unit.per_s > 0


def units_of(
    cells: dict[WeatherColumn, Floats], options: WeatherOptions
) -> tuple[dict[WeatherColumn, str], list[ImportMessage]]:
    """Return the unit of each column that need not be left out, and what is to be said."""
    units, said, bare = {}, [], {}
    for column, values in cells.items():
        kind = KIND_OF[column.measure]
        told = column.unit.casefold().replace(" ", "") or options.unit(kind)
        said += _about_other_unit(column, options.unit(kind))
        if kind == "temperature" and not told:
            bare[column] = values
            continue
        unit, about = _unit_of(column, kind, told)
        said += about
        if unit:
            units[column] = unit
    if bare:
        unit, about = _temperature_unit({one.name: values for one, values in bare.items()})
        said += about
        units |= dict.fromkeys(bare, unit)
    return units, said


def _about_other_unit(column: WeatherColumn, chosen: str) -> list[ImportMessage]:
    """Return a doubt about a unit that was chosen for a column which states another."""
    stated, wanted = UNITS.get(column.unit.casefold().replace(" ", "")), UNITS.get(chosen)
    if stated is None or wanted is None or stated == wanted:
        return []
    said = worded(
        "{name} was read in {unit!r}, its own unit, and not in {chosen!r}, which was chosen.",
        name=column.name,
        unit=column.unit,
        chosen=chosen,
    )
    return [doubtful(said)]


def _unit_of(column: WeatherColumn, kind: str, told: str) -> tuple[str, list[ImportMessage]]:
    """Return the unit of a column, empty where it must be left out, and what is to be said."""
    if told:
        if told not in UNITS or UNITS[told].kind != kind:
            if kind == "humidity":
                said = worded(
                    "The unit of {name} is {told!r} and not %. It was left out; nothing needs it.",
                    name=column.name,
                    told=told,
                )
                return "", [dropped(said)]
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
    if kind == "speed":
        remedy = Remedy("wind_unit", "km/h", worded("Name the unit"), ("m/s", "mph", "kn"))
        said = worded("{name} has no unit, so the wind was left out.", name=column.name)
        return "", [dropped(said, None, remedy)]
    if kind == "rain":
        remedy = Remedy("rain_unit", "in", worded("Read as inches"))
        said = worded("{name} has no unit; read as millimetres.", name=column.name)
        return "mm", [guessed(said, None, remedy)]
    return "%", []


def _temperature_unit(columns: dict[str, Floats]) -> tuple[str, list[ImportMessage]]:
    """Return the unit that a table's temperatures tell together; ask where it could be either."""
    knowns = {name: _known(values) for name, values in columns.items()}
    names = ", ".join(columns)
    name = max(columns, key=lambda one: float(knowns[one].max(initial=-np.inf)))
    most = float(knowns[name].max(initial=-np.inf))
    highest = _highest(columns[name], knowns[name])
    if all(_looks_like_kelvin(known) for known in knowns.values() if known.size):
        raise ChoiceNeeded(
            worded(
                "{names} {n:has|have} no unit and {n:goes|go} up to {most:g}, as temperatures in "
                "Kelvin do. Are they in Kelvin, or in tenths of a degree?",
                names=names,
                n=len(columns),
                most=highest,
            ),
            "temperature_unit",
            ("K", "0.1 C", "0.1 F"),
        )
    if most > _WARMEST_F:
        raise ChoiceNeeded(
            worded(
                "{name} has no unit and goes up to {most:g}, which is neither Celsius nor "
                "Fahrenheit. Is it in tenths?",
                name=name,
                most=highest,
            ),
            "temperature_unit",
            ("0.1 C", "0.1 F", "K"),
        )
    if most > _SURELY_F:
        _must_be_near(knowns)
        said = worded(
            "{names} {n:has|have} no unit; read as Fahrenheit, for {name} goes up to {most:g}.",
            names=names,
            n=len(columns),
            name=name,
            most=highest,
        )
        remedy = Remedy("temperature_unit", "C", worded("Read as Celsius"), ("0.1 C",))
        return "f", [guessed(said, None, remedy)]
    if most > _WARMEST_C or any(k.size and k.mean() > _WARMEST_MEAN_C for k in knowns.values()):
        raise ChoiceNeeded(
            worded(
                "{names} {n:has|have} no unit, and what {n:it holds|they hold} could be Celsius "
                "or Fahrenheit. Which is it?",
                names=names,
                n=len(columns),
            ),
            "temperature_unit",
            ("F", "C"),
        )
    remedy = Remedy("temperature_unit", "F", worded("Read as Fahrenheit"))
    said = worded("{names} {n:has|have} no unit; read as Celsius.", names=names, n=len(columns))
    return "c", [guessed(said, None, remedy)]


def _known(values: Floats) -> Floats:
    """Return what was measured, in order, without the highest: a few broken ones tell nothing."""
    known = np.sort(values[~np.isnan(values)])
    return known[: len(known) - int(MOST_NONSENSE * len(known))]


def _highest(values: Floats, known: Floats) -> float:
    """Return the highest of values that is not far beyond what is `known`, in order."""
    if not known.size:
        return float("nan")
    most = float(known[-1])
    return float(np.nanmax(values[values <= most + 2.0 * (most - float(np.median(known)))]))


def _looks_like_kelvin(known: Floats) -> bool:
    """Tell whether values in order, all but a few of the lowest, are temperatures in Kelvin."""
    least = known[int(MOST_NONSENSE * len(known))]
    return bool(_KELVIN[0] <= least and known[-1] <= _KELVIN[1])


def _must_be_near(knowns: dict[str, Floats]) -> None:
    """Refuse temperatures that are too far apart to be all in Fahrenheit."""
    middles = {name: float(np.median(known)) for name, known in knowns.items() if known.size}
    low, high = min(middles, key=middles.__getitem__), max(middles, key=middles.__getitem__)
    if (apart_f := middles[high] - middles[low]) <= _FARTHEST_APART_F:
        return
    raise FileProblem(
        worded(
            "{low} and {high} must be in one unit, but as Fahrenheit {high} is mostly {apart:.0f} "
            "degrees warmer. Write the unit of each behind its name, as {high} (F).",
            low=low,
            high=high,
            apart=apart_f,
        )
    )
