"""All plots in a table that can be sorted: their state, and who works there when."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd
import streamlit as st

from ..words import texts

if TYPE_CHECKING:
    from ..state.estate import PlotState
    from ..state.shared_plots import PlannedTurn


def of(
    plots: list[PlotState], turns: tuple[PlannedTurn, ...] = ()
) -> tuple[pd.DataFrame, dict[str, Any]]:
    """Return the table, a row a plot in their order, and how its columns are written."""
    names, more = texts.PLOTS_COLUMNS, texts.PLAN_ALL_COLUMNS
    columns: dict[str, list[Any]] = {names["name"]: [plot.name for plot in plots]}
    if turns:
        own = [next((one for one in turns if one.plot is plot), None) for plot in plots]
        columns |= {
            more["who"]: [one and one.who for one in own],
            more["from"]: [one and f"{one.begins:%H:%M}" for one in own],
            more["to"]: [one and f"{one.ends:%H:%M}" for one in own],
            more["plants"]: [one and len(one.plan.route) for one in own],
            more["finds"]: [one and one.plan.route.expected_finds for one in own],
        }
    if any(plot.expected is not None for plot in plots):
        columns[names["days_since"]] = [plot.days_since for plot in plots]
        columns[names["expected"]] = [plot.expected for plot in plots]
    whole, tenth = (st.column_config.NumberColumn(format=how) for how in ("%.0f", "%.1f"))
    return pd.DataFrame(columns), {names["expected"]: whole, more["finds"]: tenth}
