"""Days and times that a caller hands over, whatever says them: a text, Python's own or numpy's.

A time of a zone is as the clock there says.
"""

from __future__ import annotations

from contextlib import suppress
from datetime import date, datetime
from typing import TYPE_CHECKING, Any

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def days_of(given: object) -> NDArray[np.datetime64] | None:
    """Return days, whatever they were given as; None: they are none.

    Examples
    --------
    >>> days_of("2026-11-18"), days_of(20_000)
    (array('2026-11-18', dtype='datetime64[D]'), None)
    """
    import numpy as np  # noqa: PLC0415 - a date is read without it

    try:
        array = _as_clocks_say(given)
        if array.size and array.dtype.kind not in "MUO":
            return None
        days = array.astype("datetime64[D]", copy=False)
    except (TypeError, ValueError, OverflowError):
        return None
    said = days.ndim or not np.isnat(days) or isinstance(given, np.datetime64 | np.ndarray)
    return days if said else None


def seconds_of(given: object) -> NDArray[np.float64]:
    """Return the seconds since midnight of what `days_of` takes, of its shape; NaN at midnight.

    A day alone is its midnight, so that no time is known there.

    Examples
    --------
    >>> seconds_of(["2026-11-18T14:00", "2026-11-18"])
    array([50400.,    nan])
    """
    import numpy as np  # noqa: PLC0415 - as above

    array = _as_clocks_say(given)
    if array.dtype.kind == "M" and np.datetime_data(array.dtype)[0] in "DWMY":
        return np.full(array.shape, np.nan)
    times = array.astype("datetime64[us]")
    second = np.asarray((times - times.astype("datetime64[D]")) / np.timedelta64(1, "s"))
    return np.where(second == 0.0, np.nan, second)


def _as_clocks_say(given: object) -> NDArray[Any]:
    """Return times as an array, those of a zone as the clock there says."""
    import numpy as np  # noqa: PLC0415 - as above

    array = np.asarray(given)
    if array.dtype.kind != "O":
        return array
    local = [
        one.replace(tzinfo=None) if isinstance(one, datetime) and one.tzinfo else one
        for one in array.ravel().tolist()
    ]
    made = np.empty(len(local), object)
    made[:] = local
    return made.reshape(array.shape)


def day_in(given: Any) -> Any:  # noqa: ANN401 - anything else is left as it is
    """Return the day of a text, a time or numpy's day; anything else as it is.

    Examples
    --------
    >>> import numpy as np
    >>> day_in("2026-11-18"), day_in(np.datetime64("2026-11-18")), day_in("soon")
    (datetime.date(2026, 11, 18), datetime.date(2026, 11, 18), 'soon')
    """
    day = given
    if isinstance(given, datetime):
        day = given.date()  # as the clock there says
    elif isinstance(given, str):
        with suppress(ValueError):
            day = date.fromisoformat(given)
    elif type(given).__name__ == "datetime64":
        day = given.astype("datetime64[D]").item()
    return day if isinstance(day, date) else given


def day_of(what: str, given: Any) -> Any:  # noqa: ANN401 - as above
    """Return what `day_in` does, for `must_be` to look at; of a text that is no day raise an error.

    Examples
    --------
    >>> day_of("A harvest", "2026-11-18")
    datetime.date(2026, 11, 18)
    """
    day = day_in(given)
    if isinstance(day, str):
        raise SettingError(f"{what} must be a day as 2026-11-18, but it is {given!r}.")
    return day
