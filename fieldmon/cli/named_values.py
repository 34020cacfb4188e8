"""What is told as NAME=VALUE."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self, TypeVar

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


class _Options(Protocol):
    def choose(self, option: str, value: str, /) -> Self:
        """Return these options with one of them set from text."""


Options = TypeVar("Options", bound=_Options)


def chosen(options: Options, more: list[str] | None) -> Options:
    """Return options of an import with others chosen, each as NAME=VALUE."""
    for name, value in named_values(more):
        options = options.choose(name, value)
    return options


def chosen_of_file(
    options: Options, more: list[str] | None, file: Path | None, flags: tuple[str, str]
) -> Options:
    """Return how a file is read; refuse to be told so of a file that is not there.

    Parameters
    ----------
    flags
        The flag of these options, and that of the file.
    """
    if more and file is None:
        option, of_file = flags
        raise SettingError(f"{option} says how to read a file: give it with {of_file} FILE.")
    return chosen(options, more)


def named_values(more: list[str] | None, flag: str = "An option") -> Iterator[tuple[str, str]]:
    """Yield names and values out of NAME=VALUE."""
    for item in more or []:
        name, equals, value = item.partition("=")
        if not equals:
            raise SettingError(f"{flag} must be NAME=VALUE, but it is {item!r}.")
        yield name.strip(), value.strip()
