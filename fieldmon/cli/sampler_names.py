"""Samplers as values of options: by name, or one of a person's own."""

from __future__ import annotations

from typing import Annotated, Any, TypeVar

import typer

from fieldmon.samplers import SAMPLERS, kind_of
from fieldmon.samplers.own import is_own

V = TypeVar("V")

_NAMES = ", ".join(SAMPLERS)
#: how a sampler of one's own is named, for the help of an option
OWN = "one of your own: my_sampler.py:Mine (docs: own_sampler)"


def known(param: typer.CallbackParam, value: V) -> V:
    """Return the names of samplers that come with fieldmon; refuse any other."""
    for name in _each(value):
        kind_of(name, param.opts[0])
    return value


def known_or_own(param: typer.CallbackParam, value: V) -> V:
    """Return names of samplers, also of a person's own; refuse what is neither."""
    for name in _each(value):
        if not is_own(name):
            kind_of(name, param.opts[0])
    return value


def _each(value: Any) -> list[str]:  # noqa: ANN401 - one name, or several
    return [value] if isinstance(value, str) else list(value or ())


OneSampler = Annotated[
    str, typer.Option(help=f"What chooses the plants: {_NAMES}.", callback=known)
]
OneSamplerOrOwn = Annotated[
    str,
    typer.Option(help=f"What chooses the plants: {_NAMES}, or {OWN}.", callback=known_or_own),
]
