"""Which column of a weather table holds what, and in which unit, by the names stations give."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.io.parse.columns import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class WeatherUnit(NamedTuple):
    """A unit: of what it is one, and how it becomes ours: ``value * factor + offset``.

    What is per so many seconds becomes a sum over those of each measurement.
    """

    kind: str
    factor: float = 1.0
    offset: float = 0.0
    per_s: int = 0

    def ours(self, values: NDArray[np.float64], step_s: float) -> NDArray[np.float64]:
        """Return values in our unit, measured every `step_s` seconds."""
        over = step_s / self.per_s if self.per_s else 1.0
        return values * (self.factor * over) + self.offset


_C = WeatherUnit("temperature")
_F = WeatherUnit("temperature", 5 / 9, -160 / 9)
_KMH = WeatherUnit("speed", 1 / 3.6)
_MPH = WeatherUnit("speed", 0.44704)
_KN = WeatherUnit("speed", 1852 / 3600)
_MS = WeatherUnit("speed")
_MM = WeatherUnit("rain")
_INCH = WeatherUnit("rain", 25.4)
_OTHER = WeatherUnit("something else")
#: units as people write them, without blanks, in small letters
UNITS = {
    **dict.fromkeys(("c", "°c", "ºc", "degc", "degreesc", "celsius", "℃", "c°"), _C),
    **dict.fromkeys(("f", "°f", "ºf", "degf", "degreesf", "fahrenheit", "℉", "f°"), _F),
    **dict.fromkeys(("k", "kelvin", "degk"), WeatherUnit("temperature", 1.0, -273.15)),
    **dict.fromkeys(("m/s", "ms", "mps", "ms-1", "m.s-1", "m/sec", "מ/ש", "م/ث"), _MS),
    **dict.fromkeys(("km/h", "kmh", "kph", "kmph", "kmh-1", "km/hr", "קמ/ש", "كم/س"), _KMH),
    **dict.fromkeys(("mph", "mi/h", "miles/h"), _MPH),
    **dict.fromkeys(("kn", "kt", "kts", "knot", "knots"), _KN),
    **dict.fromkeys(("mm", "l/m2", "l/m²", "מ״מ", 'מ"מ', "מממ", "مم", "ملم"), _MM),
    **dict.fromkeys(("mm/h", "mm/hr", "mm/hour"), WeatherUnit("rain", per_s=3600)),
    **dict.fromkeys(("mm/d", "mm/day"), WeatherUnit("rain", per_s=86_400)),
    **dict.fromkeys(("mm/10min", "mm/10minutes"), WeatherUnit("rain", per_s=600)),
    **dict.fromkeys(("cm",), WeatherUnit("rain", 10.0)),
    **dict.fromkeys(("0.1c", "0.1°c"), WeatherUnit("temperature", 0.1)),
    **dict.fromkeys(("0.1f", "0.1°f"), WeatherUnit("temperature", 0.1 * 5 / 9, -160 / 9)),
    "0.1m/s": WeatherUnit("speed", 0.1),
    "0.1mm": WeatherUnit("rain", 0.1),
    **dict.fromkeys(("in", "inch", "inches", '"', "in."), _INCH),
    **dict.fromkeys(("%", "pct", "percent", "%rh", "rh%", "prozent"), WeatherUnit("humidity")),
    **dict.fromkeys(("°", "º", "deg", "degrees", "grad", "grados"), WeatherUnit("direction")),
    **dict.fromkeys(("10sdeg", "10deg", "10°"), WeatherUnit("direction", 10.0)),
    **dict.fromkeys(
        ("hpa", "mbar", "mb", "kpa", "pa", "inhg", "mmhg", "w/m2", "w/m²", "wm-2", "v", "volts"),
        _OTHER,
    ),
    **dict.fromkeys(("mj/m2", "mj/m²", "min", "h", "m", "km", "kg", "g/m3", "ppm", "lux"), _OTHER),
}
#: of which kind each measure's unit must be
KIND_OF = {
    "temperature_c": "temperature", "low_c": "temperature", "high_c": "temperature",
    "wind_speed_m_s": "speed", "wind_from_deg": "direction", "rain_mm": "rain",
    "humidity_pct": "humidity",
}  # fmt: skip
#: what people may write for each kind
WRITTEN = {
    "temperature": "C, F or K", "speed": "m/s, km/h, mph or kn", "rain": "mm, cm or in",
    "humidity": "%", "direction": "degrees",
}  # fmt: skip

# English, Spanish, French, German, Italian, Portuguese, Dutch, Hebrew, Arabic; DWD, KNMI, NASA
# POWER and GHCN have short names of their own
_TEMPERATURE = (
    *("temp", "tair", "airt", "t2m", "tavg", "tmean", "tmoy", "tmed", "טמפ", "حرار", "wärme"),
    *("tmin", "tmax", "mint", "maxt"),
)
_EXACT = {
    **dict.fromkeys(
        ("t", "ta", "tm", "tg", "tmk", "tttu", "tt10", "tmp", "tmpc", "tmpf"), "temperature_c"
    ),
    **dict.fromkeys(("tn", "tnk"), "low_c"),
    **dict.fromkeys(("tx", "txk"), "high_c"),
    **dict.fromkeys(("ws", "ff", "fm", "u2", "wspd", "ws2m", "ws10m", "awnd"), "wind_speed_m_s"),
    **dict.fromkeys(("sknt", "fh", "fg", "u10"), "wind_speed_m_s"),
    **dict.fromkeys(("wd", "dd", "wdir", "drct", "wd2m", "wd10m", "ddvec"), "wind_from_deg"),
    **dict.fromkeys(("rr", "rsk", "prcp", "ppt", "p01i", "r1", "precip"), "rain_mm"),
    **dict.fromkeys(
        ("rh", "rh2m", "upm", "hr", "ur", "relh", "rf", "rftu", "rf10", "rhavg"), "humidity_pct"
    ),
}
_LOW = (
    *("min", "low", "tief", "laag", "bassa", "baja", "נמוכ", "מינ", "صغر"),
    *("ادن", "أدن", "دنيا"),
)
_HIGH = (
    *("max", "high", "hoch", "hoechst", "höchst", "hoog", "alta", "מקס", "מירב", "גבוה"),
    *("عظم", "اعل", "أعل", "قصوى", "massim"),
)
_RAIN = (
    *("rain", "precip", "prectot", "pluie", "pluvi", "lluvia", "regen", "niederschlag"),
    *("neerslag", "pioggia", "chuva", "משקע", "גשם", "مطر", "امطار", "أمطار", "هطول"),
)
_HUMIDITY = ("humid", "hum", "feucht", "vochtig", "umid", "לחות", "رطوب")
_WIND = ("wind", "viento", "vent", "רוח", "رياح", "الريح", "windspd")
_KINDS = (
    ("wind", _WIND),
    ("air", _TEMPERATURE),
    ("rain_mm", _RAIN),
    ("humidity_pct", _HUMIDITY),
)
# too short, or within too many words, to be told by a stem: Hi Temp, but hauteur
_LOW_WORDS = frozenset({"lo", "bas", "basse", "basses"})
_HIGH_WORDS = frozenset({"hi", "haut", "haute", "hautes"})
# means of half a day are none of the day: those of the night, and beside them those of the day
_NIGHT = ("night", "nacht", "nuit", "noche", "nocturn", "nott", "noite", "לילה", "ليل")
_DAY = ("daytemp", "tempday", "daytime", "tagtemp", "tagestemp", "dagtemp")
_DAY_WORDS = frozenset(
    {"day", "tag", "tags", "dag", "jour", "dia", "día", "diurna", "diurno", "giorno"}
    | {"יום", "نهار", "النهار"}
)
_DIRECTION = ("dir", "richt", "rumbo", "כיוון", "اتجاه", "azimut")
# what looks like one of them and is none
_NOT = (
    *("soil", "boden", "suelo", "ground", "grass", "dew", "taupunkt", "rocio", "rosee", "rugiada"),
    *("wet", "bulb", "feel", "appar", "chill", "heat", "leaf", "water", "inside", "indoor", "room"),
    *("logger", "batt", "canopy", "road", "sea", "rate", "intens", "gust", "rafag", "rafal"),
    *("raffic", "boe", "windboe", "peak", "prob", "stdev", "stddev", "panel", "inner", "innen"),
    *("bulbo", "קרקע", "טל", "משב", "تربة", "ندى", "ventil", "event", "template", "month", "year"),
)


class WeatherColumn(NamedTuple):
    """A column of a weather table: its name, what it measures, and the unit that it states."""

    name: str
    measure: str
    unit: str


def weather_columns(names: list[str], units: dict[str, str]) -> tuple[WeatherColumn, ...]:
    """Return the columns that measure the weather, one for each measure, the first that does.

    Parameters
    ----------
    names
        Of the table's columns, in their order.
    units
        What a line of units below the names says, by name; empty without one.
    """
    found: dict[str, WeatherColumn] = {}
    halves = half_days(names)
    for name in names:
        column = weather_column(name, units.get(name, ""))
        if column is not None and name not in halves:
            found.setdefault(column.measure, column)
    return tuple(found.values())


def half_days(names: list[str]) -> tuple[str, ...]:
    """Return the columns with the temperature of the night, or of the day beside it, by name."""
    means = [n for n in names if (one := weather_column(n)) and one.measure == "temperature_c"]
    nights = [name for name in means if _has(plain(name), _NIGHT)]
    days = [n for n in means if _has(plain(n), _DAY) or not _words_of(n).isdisjoint(_DAY_WORDS)]
    return (*days, *nights) if nights else ()


def weather_column(name: str, unit: str = "") -> WeatherColumn | None:
    """Return what a column measures by its name; None: nothing of the weather that is used.

    Examples
    --------
    >>> weather_column("Wind_Speed_km_h")
    WeatherColumn(name='Wind_Speed_km_h', measure='wind_speed_m_s', unit='km/h')
    """
    bare, stated = _split(name)
    measure = _measure(plain(bare) or plain(name), _words_of(bare))
    if measure is None:
        return None
    return WeatherColumn(name, measure, unit_named(unit) or stated)


def _split(name: str) -> tuple[str, str]:
    """Return a name without its unit, and the unit, as in ``Temp (°C)`` or ``wind_m_s``."""
    if bracket := re.search(r"[(\[]\s*([^)\]]*?)\s*[)\]]", name):
        bare = name[: bracket.start()] + name[bracket.end() :]
        unit = unit_named(bracket[1])
        # Temp, °C (LGR S/N: 10)
        inner = ("", "") if unit else _split(bare)
        return inner if inner[1] else (bare, unit or bracket[1])
    parts = _words(name)
    for n in (2, 1):
        if len(parts) > n:
            for between in ("/", ""):
                unit = unit_named(between.join(parts[-n:]))
                # T2M_MIN is no number of minutes
                if unit and UNITS[unit] is not _OTHER:
                    return " ".join(parts[:-n]), unit
    return name, ""


def _words(name: str) -> list[str]:
    """Return the words of a name, as in ``Hi Temp``, ``hi_temp`` and ``hiTemp``."""
    spread = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return [part for part in re.split(r"[\s_\-,.:;]+", spread) if part]


def _words_of(name: str) -> frozenset[str]:
    """Return the words of a name in small letters."""
    return frozenset(word.casefold().strip("()[]'") for word in _words(name))


def unit_named(text: str) -> str:
    """Return a unit as `UNITS` has it; empty if it is none."""
    bare = text.strip().casefold().replace(" ", "").replace("_", "/")
    return next((one for one in (bare, bare.strip(".")) if one in UNITS), "")


def _measure(name: str, words: frozenset[str]) -> str | None:
    """Return what a plain name of some words measures."""
    if name in _EXACT:
        return _EXACT[name]
    found = [kind for kind, stems in _KINDS if _has(name, stems)]
    if not found or _has(name, _NOT):
        return None
    is_low = _has(name, _LOW) or not words.isdisjoint(_LOW_WORDS)
    is_high = _has(name, _HIGH) or not words.isdisjoint(_HIGH_WORDS)
    if found[0] == "wind" and _has(name, _DIRECTION):
        return "wind_from_deg"
    if found[0] == "air":
        return "low_c" if is_low else "high_c" if is_high else "temperature_c"
    if found[0] == "rain_mm":
        return "rain_mm"
    measure = {"wind": "wind_speed_m_s"}.get(found[0], found[0])
    return None if is_low or is_high else measure


def _has(name: str, stems: tuple[str, ...]) -> bool:
    return any(stem in name for stem in stems)
