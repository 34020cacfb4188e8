"""What is told as NAME=VALUE."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self, TypeVar

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator


class _Options(Protocol):
    def choose(self, option: str, value: str, /) -> Self:
        """Return these options with one of them set from text."""


Options = TypeVar("Options", bound=_Options)


def chosen(options: Options, more: list[str] | None) -> Options:
    """Return options of an import with others chosen, each as NAME=VALUE."""
    for name, value in named_values(more):
        options = options.choose(name, value)
    return options


def named_values(more: list[str] | None, flag: str = "An option") -> Iterator[tuple[str, str]]:
    """Yield names and values out of NAME=VALUE."""
    for item in more or []:
        name, equals, value = item.partition("=")
        if not equals:
            raise SettingError(f"{flag} must be NAME=VALUE, but it is {item!r}.")
        yield name.strip(), value.strip()
