"""When each row of a weather table was measured.

Decisions
---------
- Times that name no zone are the plot's, by its clock; where one stands in the hour that clocks
  skip in spring, the station's clock was never put forward, and all are standard time.
- A time is when its hour begins, unless hours are counted 1 to 24: then each is the one that ends.
"""

from __future__ import annotations

import re
from datetime import UTC, date, datetime, timedelta, timezone
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, Remedy, dropped, guessed, seen
from fieldmon.io.parse.clock import clock_time, is_clock_alone, local_time, zone_of
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.parse.dates import dates
from fieldmon.io.parse.values import number, numbers
from fieldmon.io.readers.date_doubts import read_day_first, refuse_mixed
from fieldmon.io.readers.weather_rows import utc_times
from fieldmon.io.readers.weather_services import NO_SERVICE, WeatherService, read_as_lst, told_zone

if TYPE_CHECKING:
    from collections.abc import Collection
    from datetime import tzinfo

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.parse.clock import ClockTime
    from fieldmon.io.parse.dates import DatedColumn
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.pests.weather import Times

# no station measured before, and nobody forecasts so far
_FIRST_DAY, _LAST_DAY = np.datetime64("1850-01-01"), np.datetime64("2150-01-01")
_HOUR_S, _DAY_S = 3600, 86_400
_CLOCKS = frozenset(
    {"time", "hour", "hora", "heure", "uhrzeit", "zeit", "ora", "uur", "שעה", "الوقت", "الساعة"}
    | {"hhmm", "tijd", "stunde"}
)
# hours if they count them: HR is a humidity in Spanish and French
_PERHAPS_HOURS = frozenset({"hr", "hh", "h"})
_DAYS = frozenset(
    {"datetime", "timestamp", "date", "datumzeit"}
    | {"messdatum", "valid", "zeitstempel", "fechahora", "dateheure", "datahora"}
    | {"dataora", "תאריךושעה", "تاريخ", "التاريخ", "observationtime", "localtime", "yyyymmdd"}
)
# 2026111813, 20261118:1300, 202611181300
_PACKED = re.compile(r"^(\d{4})(\d\d)(\d\d)[ T:_]?(\d\d)(?::?(\d\d)(?::?\d\d)?)?(Z?)$")
# 01.06.2026, perhaps with a clock behind
_DOTTED = re.compile(r"^\D*\d{1,2}\.\d{1,2}\.(?:\d{4}|\d\d)\b")
_AFTER_DATE = re.compile(
    r"^(?:\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/. ]\d{1,2}[-/. ](?:\d{4}|\d\d)|"
    r"[^:]*[^\W\d_][^:]*\D\d{4})[,T\s]+(\S.*)$"  # a month or a weekday in words
)
_BARE_HOUR = re.compile(r"^(\d{1,2})(?:[h.](\d\d)|(\d\d))?\s*(?:h|hrs|uhr)?\.?(Z?)$", re.IGNORECASE)
# Time (UTC), Date Time GMT+02:00
_ZONE = re.compile(r"[\s,_(]*(?:utc|gmt|zulu)\s*([-+]\d{1,2}(?::?\d\d)?)?\)?", re.IGNORECASE)
_HHMM = re.compile(r"\d{1,4}([.,]0+)?")


class TimeColumns(NamedTuple):
    """The columns of a date (one; year, month and day; year and day of it), and of a clock."""

    day: tuple[str, ...]
    clock: str | None

    @property
    def names(self) -> frozenset[str]:
        """Return the names of all of them."""
        return frozenset((*self.day, self.clock or "")) - {""}


class TimesRead(NamedTuple):
    """Times ``(n,)`` UTC, the zone of the place, and what there is to say."""

    at: Times
    zone: tzinfo
    messages: list[ImportMessage]


def is_time_name(name: str) -> bool:
    """Return whether a column of this name holds dates or times."""
    return _bare(name) in _CLOCKS | _DAYS


def _bare(name: str) -> str:
    """Return a plain name without its zone."""
    return plain(_ZONE.sub("", name))


def time_columns(layer: Layer, weather: Collection[str] = ()) -> TimeColumns:
    """Return which columns say when; `weather` are those that measure it.

    Raises
    ------
    FileProblem
        If none does.
    """
    free = [name for name in layer.columns if name not in weather]
    clock = next((name for name in free if _bare(name) in _CLOCKS), None)
    clock = clock or next(
        (name for name in layer.columns if plain(name) in _PERHAPS_HOURS
         and _counts_hours(layer.columns[name])), None,
    )  # fmt: skip
    day = next((name for name in free if _bare(name) in _DAYS), None)
    if day is not None:
        return TimeColumns((day,), clock)
    parts = _parts(free)
    day = find("date", [name for name in free if name not in (clock, *parts)])
    day = day or (None if parts else find("date", [name for name in free if name != clock]))
    if day is None and not parts and clock is None:
        raise FileProblem(
            worded(
                "{name} must have a column of dates or times, but has {columns}.",
                name=layer.name,
                columns=", ".join(layer.columns) or "none",
            )
        )
    return TimeColumns((day,) if day else parts, clock)


def _parts(names: list[str]) -> tuple[str, ...]:
    """Return the columns of year, month and day, or of year and day of the year; or none."""
    known = {plain(name): name for name in reversed(names)}
    for year, *rest in (("year", "mo", "dy"), ("year", "doy")):
        if year in known and all(one in known for one in rest):
            return (known[year], *(known[one] for one in rest))
    parts = [find(part, names) for part in ("year", "month", "day")]
    found = tuple(part for part in parts if part)
    return found if len(set(found)) == len(parts) else ()


def _counts_hours(column: NDArray[np.object_]) -> bool:
    """Return whether a column counts the hours of days, each an hour after the one before."""
    hours = numbers(column)
    if len(hours) < 2 or not ((hours >= 0) & (hours <= 24) & (hours % 1 == 0)).all():
        return False
    steps = np.diff(hours) % 24
    # the newest may stand first
    return any(np.mean(steps == step) > 0.5 for step in (1, 2, 3, 6, 12, 23, 22, 21, 18))


def times_of(
    layer: Layer,
    columns: TimeColumns,
    options: WeatherOptions,
    service: WeatherService = NO_SERVICE,
) -> TimesRead:
    """Return when each row of a table was measured.

    Raises
    ------
    ChoiceNeeded
        If dates could be day or month first, or are both.
    """
    zone = zone_of(options.zone) if options.zone else UTC
    cells = _cells(layer, columns)
    read = dates(np.array(cells, dtype=object), options.date_order)
    # with points nobody writes the month first; read day first, as records are
    dotted = read.is_ambiguous and all(_DOTTED.match(cell) for cell in cells if cell)
    if read.is_ambiguous and not dotted:
        raise ChoiceNeeded(
            worded(
                "Dates of {name} could be day or month first ({example}). Which is it?",
                name=layer.name,
                example=cells[0],
            ),
            "date_order",
            ("dmy", "mdy"),
        )
    refuse_mixed(read, layer.name)
    clocks = {cell: clock_time(cell) for cell in set(cells)}
    local, stated = _local_times(cells, read.day, clocks)
    ends, said_of_hours = _hours_that_end(layer, columns, service, clocks)
    if ends:
        local -= np.timedelta64(_HOUR_S, "s")
    messages = [*said_of_hours, *([read_day_first()] if dotted else [])]
    by_day = all(clock is None for clock in clocks.values())
    if by_day or np.isnat(local).all():
        at = utc_times(local, zone)
    else:
        first = local[~np.isnat(local)][0]
        there, said_of_zone = _zone_of_times(layer, columns, service, zone, first)
        at, said_of_clock = _as_utc(local, there, zone)
        at = np.where(stated, local, at)
        if not stated.all():
            messages += [*said_of_zone, *said_of_clock]
            if there is None and not options.zone:
                remedy = Remedy("zone", "+02:00", worded("Name the time zone"))
                messages.append(guessed(worded("Times name no zone; read as UTC."), None, remedy))
    return TimesRead(at, zone, [*messages, *_about_broken(cells, read, clocks)])


def _local_times(
    cells: list[str], day: Times, clocks: dict[str, ClockTime | None]
) -> tuple[Times, NDArray[np.bool_]]:
    """Return the times in cells ``(n,)``, NaT for none, and which of them state their zone.

    Those are UTC.
    """
    local = np.full(len(cells), "NaT", "datetime64[s]")
    stated = np.zeros(len(cells), bool)
    for i, cell in enumerate(cells):
        clock = clocks[cell]
        if np.isnat(day[i]) or not _FIRST_DAY <= day[i] < _LAST_DAY:
            continue
        if clock is None and _rest(cell):
            continue
        local[i] = day[i] if clock is None else local_time(day[i], clock, UTC)
        stated[i] = clock is not None and clock.offset is not None
    return local, stated


def _about_broken(
    cells: list[str], read: DatedColumn, clocks: dict[str, ClockTime | None]
) -> list[ImportMessage]:
    """Return what to say of cells that are no date, or one with something that is no clock."""
    broken = [*read.broken, *(c for c in clocks if clocks[c] is None and _rest(c))]
    n_broken = len(read.unread) + sum(clocks[cell] is None and _rest(cell) for cell in cells)
    if not n_broken:
        return []
    shown = ", ".join(repr(cell) for cell in broken[:3])
    return [dropped(worded("{n} {n:time is|times are} none ({shown}).", n=n_broken, shown=shown))]


def _rest(cell: str) -> bool:
    """Return whether more figures than a date stand in a cell."""
    found = _AFTER_DATE.match(cell)
    return found is not None and any(letter.isdigit() for letter in found[1])


def _cells(layer: Layer, columns: TimeColumns) -> list[str]:
    """Return each row's date and clock as one text."""
    days = _days(layer, columns.day)
    clocks = _clocks(layer, columns.clock) if columns.clock else [""] * len(layer)
    return [_together(one, at) for one, at in zip(days, clocks, strict=True)]


def _together(day: str, clock: str) -> str:
    """Return a date and a clock as one text; empty where the clock says a word."""
    if not day or not clock or is_clock_alone(clock):
        return _spaced(f"{day} {clock}".strip())
    if clock_time(clock) is not None:
        return clock
    return _spaced(f"{day} {clock}") if any(letter.isdigit() for letter in clock) else ""


def _spaced(cell: str) -> str:
    """Return a time that is packed, or has an hour alone, as others are written."""
    if (packed := _PACKED.match(cell)) is not None:
        year, month, day, hour, minute, zone = packed.groups()
        return f"{year}-{month}-{day} {hour}:{minute or '00'}{zone}"
    if (after := _AFTER_DATE.match(cell)) is None or (bare := _BARE_HOUR.match(after[1])) is None:
        return cell
    hour, *minutes, zone = bare.groups()
    return f"{cell[: after.start(1)]}{hour}:{next(filter(None, minutes), '00')}{zone}"


def _days(layer: Layer, names: tuple[str, ...]) -> list[str]:
    """Return each row's date."""
    if len(names) < 2:
        return [text(v) for v in layer.columns[names[0]]] if names else [""] * len(layer)
    return [_put_together(parts) for parts in zip(*(layer.columns[n] for n in names), strict=True)]


def _put_together(parts: tuple[object, ...]) -> str:
    """Return a date of year, month and day, or of year and day of the year."""
    try:
        year, *rest = (int(float(text(part))) for part in parts)
        if len(rest) == 1:
            return str(date(year, 1, 1) + timedelta(days=rest[0] - 1))
    except (ValueError, OverflowError):
        return ""
    return f"{year:04d}-{rest[0]:02d}-{rest[1]:02d}"


def _clocks(layer: Layer, name: str) -> list[str]:
    """Return each row's clock as HH:MM, of whole hours, of HHMM or of parts of a day too."""
    cells = [text(v) for v in layer.columns[name]]
    filled = [cell for cell in cells if cell]
    if filled and all(_HHMM.fullmatch(cell) for cell in filled):
        whole = [int(re.split("[.,]", cell)[0]) if cell else None for cell in cells]
        most = max(one for one in whole if one is not None)
        by = 100 if plain(name) == "hhmm" or most > 24 else 1
        return ["" if one is None else f"{one // by:02d}:{one % by:02d}" for one in whole]
    shares = [number(cell) for cell in filled]
    if filled and all(0.0 <= share < 1.0 for share in shares):
        seconds = [round(number(cell) * _DAY_S) if cell else 0 for cell in cells]
        return [f"{s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in seconds]
    return cells


def _hours_that_end(
    layer: Layer,
    columns: TimeColumns,
    service: WeatherService,
    clocks: dict[str, ClockTime | None],
) -> tuple[bool, list[ImportMessage]]:
    """Return whether hours are counted 1 to 24, each the one that ends then, and what to say."""
    seconds = {clock.seconds for clock in clocks.values() if clock is not None}
    whole = all(one % _HOUR_S == 0 for one in seconds)
    if not seconds or not whole or 0 in seconds:
        return False, []
    if service.hours_end or _DAY_S in seconds:
        said = worded("Hours are counted 1 to 24; each was read as the hour that ends then.")
        return True, [seen(said) if service.hours_end else guessed(said)]
    if columns.clock is None or any(":" in text(v) for v in layer.columns[columns.clock]):
        return False, []
    return False, [
        guessed(worded("Hours were read as 0 to 23, each as the hour that begins then."))
    ]


def _zone_of_times(
    layer: Layer, columns: TimeColumns, service: WeatherService, place: tzinfo, first: np.datetime64
) -> tuple[tzinfo | None, list[ImportMessage]]:
    """Return the zone that a service, lines above or names of columns tell, and what to say."""
    zone, said = told_zone(layer, service)
    if zone is not None:
        return zone, said
    for name in columns.names:
        if (found := _ZONE.search(name)) is not None:
            return (zone_of(found[1]) if found[1] else UTC), []
    if service.solar or any(re.search(r"\bLST\b", name) for name in columns.names):
        zone = _standard(place, first)
        return zone, [guessed(read_as_lst(zone))]
    return None, []


def _standard(zone: tzinfo, at: np.datetime64) -> timezone:
    """Return the zone's standard time of a local time."""
    moment = at.astype("datetime64[s]").astype(datetime).replace(tzinfo=zone)
    return timezone(moment.utcoffset() - (moment.dst() or timedelta()))


def _as_utc(local: Times, told: tzinfo | None, zone: tzinfo) -> tuple[Times, list[ImportMessage]]:
    """Return times as UTC: by the zone told, else by the clock of the place, and what to say."""
    if told is not None:
        return utc_times(local, told), []
    skipped = _skipped(local, zone)
    if skipped is None:
        return utc_times(local, zone), []
    standard = _standard(zone, np.datetime64(skipped - timedelta(days=1), "s"))
    said = worded(
        "Clocks skip {time}, but it was measured; all times were read as standard time, {zone}.",
        time=f"{skipped:%Y-%m-%d %H:%M}",
        zone=standard.tzname(None),
    )
    return utc_times(local, standard), [guessed(said)]


def _skipped(local: Times, zone: tzinfo) -> datetime | None:
    """Return the first of local times that the zone's clock never shows; None: it shows all."""
    for one in local:
        if np.isnat(one):
            continue
        naive: datetime = one.astype(datetime)
        moment = naive.replace(tzinfo=zone)
        if moment.astimezone(UTC).astimezone(zone).replace(tzinfo=None) != naive:
            return naive
    return None
