"""Seasons given to commands: which options go with them, and each once. Heavy imports wait."""

from __future__ import annotations

import shlex
from itertools import combinations
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable
    from pathlib import Path

    import typer

    from fieldmon.monitoring import Season


def opened(files: Iterable[Path]) -> list[Season]:
    """Open the seasons that go into one table or report.

    Raise `SettingError` where two are copies of one: what both hold would stand there twice.
    """
    from fieldmon.monitoring import Season  # noqa: PLC0415

    seasons = [Season(file) for file in files]
    for one, other in combinations(seasons, 2):
        if one.is_copy(other.path):
            pasted = shlex.join([str(one.path), str(other.path)])
            raise SettingError(
                f"Each season must be given once, but {one.path} and {other.path} are the same or "
                "copies of one: what both hold would stand there twice. Leave one away, or bring "
                f"them together first: fieldmon merge {pasted}"
            )
    return seasons


def refuse_what_was_chosen(context: typer.Context, takes: Collection[str]) -> None:
    """Raise `SettingError` where an option was given that a season has kept since it began.

    `takes` names the parameters of a command that do go with a season.
    """
    told = {
        name
        for name in context.params
        if (source := context.get_parameter_source(name)) is not None
        and source.name == "COMMANDLINE"
    }
    if more := sorted(told.difference(takes)):
        flags = ", ".join(f"--{name.replace('_', '-')}" for name in more)
        raise SettingError(
            f"A season keeps what was chosen when it began, but {flags} was given too. "
            "Leave it away, or choose otherwise for the days to come with: fieldmon change"
        )
