"""A row bent by dragging: the rows that follow it are drawn over the plot before they are used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.plot.row_course import row_corners

from ..show.map_view import Drawable
from ..show.maps import marks
from ..show.maps.colours import GATE
from ..state import cached, notices, widget_memory
from ..state.plot_edits import ROW, Edit
from ..state.plot_files import draw, drawn, laid
from ..words import texts
from ..words.language import of_error

if TYPE_CHECKING:
    from pydeck import Layer

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

    from ..state.choices import Choices
    from ..state.plot_edits import Points

# a row is bent by so many handles, or by its own corners where these are few
_HANDLES, _MOST_HANDLES = 5, 12
_TRIED = "row tried"


def can_bend(choices: Choices) -> bool:
    """Return whether rows follow one that is drawn: not where plants were measured."""
    return choices.plot.field.plants is None


def show(choices: Choices) -> None:
    """Show which row is bent, and what the others would be; use them, or drop them."""
    grid = choices.plot.grid
    last = int(grid.row_line.max()) + 1
    widget_memory.show(st.number_input, texts.BEND_ROW, 1, last, step=1,
                       key=_row_key(choices), default=_middle(grid),
                       on_change=drop, args=(choices,))  # fmt: skip
    plot = _tried(choices)
    if plot is None:
        return
    rows = int(plot.grid.row_line.max()) + 1
    plants = texts.PLANTS_COUNTED.format(n=len(plot.grid))
    st.markdown(texts.BEND_MAKES.format(n=rows, plants=plants))
    with st.container(horizontal=True):
        st.button(texts.BEND_USE, key="bend_use", type="primary", on_click=_use, args=(choices,))
        st.button(texts.BEND_DROP, key="bend_drop", on_click=drop, args=(choices,))


def bent_line(choices: Choices) -> Drawable:
    """Return the row to be bent, with its handles."""
    grid = choices.plot.grid
    line = min(int(widget_memory.value(_row_key(choices), _middle(grid))), _last(grid)) - 1
    # anew where another row is bent, or what was tried was used or dropped
    name = f"{ROW} {line} {_turn(choices)} {choices.key}"
    return Drawable("bent", name, texts.DRAW_HINTS[ROW], points=_handles(grid, line))


def try_row(choices: Choices, points: Points) -> None:
    """Keep how a row was bent, to show what rows would follow it."""
    st.session_state[_TRIED] = choices.plot_key, points


def layers(choices: Choices) -> list[Layer]:
    """Return the rows that would be used, over the plot."""
    plot = _tried(choices)
    if plot is None:
        return []
    key = f"tried {choices.plot_key} {drawn(choices.plot_key)} {_points(choices)}"
    return cached.layers(key, lambda: [marks.rows(plot.grid, "rows-tried", GATE)])


def drop(choices: Choices) -> None:
    """Forget how a row was bent."""
    st.session_state.pop(_TRIED, None)
    st.session_state[f"bend turn {choices.plot_key}"] = _turn(choices) + 1


def _use(choices: Choices) -> None:
    """Lay plants along the rows that follow the one that was bent."""
    if points := _points(choices):
        draw(choices.plot_key, (*drawn(choices.plot_key), Edit(ROW, points)))
    drop(choices)


def _tried(choices: Choices) -> Plot | None:
    """Return the plot as it would be; None where nothing was bent, or no plant has room."""
    points = _points(choices)
    if not points:
        return None
    made = (*drawn(choices.plot_key), Edit(ROW, points))
    try:
        return laid(choices.plot_key, made, choices.plot.field, made[-1:])[0]
    except FieldmonError as error:
        notices.keep("error", of_error(error))
        drop(choices)
        return None


def _handles(grid: PlantGrid, line: int) -> Points:
    """Return the corners of a row on the ground, or some evenly along it where it is straight."""
    pieces = np.flatnonzero(grid.row_line[grid.unbroken] == line)
    corners_m = np.concatenate([row_corners(grid)[k] for k in pieces])
    whole = shapely.simplify(shapely.linestrings(corners_m), 0.5)
    places = shapely.get_coordinates(whole)
    if not 3 <= len(places) <= _MOST_HANDLES:
        share = np.linspace(0.0, 1.0, _HANDLES)
        even = shapely.line_interpolate_point(whole, share, normalized=True)
        places = shapely.get_coordinates(even)
    return tuple((float(lon), float(lat)) for lon, lat in grid.frame.lonlat(places))


def _middle(grid: PlantGrid) -> int:
    return (_last(grid) + 1) // 2


def _last(grid: PlantGrid) -> int:
    return int(grid.row_line.max()) + 1


def _points(choices: Choices) -> Points:
    plot_key, points = st.session_state.get(_TRIED, ("", ()))
    return points if plot_key == choices.plot_key and can_bend(choices) else ()


def _turn(choices: Choices) -> int:
    turn: int = st.session_state.get(f"bend turn {choices.plot_key}", 0)
    return turn


def _row_key(choices: Choices) -> str:
    return f"bend_row {choices.key}"
