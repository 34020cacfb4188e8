"""Boxes for what was done on a day: empty on each day and in each season, and once it is kept.

What was said in them and not kept yet is there again on another page and after a reload. One that
stays holds what was said in it though the others are emptied, in its tab and on its day. What is
said while another day's or the emptied boxes are on their way, in those still in view, is said in
the ones to come.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, time
from typing import TYPE_CHECKING, Any, TypeVar

import streamlit as st

from . import widget_memory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .choices import Choices

T = TypeVar("T")
_BOXES, _TIMES = "fresh boxes", "emptied "
_WHERE, _HELD, _LATE = "form and name of boxes", "boxes held", "boxes filled late"
# boxes of days and times, which are kept as texts
_READ = {
    "treat began ": time.fromisoformat,
    "treat ended ": time.fromisoformat,
    "when_time ": time.fromisoformat,
    "when_day ": date.fromisoformat,
}
_MOVED = "boxes filled from another day's"
_STAYING, _STAYED = "boxes that stay", "what stayed in boxes"


@dataclass(frozen=True, eq=False)
class FreshBoxes:
    """The boxes of one form: what somebody said of a day is never read as said of another.

    Parameters
    ----------
    form
        What the form is for; each is emptied by itself.
    choices
        Of which season and day it is.
    """

    form: str
    choices: Choices

    def key(self, box: str) -> str:
        """Return the key of a box."""
        place = f"{self.choices.day} {self.choices.key}"
        return f"{box} {self.form} {self.times} {place}"

    @property
    def _times(self) -> str:
        return f"{_TIMES}{self.form} {self.choices.day} {self.choices.key}"

    @property
    def times(self) -> int:
        """Return how often the boxes of this day were emptied."""
        times: int = st.session_state.get(self._times, 0)
        return times

    def hold_anything(self) -> bool:
        """Return whether something is said in a box that is shown."""
        return any(of == self._times for (_, of, _), stayed in _said() if not stayed)

    def show(
        self, widget: Callable[..., T], *arguments: object, box: str, stays: bool = False,
        **settings: object,
    ) -> T:  # fmt: skip
        """Show a box with what was said in it and not kept yet.

        One that `stays` is not emptied with the others, in this tab and on this day.
        """
        late: dict[tuple[str, str], object] = st.session_state.get(_LATE, {})
        if (self.form, box) in late:
            self.put(box, late.pop((self.form, box)))
        _shown()[self.key(box)] = self._times
        where: dict[str, tuple[str, str]] = st.session_state.setdefault(_WHERE, {})
        where[self.key(box)] = self.form, box
        if stays:
            st.session_state.setdefault(_STAYING, set()).add(self.key(box))
        return widget_memory.show(widget, *arguments, key=self.key(box), **settings)

    def said(self, box: str) -> Any:  # noqa: ANN401 - whatever the widget holds
        """Return what a box holds; None where it is not shown."""
        key = self.key(box)
        return widget_memory.value(key) if key in _shown() else st.session_state.get(key)

    def put(self, box: str, value: object) -> None:
        """Let a box hold a value (for callbacks)."""
        key = self.key(box)
        _shown()[key] = self._times
        widget_memory.put(key, value)
        st.session_state[key] = value

    def empty(self) -> None:
        """Let the boxes be empty from the next run on; those of another day stay as they are."""
        for key in [key for key in _held() if key not in _shown()]:  # emptied before: long gone
            del _held()[key]
        emptied = [key for key, of in _shown().items() if of == self._times]
        hold(emptied)
        staying = st.session_state.get(_STAYING, set()).intersection(emptied)
        stay = {st.session_state[_WHERE][key][1]: widget_memory.value(key) for key in staying}
        for key in emptied:
            del _shown()[key]
        st.session_state[self._times] = self.times + 1
        for box, value in stay.items():
            self.put(box, value)
            st.session_state.setdefault(_STAYED, {})[self.key(box)] = value


def hold(keys: Iterable[str] | None = None) -> None:
    """Hold what was said in boxes until now, as others take their place (for callbacks).

    `keys`: of which boxes; None: of all, as another day is chosen.
    """
    held, where = _held(), st.session_state.get(_WHERE, {})
    for key in list(_shown() if keys is None else keys):
        if key in where:
            now = widget_memory.value(key)
            held.setdefault(key, (now, now))


def turn(choices: Choices) -> None:
    """Show the boxes of this day from now on.

    What was said since in boxes that were held will be in those that took their place. A box that
    none took the place of, such as a stop of another route, is as it was.
    """
    here = f" {choices.day} {choices.key}"
    st.session_state[_LATE] = late = {}
    for key, (before, last) in list(_held().items()):
        # an emptied box is shown no more, what it holds is nothing that was said
        is_shown = key in _shown()
        if not key.endswith(f" {choices.key}") or (is_shown and key.endswith(here)):
            del _held()[key]
            continue
        now = widget_memory.value(key)
        if now not in (before, last):  # else the browser sends again what is known
            form, box = st.session_state[_WHERE][key]
            late[form, box] = now
            _held()[key] = (before, now)
            if not key.endswith(here):
                _moved()[FreshBoxes(form, choices).key(box)] = now
        if now != before and is_shown:
            widget_memory.put(key, before)


def hold_of_another_day(choices: Choices) -> bool:
    """Return whether a box of this day still holds what was said in another day's, and moved."""
    here = f" {choices.day} {choices.key}"
    return any(
        key in _shown() and key.endswith(here) and widget_memory.value(key) == value
        for key, value in _moved().items()
    )


def _moved() -> dict[str, object]:
    moved: dict[str, object] = st.session_state.setdefault(_MOVED, {})
    return moved


def _held() -> dict[str, tuple[object, object]]:
    """Return what boxes held when others took their place, and what was said in them last."""
    held: dict[str, tuple[object, object]] = st.session_state.setdefault(_HELD, {})
    return held


def said() -> dict[str, Any]:
    """Return what was said in all boxes and not kept yet, as JSON can hold it; empty: nothing.

    What stayed in a box counts beside what was said since alone: of itself it is this tab's.
    """
    held = [*_said()]
    said = [one for one, stayed in held if not stayed]
    of_forms = {of for _, of, _ in said}
    said += [one for one, stayed in held if stayed and one[1] in of_forms]
    boxes = {key: [of, str(one) if isinstance(one, date | time) else one] for key, of, one in said}
    if not boxes:
        return {}
    emptied = [str(key) for key in st.session_state if str(key).startswith(_TIMES)]
    return {"boxes": boxes, "times": {key: st.session_state[key] for key in emptied}}


def take(said: dict[str, Any]) -> None:
    """Let boxes begin with what was said in them before a reload, as `said` returned it."""
    st.session_state.update(said.get("times", {}))
    for key, (of, value) in said.get("boxes", {}).items():
        _shown()[key] = of
        read = next((read for box, read in _READ.items() if key.startswith(box)), None)
        widget_memory.first(key, read(value) if read and isinstance(value, str) else value)


def _said() -> Iterator[tuple[tuple[str, str, Any], bool]]:
    """Yield of each box that holds something its key, its count and that; and whether it stayed."""
    before = st.session_state.get(_STAYED, {})
    for key, of in [*_shown().items()]:
        value = widget_memory.value(key)
        if value not in (None, "", []):
            yield (key, of, value), value == before.get(key)


def _shown() -> dict[str, str]:
    """Return the count of each box that may hold something: how often its form was emptied."""
    shown: dict[str, str] = st.session_state.setdefault(_BOXES, {})
    return shown
