"""Rain that a station counts up, until it begins again from nothing.

Decisions
---------
- What is counted up stands still when the rain stops, and falls when the station begins again.
  Rain that was measured hour by hour falls when the rain gets weaker.
- Where the name says that it is counted up (``Daily Rain``, ``Precip. Accum.``), hours of standing
  still for each fall are enough. Elsewhere it must also have stood still for longer, and have risen
  twice in a row.
- Where it never falls but at one time of day, on two days or more, and to little or nothing, nobody
  knows: it is read as it stands, and doubted.
- In tables by the day ``Daily Rain`` is what fell on each. Nothing is counted up there that falls,
  but where a month begins: rain of the month or the season. It must also rise within months, for a
  month's mean stands on each of its days.
- What fell is the difference, after a fall the value itself; before the first value nobody knows.
  Of rain over midnight a little is lost where the new day's count is at once above the old one's.
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, guessed
from fieldmon.io.parse.columns import plain
from fieldmon.pests.weather import DAY_S, HOUR_S

if TYPE_CHECKING:
    from datetime import tzinfo

    from numpy.typing import NDArray

    from fieldmon.pests.weather import Floats, Times

#: what `WeatherOptions.rain_is` can be
EACH, RUNNING = "each", "running"
_NAMED = (
    *("accum", "cumul", "kumul", "running", "since", "sofar", "today", "daily", "dayrain"),
    *("rainday", "weekly", "heute", "tages", "diari", "journalier", "giornalier"),
    *("מצטבר", "יומי", "تراكم", "يومي"),
)
# of standing still above nothing: for each fall, and in all where no name says it
_STILL_EACH_S, _STILL_S, _STILL = 3 * HOUR_S, 6 * HOUR_S, 5
# of falls at one time of day: so many, so many rises for each, and to such a share at most
_FALLS, _RISES_A_FALL, _LEFT = 2, 4, 0.25
# of never moving at all
_STILL_ALL_S = 3 * DAY_S


def what_fell(
    name: str, counted: Floats, at: Times, told: str | None, zone: tzinfo = UTC
) -> tuple[Floats, list[ImportMessage]]:
    """Return the rain of each measurement ``(n,)``, and what is to be said of its column.

    Parameters
    ----------
    name
        The column's.
    counted
        ``(n,)`` what stands in it.
    at
        ``(n,)`` when it was measured, UTC.
    told
        `EACH` or `RUNNING`; None: nobody said.
    zone
        Of the place, by which its months begin.
    """
    known = np.flatnonzero(~np.isnan(counted) & ~np.isnat(at))
    # a line that stands twice says the same twice
    times, first, of_time = np.unique(
        at[known].astype(np.int64), return_index=True, return_inverse=True
    )
    values, fell = counted[known][first], np.full(len(counted), np.nan)
    fell[known] = _differences(values)[of_time]
    if told is not None:
        return (fell if told == RUNNING else counted), []
    by_day = _step_s(times) > DAY_S / 2
    is_named = not by_day and any(stem in plain(name) for stem in _NAMED)
    begins = _month_begins(times, zone) if by_day else None
    if _counts_up(values, times, begins, is_named=is_named):
        said = worded("{name} counts up; what fell was read as the difference.", name=name)
        remedy = Remedy("rain_is", EACH, worded("Read each value as what fell"))
        return fell, [guessed(said, None, remedy)]
    if is_named and values.any():
        said = worded("{name} falls during the day; each value was read as what fell.", name=name)
        remedy = Remedy("rain_is", RUNNING, worded("Read it as counted up"))
        return counted, [guessed(said, None, remedy)]
    if not by_day and _falls_once_a_day(values, times):
        said = worded(
            "{name} rises all day and falls at one time of day only, as what a station counts up "
            "does; each value was read as what fell. Say which it is.",
            name=name,
        )
        remedy = Remedy("rain_is", RUNNING, worded("Read it as counted up"), (EACH,))
        return counted, [doubtful(said, None, remedy)]
    return counted, []


def _differences(values: Floats) -> Floats:
    """Return by how much each value ``(n,)`` is above the one before; after a fall, above none."""
    # where it begins at nothing, nothing fell before
    steps = np.diff(values, prepend=np.nan if values[:1].any() else 0.0)
    return np.where(steps < 0.0, values, steps)


def _month_begins(times: NDArray[np.int64], zone: tzinfo) -> NDArray[np.bool_]:
    """Return before which of times ``(n,)``, seconds, but the first another month begins."""
    # a day that is stated as UTC midnight is that day all the same
    there = zone if (times % DAY_S).any() else UTC
    months = np.array([datetime.fromtimestamp(one, there).month for one in times.tolist()])
    begins: NDArray[np.bool_] = months[1:] != months[:-1]
    return begins


def _counts_up(
    values: Floats, times: NDArray[np.int64], begins: NDArray[np.bool_] | None, *, is_named: bool
) -> bool:
    """Return whether values ``(n,)`` at times ``(n,)`` in order, seconds, are counted up.

    In tables by the day, `begins` says before which of them but the first another month does.
    """
    steps, apart_s = np.diff(values), np.diff(times)
    falls, rises = (times[1:][which] for which in (steps < 0.0, steps > 0.0))
    is_still = (steps == 0.0) & (values[1:] > 0.0)
    still_s = float(apart_s[is_still].sum())
    if not values.any() or still_s < _STILL_EACH_S * len(falls):
        return False
    by_month = begins is not None and len(falls) > 0
    if begins is not None and by_month:
        within = steps[~begins]
        if (within < 0.0).any() or not (within > 0.0).any():
            return False
    if is_named:
        return True
    if np.count_nonzero(is_still) < _STILL or still_s < _STILL_S:
        return False
    if (by_month or not len(falls)) and still_s > _STILL_ALL_S:
        return True
    # amounts that were shared out to the hours of a day, or of half a day, rise once in that time
    again_s = np.diff(rises)
    return len(again_s) > 0 and bool(again_s.min() <= max(_step_s(times), HOUR_S))


def _falls_once_a_day(values: Floats, times: NDArray[np.int64]) -> bool:
    """Return whether values ``(n,)`` at times in order rise often, and fall at one time of day.

    Some amounts that were shared out to the hours of a day do, too: they rise once in it.
    """
    steps = np.diff(values)
    fall, n_rises = np.flatnonzero(steps < 0.0), int(np.count_nonzero(steps > 0.0))
    if len(fall) < _FALLS or n_rises < _RISES_A_FALL * len(fall):
        return False
    at_s = times[1:][fall] % DAY_S
    off_s = np.abs((at_s - at_s[0] + DAY_S // 2) % DAY_S - DAY_S // 2)
    fell_to = values[1:][fall] <= _LEFT * values[:-1][fall]
    # clocks change in between, and a reading may be missing
    return bool(fell_to.all() and (off_s <= HOUR_S).all())


def _step_s(times: NDArray[np.int64]) -> float:
    """Return how many seconds lie between times in order; of one, none."""
    return float(np.median(np.diff(times))) if len(times) > 1 else 0.0
