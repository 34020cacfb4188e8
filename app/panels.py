"""Pieces that several pages show."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from datetime import datetime, time, timedelta
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.observations import ABSENT, PRESENT, usable
from fieldmon.io.writers import FORMATS
from fieldmon.planning.explain import explain
from fieldmon.plot.grid import plant_at, row_label

from . import cached, maps, remembered, ruler, texts
from .choices import room_px

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.infestation.observations import Observations
    from fieldmon.io.writers import HandoffPlan
    from fieldmon.io.writers.handoff import HandoffFormat
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

    from .choices import Choices

    #: takes what was tapped, by layer
    Tapped = Callable[[dict], None]

STARTS = time(6, 0)
_SEEN = {"found": PRESENT, "clean": ABSENT}
_ROW, _PLANT = "history row", "history plant"


def starts(choices: Choices, today: DayPlan) -> datetime:
    """Return the local time at which the planned route, or what is left of it, starts."""
    begins = STARTS if choices.project is None else choices.project.settings.starts
    gone = timedelta(seconds=today.scene.robot.day_s - today.scene.seconds_left)
    return datetime.combine(choices.on, begins) + gone


def stops(choices: Choices, today: DayPlan) -> pd.DataFrame:
    """Return the stops in order, as a table."""
    label = row_label(choices.plot.grid, today.route.plant)
    gone = pd.to_timedelta(today.route.arrive_s.round(), unit="s")
    columns = {
        texts.COLUMN_ARRIVE: (pd.Timestamp(starts(choices, today)) + gone).strftime("%H:%M:%S"),
        texts.COLUMN_ROW: label.line,
        texts.COLUMN_PLANT: label.number,
        texts.COLUMN_CHANCE: (100 * today.route.chance).round(1),
    }
    return pd.DataFrame(columns, pd.RangeIndex(1, len(today.route) + 1, name="stop"))


def other_formats(choices: Choices, plan: HandoffPlan) -> None:
    """Offer the route in the formats of robots, phones and paper."""
    name = st.selectbox(texts.FORMAT, list(FORMATS), key="format", filter_mode=None,
                        format_func=lambda one: f"{one}: {FORMATS[one].reader}")  # fmt: skip
    chosen = FORMATS[name]
    ending = f".{name}.zip" if chosen.several else chosen.endings[0]
    st.download_button(
        texts.DOWNLOAD_AS.format(reader=chosen.reader), partial(_handed_off, chosen, plan),
        f"route_{choices.day}{ending}", key="download_format", on_click="ignore",
    )  # fmt: skip


def _handed_off(chosen: HandoffFormat, plan: HandoffPlan) -> bytes:
    """Return a day in a format, several files as one zip; made when somebody wants it."""
    made = chosen.make(plan)
    if not chosen.several:
        return next(iter(made.values()))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for ending, data in made.items():
            archive.writestr(f"route{ending}", data)
    return packed.getvalue()


def chance_of(choices: Choices) -> cached.Array:
    """Return what is believed on the chosen day, after what was recorded of it."""
    if choices.project is None:
        return choices.today().chance
    return cached.evening(choices.key, choices.revision, choices.day, choices.project)


def _recorded(choices: Choices) -> tuple[str, Plot, Observations]:
    """Return the records that are known on the chosen day, their plot, and a key for both."""
    known = usable(choices.records, np.datetime64(choices.day)).observations
    return f"{choices.key} {choices.day}", choices.plot, known


def states_of(choices: Choices) -> cached.Array:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1); of records without a season."""
    if choices.project is None:
        return cached.recorded_states(*_recorded(choices))
    return choices.project.history.states(choices.project.settings.day(choices.on))


def spots_of(choices: Choices) -> HotSpots:
    """Return the hot spots of the chosen day: of findings in a season, else of records."""
    if choices.project is None:
        return cached.recorded_hot_spots(*_recorded(choices))
    return cached.season_hot_spots(choices.key, choices.revision, choices.day, choices.project)


def ages_of(choices: Choices) -> cached.Array:
    """Return ``(n,)`` days since each plant was inspected; -1: never."""
    if choices.project is None:
        return np.full(len(choices.plot.grid), -1)
    day = choices.project.settings.day(choices.on)
    last = choices.project.history.last_inspected(day)
    return np.where(last < 0, -1, day - last)


def plant_layers(choices: Choices, shade_by: str, rows: tuple[int, int] | None = None) -> list:
    """Return the plants' layers, made once for what is known of them, whoever is to go there."""
    key = f"{choices.key} {choices.revision} {choices.day}"
    make = partial(_plant_layers, choices, shade_by, rows)
    return cached.layers(f"plants {shade_by} {rows} {key}", make)


def _plant_layers(choices: Choices, shade_by: str, rows: tuple[int, int] | None) -> list:
    grid = choices.plot.grid
    extra = []
    if shade_by == "chance":
        chance = chance_of(choices)
        shade, notes = maps.by_chance(chance), partial(_chance_notes, chance)
    else:
        state, ages = states_of(choices), ages_of(choices)
        shade = maps.by_state(state) if shade_by == "state" else maps.by_age(ages)
        extra = maps.finds(grid, state)
        notes = partial(state_notes, state)
    layers = [maps.plants(grid, shade, notes)]
    if rows is not None and len(grid) > maps.POINTS_AT_MOST:
        line = grid.row_line[grid.row] + 1
        part = np.flatnonzero((line >= rows[0]) & (line <= rows[1]))[: maps.POINTS_AT_MOST]
        layers.append(maps.plants(grid, shade, notes, part))
    return [*layers, *extra]


def _chance_notes(chance: cached.Array, which: NDArray[np.intp]) -> list[str]:
    return [texts.TIP_CHANCE.format(chance=c) for c in chance[which].tolist()]


def state_notes(state: cached.Array, which: NDArray[np.intp]) -> list[str]:
    """Return the state of some plants in words."""
    names = texts.LEGEND_STATES
    words = ((1, names["found"]), (0, names["clean"]), (-1, names["never"]))
    said = {value: texts.TIP_STATE.format(state=word) for value, word in words}
    return [said[s] for s in state[which].tolist()]


@dataclass(frozen=True, eq=False)
class Way:
    """A route on the map, and the local time at which it starts."""

    route: Route
    begins: datetime


def route_of_day(choices: Choices) -> Way:
    """Return the way that the robot went on a day that was worked, or that it is to go."""
    today, project = choices.today(), choices.project
    if project is not None and (not len(today.route) or choices.on < project.last_date()):
        done = cached.season_done(choices.key, choices.revision, choices.day, project)
        if len(done):
            return Way(done, datetime.combine(choices.on, project.settings.starts))
    return Way(today.route, starts(choices, today))


def route_layers(choices: Choices, route: Route, *, numbers: bool) -> list:
    """Return the route's layers, made once."""
    shown = f"{choices.robot} {choices.sampler} {numbers} {choices.dark} {route.end_s}"
    key = f"route {choices.key} {choices.revision} {choices.day} {shown}"
    return cached.layers(key, partial(maps.route, route, numbers=numbers, dark=choices.dark))


def with_marks(choices: Choices, layers: list, shown: list[str]) -> list:
    """Return the layers with hot spots and records, where these are to be shown."""
    if "hot" in shown:
        layers = maps.with_hot(layers, _hot_layers(choices))
    if "records" in shown:
        layers = layers + maps.records(choices.records, dark=choices.dark)
    return layers


def _hot_layers(choices: Choices) -> list:
    def make() -> list:
        return maps.hot(choices.plot.grid, spots_of(choices), dark=choices.dark)

    key = f"{choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(f"hot {key}", make)


def draw(
    choices: Choices, layers: list, key: str, tap: Tapped | None = None,
    clicked: ruler.Clicked | None = None, chart: DeltaGenerator | None = None,
) -> None:  # fmt: skip
    """Show a map with outline, scale and north, in `chart` if there is a place for it already.

    `tap` is called once for each thing that is tapped, `clicked` with every position clicked on.
    """
    grid = choices.plot.grid
    route = next((layer for layer in layers if layer.id == "route"), None)
    alt = texts.MAP_ALT.format(
        name=choices.plot.field.name, plants=len(grid), finds=int((states_of(choices) == 1).sum()),
        stops=0 if route is None else len(route_of_day(choices).route),
    )  # fmt: skip
    outline = maps.boundary(choices.plot.field, dark=choices.dark)
    picture = maps.deck(grid, [outline, *layers], room_px(key))
    picture.renamed = st.session_state.get(f"renamed {key}", frozenset())
    # a callback, since what was tapped stays selected in all the runs that follow
    (chart or st).pydeck_chart(
        picture, height=choices.map_px, key=key, alt=alt,
        on_select="ignore" if tap is None else partial(_tapped, key, tap),
    )  # fmt: skip
    ruler.show(key, picture.initial_view_state, choices.units, clicked)


def _tapped(key: str, tap: Tapped) -> None:
    objects = {
        name.removesuffix(maps.RENAMED): hits
        for name, hits in st.session_state[key].selection.objects.items()
    }
    renamed = st.session_state.get(f"renamed {key}", frozenset())
    st.session_state[f"renamed {key}"] = renamed ^ objects.keys()
    tap(objects)


def signs(shown: Sequence[str]) -> None:
    """Show what the signs of the layers shown mean."""
    captions([text for name, text in texts.LEGENDS.items() if name in shown])


def captions(parts: Sequence[str]) -> None:
    """Show what the signs of a map mean."""
    st.caption(" · ".join(parts))


def route_figures(choices: Choices, today: DayPlan) -> None:
    """Show the figures to decide by."""
    route, n = today.route, len(choices.plot.grid)
    finds = route.expected_found
    with st.container(horizontal=True):
        st.metric(texts.PLANTS_TO_INSPECT, f"{len(route):,} / {n:,}", width="content")
        st.metric(texts.TIME, f"{route.end_s / 3600:.1f} h", width="content")
        st.metric(texts.DRIVE, choices.units.metres(route.drive_m), width="content")
        st.metric(texts.FINDS, f"{finds:.1f}", help=texts.FINDS_HELP, width="content")


def said_of_day(choices: Choices, today: DayPlan) -> None:
    """Say what was recorded of the day, and why there is no route where there is none."""
    said = "" if len(today.route) else texts.NO_STOPS
    if choices.project is not None:
        now = cached.known(choices.key, choices.revision, choices.day, choices.project)
        done = {"inspected": now.inspected_today, "found": now.found_today}
        if now.inspected_today:
            st.info((texts.TODAY_OVER if said else texts.TODAY_DONE).format(**done))
            return
    if said:
        st.warning(said)


def changes(choices: Choices) -> list[str]:
    """Return sentences on what changed since yesterday."""
    project, revision = choices.project, choices.revision
    if project is None:
        return []
    day = project.settings.day(choices.on)
    if day == 0:
        return [texts.CHANGED_FIRST]
    yesterday = choices.on - timedelta(days=1)
    own = (choices.key, revision)
    before = cached.day_in_figures(*own, str(yesterday), project)
    now = cached.day_in_figures(*own, choices.day, project)
    on = choices.units.day(yesterday)
    said = [texts.CHANGED_NONE.format(day=on)]
    if before.inspected:
        said = [texts.CHANGED_FINDS.format(found=before.found, inspected=before.inspected, day=on)]
    diff = now.expected - before.expected
    said.append(
        texts.CHANGED_OUT.format(
            now=now.expected, before=before.expected, diff=abs(diff), sign="+" if diff >= 0 else "−"
        )
    )
    spots = [len(cached.season_hot_spots(*own, day, project))
             for day in (str(yesterday), choices.day)]  # fmt: skip
    if spots[0] != spots[1]:
        said.append(texts.CHANGED_HOT.format(now=spots[1], before=spots[0]))
    rows = _risen(choices, str(yesterday))
    return [*said, texts.CHANGED_ROWS.format(rows=rows)] if rows else said


def found_on_day(choices: Choices) -> dict[str, str]:
    """Return the numbers of the plants found on the day, by row."""
    project = choices.project
    if project is None:
        return {}
    done = project.history.inspections.on(choices.on)
    label = row_label(choices.plot.grid, np.unique(done.plant[done.result == FOUND]))
    rows: dict[str, list[str]] = {}
    for line, number in zip(label.line.tolist(), label.number.tolist(), strict=True):
        rows.setdefault(texts.REPORT_IN_ROW.format(row=line), []).append(str(number))
    return {row: ", ".join(numbers) for row, numbers in rows.items()}


def reasons(choices: Choices, today: DayPlan) -> list[str]:
    """Return what the stops of the day are for, in sentences."""
    project = choices.project
    if project is None or not len(today.route):
        return []
    done, now = project.history.inspections, np.datetime64(choices.on)
    lately = (done.result == FOUND) & (done.date <= now) & (done.date > now - 7)
    finds = dict(zip(done.plant[lately].tolist(), done.date[lately].tolist(), strict=True))
    on = [texts.WHY_TODAY if d == choices.on else f"{d:%A}" for d in finds.values()]
    return explain(today.scene, today.work, np.array([*finds], np.int32), on)


def _risen(choices: Choices, yesterday: str) -> str:
    """Return the three rows whose mean chance rose most over the night, in words."""
    grid, project = choices.plot.grid, choices.project
    line = grid.row_line[grid.row]
    maps_ = [cached.morning(choices.key, choices.revision, day, project)
             for day in (yesterday, choices.day)]  # fmt: skip
    total = [np.bincount(line, chance) for chance in maps_]
    rise = (total[1] - total[0]) / np.maximum(np.bincount(line), 1)
    top = [k for k in np.argsort(-rise)[:3] if rise[k] > 0.001]
    return ", ".join(f"{k + 1} (+{rise[k]:.1%})" for k in top)


def take_plant(choices: Choices, objects: dict) -> None:
    """Take the plant that was tapped as the one whose history is shown."""
    hits = [hit["i"] for layer in objects.values() for hit in layer if "i" in hit]
    if hits:
        grid = choices.plot.grid
        label = row_label(grid, np.array([min(hits[0], len(grid) - 1)]))
        st.session_state[_ROW], st.session_state[_PLANT] = int(label.line[0]), int(label.number[0])


def chosen_layers(choices: Choices) -> list:
    """Return the ring round the plant whose history is shown, if there is such a plant."""
    try:
        plant = plant_at(choices.plot.grid, *(remembered.value(key, 1) for key in (_ROW, _PLANT)))
    except FieldmonError:
        return []  # its history says why
    return maps.chosen(choices.plot.grid, plant)


def history(choices: Choices) -> None:
    """Show what is known of the plant tapped, or of the one whose row and number are given."""
    st.markdown(f"**{texts.HISTORY}**")
    st.caption(texts.HISTORY_TAP)
    row, number = (
        remembered.show(st.number_input, label, 1, key=key, default=1)
        for label, key in ((texts.HISTORY_ROW, _ROW), (texts.HISTORY_PLANT, _PLANT))
    )
    plant = plant_at(choices.plot.grid, int(row), int(number))
    now = first = chance_of(choices)
    if choices.project is not None:
        begins = str(choices.project.settings.begins)
        first = cached.morning(choices.key, choices.revision, begins, choices.project)
    st.markdown(texts.HISTORY_NOW.format(now=now[plant], first=first[plant]))
    for line in _looks(choices, plant):
        st.markdown(line)


def _looks(choices: Choices, plant: int) -> list[str]:
    project = choices.project
    if project is None:
        return [texts.HISTORY_NEVER]
    done = project.history.inspections
    own = np.flatnonzero(done.plant == plant)
    lines = []
    for k in own.tolist():
        second = done.second[k]
        at = "" if np.isnan(second) else f" {int(second) // 3600:02d}:{int(second) // 60 % 60:02d}"
        day = choices.units.day(done.date[k].item())
        result = texts.HISTORY_RESULTS[int(done.result[k])]
        lines.append(texts.HISTORY_LINE.format(day=day, time=at, result=result))
    return lines or [texts.HISTORY_NEVER]


def meanings(choices: Choices) -> list[str]:
    """Return where each hot spot is and what it means, in words."""
    spots, grid = spots_of(choices), choices.plot.grid
    if not len(spots):
        return [texts.HOT_NONE]
    said = []
    for k in range(min(len(spots), 8)):
        p = float(spots.p[k])
        chance = texts.CHANCE_P_SMALL if p < 1e-4 else texts.CHANCE_P.format(n=max(round(1 / p), 1))
        said.append(
            texts.HOT_MEANS.format(
                rows=_place(grid, np.flatnonzero(spots.of_plant == k)),
                found=spots.found[k], inspected=spots.inspected[k], plants=spots.plants[k],
                expected=spots.expected[k], p=chance,
            )
        )  # fmt: skip
    return said


def _place(grid: PlantGrid, plants: cached.Array) -> str:
    """Return which rows and which of their plants these are, in words."""
    label = row_label(grid, plants)
    first, last = int(label.line.min()), int(label.line.max())
    said = texts.HOT_ROW if first == last else texts.HOT_ROWS
    low, high = int(label.number.min()), int(label.number.max())
    return said.format(first=first, last=last, low=low, high=high)


def remarks_on_records(choices: Choices) -> list[str]:
    """Return what planning says about records it cannot use."""
    return list(usable(choices.records, np.datetime64(choices.day)).messages())


def records_until(choices: Choices) -> tuple[Observations, str]:
    """Show a slider over the days of the records; return those up to its day, and how many."""
    records = choices.records
    known = np.unique(records.day[~np.isnat(records.day)])
    shown = records
    if len(known) > 1:
        first, last = (day.item() for day in (known[0], known[-1]))
        until = st.slider(texts.RECORDS, first, last, last, key=f"until {first} {last}")
        shown = records.take(np.isnat(records.day) | (records.day <= np.datetime64(until)))
    if not len(records):
        return records, ""
    counts = {name: int((shown.present == value).sum()) for name, value in _SEEN.items()}
    return shown, texts.RECORDS_SHOWN.format(shown=len(shown), all=len(records), **counts)
