"""Widgets that keep what was chosen when the page is turned.

Streamlit forgets a widget's value on another page. Its ``persist_state="session"`` (1.67) shows
the default in the run that turns the page where only one run came before: a reload of the address
of a season, then another page, was the sample estate again.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar, overload

import streamlit as st

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

T = TypeVar("T")
# how a box writes a number that may have a fraction: 2, not 2.00
_SHORTEST = "%.8g"
_VALUES, _PAGE, _BEGINS = "widget values", "page", "widget begins"
_NO_WIDGET = object()


def turn(page: str) -> None:
    """Say which page is about to be shown; keep what was said on the one before.

    The run that was to hear of it may have been broken off before the box's turn came.
    """
    st.session_state[_PAGE] = page
    for key in list(_values()):
        value(key)


@contextmanager
def page(name: str) -> Iterator[None]:
    """Show a page of an item of the menu: a box that several pages have begins again on each."""
    item = st.session_state.get(_PAGE, "")
    st.session_state[_PAGE] = f"{item} {name}"
    try:
        yield
    finally:
        st.session_state[_PAGE] = item


def first(key: str, value: object) -> None:
    """Let a widget begin with a value, if it was never shown and there is one."""
    if value is not None:
        _values().setdefault(key, ("", value))


def value(key: str, default: object = None) -> Any:  # noqa: ANN401 - whatever the widget holds
    """Return what was chosen last, on whichever page, though its widget may come further down."""
    values = _values()
    page, kept = values.get(key, ("", default))
    now = st.session_state.get(key, _NO_WIDGET)  # each look at the session's state takes a while
    if now is not _NO_WIDGET:
        kept = now
        # what it changes may be that its widget is not shown any more
        values[key] = (page, kept)
    return kept


def values_of(names: frozenset[str]) -> dict[str, Any]:
    """Return the values of all widgets whose keys begin with one of the names, if they have one."""
    kept = {key: value(key) for key in list(_values()) if key.split(" ")[0] in names}
    return {key: one for key, one in kept.items() if one is not None}


def change(names: tuple[str, ...], new: Callable[[Any], Any]) -> None:
    """Change the values of all widgets whose keys are, or begin with, a name (for callbacks)."""
    for key, (page, kept) in list(_values().items()):
        now = st.session_state.get(key, kept)
        if (key in names or key.split(" ")[0] in names) and now is not None:
            _values()[key] = (page, new(now))
            # another unit, other limits: its own default must lie within them too
            st.session_state.setdefault(_BEGINS, {})[key] = new(now)
            if key in st.session_state:
                st.session_state[key] = new(now)


def carry(old: str, new: str) -> None:
    """Let widgets whose keys hold `new` begin with the values of those of `old` (for callbacks)."""
    for key in [key for key in _values() if old in key]:
        _values()[key.replace(old, new)] = ("", value(key))


def put(key: str, new: object) -> None:
    """Let a widget hold a value, which may be none (for callbacks)."""
    page, _ = _values().get(key, ("", None))
    _values()[key] = (page, new)
    st.session_state.setdefault(_BEGINS, {})[key] = new
    if key in st.session_state:
        st.session_state[key] = new


def forget(key: str) -> None:
    """Let a widget that is not shown any more begin anew, should it be shown again."""
    _values().pop(key, None)
    st.session_state.get(_BEGINS, {}).pop(key, None)


# of Streamlit's signatures of a box of options, the first is that of a box without any
@overload
def show(
    widget: Callable[[str, list[str]], T], label: str, options: list[str], /, *, key: str,
    default: object = None, **settings: object,
) -> T: ...  # fmt: skip


@overload
def show(
    widget: Callable[..., T], /, *arguments: object, key: str, default: object = None,
    **settings: object,
) -> T: ...  # fmt: skip


def show(
    widget: Callable[..., T], /, *arguments: object, key: str, default: object = None,
    **settings: object,
) -> T:  # fmt: skip
    """Show a widget with what was chosen before, on this page or another."""
    state, page = st.session_state, st.session_state.get(_PAGE, "")
    values = _values()
    shown_on, kept = values.get(key, ("", default))
    begins = state.setdefault(_BEGINS, {})
    if shown_on != page or key not in state:
        # the last page's widget, if it was just left, knows better than what its last run saw
        begins[key] = state[key] = state.get(key, kept)
    own = _own_default(widget, arguments, begins.get(key, kept))
    chosen = anew(widget, *arguments, key=key, **settings, **own)
    _values()[key] = (page, chosen)
    return chosen


def anew(widget: Callable[..., T], *arguments: object, **settings: object) -> T:
    """Show a widget that begins anew on each page, its number written as `show` writes it."""
    numbers = (*arguments[1:], settings.get("value"), settings.get("step"))
    if _name(widget) == "number_input" and any(isinstance(one, float) for one in numbers):
        settings["format"] = _SHORTEST
    return widget(*arguments, **settings)


def _own_default(
    widget: Callable[..., object], arguments: tuple[object, ...], value: object
) -> dict[str, Any]:
    """Return the widget's own default, the same as long as a page is shown.

    A run that is followed at once by another never reaches the browser, nor does the value set in
    it: a box then fell back to its least number, and a choice to none.
    """
    name = _name(widget)
    if name in {"selectbox", "radio"}:
        options: list[object] = list(arguments[1])  # type: ignore[call-overload]
        return {"index": options.index(value)} if value in options else {}
    if name in {"pills", "segmented_control", "multiselect"}:
        return {"default": value}
    return {"value": value}


def _name(widget: Callable[..., object]) -> str:
    return getattr(widget, "__name__", "")


def _values() -> dict[str, tuple[str, Any]]:
    values: dict[str, tuple[str, Any]] = st.session_state.setdefault(_VALUES, {})
    return values
