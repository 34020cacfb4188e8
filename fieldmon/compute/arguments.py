"""One value that a caller of the library hands over: refused in a sentence where it will not do.

Pages and commands hand over what they made themselves; a program of one's own may not. What an
annotation says is asked by `fieldmon.compute.kinds`; here is what it cannot say. Arrays and days
are asked in `array_arguments` and `day_arguments`.
"""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING
from zoneinfo import ZoneInfo

from fieldmon.compute.wording import LANGUAGES, worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from fieldmon.compute.ranges import AllowedRange

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
        What is asked for, and what it must be: ``"Records must be fm.Records"``.
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


def must_be_in(what: str, allowed: AllowedRange, given: float) -> None:
    """Raise `SettingError` unless a number is in a range."""
    if rule := allowed.broken(given):
        raise SettingError(f"{what} must be {rule}, but it is {shown(given)}.")


def must_be_known(what: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Raise `SettingError` unless all names are known ones."""
    for name in given:
        if name not in known:
            raise SettingError(f"{what} are {', '.join(known)}, but one is called {name!r}.")


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


def is_one_of(given: object, known: Collection[str]) -> bool:
    """Return whether something is one of some names, whatever it is.

    Examples
    --------
    >>> is_one_of("with", ("none", "with")), is_one_of(["with"], ("none", "with"))
    (True, False)
    """
    return isinstance(given, str) and given in known


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


def must_have_its_name(what: str, given: Collection[str], old: str, new: str) -> None:
    """Raise `SettingError` where an argument is given by a name that it has no more.

    Examples
    --------
    >>> must_have_its_name("A season's records", {"observations"}, "observations", "records")
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: A season's records must be given as 'records', but they are given as 'observations', their name before. Write records=.
    """  # noqa: E501 - a sentence
    if old in given:
        raise SettingError(
            f"{what} must be given as {new!r}, but they are given as {old!r}, their name before. "
            f"Write {new}=."
        )


def with_article(name: str) -> str:
    """Return a word behind its article; one of many things has none.

    Examples
    --------
    >>> with_article("Robot"), with_article("Records")
    ('a Robot', 'Records')
    """
    if name.endswith("s"):
        return name
    return f"{'an' if name[:1] in 'AEIOUaeiou' else 'a'} {name}"
