"""Help that flows: lines end where the window does, not where the source's do."""

from __future__ import annotations

import re
from functools import wraps
from inspect import getdoc
from typing import TYPE_CHECKING, Any

import typer

from fieldmon.cli.outputs import refuse_what_is_read

if TYPE_CHECKING:
    from collections.abc import Callable

# an end of line that ends no paragraph and begins no example
_WRAPPED = re.compile(r"(?<!\n)\n(?!\n|Example: )")


class Commands(typer.Typer):
    """Commands that are told by their docstrings, paragraph by paragraph."""

    def command(self, name: str | None = None, **options: Any) -> Callable[[Any], Any]:  # noqa: ANN401 - typer's own
        """Return what makes a command of a function."""

        def register(function: Any) -> Any:  # noqa: ANN401 - typer's own

            @wraps(function)
            def called(**told: Any) -> Any:  # noqa: ANN401 - what a command is told is of any type
                refuse_what_is_read(told)
                return function(**told)

            known = {"help": flowing(getdoc(function) or "")} | options
            typer.Typer.command(self, name, **known)(called)
            return function

        return register


def flowing(text: str) -> str:
    r"""Return a text with the lines of each paragraph joined; an example keeps its own.

    Examples
    --------
    >>> from fieldmon.cli.help_text import flowing
    >>> flowing("Plan a\nday.\n\nIt is\nwritten.\nExample: fieldmon plan a.zip")
    'Plan a day.\n\nIt is written.\nExample: fieldmon plan a.zip'
    """
    return _WRAPPED.sub(" ", text)
