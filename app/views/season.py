"""The season: found and inspected by day, what is still out there; recording and undoing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from app import charts, keeping, recording, texts

if TYPE_CHECKING:
    from app.choices import Choices
    from fieldmon.project import Status


def show(choices: Choices) -> None:
    """Show where the season stands, and take in what was found."""
    st.subheader(f"{choices.name}: {texts.SEASON}")
    if choices.project is None:
        st.markdown(texts.NEEDS_SEASON)
        keeping.begin(choices)
        return
    statuses = keeping.statuses(choices)
    _figures(statuses[-1])
    left, right = st.columns([1, 1])
    with left:
        _charts(choices, statuses)
    with right:
        recording.show(choices)
        with st.expander(texts.BATCHES, expanded=True):
            keeping.batches(choices)


def _figures(now: Status) -> None:
    out = now.outlook
    with st.container(horizontal=True):
        st.metric(texts.EXPECTED_LEFT, f"{out.expected:.1f} ({out.low}-{out.high})",
                  help=texts.EXPECTED_HELP, width="content")  # fmt: skip
        st.metric(texts.FOUND_EVER, f"{now.found:,}", width="content")
        st.metric(texts.DETECTED, f"{now.detection_pct:.0f} %", width="content")
        st.metric(texts.INSPECTED_EVER, f"{now.inspected:,} / {now.plants:,}", width="content")
        st.metric(texts.CLEAN_CHANCE, f"{out.chance_clean:.1%}", width="content")


def _charts(choices: Choices, statuses: list[Status]) -> None:
    axes = (texts.DATE_AXIS, texts.INSPECTED_AXIS, texts.FOUND_AXIS)
    st.altair_chart(charts.season_days(statuses, axes), alt=texts.FOUND_AXIS)
    st.altair_chart(
        charts.still_out(statuses, (texts.DATE_AXIS, texts.OUT_AXIS)), alt=texts.OUT_AXIS
    )
    now, grid = statuses[-1], choices.plot.grid
    st.markdown(f"**{texts.ROW_AGES}**")
    line = grid.row_line.astype(np.int64) + 1
    never = len(set(line.tolist())) - len(set(line[~np.isnan(now.days_since)].tolist()))
    st.altair_chart(
        charts.row_ages(now.days_since, line, (texts.ROW_AXIS, texts.DAYS_SINCE)),
        alt=texts.ROW_AGES,
    )
    st.caption(texts.NEVER_ROWS.format(n=never, all=len(set(line.tolist()))))
