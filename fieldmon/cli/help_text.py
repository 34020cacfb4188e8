"""Help that flows: lines end where the window does, not where the source's do."""

from __future__ import annotations

import re
import sys
from copy import copy
from functools import cache, wraps
from inspect import getdoc
from typing import TYPE_CHECKING, Any

import typer

from fieldmon.cli.outputs import refuse_what_is_read
from fieldmon.cli.season_files import until_the_end

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

# an end of line that ends no paragraph and begins no example
_WRAPPED = re.compile(r"(?<!\n)\n(?!\n|Example: )")

# names of options that are still taken, though no help shows them
_CALLED_NOW = {"observations": "records"}
_OLD_NAMES = {"token_normalize_func": lambda name: _CALLED_NOW.get(name, name)}


class Commands(typer.Typer):
    """Commands that are told by their docstrings, paragraph by paragraph."""

    def command(self, name: str | None = None, **options: Any) -> Callable[[Any], Any]:  # noqa: ANN401 - typer's own
        """Return what makes a command of a function."""

        def register(function: Any) -> Any:  # noqa: ANN401 - typer's own

            @wraps(function)
            def called(**told: Any) -> Any:  # noqa: ANN401 - what a command is told is of any type
                refuse_what_is_read(told)
                with until_the_end():
                    return function(**told)

            known = {"help": flowing(getdoc(function) or "")} | options
            known.setdefault("context_settings", _OLD_NAMES)
            typer.Typer.command(self, name, **known)(called)
            return function

        return register

    def __call__(self, args: Sequence[str] | None = None, **more: Any) -> Any:  # noqa: ANN401 - typer's own
        """Run the command that the words begin with."""
        words = sys.argv[1:] if args is None else args
        return _put_together(self, *self.named(words))(args, **more)

    def named(self, words: Sequence[str]) -> Iterator[str]:
        """Yield those of the words that lead to a command: those of its groups, its own."""
        first = words[0] if words else ""
        for group in self.registered_groups:
            if group.name and group.name == first and isinstance(group.typer_instance, Commands):
                yield group.name
                yield from group.typer_instance.named(words[1:])
        yield from (one.name for one in self.registered_commands if one.name and one.name == first)

    def only(self, *names: str) -> Commands:
        """Return these commands without any of another name; all of them, if none is given."""
        if not names:
            return self
        alone = copy(self)
        alone.registered_commands = [
            one for one in self.registered_commands if one.name == names[0]
        ]
        alone.registered_groups = [
            copy(one) for one in self.registered_groups if one.name == names[0]
        ]
        for group in alone.registered_groups:
            if isinstance(group.typer_instance, Commands):
                group.typer_instance = group.typer_instance.only(*names[1:])
        return alone


@cache
def _put_together(commands: Commands, *names: str) -> Callable[..., Any]:
    """Return what runs a command by itself: to put all together takes as long as the imports."""
    return typer.main.get_command(commands.only(*names))


def flowing(text: str) -> str:
    r"""Return a text with the lines of each paragraph joined; an example keeps its own.

    Examples
    --------
    >>> from fieldmon.cli.help_text import flowing
    >>> flowing("Plan a\nday.\n\nIt is\nwritten.\nExample: fieldmon plan a.zip")
    'Plan a day.\n\nIt is written.\nExample: fieldmon plan a.zip'
    """
    return _WRAPPED.sub(" ", text)
