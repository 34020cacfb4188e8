"""What time it is on a plot: in the time zone in which it lies, wherever the program runs."""

from __future__ import annotations

import json
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta
from functools import cache, lru_cache
from itertools import product
from typing import TYPE_CHECKING
from zoneinfo import ZoneInfo

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.plot.polygons import polygons_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

# no clock was ever put back by more than a day: where the date line moved
_BACK_HOURS = 26


@dataclass(frozen=True)
class LocalClock:
    """The clock of a place; its times have no zone of their own.

    Parameters
    ----------
    zone
        Name of the time zone, as ``"Asia/Jerusalem"``; empty: this machine's, whichever it is.
    """

    zone: str = ""

    def at(self, moment: datetime) -> datetime:
        """Return the local time of a moment that names its zone."""
        zone = ZoneInfo(self.zone) if self.zone else None
        return moment.astimezone(zone).replace(tzinfo=None)

    def now(self) -> datetime:
        """Return the local time, to the second."""
        return self.at(utc_now()).replace(microsecond=0)

    def moment(self, on: date, at: time) -> datetime:
        """Return a local date and time as a moment that names its zone."""
        local = datetime.combine(on, at)
        return local.replace(tzinfo=ZoneInfo(self.zone)) if self.zone else local.astimezone()

    def today(self) -> date:
        """Return the local date."""
        return self.now().date()

    def put_forward(self, start: datetime, seconds: float) -> timedelta:
        """Return by how much the clock is put forward in so many seconds from a local time.

        Less than 0 where it is put back.
        """
        shown = start + timedelta(seconds=seconds)
        moment = self.moment(start.date(), start.time()).astimezone(UTC)
        return self.at(moment + timedelta(seconds=seconds)) - shown

    def after(self, start: datetime, seconds: float) -> datetime:
        """Return what the clock shows so many seconds after a local time, though it be changed.

        A `start` that names its zone goes by that one's clock.

        Examples
        --------
        >>> from datetime import datetime
        >>> from fieldmon.plot.local_clock import LocalClock
        >>> str(LocalClock("Asia/Jerusalem").after(datetime(2027, 3, 26, 1, 30), 3600))
        '2027-03-26 03:30:00'
        """
        gone = timedelta(seconds=seconds)
        if start.tzinfo is not None:
            return (start.astimezone(UTC) + gone).astimezone(start.tzinfo)
        return start + gone + self.put_forward(start, seconds)

    def second_after(self, on: date, second: float, seconds: float) -> float:
        """Return the second of a day that the clock shows so many seconds after another one.

        Where it is put back, as if it were not: the hour that it shows twice would be in no order.
        """
        start = datetime.combine(on, time()) + timedelta(seconds=second)
        moved_s = self.put_forward(start, seconds).total_seconds()
        return second + seconds + max(0.0, moved_s)

    def seconds_between(self, on: date, second: float, later: float) -> float:
        """Return how many seconds pass from one second of a day to another; see `second_after`."""
        midnight = datetime.combine(on, time())
        local = [midnight + timedelta(seconds=one) for one in (second, later)]
        begin, end = (self.moment(at.date(), at.time()).astimezone(UTC) for at in local)
        moved = (local[1] - local[0]) - (end - begin)
        return later - second - max(0.0, moved.total_seconds())

    def latest(self, local: datetime) -> datetime:
        """Return the last moment at which the clock shows a local time.

        Where clocks are put back it shows the time twice; a time that was left out counts by the
        offset that puts it later.
        """
        zone = ZoneInfo(self.zone) if self.zone else None
        folds = (local.replace(tzinfo=zone, fold=fold).astimezone(UTC) for fold in (0, 1))
        return max(folds)

    def passed(self, moment: datetime) -> datetime:
        """Return a local time that the clock never shows before a moment; whole minutes.

        It is the time of that moment, rounded up. Within the hour after clocks were put back it is
        later: an hour earlier the clock showed the same.
        """
        ahead = max(_ahead(self, moment), *self._shown_twice(moment))
        local = moment.astimezone(UTC).replace(tzinfo=None) + ahead
        whole = local.replace(second=0, microsecond=0)
        return whole if whole == local else whole + timedelta(minutes=1)

    def _shown_twice(self, moment: datetime) -> Iterator[timedelta]:
        """Yield offsets by which the clock showed the time of a moment, or later, before it."""
        now = _ahead(self, moment)
        yield now
        earlier = (_ahead(self, moment - timedelta(hours=h)) for h in range(1, _BACK_HOURS))
        for before in {*earlier}:
            if before > now and _ahead(self, moment - (before - now)) == before:
                yield before


def _ahead(clock: LocalClock, moment: datetime) -> timedelta:
    """Return how far the clock is ahead of UTC at a moment."""
    return clock.at(moment) - moment.astimezone(UTC).replace(tzinfo=None)


def utc_now() -> datetime:
    """Return this moment."""
    return datetime.now(UTC)


def utc_text(moment: datetime | None = None) -> str:
    """Return a moment as season files note it, in UTC; None: this one."""
    return (moment or datetime.now(UTC)).astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")


def local_clock(field: Field) -> LocalClock:
    """Return the clock of a plot by its position; this machine's where no zone is known there.

    Zones are those of OpenStreetMap, simplified: right up to some hundred metres from a border.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.plot.local_clock import local_clock
    >>> local_clock(fm.read_plot("sample_data/paran_estate.zip", feature="Gate").field)
    LocalClock(zone='Asia/Jerusalem')
    """
    west, south, east, north = field.boundary.bounds
    return clock_at((west + east) / 2, (south + north) / 2)


def grid_clock(grid: PlantGrid) -> LocalClock:
    """Return the clock of the place where plants stand."""
    return clock_at(grid.frame.lon, grid.frame.lat)


def clock_at(lon: float, lat: float) -> LocalClock:
    """Return the clock of a place; this machine's where no zone is known there."""
    from tzfpy import get_tz  # noqa: PLC0415 - the map of zones takes a tenth of a second

    with suppress(KeyError, ValueError, OSError):
        return LocalClock(ZoneInfo(get_tz(lon, lat)).key)
    return LocalClock()


def at_sea(lon: float, lat: float) -> bool:
    """Tell whether a place lies in the open sea, some 22 km or more from any land.

    Examples
    --------
    >>> from fieldmon.plot.local_clock import at_sea
    >>> at_sea(30.35, 35.14), at_sea(35.14, 30.35)
    (True, False)
    """
    from tzfpy import get_tz  # noqa: PLC0415 - as above

    return str(get_tz(lon, lat)).startswith("Etc/")


def zones_within(bounds: tuple[float, float, float, float]) -> tuple[str, ...]:
    """Return the time zones of land in a part of the earth: west, south, east, north.

    Small ones may be missed: they are looked up at 40 x 30 places.
    """
    from tzfpy import get_tz  # noqa: PLC0415 - as above

    west, south, east, north = bounds
    places = product(np.linspace(west, east, 40).tolist(), np.linspace(south, north, 30).tolist())
    found = dict.fromkeys(get_tz(lon, lat) for lon, lat in places)
    return tuple(zone for zone in found if zone and not zone.startswith("Etc/"))


@cache
@lru_cache(maxsize=16)  # a zone's outline may have 100 000 corners
def zone_outline(zone: str, rough_deg: float) -> MultiPolygon:
    """Return where a time zone counts, lon/lat; empty where the zone is unknown.

    Parameters
    ----------
    zone
        Its name, as ``"Asia/Jerusalem"``.
    rough_deg
        How far the outline may be off, degrees.

    Examples
    --------
    >>> from fieldmon.plot.local_clock import zone_outline
    >>> zone_outline("Asia/Jerusalem", 0.1).contains(shapely.Point(35.2, 30.4))
    True
    """
    from tzfpy import get_tz_polygon_geojson, timezonenames  # noqa: PLC0415 - as above

    if zone not in timezonenames():
        return MultiPolygon()
    found = json.loads(get_tz_polygon_geojson(zone))
    (feature,) = found.get("features", [found])
    shape = shapely.from_geojson(json.dumps(feature["geometry"]))
    # the zones' own outlines cross themselves here and there
    return polygons_of(shapely.make_valid(shapely.simplify(shape, rough_deg)))
