"""The published experiments with prior information, made again; on the chosen plot too."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from fieldmon.studies.thesis.chapter5.published import PARTS
from fieldmon.studies.thesis.chapter5.report import report_html
from fieldmon.studies.thesis.chapter5.study import (
    TITLES,
    rows,
    run_prior,
    run_site,
)
from fieldmon.studies.tidy_csv import csv_text

from ..actions import studying
from ..show import charts
from ..show.study_curves import curves
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter5.study import PriorStudy

    from ..actions.studying import Progress
    from ..state.choices import Choices

#: stands for the plot that is open, whatever it is called in a language
_OWN = "This plot"


def show(choices: Choices | None) -> None:
    """Choose a scenario, a sweep or the own plot; run it with progress, show it."""
    st.subheader(texts.PRIOR_TITLE)
    st.caption(texts.PRIOR_INTRO)
    names = [*PARTS] if choices is None else [*PARTS, _OWN]
    with st.container(horizontal=True, vertical_alignment="bottom"):
        part = st.selectbox(
            texts.PRIOR_PART, names, key="prior_part", width=320,
            format_func=lambda name: texts.PRIOR_OWN if name == _OWN else TITLES.get(name, name),
        )  # fmt: skip
        seeds = st.number_input(texts.REPLICATES, 2, 1000, 10, 10, key="prior_seeds", width=200)
        started = st.button(texts.STUDY_RUN, type="primary", key="prior_run")
    asked = (part, int(seeds), choices.key if choices and part == _OWN else "")
    studying.say_stopped("prior")
    if started:
        own = choices if part == _OWN else None
        made = studying.run("prior", lambda progress: _run(part, int(seeds), own, progress))
        if made is None:
            return
        st.session_state["prior_study"] = (asked, made, csv_text(rows(made)), report_html(made))
    kept = st.session_state.get("prior_study")
    if kept is not None and kept[0] == asked:
        _result(*kept[1:])


def _run(part: str, seeds: int, own: Choices | None, progress: Progress) -> PriorStudy:
    if own is not None:
        return run_site(studying.site_of(own), seeds, progress=progress)
    return run_prior((part,), seeds, progress=progress)


def _result(made: PriorStudy, table_csv: str, report: str) -> None:
    for part in made.parts:
        st.markdown(f"**{part.title}**")
        chart = charts.curves(curves(part), (texts.DAY_AXIS, texts.DETECTION_AXIS))
        st.altair_chart(chart, alt=texts.STUDY_ALT.format(title=part.title))
    if made.compared:
        st.dataframe(pd.read_csv(io.StringIO(csv_text(made.compared))), hide_index=True)
    st.dataframe(pd.read_csv(io.StringIO(table_csv)), height=300, hide_index=True)
    with st.container(horizontal=True):
        st.download_button(texts.STUDY_REPORT, report, "prior.html", "text/html", on_click="ignore")
        st.download_button(texts.STUDY_CSV, table_csv, "prior.csv", "text/csv", on_click="ignore")
