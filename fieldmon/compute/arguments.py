"""What a caller of the library hands over: refused in a sentence where it is something else.

Pages and commands hand over what they made themselves; a program of one's own may not.
"""

from __future__ import annotations

from dataclasses import fields
from datetime import date, datetime
from numbers import Real
from typing import TYPE_CHECKING, Any

from fieldmon.compute.ranges import AllowedRange
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence
    from typing import TypeVar

    import numpy as np
    from numpy.typing import NDArray

    K = TypeVar("K", np.float64, np.bool_)

_LONGEST = 40
RATE_L_HA = AllowedRange(0.0, 100_000.0, above=True, below=True, unit=" litres per hectare")
_NUMBERS = {"float", "int"}
# beyond it, whole numbers of Python become no others
_MOST = 10**300


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
    >>> shown("4h"), shown(None), shown([1, 2])
    ("'4h'", 'None', 'a list')
    """
    if given is None or isinstance(given, str | bytes | Real):
        text = repr(getattr(given, "item", lambda: given)())
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
    return of_kind(type(given))


def of_kind(kind: type) -> str:
    """Return the name of a kind with its article: ``"a Robot"``."""
    return f"{'an' if kind.__name__[:1] in 'AEIOUaeiou' else 'a'} {kind.__name__}"


def must_hold_numbers(settings: Any, whose: str) -> None:  # noqa: ANN401 - any dataclass
    """Raise `SettingError` unless fields of a dataclass that are numbers hold numbers.

    Parameters
    ----------
    settings
        A dataclass, of which fields annotated as ``float`` or ``int``, or one of them
        ``| None``, are looked at.
    whose
        Who has them, in the sentence: ``"The robot's"``.
    """
    for field in fields(settings):
        kind, _, empty = str(field.type).partition(" | ")
        value = getattr(settings, field.name)
        if kind not in _NUMBERS or (value is None and empty == "None"):
            continue
        if not isinstance(value, Real):
            raise SettingError(f"{whose} {field.name} must be a number, but it is {shown(value)}.")
        if isinstance(value, int) and abs(value) > _MOST:
            raise SettingError(
                f"{whose} {field.name} must be a number of less than 300 digits, "
                f"but it is {shown(value)}."
            )


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
        if kind is not np.bool_:
            array = array.astype(kind)
    except (TypeError, ValueError):
        array = None
    if array is None or array.dtype != kind:
        sentence = f"{what} must hold {held}, but {shown(given)} does not. {instead}"
        raise SettingError(sentence.rstrip())
    return array


def must_be_rate(rate_l_ha: float) -> None:
    """Raise `SettingError` unless so many litres can be sprayed on a hectare."""
    must_be("The rate in the zones must be a number", rate_l_ha, Real, "Give litres a hectare.")
    if RATE_L_HA.broken(rate_l_ha):
        raise SettingError(
            worded(
                "The rate in the zones must lie between 0 and 100 000 litres a hectare, but it "
                "is {rate_l_ha:g}.",
                rate_l_ha=rate_l_ha,
            )
        )


def must_be_known(what: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Raise `SettingError` unless all names are known ones."""
    for name in given:
        if name not in known:
            raise SettingError(f"{what} are {', '.join(known)}, but one is called {name!r}.")


def day_of(what: str, given: Any) -> Any:  # noqa: ANN401 - anything else is left as it is
    """Return the day of a text or a time; anything else as it is, for `must_be` to look at.

    Raise `SettingError` where a text is no day.

    Examples
    --------
    >>> day_of("A harvest", "2026-11-18")
    datetime.date(2026, 11, 18)
    """
    if isinstance(given, datetime):
        return given.date()
    if not isinstance(given, str):
        return given
    try:
        return date.fromisoformat(given)
    except ValueError as error:
        raise SettingError(f"{what} must be a day as 2026-11-18, but it is {given!r}.") from error
