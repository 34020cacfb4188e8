"""Samplers as values of options: by name, or one of a person's own."""

from __future__ import annotations

from typing import Annotated

import typer

from fieldmon.samplers import SAMPLERS, kind_of
from fieldmon.samplers.own import is_own

_NAMES = ", ".join(SAMPLERS)
#: how a sampler of one's own is named, for the help of an option
OWN = "one of your own: my_sampler.py:Mine (docs: own_sampler)"


def known(value: str | list[str] | None) -> str | list[str] | None:
    """Return the names of samplers that come with fieldmon; refuse any other."""
    for name in [value] if isinstance(value, str) else value or ():
        kind_of(name)
    return value


def known_or_own(value: str | list[str] | None) -> str | list[str] | None:
    """Return names of samplers, also of a person's own; refuse what is neither."""
    for name in [value] if isinstance(value, str) else value or ():
        if not is_own(name):
            kind_of(name)
    return value


OneSampler = Annotated[
    str, typer.Option(help=f"What chooses the plants: {_NAMES}.", callback=known)
]
OneSamplerOrOwn = Annotated[
    str,
    typer.Option(help=f"What chooses the plants: {_NAMES}, or {OWN}.", callback=known_or_own),
]
