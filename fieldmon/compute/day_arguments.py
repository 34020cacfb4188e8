"""Days and times that a caller hands over, whatever says them: a text, Python's own or numpy's.

They are local ones of a plot. A time that names another zone is turned into the plot's where the
plot is known, and else refused: which day it is there, nobody could say.
"""

from __future__ import annotations

import re
from contextlib import suppress
from datetime import date, datetime, time
from typing import TYPE_CHECKING, Any, TypeAlias

from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError, SettingError

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray


#: a day that a public method takes: a date, a text as "2026-11-18", a moment, or numpy's day. What
#: `checked` hands to the method is a date: Any lets callers give what `day_in` reads
Day: TypeAlias = date | Any
#: a time of day, likewise: a time, or a text as "07:00"
TimeOfDay: TypeAlias = time | Any

# a year or a month; and a time of day, and then a zone: numpy would turn it into UTC
_MONTH = re.compile(r"\s*[-+]?\d+(?:-\d\d?)?\s*")
_OF_ZONE = re.compile(r"[T ]\d\d.*(?:Z|[+-]\d\d(?::?\d\d)?)\s*$", re.IGNORECASE)


def days_of(given: object) -> NDArray[np.datetime64] | None:
    """Return days, whatever they were given as; None: they are none, as a month is.

    Raise `ObservationError` where one names a zone.

    Examples
    --------
    >>> days_of("2026-11-18"), days_of(20_000)
    (array('2026-11-18', dtype='datetime64[D]'), None)
    >>> days_of("2026-11")
    """
    import numpy as np  # noqa: PLC0415 - a date is read without it

    try:
        array = _local(given)
        if array.size and array.dtype.kind not in "MUO":
            return None
        if array.dtype.kind == "M" and _is_longer(array.dtype) and not np.isnat(array).all():
            return None
        if array.dtype.kind in "OU" and any(map(_is_no_day, array.ravel().tolist())):
            return None
        days = array.astype("datetime64[D]", copy=False)
    except (TypeError, ValueError, OverflowError):
        return None
    said = days.ndim or not np.isnat(days) or isinstance(given, np.datetime64 | np.ndarray)
    return days if said else None


def seconds_of(given: object) -> NDArray[np.float64]:
    """Return the seconds since midnight of what `days_of` takes, of its shape; NaN at midnight.

    A day alone is its midnight, so that no time is known there. Raise `ObservationError`
    as it does.

    Examples
    --------
    >>> seconds_of(["2026-11-18T14:00", "2026-11-18"])
    array([50400.,    nan])
    """
    import numpy as np  # noqa: PLC0415 - as above

    array = _local(given)
    if array.dtype.kind == "M" and (array.dtype == "datetime64[D]" or _is_longer(array.dtype)):
        return np.full(array.shape, np.nan)
    times = array.astype("datetime64[us]")
    second = np.asarray((times - times.astype("datetime64[D]")) / np.timedelta64(1, "s"))
    return np.where(second == 0.0, np.nan, second)


def _local(given: object) -> NDArray[Any]:
    """Return times as an array; raise `ObservationError` where one names a zone."""
    import numpy as np  # noqa: PLC0415 - as above

    if (kind := _kind_of_zone(given)) is not None:
        raise ObservationError(_no_plot(f"the column's type, {kind},"))
    array = np.asarray(given)
    if array.dtype.kind in "OU":
        for one in array.ravel().tolist():
            if _names_zone(one):
                raise ObservationError(_no_plot(one))
    return array


def _kind_of_zone(given: object) -> object | None:
    """Return the type of a column whose times are of a zone; None: it is none.

    Of polars' and pyarrow's numpy would make times of UTC.
    """
    dtype = getattr(given, "dtype", None)
    kinds = dtype, getattr(dtype, "pyarrow_dtype", None), getattr(given, "type", None)
    return next(
        (kind for kind in kinds if getattr(kind, "tz", None) or getattr(kind, "time_zone", None)),
        None,
    )


def _is_longer(kind: Any) -> bool:  # noqa: ANN401 - numpy's
    """Return whether times of a kind of numpy's are longer than days."""
    import numpy as np  # noqa: PLC0415 - as above

    return np.datetime_data(kind)[0] in {"W", "M", "Y"}


def _is_no_day(given: Any) -> bool:  # noqa: ANN401 - anything
    """Return whether something is a week, month or year, of which numpy would take some day."""
    if isinstance(given, str):
        return _MONTH.fullmatch(given) is not None
    kind = type(given).__name__
    if kind == "Period":  # pandas's
        return bool(given.start_time.date() != given.end_time.date())
    return kind == "datetime64" and _is_longer(given.dtype)


def _names_zone(given: object) -> bool:
    if isinstance(given, str):
        return _OF_ZONE.search(given) is not None
    return isinstance(given, datetime) and given.tzinfo is not None


def _no_plot(given: object) -> str:
    return (
        f"Days and times must be the plot's own, but {given} names a zone, and the plot is not "
        "known here. Turn them into the plot's time and leave the zone out, in pandas with "
        'times.dt.tz_convert("Asia/Jerusalem").dt.tz_localize(None); read_inspections and '
        "read_records do so with files."
    )


def day_in(
    given: Any,  # noqa: ANN401 - anything else is left as it is
    local: Callable[[datetime], datetime] | None = None,
) -> Any:  # noqa: ANN401 - as above
    """Return the day of a text, a time or numpy's day; anything else as it is.

    A text may say a time, as what it writes may. `local` gives the plot's time of a moment that
    names its zone; None: the plot is not known, and such a moment raises `SettingError`.

    Examples
    --------
    >>> import numpy as np
    >>> day_in("2026-11-18T07:00"), day_in(np.datetime64("2026-11-18")), day_in("soon")
    (datetime.date(2026, 11, 18), datetime.date(2026, 11, 18), 'soon')
    """
    if isinstance(given, str):
        with suppress(ValueError):
            given = datetime.fromisoformat(given)
    day = given
    if isinstance(given, datetime):
        if given.tzinfo is not None:
            if local is None:
                raise SettingError(_no_plot(given))
            given = local(given)
        day = given.date()
    elif type(given).__name__ == "datetime64" and not _is_longer(given.dtype):
        day = given.astype("datetime64[D]").item()
    return day if isinstance(day, date) else given


def time_in(given: Any) -> Any:  # noqa: ANN401 - as above
    """Return the time of day of a text; anything else, and a time of a zone, as it is.

    Examples
    --------
    >>> time_in("07:00"), time_in("7:00"), time_in("at seven")
    (datetime.time(7, 0), datetime.time(7, 0), 'at seven')
    """
    if isinstance(given, str):
        with suppress(ValueError):
            read = time.fromisoformat(given.zfill(5) if ":" in given else given)
            return given if read.tzinfo else read
    return given


def day_of(
    what: str,
    given: Any,  # noqa: ANN401 - as above
    local: Callable[[datetime], datetime] | None = None,
) -> Any:  # noqa: ANN401 - as above
    """Return what `day_in` does, for `must_be` to look at; of a text that is no day raise an error.

    Examples
    --------
    >>> day_of("A harvest", "2026-11-18")
    datetime.date(2026, 11, 18)
    """
    day = day_in(given, local)
    if isinstance(day, str):
        raise SettingError(f"{what} must be a day as 2026-11-18, but it is {given!r}.")
    return day


def clock_of(what: str, told: str) -> time:
    """Return the local time of the day that is told as HH:MM; else raise `SettingError`.

    Examples
    --------
    >>> clock_of("--start", "07:30")
    datetime.time(7, 30)
    """
    try:
        return datetime.strptime(told, "%H:%M").time()  # noqa: DTZ007 - local time
    except ValueError as error:
        raise SettingError(
            worded("{what} must be a time as HH:MM, but it is {told!r}.", what=what, told=told)
        ) from error
