"""Changing the plot: rows by hand; gate, paths and no-go areas drawn by clicks or typed; undo."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.plot.layout import Planting

from ..show.maps import colours, marks, plant_layers
from ..state import cached, notices, widget_memory
from ..state.chosen_units import units
from ..state.plot_edits import GATE, NO_GO, PATH, Edit, points_of
from ..state.plot_files import draw, drawn, laid
from ..words import texts

if TYPE_CHECKING:
    from ..show.scale_bar import Clicked
    from ..state.choices import Choices
    from ..state.plot_edits import Points

_NAMES = {GATE: texts.DRAW_KINDS["gate"], PATH: texts.DRAW_KINDS["path"],
          NO_GO: texts.DRAW_KINDS["no_go"]}  # fmt: skip


def rows(plot_key: str) -> None:
    """Show what was found of a plot's rows, to be set by hand."""
    with st.expander(texts.ROWS, expanded=True):
        st.caption(texts.FOUND_ROWS)
        widget_memory.show(st.number_input, texts.BEARING, 0.0, 360.0, step=0.5,
                        help=texts.BEARING_HELP, key=f"row_bearing {plot_key}")  # fmt: skip
        spacings(plot_key)
        now, usual_m = units(), Planting().headland_m
        widget_memory.show(
            st.number_input, texts.HEADLAND.format(unit=now.length), *now.limits(0.1, 50.0),
            step=0.1, key=f"headland {plot_key}", default=now.shown(usual_m),
        )  # fmt: skip
        widget_memory.show(st.toggle, texts.BOTH_FACES, key=f"both_faces {plot_key}", default=False)


def spacings(plot_key: str) -> None:
    """Show how far rows and plants are apart, to be set by hand."""
    now, usual = units(), Planting()
    rows_m, plants_m = usual.row_spacing_m, usual.plant_spacing_m
    help_ = texts.SPACING_HELP.format(rows=now.metres(rows_m), plants=now.metres(plants_m))
    for name, label in (("row_spacing", texts.ROW_SPACING), ("plant_spacing", texts.PLANT_SPACING)):
        widget_memory.show(
            st.number_input, label.format(unit=now.length), *now.limits(0.1, 50.0), step=0.1,
            help=help_, key=f"{name} {plot_key}",
        )  # fmt: skip


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
    shown = marks.paths(field)
    if field.gate is not None:
        shown.append(marks.places([list(field.gate)], "gate", colours.GATE, "gate"))
    if not _kind():
        return shown
    return [*shown, *marks.drawing(_points(choices))]


def plain_plants(choices: Choices) -> list:
    """Return the plants in one colour, made once."""
    grid = choices.plot.grid

    def make() -> list:
        shade = colours.plain(len(grid))
        return [plant_layers.plants(grid, shade, plant_layers.unsaid)]

    return cached.layers(f"plain {choices.key}", make)


def clicks(choices: Choices) -> Clicked | None:
    """Return what takes clicks on the map as points of what is being drawn; None: nothing is."""
    return partial(_put, choices) if _kind() else None


def _kind() -> str:
    kind: str = st.session_state.get("draw_kind", "")
    return kind


def _points(choices: Choices) -> Points:
    points: Points = st.session_state.get(f"drawing {choices.plot_key}", ())
    return points


def _put(choices: Choices, points: Points) -> None:
    made = points[-1:] if _kind() == GATE else (*_points(choices), *points)
    st.session_state[f"drawing {choices.plot_key}"] = made
    if _kind() == GATE and made:
        _finish(choices)


def _add(choices: Choices) -> None:
    try:
        _put(choices, points_of(st.session_state.get("draw_typed", "")))
        st.session_state["draw_typed"] = ""
    except FieldmonError as error:
        notices.keep("error", str(error))


def _finish(choices: Choices) -> None:
    """Keep what was drawn, if the plot can still be planted and driven with it."""
    try:
        made = (*drawn(choices.plot_key), Edit(_kind(), _points(choices)))
        laid(choices.plot_key, made, choices.plot.field, made[-1:])
        draw(choices.plot_key, made)
        _drop(choices)
    except FieldmonError as error:
        notices.keep("error", str(error))


def _drop(choices: Choices) -> None:
    st.session_state[f"drawing {choices.plot_key}"] = ()


def _undo(choices: Choices) -> None:
    draw(choices.plot_key, drawn(choices.plot_key)[:-1])
