"""Plants that stand in rows several ways: each way is drawn over them, and one is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from ..show.maps import directions as drawn_directions
from ..state import cached, cached_files, row_settings
from ..words import texts
from ..words.language import number

if TYPE_CHECKING:
    from pydeck import Layer

    from fieldmon.plot.row_detection import RowDirection

    from ..show.maps.labels import Label
    from ..show.maps.legends import LegendPart
    from ..state.choices import Choices

# a bearing this near is the same direction, made exact
_SAME_DEG = 2.0


def directions(choices: Choices) -> tuple[RowDirection, ...]:
    """Return the directions of rows to choose from; none where names, blocks or bends decide."""
    plot = choices.plot
    rows, plants = plot.rows, plot.field.plants
    if rows is None or plants is None or choices.season is not None:
        return ()
    if rows.directions:
        return rows.directions
    decided = rows.named or not rows.in_rows or plot.grid.aisles_m is not None
    # found without what was said of them: one may change one's mind
    return (
        ()
        if decided or not _is_said(choices)
        else cached_files.directions(choices.plot_key, plants)
    )


def show(choices: Choices) -> None:
    """Show a button for each direction; the one in which rows run now is marked."""
    found = directions(choices)
    if not found:
        return
    with st.container(border=True):
        st.markdown(f"### {texts.DIRECTIONS}")
        st.markdown(texts.DIRECTIONS_NOTE)
        for k, note in enumerate(_notes(choices, found)):
            now = _runs(choices, found[k])
            st.button(note, key=f"direction {k}", width="stretch",
                      type="primary" if now else "secondary",
                      icon=":material/check:" if now else None, on_click=row_settings.turn,
                      args=(choices.plot_key, round(found[k].bearing_deg, 1)))  # fmt: skip
        if _is_said(choices):
            st.button(texts.DIRECTIONS_AGAIN, key="directions_again", icon=":material/undo:",
                      on_click=row_settings.turn, args=(choices.plot_key, None))  # fmt: skip


def layers(choices: Choices) -> list[Layer]:
    """Return the rows of each direction, until one is chosen."""
    found, plants = _open(choices), choices.plot.field.plants
    if plants is None or not found:
        return []
    notes = _notes(choices, found)
    key = f"directions {choices.key} {choices.units}"
    return cached.layers(key, lambda: drawn_directions.layers(plants, found, notes))


def legend(choices: Choices) -> list[LegendPart]:
    """Return what the lines of each direction mean."""
    found = _open(choices)
    return [drawn_directions.legend(_notes(choices, found))] if found else []


def labels(choices: Choices) -> list[Label]:
    """Return the numbers of the directions, as the buttons have them."""
    found, plants = _open(choices), choices.plot.field.plants
    return drawn_directions.numbers(plants, found) if found and plants is not None else []


def _open(choices: Choices) -> tuple[RowDirection, ...]:
    return () if _is_said(choices) else directions(choices)


def _is_said(choices: Choices) -> bool:
    return row_settings.row_settings(choices.plot_key)["row_bearing_deg"] is not None


def _runs(choices: Choices, one: RowDirection) -> bool:
    apart = (choices.plot.grid.frame.bearing_deg - one.bearing_deg + 90.0) % 180.0 - 90.0
    return abs(apart) < _SAME_DEG


def _notes(choices: Choices, found: tuple[RowDirection, ...]) -> tuple[str, ...]:
    """Return what is said of each direction, on its button and in the legend."""
    return tuple(
        texts.DIRECTION.format(
            number=number(k, "d"), bearing=number(one.bearing_deg, ".0f"), n=one.n_rows,
            apart=choices.units.metres(one.row_spacing_m, 1),
        )
        for k, one in enumerate(found, start=1)
    )  # fmt: skip
