"""All plots in a table that can be sorted: their state, and who works there when."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd
import streamlit as st

from fieldmon.compute.wording import digits_of_estimate

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
            more["finds"]: [one and _rounded(one.plan.route.expected_found) for one in own],
        }
    if any(plot.expected is not None for plot in plots):
        columns[names["days_since"]] = [plot.days_since for plot in plots]
        columns[names["expected"]] = [_rounded(plot.expected) for plot in plots]
    written = st.column_config.NumberColumn(format="localized")
    return pd.DataFrame(columns), {names["expected"]: written, more["finds"]: written}


def _rounded(value: float | None) -> float | None:
    """Return an estimate as precise as `about` says it; a number, by which a table can sort."""
    return None if value is None else round(value, digits_of_estimate(value))
