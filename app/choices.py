"""The sidebar: widgets in, one frozen value out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any

import streamlit as st

from fieldmon import robot as robots
from fieldmon.errors import ChoiceNeeded, FieldmonError
from fieldmon.field import Field, Observations
from fieldmon.geodata.options import PlotOptions, ReadOptions, RecordOptions, Upload
from fieldmon.monitor import Plot, planting_of

from . import cached, texts

if TYPE_CHECKING:
    from fieldmon.geodata.findings import Finding
    from fieldmon.robot import Robot

SAMPLE = Path(__file__).resolve().parents[1] / "sample_data"
LAST_SAMPLE_DAY = date(2026, 11, 16)


@dataclass(frozen=True, eq=False)
class Choices:
    """What the person chose, read and laid out.

    Parameters
    ----------
    key
        Stands for the plot and the records in cache keys.
    plot, records
        The plot with its plants, and the records near it.
    findings
        What the imports had to say.
    robot, sampler, day
        Who inspects, who chooses, and for which day (ISO).
    """

    key: str
    plot: Plot
    records: Observations
    findings: tuple[Finding, ...]
    robot: Robot
    sampler: str
    day: str

    @property
    def phone(self) -> bool:
        """Return whether the page is shown on a phone, by what its browser says."""
        return "Mobi" in (st.context.headers.get("User-Agent") or "")

    @property
    def map_px(self) -> int:
        """Return the height of the map: half a phone's screen, more on a laptop."""
        return 400 if self.phone else 500


@dataclass(frozen=True, eq=False)
class _File:
    """A file to read: what stands for it in keys, and where it is or its bytes."""

    key: str
    source: Path | Upload


def choose() -> Choices | None:
    """Show the sidebar; return the choices, or None while there is no plot to show."""
    with st.sidebar:
        files = _files()
        if files is None:
            return None
        plot_file, record_file, plant_file = files
        try:
            field, key, findings = _field(plot_file, plant_file)
            plot, key = _plot(field, key)
            records, heard, key = _records(record_file, plot, key)
            robot, sampler, day = _work(record_file)
        except FieldmonError as error:
            _say(error)
            return None
    return Choices(key, plot, records, (*findings, *heard), robot, sampler, day)


def _files() -> tuple[_File | None, _File | None, _File | None] | None:
    where = st.segmented_control(
        texts.PLOT_FROM, [texts.SAMPLE, texts.UPLOAD], default=texts.SAMPLE, key="where"
    )
    if where != texts.UPLOAD:
        st.caption(texts.SAMPLE_NOTE)
        return _sample("paran_estate.zip"), _sample("mite_records.csv"), None
    plot = _uploaded(st.file_uploader(texts.PLOT_FILE, key="plot_file"))
    records = _uploaded(st.file_uploader(texts.RECORD_FILE, key="record_file"))
    plants = _uploaded(st.file_uploader(texts.PLANT_FILE, key="plant_file"))
    return None if plot is None and plants is None else (plot, records, plants)


def _sample(name: str) -> _File:
    return _File(f"sample/{name}", SAMPLE / name)


def _uploaded(file: Any) -> _File | None:  # noqa: ANN401 - Streamlit's class is private
    if file is None:
        return None
    data = file.getvalue()
    return _File(cached.digest(data), Upload(file.name, data))


def _field(
    plot_file: _File | None, plant_file: _File | None
) -> tuple[Field | None, str, tuple[Finding, ...]]:
    """Return the chosen field with its measured plants; None if there are plants only."""
    plants, key = None, ""
    if plant_file is not None:
        options = _settled(plant_file, ReadOptions())
        plants = cached.measured_plants(plant_file.key, options, plant_file.source)
        key = f"{plant_file.key}{options}"
    if plot_file is None:
        st.session_state["plants"] = plants
        return None, key, ()
    options = _settled(plot_file, PlotOptions())
    read = cached.plots(plot_file.key, options, plot_file.source)
    names = [field.name for field in read.value]
    name = st.selectbox(texts.WHICH_PLOT, names, key=f"feature {plot_file.key}")
    field = read.value[names.index(name)]
    if plants is not None:
        field = replace(field, plants=plants)
    if plot_file.key.startswith("sample/"):
        field = replace(field, paths=cached.paths(_sample("tracks.geojson").source))
    return field, f"{key}{plot_file.key}{options}{name}", read.findings


def _plot(field: Field | None, key: str) -> tuple[Plot, str]:
    """Return the plot with its plants, as the row settings say."""
    with st.expander(texts.ROWS):
        bearing = st.number_input(
            texts.BEARING, 0.0, 360.0, None, 0.5, help=texts.BEARING_HELP, key="bearing"
        )
        rows = st.number_input(
            texts.ROW_SPACING, 0.1, 50.0, None, 0.1, help=texts.SPACING_HELP, key="rows"
        )
        plants = st.number_input(
            texts.PLANT_SPACING, 0.1, 50.0, None, 0.1, help=texts.SPACING_HELP, key="plants_apart"
        )
        headland = st.number_input(texts.HEADLAND, 0.1, 50.0, 4.0, 0.5, key="headland")
        both_faces = st.toggle(texts.BOTH_FACES, key="both_faces")
    given = {
        "row_bearing_deg": bearing,
        "row_spacing_m": rows,
        "plant_spacing_m": plants,
        "headland_m": headland,
        "faces": 2 if both_faces else None,
    }
    if field is None:
        by_hand = {name: value for name, value in given.items() if value is not None}
        from fieldmon.planting import Planting  # noqa: PLC0415 - only without a boundary

        planting = Planting(**by_hand)
        return cached.plot_around(key, planting, st.session_state["plants"]), f"{key}{planting}"
    planting = planting_of(field, **given)
    return cached.plot(key, planting, field), f"{key}{planting}"


def _records(
    file: _File | None, plot: Plot, key: str
) -> tuple[Observations, tuple[Finding, ...], str]:
    if file is None:
        return Observations.none(), (), key
    options = _settled(file, RecordOptions())
    key = f"{key}{file.key}{options}"
    read = cached.records(key, options, file.source, plot.field)
    return read.value, read.findings, key


def _work(record_file: _File | None) -> tuple[Robot, str, str]:
    with st.expander(texts.WHO, expanded=True):
        who = st.segmented_control(texts.WHO, [texts.ROBOT, texts.SCOUT], default=texts.ROBOT,
                                   key="who", label_visibility="collapsed")  # fmt: skip
        base = robots.scout() if who == texts.SCOUT else robots.Robot()
        hours = st.slider(texts.HOURS, 0.5, 16.0, base.hours, 0.5, key=f"hours {who}")
        look = st.slider(texts.LOOK, 20, 60, int(base.look_s), 5, key=f"look {who}")
        names = list(texts.SAMPLERS)
        sampler = st.selectbox(
            texts.SAMPLER, names, format_func=texts.SAMPLERS.__getitem__, key="sampler"
        )
        is_sample = record_file is not None and record_file.key.startswith("sample/")
        day = st.date_input(
            texts.DATE, LAST_SAMPLE_DAY if is_sample else "today", key=f"day {is_sample}"
        )
    return replace(base, hours=float(hours), look_s=float(look)), sampler, str(day)


def _settled(file: _File, options: Any) -> Any:  # noqa: ANN401 - any of three options
    """Return the options with what was answered for this file before."""
    for option, value in st.session_state.get(f"answers {file.key}", ()):
        options = options.choose(option, value)
    st.session_state["asking"] = file.key
    return options


def _say(error: FieldmonError) -> None:
    """Show a problem as its sentence; where the file leaves a choice, ask for it."""
    if not isinstance(error, ChoiceNeeded):
        st.error(str(error))
        return
    st.warning(str(error))
    asking = st.session_state.get("asking", "")
    label = f"{texts.CHOOSE}: {error.option}"
    if error.choices and error.option != "columns":
        value = st.selectbox(label, error.choices, key=f"ask {asking} {error.option}")
    else:
        hint = ", ".join(error.choices)
        value = st.text_input(label, placeholder="date=Datum", help=hint or None,
                              key=f"ask {asking} {error.option}")  # fmt: skip
    if st.button(texts.CHOOSE_BUTTON, key=f"use {asking} {error.option}") and value:
        answers = st.session_state.get(f"answers {asking}", ())
        st.session_state[f"answers {asking}"] = (*answers, (error.option, value))
        st.rerun()
