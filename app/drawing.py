"""Changing the plot: rows by hand; gate, paths and no-go areas drawn by clicks or typed; undo."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError

from . import cached, keeping, maps, remembered, texts
from .choices import draw, drawn, laid
from .edits import GATE, NO_GO, PATH, Edit, points_of

if TYPE_CHECKING:
    from .choices import Choices
    from .edits import Points

_NAMES = {GATE: texts.DRAW_KINDS["gate"], PATH: texts.DRAW_KINDS["path"],
          NO_GO: texts.DRAW_KINDS["no_go"]}  # fmt: skip


def rows(plot_key: str) -> None:
    """Show what was found of a plot's rows, to be set by hand."""
    with st.expander(texts.ROWS, expanded=True):
        st.caption(texts.FOUND_ROWS)
        for key, label, limits, help_ in (
            ("row_bearing_deg", texts.BEARING, (0.0, 360.0, 0.5), texts.BEARING_HELP),
            ("row_spacing_m", texts.ROW_SPACING, (0.1, 50.0, 0.1), texts.SPACING_HELP),
            ("plant_spacing_m", texts.PLANT_SPACING, (0.1, 50.0, 0.1), texts.SPACING_HELP),
        ):
            low, high, step = limits
            remembered.show(st.number_input, label, low, high, step=step, help=help_,
                            key=f"{key} {plot_key}")  # fmt: skip
        remembered.show(st.number_input, texts.HEADLAND, 0.1, 50.0, step=0.5, default=4.0,
                        key=f"headland_m {plot_key}")  # fmt: skip
        remembered.show(st.toggle, texts.BOTH_FACES, key=f"both_faces {plot_key}", default=False)


def tools(choices: Choices) -> None:
    """Show what can be drawn, and undo."""
    with st.expander(texts.DRAW, expanded=bool(_kind() or drawn(choices.plot_key))):
        st.caption(texts.DRAW_NOTE)
        st.selectbox(texts.DRAW_KIND, list(texts.DRAW_KINDS), key="draw_kind", filter_mode=None,
                     format_func=texts.DRAW_KINDS.__getitem__, on_change=_drop,
                     args=(choices,))  # fmt: skip
        if _kind():
            st.text_input(texts.DRAW_TYPED, key="draw_typed", placeholder="35.1503,30.3601")
            st.button(texts.DRAW_ADD, key="draw_add", on_click=_add, args=(choices,))
        if points := _points(choices):
            st.caption(texts.DRAW_POINTS.format(n=len(points)))
            with st.container(horizontal=True):
                st.button(texts.DRAW_DONE, key="draw_done", type="primary", on_click=_finish,
                          args=(choices,))  # fmt: skip
                st.button(texts.DRAW_DROP, key="draw_drop", on_click=_drop, args=(choices,))
        made = drawn(choices.plot_key)
        for edit in made:
            st.caption(f"{_NAMES[edit.kind]}: {len(edit.lonlat)}")
        if made:
            st.button(texts.DRAW_UNDO, key="draw_undo", icon=":material/undo:", on_click=_undo,
                      args=(choices,))  # fmt: skip


def layers(choices: Choices) -> list:
    """Return what is being drawn, the gate, paths, and, while drawing, what can be clicked on."""
    field = choices.plot.field
    shown = maps.paths(field)
    if field.gate is not None:
        shown.append(maps.places([list(field.gate)], "gate", maps.GATE, "gate"))
    if not _kind():
        return shown
    return [
        *shown,
        *maps.drawing(_points(choices)),
        maps.clickable(choices.plot.grid, texts.DRAW_HERE),
    ]


def plain_plants(choices: Choices) -> list:
    """Return the plants in one colour, made once."""
    grid = choices.plot.grid

    def make() -> list:
        shade = maps.plain(len(grid))
        return [maps.plants(grid, shade, maps.unsaid)]

    return cached.layers(f"plain {choices.key}", make)


def take(choices: Choices, objects: dict) -> None:
    """Take a click on the map as a point of what is being drawn."""
    hits = objects.get("clicks", []) if _kind() else []
    if hits:
        _put(choices, ((float(hits[0]["p"][0]), float(hits[0]["p"][1])),))


def _kind() -> str:
    kind: str = st.session_state.get("draw_kind", "")
    return kind


def _points(choices: Choices) -> Points:
    points: Points = st.session_state.get(f"drawing {choices.plot_key}", ())
    return points


def _put(choices: Choices, points: Points) -> None:
    st.session_state[f"drawing {choices.plot_key}"] = (*_points(choices), *points)
    if _kind() == GATE:
        _finish(choices)


def _add(choices: Choices) -> None:
    try:
        _put(choices, points_of(st.session_state.get("draw_typed", "")))
        st.session_state["draw_typed"] = ""
    except FieldmonError as error:
        keeping.note("error", str(error))


def _finish(choices: Choices) -> None:
    """Keep what was drawn, if the plot can still be planted and driven with it."""
    try:
        made = (*drawn(choices.plot_key), Edit(_kind(), _points(choices)))
        laid(choices.plot_key, made, choices.plot.field, made[-1:])
        draw(choices.plot_key, made)
        _drop(choices)
    except FieldmonError as error:
        keeping.note("error", str(error))


def _drop(choices: Choices) -> None:
    st.session_state[f"drawing {choices.plot_key}"] = ()


def _undo(choices: Choices) -> None:
    draw(choices.plot_key, drawn(choices.plot_key)[:-1])
