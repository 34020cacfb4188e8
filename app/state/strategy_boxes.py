"""Boxes of who works, and how long: what they say otherwise than what counts is kept.

It is there again on another page and, by `kept_files`, after a reload.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar, overload

import streamlit as st

from . import widget_memory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

T = TypeVar("T")
_BOXES, _SHOWN = "strategy boxes", "strategy boxes shown"


@contextmanager
def all_of(place: str) -> Iterator[None]:
    """Show within this all boxes of a place, such as a season; others that it had are forgotten.

    Their keys name what counts: should it count again, nothing was said in them since.
    """
    st.session_state[_SHOWN] = shown = set[str]()
    yield
    for key in [key for key, (where, _) in _boxes().items() if where == place]:
        if key not in shown:
            del _boxes()[key]
            widget_memory.forget(key)


# as in `widget_memory`
@overload
def show(
    widget: Callable[[str, list[str]], T], label: str, options: list[str], /, *, place: str,
    key: str, counts: object, **settings: object,
) -> T: ...  # fmt: skip


@overload
def show(
    widget: Callable[..., T], /, *arguments: object, place: str, key: str, counts: object,
    **settings: object,
) -> T: ...  # fmt: skip


def show(
    widget: Callable[..., T], /, *arguments: object, place: str, key: str, counts: object,
    **settings: object,
) -> T:  # fmt: skip
    """Show a box of a place; it begins with what counts, or with what was said in it since."""
    _boxes()[key] = place, counts
    st.session_state.setdefault(_SHOWN, set()).add(key)
    return widget_memory.show(widget, *arguments, key=key, default=counts, **settings)


def said() -> dict[str, list[Any]]:
    """Return what boxes say otherwise than what counts, as JSON can hold it."""
    now = {key: widget_memory.value(key, counts) for key, (_, counts) in _boxes().items()}
    return {key: [*of, now[key]] for key, of in _boxes().items() if now[key] != of[1]}


def take(said: dict[str, list[Any]]) -> None:
    """Let boxes begin with what was said in them before a reload, as `said` returned it."""
    for key, (place, counts, value) in said.items():
        _boxes()[key] = place, counts
        widget_memory.put(key, value)


def _boxes() -> dict[str, tuple[str, Any]]:
    """Return of which place each box is, and what counts in it."""
    boxes: dict[str, tuple[str, Any]] = st.session_state.setdefault(_BOXES, {})
    return boxes
