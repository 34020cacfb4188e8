"""The sidebar: widgets in, one frozen value out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date, datetime
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.errors import FieldmonError
from fieldmon.infestation.observations import Observations
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.plot import robot as robots
from fieldmon.plot.layout import Planting
from fieldmon.plot.plot import Plot, planting_of

from . import (
    cached,
    canopies,
    early,
    files,
    maps,
    remembered,
    risks,
    seasons,
    texts,
    verdicts,
    warming,
)
from .early import SAMPLE, WHERE
from .edits import Edit, edited
from .files import File, Heard
from .units import AREAS_M2, DATES, LENGTHS, Units

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.monitoring import Season
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.field import Field
    from fieldmon.plot.robot import Robot

    from .early import Places

LAST_SAMPLE_DAY = date(2026, 11, 16)
#: what is put into cache keys for the sample estate's files
_SAMPLE = "sample/"
_DAY = "day {season}"
# what is said of rows by hand, in the chosen unit
_LENGTHS = ("row_spacing", "plant_spacing", "headland")
# a sampler's box is too narrow for more than its name
_NAMED = {
    "format_func": verdicts.short,
    "help": "\n".join(f"- {is_}" for is_ in texts.SAMPLERS.values()),
}
_ROOMS = {"field_map": maps.MOST_PX, "plot_map": maps.HALF_PX, "season_map": maps.HALF_PX}


@dataclass(frozen=True, eq=False)
class Choices:
    """What the person chose, read and laid out.

    Parameters
    ----------
    key
        Stands for the plot and the records in cache keys.
    plot, records
        The plot with its plants, and the records near it.
    heard
        What the imports had to say.
    robot, sampler, day
        Who inspects, who chooses, and for which day (ISO).
    units
        How numbers are written.
    project
        The season that is open, or None: nothing is kept then.
    plot_key
        Names the plot before anything was drawn on it.
    risk
        ``(n,)`` risk of the plants from a raster, or None; a season has taken it in.
    """

    key: str
    plot: Plot
    records: Observations
    heard: tuple[Heard, ...]
    robot: Robot
    sampler: str
    day: str
    units: Units
    project: Season | None = None
    plot_key: str = ""
    risk: cached.Array | None = None

    @property
    def name(self) -> str:
        """Return the plot's name, apart from the text around it, whatever its script."""
        return texts.isolated(self.plot.field.name)

    @property
    def on(self) -> date:
        """Return the day."""
        return date.fromisoformat(self.day)

    @property
    def revision(self) -> str:
        """Return what changes with everything that is recorded."""
        return "" if self.project is None else cached.revision(self.project)

    @property
    def dark(self) -> bool:
        """Return whether the page is dark."""
        return early.is_dark()

    @property
    def map_px(self) -> int:
        """Return the height of the map: half a phone's screen, more on a laptop."""
        return early.map_px()

    def today(self) -> DayPlan:
        """Return the planned day: what is left of it, once something of it was recorded."""
        if self.project is not None:
            return cached.season_today(self.key, self.revision, self.day, self.project)
        known = self.records, self.risk
        return cached.today(self.key, self.day, self.robot, self.sampler, self.plot, known)


@dataclass(frozen=True, eq=False)
class Chosen:
    """The choices, or why there are none yet (neither: nothing was brought)."""

    choices: Choices | None = None
    problem: FieldmonError | None = None


def room_px(name: str) -> tuple[int, int]:
    """Return the room that a map has on this device, by the map's name."""
    return _ROOMS[name] if name in _ROOMS and not early.is_phone() else early.room_px()


def choose(places: Places | None = None) -> Chosen:
    """Show the sidebar; return the choices, or the problem that keeps from them."""
    above, chart = (st.empty(), None) if places is None else (places.above, places.chart)
    with st.sidebar:
        where = _where()
        try:
            if where not in (texts.SAMPLE, texts.UPLOAD):
                _wait(above)
                return Chosen(_open(where))
            return Chosen(_unsaved(where, above, chart))
        except FieldmonError as error:
            return Chosen(problem=error)
        finally:
            _units()


def _wait(
    above: DeltaGenerator, chart: DeltaGenerator | None = None, field: Field | None = None
) -> None:
    """Show the outline until plants can be laid, and how far compiling is, once an installation."""
    ready = warming.start().ready
    if field is not None and chart is not None and not ready.is_set():
        early.outline(chart, field)
    while not ready.wait(0.5):
        if FIRST_USE.compiled:
            above.info(texts.COMPILING.format(n=FIRST_USE.compiled))
    above.empty()


def _where() -> str:
    options = [texts.SAMPLE, texts.UPLOAD, *seasons.names()]
    remembered.first(WHERE, st.query_params.get(WHERE))
    if remembered.value(WHERE) not in options:
        st.session_state[WHERE] = texts.SAMPLE
    chosen = remembered.show(
        st.selectbox, texts.PLOT_FROM, options, key=WHERE, help=texts.PLOT_FROM_HELP,
        filter_mode=None,
    )  # fmt: skip
    # the address leads back to the season after a reload, and to another person's screen
    if chosen == texts.SAMPLE:
        st.query_params.pop(WHERE, None)
    elif st.query_params.get(WHERE) != chosen:
        st.query_params[WHERE] = chosen
    return chosen


def open_season(name: str) -> None:
    """Let the season of this name be open from the next run on (for callbacks)."""
    st.session_state[WHERE] = name


def _open(name: str) -> Choices:
    project = cached.project(seasons.path_of(name))
    setup, key = project.settings, str(project.path)
    day = remembered.show(
        st.date_input, texts.DATE, min_value=setup.begins, key=_DAY.format(season=name),
        default=project.last_date(), format=read_units().date_format,
    )  # fmt: skip
    heard = tuple(Heard(key, cached.finding_of(remark)) for remark in cached.remarks(key, project))
    choices = Choices(
        key, project.plot, project.observations, heard, setup.robot, setup.sampler, str(day),
        read_units(), project, key,
    )  # fmt: skip
    _change(name, choices)
    return choices


def _change(name: str, choices: Choices) -> None:
    """Show who works in the season that is open, and change it on demand."""
    project = choices.project
    with st.expander(texts.WHO):
        setup, before = project.settings, project.before_change()
        key = f"{name} {setup.robot.hours} {setup.robot.look_s} {setup.sampler}"
        # a command, or "one hour more", may have set what is beyond the usual
        usual_s = setup.robot.look_s
        hours = st.slider(texts.HOURS, min(0.5, setup.robot.hours), max(16.0, setup.robot.hours),
                          setup.robot.hours, 0.5, key=f"hours {key}")  # fmt: skip
        look = st.slider(texts.LOOK, min(20.0, usual_s), max(60.0, usual_s), usual_s, 5.0,
                         format="%g", key=f"look {key}")  # fmt: skip
        names = list(texts.SAMPLERS)
        sampler = st.selectbox(
            texts.SAMPLER, names, names.index(setup.sampler), key=f"sampler {key}", **_NAMED
        )
        st.caption(verdicts.described(sampler))
        robot = replace(setup.robot, hours=float(hours), look_s=float(look))
        wanted = replace(setup, robot=robot, sampler=sampler)
        if wanted != setup:
            st.caption(texts.CHANGE_NOTE)
            if st.button(texts.CHANGE, type="primary", key="change_setup"):
                project.change(wanted, setup)
                st.rerun()
        if before is not None:
            back = verdicts.arm_name(before.sampler, before.robot.hours, before.robot.look_s)
            label = texts.UNDO_CHANGE.format(way=back, starts=f"{before.starts:%H:%M}")
            if st.button(label, key="undo_change", icon=":material/undo:"):
                project.undo_change()
                st.rerun()


def _unsaved(where: str, above: DeltaGenerator, chart: DeltaGenerator | None) -> Choices | None:
    if where == texts.SAMPLE:
        st.caption(texts.SAMPLE_NOTE)
        plot_file, record_file, plant_file = (
            _sample(early.PLOTS), _sample("mite_records.csv"), None,
        )  # fmt: skip
    else:
        brought = files.brought()
        kinds = (files.PLOT, files.RECORDS, files.PLANTS)
        plot_file, record_file, plant_file = (brought.get(kind) for kind in kinds)
        if plot_file is None and plant_file is None:
            return None
    plants, plant_key = _plants(plant_file)
    field, plot_key, heard = _field(plot_file, plants, plant_key)
    _wait(above, chart, field)
    plot, key = _plot(field, plot_key, plants)
    plot, gaps, key = canopies.of(plot, key)
    records, more, key = _records(record_file, plot, key)
    risk, said, key = risks.of(plot, key)
    robot, sampler, day = _work(where)
    return Choices(
        key, plot, records, (*heard, *gaps, *more, *said), robot, sampler, day, read_units(), None,
        plot_key, risk,
    )  # fmt: skip


def _sample(name: str) -> File:
    return File(_SAMPLE + name, SAMPLE / name)


def _plants(file: File | None) -> tuple[cached.Array | None, str]:
    if file is None:
        return None, ""
    options = files.settled(file, ReadOptions())
    return cached.measured_plants(file.key, options, file.source), f"{file.key}{options}"


def _field(
    file: File | None, plants: cached.Array | None, plant_key: str
) -> tuple[Field | None, str, tuple[Heard, ...]]:
    """Return the chosen field with its measured plants; None if there are plants only."""
    if file is None:
        return None, plant_key, ()
    options = files.settled(file, PlotOptions())
    read = cached.plots(file.key, options, file.source)
    names = [field.name for field in read.value]
    number = remembered.show(
        st.selectbox, texts.WHICH_PLOT, range(len(names)), format_func=names.__getitem__,
        key=f"feature {file.key}", default=0,
    )  # fmt: skip
    field = read.value[number or 0]
    if plants is not None:
        field = replace(field, plants=plants)
    if file.key.startswith(_SAMPLE):
        field = replace(field, paths=cached.paths(_sample("tracks.geojson").source))
    key = f"{plant_key}{file.key}{options}{number}"
    heard = tuple(Heard(file.key, f) for f in read.messages if f.feature in (None, field.name))
    return field, key, heard


def drawn(plot_key: str) -> tuple[Edit, ...]:
    """Return what was drawn on a plot, in order."""
    edits: tuple[Edit, ...] = st.session_state.get(f"edits {plot_key}", ())
    return edits


def draw(plot_key: str, edits: tuple[Edit, ...]) -> None:
    """Keep what was drawn on a plot."""
    st.session_state[f"edits {plot_key}"] = edits


def row_settings(plot_key: str) -> dict[str, float | None]:
    """Return what was said about a plot's rows by hand; None: found, or as the file says."""
    said, units = {}, read_units()
    for name in _LENGTHS:
        shown = remembered.value(f"{name} {plot_key}")
        said[f"{name}_m"] = None if shown is None else units.in_metres(shown)
    both = remembered.value(f"both_faces {plot_key}")
    bearing = remembered.value(f"row_bearing {plot_key}")
    return {**said, "row_bearing_deg": bearing, "faces": 2 if both else None}


def _plot(field: Field | None, key: str, plants: cached.Array | None) -> tuple[Plot, str]:
    """Return the plot with its plants, as the row settings and what was drawn say."""
    st.session_state["laying"] = key
    edits, given = drawn(key), row_settings(key)
    if field is None:
        planting = Planting(**{name: v for name, v in given.items() if v is not None})
        around = cached.plot_around(key, planting, plants)
        if not edits:
            return around, f"{key}{planting}"
        field = around.field
    return laid(key, edits, field, edits)


def laid(
    plot_key: str, edits: tuple[Edit, ...], field: Field, new: tuple[Edit, ...]
) -> tuple[Plot, str]:
    """Return the plot on which all `edits` are drawn, the `new` ones of them not yet on `field`."""
    planting = planting_of(field, **row_settings(plot_key))
    key = f"{plot_key}{edits}"
    return cached.plot(key, planting, edited(field, new)), f"{key}{planting}"


def _records(
    file: File | None, plot: Plot, key: str
) -> tuple[Observations, tuple[Heard, ...], str]:
    if file is None:
        return Observations.none(), (), key
    options = files.settled(file, RecordOptions())
    key = f"{key}{file.key}{options}"
    read = cached.records(key, options, file.source, plot.field)
    return read.value, tuple(Heard(file.key, finding) for finding in read.messages), key


def _work(where: str) -> tuple[Robot, str, str]:
    first = LAST_SAMPLE_DAY if where == texts.SAMPLE else datetime.now().astimezone().date()
    day = remembered.show(
        st.date_input, texts.DATE, key=_DAY.format(season=where), default=first,
        format=read_units().date_format,
    )  # fmt: skip
    with st.expander(texts.WHO, expanded=True):
        who = remembered.show(
            st.segmented_control, texts.WHO, [texts.ROBOT, texts.SCOUT], key="who",
            default=texts.ROBOT, required=True, label_visibility="collapsed",
        )  # fmt: skip
        base = robots.scout() if who == texts.SCOUT else robots.Robot()
        hours = remembered.show(st.slider, texts.HOURS, 0.5, 16.0, step=0.5, key=f"hours {who}",
                                default=base.hours)  # fmt: skip
        look = remembered.show(st.slider, texts.LOOK, 20, 60, step=5, key=f"look {who}",
                               default=int(base.look_s))  # fmt: skip
        sampler = remembered.show(
            st.selectbox, texts.SAMPLER, list(texts.SAMPLERS), key="sampler",
            default=next(iter(texts.SAMPLERS)), **_NAMED,
        )  # fmt: skip
        st.caption(verdicts.described(sampler))
    return replace(base, hours=float(hours), look_s=float(look)), sampler, str(day)


def _units() -> None:
    with st.expander(texts.DISPLAY):
        for key, label, options in (
            ("length", texts.LENGTH, LENGTHS), ("area", texts.AREA, AREAS_M2),
            ("date_like", texts.DATE_LIKE, DATES),
        ):  # fmt: skip
            remembered.show(
                st.selectbox, label, list(options), key=key, default=next(iter(options)),
                filter_mode=None, on_change=_carry_over, args=(read_units(),),
            )  # fmt: skip


def _carry_over(before: Units) -> None:
    """Carry lengths that boxes hold over into the unit that is now chosen."""
    units = read_units()
    if units.length != before.length:
        remembered.change(_LENGTHS, lambda shown: units.shown(before.in_metres(shown)))


def read_units() -> Units:
    """Return how this session wants numbers written."""
    chosen = {name: remembered.value(name) for name in ("length", "area", "date_like")}
    return Units(**{name: value for name, value in chosen.items() if value})
