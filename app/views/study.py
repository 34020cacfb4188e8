"""The published experiments without prior information, made again."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from fieldmon.studies.thesis.chapter4.report import report_html
from fieldmon.studies.thesis.chapter4.study import run_no_prior, table_names
from fieldmon.studies.tidy_csv import csv_text

from ..actions import studying
from ..words import texts

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter4.study import NoPriorStudy


def show() -> None:
    """Choose a table, run it with progress, show it beside the printed one."""
    st.subheader(texts.STUDY_TITLE)
    st.caption(texts.STUDY_INTRO)
    with st.container(horizontal=True, vertical_alignment="bottom"):
        table = st.selectbox(texts.STUDY_TABLE, table_names(), key="study_table", width=200)
        replicates = st.number_input(
            texts.REPLICATES, 2, 2000, 100, 50, key="study_replicates", width=200
        )
        seed = st.number_input(texts.SEED, 0, 10_000, 1, key="study_seed", width=150)
        started = st.button(texts.STUDY_RUN, type="primary", key="study_run")
    asked = (table, int(replicates), int(seed))
    studying.say_stopped("study")
    if started:
        made = studying.run("study", lambda progress: run_no_prior(*asked, progress))
        if made is None:
            return
        st.session_state["study"] = (asked, made, csv_text(made.cells), report_html(made))
    kept = st.session_state.get("study")
    if kept is not None and kept[0] == asked:
        _result(f"no_prior_{table}", *kept[1:])


def _result(name: str, made: NoPriorStudy, table_csv: str, report: str) -> None:
    for part in made.tables:
        st.markdown(f"**{part.title}**")
        st.markdown("\n".join(f"- {sentence}" for sentence in part.summary))
    st.dataframe(pd.read_csv(io.StringIO(table_csv)), height=400, hide_index=True)
    with st.container(horizontal=True):
        st.download_button(
            texts.STUDY_REPORT, report, f"{name}.html", "text/html", on_click="ignore"
        )
        st.download_button(texts.STUDY_CSV, table_csv, f"{name}.csv", "text/csv", on_click="ignore")
