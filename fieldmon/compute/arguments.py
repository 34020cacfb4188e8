"""What a caller of the library hands over: refused in a sentence where it is something else.

Pages and commands hand over what they made themselves; a program of one's own may not.
"""

from __future__ import annotations

from contextlib import suppress
from datetime import date, datetime
from numbers import Real
from typing import TYPE_CHECKING, Any
from zoneinfo import ZoneInfo

from fieldmon.compute.wording import LANGUAGES, worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
    from typing import TypeVar

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.compute.ranges import AllowedRange

    K = TypeVar("K", np.float64, np.bool_)

_LONGEST = 40


def must_be(
    what: str,
    given: object,
    kind: type | tuple[type, ...],
    instead: str,
    but_no: tuple[type, ...] = (),
) -> None:
    """Raise `SettingError` unless something is of a kind.

    Parameters
    ----------
    what
        What is asked for, and what it must be: ``"Records must be Observations"``.
    given
        What was handed over.
    kind
        What it must be.
    instead
        What to do.
    but_no
        Kinds of it that will not do: a moment is a date to Python.

    Examples
    --------
    >>> must_be("A name must be text", 3, str, "Put it in quotes.")
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A name must be text, but it is 3. Put it in quotes.
    """
    if not isinstance(given, kind) or isinstance(given, but_no):
        raise SettingError(f"{what}, but it is {shown(given)}. {instead}")


def shown(given: object) -> str:
    """Return how a sentence says what was handed over: a short value itself, else its kind.

    Examples
    --------
    >>> import numpy as np
    >>> shown("4h"), shown(None), shown([1, 2]), shown((1, "x")), shown(np.arange(3))
    ("'4h'", 'None', 'a list', "(1, 'x')", 'an array of int64')
    """
    if given is None or isinstance(given, str | bytes | Real):
        text = repr(getattr(given, "item", lambda: given)())
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
    if type(given).__name__ == "datetime64":
        return str(given)
    if isinstance(given, type):
        return f"the class {given.__name__}"
    if hasattr(given, "setflags") and hasattr(given, "dtype"):
        return f"an array of {given.dtype}"
    if isinstance(given, tuple) and len(text := repr(given)) <= _LONGEST:
        return text
    return of_kind(type(given))


def of_kind(kind: type) -> str:
    """Return the name of a kind with its article: ``"a Robot"``."""
    return with_article(kind.__name__)


def with_article(name: str) -> str:
    """Return a word behind its article; one of many things has none.

    Examples
    --------
    >>> with_article("Robot"), with_article("Observations")
    ('a Robot', 'Observations')
    """
    if name.endswith("s"):
        return name
    return f"{'an' if name[:1] in 'AEIOUaeiou' else 'a'} {name}"


def is_one_of(given: object, known: Collection[str]) -> bool:
    """Return whether something is one of some names, whatever it is.

    Examples
    --------
    >>> is_one_of("with", ("none", "with")), is_one_of(["with"], ("none", "with"))
    (True, False)
    """
    return isinstance(given, str) and given in known


def array_of(kind: type[K], what: str, given: object, instead: str = "") -> NDArray[K]:
    """Return an array of numbers, or of True and False; raise `SettingError` for anything else.

    Parameters
    ----------
    kind
        ``np.float64`` or ``np.bool_``: numbers are not taken for True and False.
    what
        What is asked for: ``"A risk map"``.
    given
        What was handed over.
    instead
        What to do.

    Examples
    --------
    >>> import numpy as np
    >>> array_of(np.float64, "A risk map", [0.1, None, 0.3])
    array([0.1, nan, 0.3])
    >>> array_of(np.bool_, "What was treated", [True, False])
    array([ True, False])
    """
    import numpy as np  # noqa: PLC0415 - names of samplers are known without it

    held = "True or False" if kind is np.bool_ else "numbers"
    try:
        array = np.asarray(given)
        if kind is not np.bool_ and array.dtype.kind in "biufO":
            array = array.astype(kind)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None or array.dtype != kind:
        sentence = f"{what} must hold {held}, but {shown(given)} does not. {instead}"
        raise SettingError(sentence.rstrip())
    return array


def plants_marked(
    what: str, given: object, n: int, wrong: Callable[[int], str]
) -> NDArray[np.bool_]:
    """Return which of n plants are marked, ``(n,)``; raise `SettingError` for anything else.

    Parameters
    ----------
    what
        What is asked for: ``"The mask of treated plants"``.
    given
        What was handed over.
    n
        How many plants there are.
    wrong
        What to say where so many are marked or not, instead of n.
    """
    import numpy as np  # noqa: PLC0415 - names of samplers are known without it

    marked = array_of(
        np.bool_, what, given, f"Of plants by their numbers give np.isin(np.arange({n}), numbers)."
    )
    if marked.shape != (n,):
        raise SettingError(wrong(marked.size))
    return marked


def entries_of(what: str, which: Any, n: int) -> Any:  # noqa: ANN401 - an array or a slice
    """Return what picks some of n entries; raise `SettingError` for anything else.

    Parameters
    ----------
    what
        What is picked: ``"Records"``.
    which
        Numbers of entries, a mask ``(n,)`` or a slice.
    n
        How many entries there are.

    Examples
    --------
    >>> entries_of("Records", [True, False], 2)
    array([ True, False])
    """
    import numpy as np  # noqa: PLC0415 - as above

    if isinstance(which, slice):
        return which
    try:
        picked = np.asarray(which)
    except ValueError:
        picked = np.empty(())
    if picked.ndim == 1 and not picked.size:
        return picked.astype(np.int64)
    if picked.dtype == bool and picked.shape == (n,):
        return picked
    if picked.ndim == 1 and picked.dtype.kind in "iu" and -n <= picked.min() <= picked.max() < n:
        return picked
    raise SettingError(
        f"{what} must be picked by their numbers below {n}, or by True and False for each, but "
        f"'which' is {shown(which)}."
    )


def must_be_shaped(whose: str, arrays: Mapping[str, tuple[Any, tuple[int, ...]]]) -> None:
    """Raise `SettingError` unless arrays have their shapes.

    Parameters
    ----------
    whose
        Who has them, in the sentence: ``"A route's"``.
    arrays
        By name: the array, and the shape that it must have.

    Examples
    --------
    >>> import numpy as np
    >>> must_be_shaped("A start's", {"chance": (np.zeros(3), (2,))})
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A start's chance must have the shape (2,), but it has (3,).
    """
    for name, (array, shape) in arrays.items():
        if array.shape != shape:
            raise SettingError(
                f"{whose} {name} must have the shape {shape}, but it has {array.shape}."
            )


def must_hold_shapes(holder: object, whose: str, shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise `SettingError` unless a holder's arrays, by their names, have these `shapes`."""
    must_be_shaped(whose, {name: (getattr(holder, name), one) for name, one in shapes.items()})


def must_be_chances(what: str, chance: NDArray[np.float64]) -> None:
    """Raise `SettingError` unless an array ``(n,)`` holds chances from 0 to 1.

    Examples
    --------
    >>> import numpy as np
    >>> must_be_chances("A start", np.array([0.1, 12.0]))
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A start must hold chances in 0..1, but plant 1 of 2 has 12.
    """
    wrong = ~((chance >= 0) & (chance <= 1))
    if wrong.any():
        plant = int(wrong.argmax())
        raise SettingError(
            f"{what} must hold chances in 0..1, but plant {plant} of {len(chance)} has "
            f"{chance[plant]:g}."
        )


def chances_of(given: object, n: int) -> NDArray[np.float64]:
    """Return what a caller hands over as the chances of n plants, ``(n,)``.

    Raise `SettingError` unless it is a chance for each.

    Examples
    --------
    >>> chances_of([0.1, 1], 2)
    array([0.1, 1. ])
    >>> chances_of([0.1], 2)
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A plot's chance map must have the shape (2,), but it has (1,).
    """
    import numpy as np  # noqa: PLC0415 - as above

    chance = array_of(np.float64, "A chance map", given)
    must_be_shaped("A plot's", {"chance map": (chance, (n,))})
    must_be_chances("A chance map", chance)
    return chance


def must_be_in(what: str, allowed: AllowedRange, given: float) -> None:
    """Raise `SettingError` unless a number is in a range."""
    if rule := allowed.broken(given):
        raise SettingError(f"{what} must be {rule}, but it is {shown(given)}.")


def must_be_name_of_file(what: str, path: object) -> None:
    """Raise `SettingError` where a text names no file, whatever there is on the disk."""
    if not str(path) or "\0" in str(path):
        raise SettingError(
            f"{what} must be given by its path, but it is {str(path)!r}. Name the file."
        )


def must_be_language(code: str) -> None:
    """Raise `SettingError` unless sentences are translated into the language of this code."""
    if code not in LANGUAGES:
        raise SettingError(
            worded(
                "A language must be one of {known}, but it is {code!r}.",
                known=", ".join(LANGUAGES),
                code=code,
            )
        )


def must_be_zone(what: str, name: str) -> None:
    """Raise `SettingError` unless a time zone has this name; empty: UTC."""
    try:
        ZoneInfo(name or "UTC")
    except (KeyError, ValueError, OSError) as error:
        raise SettingError(
            f"{what} must be a time zone as Asia/Jerusalem, but it is {name!r}."
        ) from error


def days_of(given: object) -> NDArray[np.datetime64] | None:
    """Return days, whatever they were given as; None: they are none.

    Examples
    --------
    >>> days_of("2026-11-18"), days_of(20_000)
    (array('2026-11-18', dtype='datetime64[D]'), None)
    """
    import numpy as np  # noqa: PLC0415 - as above

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


def must_be_known(what: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Raise `SettingError` unless all names are known ones."""
    for name in given:
        if name not in known:
            raise SettingError(f"{what} are {', '.join(known)}, but one is called {name!r}.")


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
