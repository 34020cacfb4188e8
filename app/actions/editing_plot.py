"""Changing the plot: rows by hand; gate, paths and no-go areas drawn by clicks or typed; undo."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import shapely
import streamlit as st

from fieldmon.errors import FieldmonError, NoRowsError, PlotError
from fieldmon.infestation.records import UNKNOWN
from fieldmon.plot.clearance import USUAL_HALF_CANOPY_M
from fieldmon.plot.planting import Planting

from ..show import field_map, map_layers
from ..show.map_view import Drawable, MapAnswers, MapContent
from ..show.maps import colours, deck, legends, marks, plant_layers
from ..state import brought_files, cached, menu, notices, row_settings, widget_memory
from ..state.brought_files import PLANTS
from ..state.chosen_units import units
from ..state.folds import fold
from ..state.plot_edits import CUT, GATE, NO_GO, PATH, ROW, Edit, points_of
from ..state.plot_files import draw, drawn, laid, laying
from ..words import texts
from ..words.language import of_error
from . import bending, drawing_plot, turning_rows

if TYPE_CHECKING:
    from pydeck import Layer

    from fieldmon.infestation.records import Records
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot

    from ..state.choices import Choices
    from ..state.plot_edits import Points

_NAMES = {GATE: "gate", PATH: "path", NO_GO: "no_go", ROW: "row", CUT: "cut"}
_SHAPES = {GATE: "point", PATH: "line", NO_GO: "area", CUT: "line"}
# more corners than this are no help
_SNAPS = 2_000


def rows(plot_key: str, *, measured: bool = False) -> None:
    """Show what was found of a plot's rows, to be set by hand; measured plants may have none."""
    with st.expander(texts.ROWS, expanded=True):
        st.caption(texts.FOUND_ROWS)
        if measured:
            widget_memory.show(st.toggle, texts.NO_ROWS, key=f"no_rows {plot_key}", default=False,
                               help=texts.NO_ROWS_HELP)  # fmt: skip
        direction(plot_key)
        spacings(plot_key)
        now, usual_m = units(), Planting().headland_m
        widget_memory.show(
            st.number_input, texts.HEADLAND.format(unit=texts.UNITS[now.length]),
            *now.limits(0.1, 50.0), step=0.1, key=f"headland {plot_key}",
            default=now.shown(usual_m),
        )  # fmt: skip
        widget_memory.show(
            st.number_input, texts.HALF_CANOPY.format(unit=texts.UNITS[now.length]),
            *now.limits(0.0, 10.0), step=0.05, key=f"half_canopy {plot_key}",
            help=texts.HALF_CANOPY_HELP.format(usual=now.metres(USUAL_HALF_CANOPY_M, 2)),
        )  # fmt: skip
        widget_memory.show(st.toggle, texts.BOTH_FACES, key=f"both_faces {plot_key}", default=False)


def within_reach(problem: FieldmonError) -> None:
    """Show what was set or drawn by hand where no plot could be laid: it may be what is wrong."""
    if is_within_reach(problem):
        if _are_rows_within_reach(problem):
            rows(laying(), measured=PLANTS in brought_files.brought())
        undo_last(laying())


def is_within_reach(problem: FieldmonError) -> bool:
    """Return whether what is wrong with a plot can be changed by hand."""
    of_plot = isinstance(problem, PlotError)
    return of_plot and (_are_rows_within_reach(problem) or bool(drawn(laying())))


def _are_rows_within_reach(problem: FieldmonError) -> bool:
    return row_settings.is_said(laying()) or isinstance(problem, NoRowsError)


def direction(plot_key: str, now: float | None = None) -> None:
    """Show in which direction rows run, to be set by hand; empty, the box shows that of `now`."""
    shown = {} if now is None else {"placeholder": f"{now:.1f}"}
    widget_memory.show(st.number_input, texts.BEARING, 0.0, 360.0, step=0.5,
                       help=texts.BEARING_HELP, key=f"row_bearing {plot_key}",
                       **shown)  # fmt: skip


def spacings(plot_key: str, laid_m: dict[str, float] | None = None) -> None:
    """Show how far rows and plants are apart, to be set by hand; empty, boxes show what is laid."""
    now, usual = units(), Planting()
    unit = texts.UNITS[now.length]
    rows_m, plants_m = usual.row_spacing_m, usual.plant_spacing_m
    help_ = texts.SPACING_HELP.format(rows=now.metres(rows_m), plants=now.metres(plants_m))
    for name, label in (("row_spacing", texts.ROW_SPACING), ("plant_spacing", texts.PLANT_SPACING)):
        widget_memory.show(
            st.number_input, label.format(unit=unit), *now.limits(0.1, 50.0), step=0.1,
            help=help_, key=f"{name} {plot_key}",
            placeholder=f"{now.shown(laid_m[f'{name}_m']):g}" if laid_m else None,
        )  # fmt: skip


def blocks(choices: Choices) -> None:
    """Show how each block is planted, to be set by hand."""
    field, now = choices.plot.field, units()
    if len(field.blocks) < 2:
        return
    unit = texts.UNITS[now.length]
    labels_ = (
        ("block_bearing", texts.BEARING, (0.0, 360.0)),
        ("block_row_spacing", texts.ROW_SPACING.format(unit=unit), now.limits(0.1, 50.0)),
        ("block_plant_spacing", texts.PLANT_SPACING.format(unit=unit), now.limits(0.1, 50.0)),
    )
    with st.expander(texts.BLOCKS, expanded=True):
        st.caption(texts.BLOCKS_NOTE)
        for block in field.blocks:
            st.markdown(texts.BLOCK.format(name=texts.isolated(block.name)))
            with st.container(horizontal=True):
                for name, label, limits in labels_:
                    widget_memory.show(
                        st.number_input, label, *limits, step=0.5,
                        key=f"{name} {block.name} {choices.plot_key}",
                    )  # fmt: skip


def tools(choices: Choices) -> None:
    """Show what can be drawn, and undo."""
    drawing_plot.offer_again()
    is_drawing = bool(_kind() or drawn(choices.plot_key))
    with fold(texts.DRAW, f"draw {choices.plot_key}", is_open=is_drawing):
        st.caption(texts.DRAW_NOTE)
        kinds = [kind for kind in texts.DRAW_KINDS if kind != ROW or bending.can_bend(choices)]
        st.selectbox(texts.DRAW_KIND, kinds, key="draw_kind", filter_mode=None,
                     format_func=texts.DRAW_KINDS.__getitem__, on_change=_drop,
                     args=(choices,))  # fmt: skip
        if _kind() == ROW:
            bending.show(choices)
        elif _kind():
            st.text_input(texts.DRAW_TYPED, key="draw_typed", placeholder=texts.DRAW_EXAMPLE)
            st.button(texts.DRAW_ADD, key="draw_add", on_click=_add, args=(choices,))
        if points := _points(choices):
            st.caption(texts.DRAW_POINTS.format(n=len(points)))
            with st.container(horizontal=True):
                st.button(texts.DRAW_DONE, key="draw_done", type="primary", on_click=_finish,
                          args=(choices,))  # fmt: skip
                st.button(texts.DRAW_DROP, key="draw_drop", on_click=_drop, args=(choices,))
        made = drawn(choices.plot_key)
        for edit in made:
            st.caption(f"{texts.DRAW_KINDS[_NAMES[edit.kind]]}: {len(edit.lonlat)}")
        undo_last(choices.plot_key)


def set_gate() -> None:
    """Turn to the map on which the gate is set with a click (for callbacks)."""
    st.session_state["draw_kind"] = "gate"
    menu.turn_to_page("plot")


def _of_records(records: Records, choices: Choices) -> list[legends.LegendPart]:
    unknown = bool((records.present == UNKNOWN).any())
    return legends.records(dark=choices.dark, unknown=unknown)


def undo_last(plot_key: str) -> None:
    """Offer to take back what was drawn last, if anything was."""
    if drawn(plot_key):
        st.button(texts.DRAW_UNDO, key="draw_undo", icon=":material/undo:", on_click=_undo,
                  args=(plot_key,))  # fmt: skip


def content(
    choices: Choices, records: Records, before: Plot | None = None
) -> tuple[MapContent, MapAnswers]:
    """Return the map on which the gate, paths and no-go areas are drawn, and who hears of it.

    The plot as it was `before` the last change lies under it.
    """
    field, kind = choices.plot.field, _kind()
    layers = [
        *map_layers.plan(choices), *_as_it_was(before), *_plain_plants(choices),
        *_row_lines(choices), *turning_rows.layers(choices),
        *marks.blocks(field, dark=choices.dark), *marks.paths(field),
        *marks.records(records, dark=choices.dark),
    ]  # fmt: skip
    layers.append(map_layers.gate(choices))
    typed = _points(choices)
    if typed:
        layers += marks.drawing(typed)
    draw = None
    if kind == ROW:
        layers += bending.layers(choices)
        draw = bending.bent_line(choices)
    elif kind:
        draw = Drawable(_SHAPES[kind], kind, texts.DRAW_HINTS[kind], _corners(field))
    made = MapContent(
        **field_map.of_plot(choices), layers=layers, switches=map_layers.switches(layers),
        legend=[*turning_rows.legend(choices), legends.plants(),
                *(_of_records(records, choices) if len(records) else ()), legends.gate(),
                *legends.plan(field, dark=choices.dark)],
        draw=draw,
        labels=[*turning_rows.labels(choices), *map_layers.words(choices)],
    )  # fmt: skip
    return made, MapAnswers(drawn=partial(_drawn, choices))


def _plain_plants(choices: Choices) -> list[Layer]:
    """Return the plants in one colour, made once."""
    grid = choices.plot.grid

    def make() -> list[Layer]:
        return [plant_layers.plants(grid, colours.plain(len(grid)))]

    return cached.layers(f"plain {choices.key}", make)


def _row_lines(choices: Choices) -> list[Layer]:
    """Return the rows as lines, as they were found or laid, made once."""
    grid = choices.plot.grid
    if not grid.in_rows:
        return []
    colour = colours.ROWS_IN_DARK if choices.dark else colours.ROWS
    key = f"row lines {choices.key} {choices.dark}"
    return cached.layers(key, lambda: [marks.rows(grid, "row-lines", colour)])


def _as_it_was(before: Plot | None) -> list[Layer]:
    if before is None:
        return []
    outline = deck.outline(before.field, "boundary-before", colours.BEFORE)
    return [marks.rows(before.grid, "rows-before", colours.BEFORE), outline]


def _corners(field: Field) -> tuple[tuple[float, float], ...]:
    """Return the corners of the outline, to which what is drawn snaps; of very many, none."""
    corners = shapely.get_coordinates(field.boundary)
    if len(corners) > _SNAPS:
        return ()
    return tuple((float(lon), float(lat)) for lon, lat in corners)


def _drawn(choices: Choices, kind: str, points: Points) -> None:
    """Keep what was drawn on the map, after what was typed before."""
    if kind.split(" ", maxsplit=1)[0] == ROW == _kind():
        bending.try_row(choices, points)
    elif kind == _kind():
        _put(choices, points)
        if kind != GATE:
            _finish(choices)


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
        notices.keep("error", of_error(error))


def _finish(choices: Choices) -> None:
    """Keep what was drawn, if the plot can still be planted and driven with it."""
    try:
        made = (*drawn(choices.plot_key), Edit(_kind(), _points(choices)))
        laid(choices.plot_key, made, choices.plot.field, made[-1:])
        draw(choices.plot_key, made)
        _drop(choices)
    except FieldmonError as error:
        notices.keep("error", of_error(error))


def _drop(choices: Choices) -> None:
    bending.drop(choices)
    st.session_state[f"drawing {choices.plot_key}"] = ()


def _undo(plot_key: str) -> None:
    draw(plot_key, drawn(plot_key)[:-1])
