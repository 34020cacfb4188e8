"""The published experiments with prior information, made again; on the chosen plot too."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from app import texts
from fieldmon.errors import FieldmonError
from fieldmon.prior import PriorSettings, prior_chance
from fieldmon.thesis.with_prior.published import PARTS
from fieldmon.thesis.with_prior.report import report_html
from fieldmon.thesis.with_prior.sites import Site
from fieldmon.thesis.with_prior.studies import (
    TITLES,
    csv_text,
    label_of,
    rows,
    run_prior,
    run_site,
)

if TYPE_CHECKING:
    from app.choices import Choices
    from fieldmon.thesis.with_prior.studies import Part, Study


def show(choices: Choices | None) -> None:
    """Choose a scenario, a sweep or the own plot; run it with progress, show it."""
    st.subheader(texts.PRIOR_TITLE)
    st.caption(texts.PRIOR_INTRO)
    names = [*PARTS] if choices is None else [*PARTS, texts.PRIOR_OWN]
    with st.container(horizontal=True, vertical_alignment="bottom"):
        part = st.selectbox(
            texts.PRIOR_PART, names, key="prior_part", width=320,
            format_func=lambda name: TITLES.get(name, name),
        )  # fmt: skip
        seeds = st.number_input(texts.REPLICATES, 2, 1000, 10, 10, key="prior_seeds", width=200)
        started = st.button(texts.STUDY_RUN, type="primary", key="prior_run")
    asked = (part, int(seeds), choices.key if choices and part == texts.PRIOR_OWN else "")
    if started:
        bar = st.progress(0.0)

        def progress(done: int, total: int) -> None:
            text = texts.STUDY_PROGRESS.format(done=done, total=total)
            bar.progress(done / max(total, 1), text)

        try:
            if choices is not None and part == texts.PRIOR_OWN:
                made = run_site(_site(choices), int(seeds), progress=progress)
            else:
                made = run_prior((part,), int(seeds), progress=progress)
        except FieldmonError as error:
            st.error(str(error))
            return
        bar.empty()
        st.session_state["prior_study"] = (asked, made, csv_text(rows(made)), report_html(made))
    kept = st.session_state.get("prior_study")
    if kept is not None and kept[0] == asked:
        _result(*kept[1:])


def _site(choices: Choices) -> Site:
    """Return the chosen plot; where it has records, they seed the start."""
    plot = choices.plot
    if not len(choices.records):
        return Site(plot.field.name, plot.aisles, plot.field)
    day = np.datetime64(choices.day, "D")
    chance = prior_chance(plot.grid, plot.field, choices.records, day, PriorSettings())
    return Site(plot.field.name, plot.aisles, plot.field, chance)


def _result(made: Study, table_csv: str, report: str) -> None:
    for part in made.parts:
        st.markdown(f"**{part.title}**")
        st.line_chart(_curves(part), x_label=texts.DAY_AXIS, y_label=texts.DETECTION_AXIS)
    if made.compared:
        st.dataframe(pd.read_csv(io.StringIO(csv_text(made.compared))))
    st.dataframe(pd.read_csv(io.StringIO(table_csv)), height=300)
    with st.container(horizontal=True):
        st.download_button(texts.STUDY_REPORT, report, "prior.html", "text/html", on_click="ignore")
        st.download_button(texts.STUDY_CSV, table_csv, "prior.csv", "text/csv", on_click="ignore")


def _curves(part: Part) -> pd.DataFrame:
    """Return the mean detection day by day, a column a configuration."""
    columns = {}
    for runs in part.runs:
        name = label_of(part.name, runs.trial)
        size = f", {runs.trial.hectares:g} ha" if part.name == "size" else ""
        columns[name + size] = runs.detection_pct.mean(axis=0)
    table = pd.DataFrame(columns)
    table.index += 1
    return table
