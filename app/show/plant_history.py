"""What is known of one plant: the one tapped on the map, or named by row and number."""

from __future__ import annotations

import base64
from dataclasses import replace
from functools import partial
from html import escape
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.compute.wording import chance_figure
from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspections import FOUND
from fieldmon.io.parse.result_words import noted_beside_gone
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring.phones import photos
from fieldmon.pests.weather import DAY_S
from fieldmon.plot.grid import plant_at, plant_numbers
from fieldmon.plot.named_rows import plant_meant

from ..state import chosen_day, widget_memory
from ..words import texts
from ..words.language import in_words, number
from . import field_map
from .map_view import MapAnswers
from .maps import plant_layers
from .recorded_batches import GONE

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray
    from pydeck import Layer

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.plot.grid import PlantGrid

    from ..state.choices import Choices
    from .map_view import MapContent, Selected, Tapped

_ROW, _PLANT, _TAPPED = "history row", "history plant", "history tapped"
_FACE = "history face"
# a number tapped is the row's own, whoever else has it for a name
_TAPPED_AT = "history tapped at"
_MOST_PHOTOS = 3


def want(
    choices: Choices, content: MapContent, selected: Selected | None = None,
    taken: Tapped | None = None, picked: tuple[int, ...] = (),
) -> None:  # fmt: skip
    """Want a map on which a tap chooses the plant whose history is shown, with a ring round it.

    `selected` hears of the plants that are selected on it, `taken` of what is tapped instead;
    `picked` are the plants selected by now.
    """
    chosen = replace(content, layers=[*content.layers, *layers(choices)])
    taking = taken or partial(take_plant, choices)
    field_map.want(chosen, MapAnswers(taking, selected=selected, picked=picked))


def take_plant(choices: Choices, layer: str, index: int) -> None:
    """Take the plant that was tapped as the one whose history is shown."""
    if layer.startswith("plants"):
        grid = choices.plot.grid
        plant = np.array([min(index, len(grid) - 1)])
        numbered, face = plant_numbers(grid, plant), int(faces(grid, plant)[0])
        row, number = int(numbered.line[0]), int(numbered.number[0])
        st.session_state[_row_box(grid)] = f"{row}" if grid.row_names else row
        st.session_state[_PLANT] = number
        if face:
            st.session_state[_FACE] = face
        st.session_state[_TAPPED_AT] = f"{row}", number
        st.session_state[_TAPPED] = True


def tapped(choices: Choices) -> tuple[int, ...]:
    """Return the plant that was tapped, or none."""
    if not st.session_state.get(_TAPPED):
        return ()
    grid = choices.plot.grid
    row, number, face = (widget_memory.value(key, 1) for key in (_row_box(grid), _PLANT, _FACE))
    try:
        return (of_face(grid, _plant(grid, f"{row}", number), face),)
    except FieldmonError:
        return ()  # its history says why


def layers(choices: Choices) -> list[Layer]:
    """Return the ring round the plant whose history is shown, if there is such a plant."""
    return [
        ring for plant in tapped(choices) for ring in plant_layers.chosen(choices.plot.grid, plant)
    ]


def show_chosen(choices: Choices) -> None:
    """Show what is known of the plant that was tapped, if one was."""
    if st.session_state.get(_TAPPED):
        show(choices)


def show(choices: Choices) -> None:
    """Show what is known of the plant tapped, or of the one whose row and number are given."""
    st.markdown(f"### {texts.HISTORY}")
    st.caption(texts.HISTORY_TAP)
    plant = _asked(choices.plot.grid)
    now = first = chosen_day.chance(choices)
    if choices.season is not None:
        first = chosen_day.morning(choices, str(choices.season.settings.begins))
    st.markdown(texts.HISTORY_NOW.format(now=_chance(now[plant]), first=_chance(first[plant])))
    low, high = chosen_day.level_range(choices).of(now[[plant]])
    if (least := _chance(low[0])) != (most := _chance(high[0])):
        st.markdown(texts.HISTORY_BETWEEN.format(low=least, high=most))
        st.caption(texts.HISTORY_CHANCE)
    st.markdown(_on_route(choices, plant))
    if _taken_as_treated(choices, plant):
        st.caption(texts.HISTORY_TREATED)
    st.markdown("\n".join(_events(choices, plant)))
    _show_photos(choices, plant)


def _asked(grid: PlantGrid) -> int:
    """Ask for a row and a number, and return the plant that they mean."""
    lowest_row, lowest = _lowest(grid)
    show_box, key = widget_memory.show, _row_box(grid)
    if grid.row_names:
        row = show_box(st.text_input, texts.HISTORY_ROW, key=key, default=f"{lowest_row}")
    else:
        row = f"{show_box(st.number_input, texts.HISTORY_ROW, 0, key=key, default=lowest_row)}"
    number = show_box(st.number_input, texts.HISTORY_PLANT, 0, key=_PLANT, default=lowest)
    plant, face = _plant(grid, row, number), 1
    if grid.twin[plant] >= 0:
        face = show_box(
            st.segmented_control, texts.HISTORY_FACE, [1, 2], key=_FACE, default=1, required=True
        )
    return of_face(grid, plant, face)


def of_face(grid: PlantGrid, plant: int, face: int) -> int:
    """Return the face, 1 or 2, of a plant that is its first one; itself where it has but one."""
    return int(grid.twin[plant]) if face == 2 and grid.twin[plant] >= 0 else plant


def _row_box(grid: PlantGrid) -> str:
    """Return the key of the box for the row: names need another than numbers."""
    return f"{_ROW} called" if grid.row_names else _ROW


def _plant(grid: PlantGrid, row: str, number: int) -> int:
    """Return the plant that was tapped, or that is meant by what was typed."""
    if st.session_state.get(_TAPPED_AT) == (row, number):
        return plant_at(grid, int(row), number)
    return plant_meant(grid, row, number)


def _lowest(grid: PlantGrid) -> tuple[int, int]:
    """Return the lowest row, and the lowest plant in it, that there is on a plot."""
    numbered = plant_numbers(grid)
    row = int(numbered.line.min())
    return row, int(numbered.number[numbered.line == row].min())


def _show_photos(choices: Choices, plant: int) -> None:
    """Show the last photos of a plant."""
    if choices.season is None:
        return
    own = [photo for photo in photos.photos_of(choices.season) if photo.plant == plant]
    for photo in own[:_MOST_PHOTOS]:
        found = photos.picture(choices.season, photo.id)
        if found is not None:
            day, who = choices.units.said_day(photo.on, choices.on), texts.isolated(photo.scout)
            st.html(_picture(*found, f"{day}, {who}"))


def _picture(kind: str, data: bytes, said: str) -> str:
    """Return a photo with its line, for the browser to draw: it need not be one that opens."""
    source = f"data:{kind};base64,{base64.b64encode(data).decode()}"
    return (
        f'<figure style="margin:0"><img alt="{escape(said)}" src="{source}" style="width:100%">'
        f"<figcaption>{escape(said)}</figcaption></figure>"
    )


def _on_route(choices: Choices, plant: int) -> str:
    """Return which stop of the day's route the plant is, and when."""
    shown = chosen_day.route(choices)
    stops = np.flatnonzero(shown.route.plant == plant)
    if not len(stops):
        return texts.HISTORY_NO_STOP
    at = shown.at(float(shown.route.arrive_s[stops[0]]))
    return texts.HISTORY_STOP.format(n=int(stops[0]) + 1, all=len(shown.route), time=f"{at:%H:%M}")


def _taken_as_treated(choices: Choices, plant: int) -> bool:
    """Return whether a plant was found, and so is taken as free of pests from then on."""
    season = choices.season
    if season is None or not season.settings.belief.treated:
        return False
    return bool(season.history.states(season.settings.day(choices.on))[plant] == FOUND)


def _events(choices: Choices, plant: int) -> list[str]:
    """Return what was found on a plant and with what it was treated, in the order of days."""
    season = choices.season
    if season is None:
        return [texts.HISTORY_NEVER]
    own = season.history.inspections.plant == plant
    done = season.history.inspections.take(own)
    days, seconds = done.date.tolist(), done.second.tolist()
    lines = _inspected(choices, done, season.history.says_gone[own])
    treated = [one for one in season.treatments() if one.place.plants[plant]]
    for one in reversed(treated):  # those behind first: places before them stay what they are
        over_s = one.application.over_s
        later = [
            day > one.on or (day == one.on and second > over_s)
            for day, second in zip(days, seconds, strict=True)
        ]
        at = later.index(True) if True in later else len(days)
        lines.insert(at, _treated(choices, one))
    return lines if len(done) else [*lines, texts.HISTORY_NEVER]


def _inspected(choices: Choices, done: Inspections, gone: NDArray[np.bool_]) -> list[str]:
    """Return a line for each inspection of a plant; `gone`: whether it said the plant is gone."""
    lines = []
    for k, (day, second) in enumerate(zip(done.date.tolist(), done.second.tolist(), strict=True)):
        result = texts.RESULTS_OF[GONE] if gone[k] else texts.HISTORY_RESULTS[int(done.result[k])]
        if not np.isnan(done.count[k]):
            result = texts.RESULT_COUNTED.format(result=result, n=number(done.count[k], ",g"))
        note = noted_beside_gone(str(done.notes[k])) if gone[k] else done.notes[k]
        beside = [texts.written(said) for said in (note, done.who[k]) if said]
        lines.append(" · ".join([_listed(choices, day, second, result), *beside]))
    return lines


def _treated(choices: Choices, one: KeptTreatment) -> str:
    """Return with what a plant was treated, and when that was over."""
    said = texts.HISTORY_SPRAYED
    if product := one.application.product:
        said = texts.HISTORY_SPRAYED_WITH.format(product=texts.isolated(product))
    return _listed(choices, one.on, one.application.over_s, said)


def _listed(choices: Choices, on: date, second: float, what: str) -> str:
    return f"- {line_of(choices, on, second, f'**{what}**')}"


def line_of(choices: Choices, on: date, second: float, what: str) -> str:
    """Return what was done on a day, with its time where that is known and of this day."""
    known = second < DAY_S
    at = f" {int(second) // 3600:02d}:{int(second) // 60 % 60:02d}" if known else ""
    day = choices.units.said_day(on, choices.on)
    return texts.HISTORY_LINE.format(day=day, time=at, result=what)


def _chance(chance: float) -> str:
    return in_words(chance_figure(chance, 1))
