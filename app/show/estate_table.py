"""All plots in a table that can be sorted: their state, and who works there when."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from fieldmon.compute.units import AREAS_M2
from fieldmon.compute.wording import digits_of_estimate
from fieldmon.io.parse.geometry import areas_m2

from ..state.chosen_units import units
from ..words import texts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from streamlit.elements.lib.column_types import ColumnConfig

    from ..state.estate import PlotState
    from ..state.shared_plots import PlannedTurn

    Column = Sequence[str | float | None]
    #: columns by their names, how wide they are, and how they are written
    Columns = tuple[dict[str, Column], list[int], dict[str, ColumnConfig]]

# all columns together, in the panel of a narrow phone: a number that is cut is another number
_ROOM_PX = 300
# of what is left, names have all
_PX = {"area": 56, "days_since": 46, "expected": 80}
_PLANNED_PX = {"who": 66, "when": 92, "finds": 56}
# letters of a name that have room at least, and how wide one is, and what lies beside them
_LETTERS, _LETTER_PX, _BESIDE_PX = 13, 6.3, 16
_LETTERS_OF_WHO = 8


def of(
    plots: list[PlotState], turns: tuple[PlannedTurn, ...] = ()
) -> tuple[pd.DataFrame, dict[str, ColumnConfig]]:
    """Return the table, a row a plot in their order, and how its columns are written."""
    name = texts.PLOTS_COLUMNS["name"]
    columns, widths, how = _planned(plots, turns) if turns else _states(plots)
    px = _ROOM_PX - sum(widths)
    letters = max(_LETTERS, int((px - _BESIDE_PX) / _LETTER_PX) - 1)
    return (
        pd.DataFrame({name: [shortened(plot.name, letters) for plot in plots]} | columns),
        {name: st.column_config.TextColumn(width=px)} | how,
    )


def _planned(plots: list[PlotState], turns: tuple[PlannedTurn, ...]) -> Columns:
    """Return who works on each plot, when, and what is expected to be found."""
    names, column = texts.PLAN_ALL_COLUMNS, st.column_config
    own = [next((one for one in turns if one.state is plot), None) for plot in plots]
    columns: dict[str, Column] = {
        names["who"]: [None if one is None else _who(one.who) for one in own],
        names["when"]: [None if one is None else _hours(one) for one in own],
        names["finds"]: [
            None if one is None else _rounded(one.route.expected_finds) for one in own
        ],
    }
    how = {names[k]: column.TextColumn(width=_PLANNED_PX[k]) for k in ("who", "when")}
    finds = column.NumberColumn(format="localized", width=_PLANNED_PX["finds"])
    return columns, [*_PLANNED_PX.values()], how | {names["finds"]: finds}


def _who(name: str) -> str:
    """Return who works, with the number that tells them apart: "inspector 1" is "insp. 1"."""
    word, _, n = name.rpartition(" ")
    return name if len(name) <= _LETTERS_OF_WHO or not n.isdecimal() else f"{word[:4]}. {n}"


def _hours(turn: PlannedTurn) -> str:
    return f"{turn.begins:%H:%M}-{turn.ends:%H:%M}"


def _states(plots: list[PlotState]) -> Columns:
    """Return how large each plot is; where any has a season, when it was seen and what is left."""
    names, area = texts.PLOTS_COLUMNS, texts.UNITS[units().area]
    number = partial(st.column_config.NumberColumn, format="localized")
    columns: dict[str, Column] = {area: _areas(plots)}
    how = {area: number(width=_PX["area"], help=texts.AREA_IS)}
    widths = [_PX["area"]]
    known: dict[str, Column] = {
        "days_since": [plot.days_since for plot in plots],
        "expected": [_rounded(plot.expected) for plot in plots],
    }
    for k, values in known.items():
        if any(one is not None for one in values):
            widths.append(_PX[k])
            columns[names[k]] = values
            how[names[k]] = number(width=_PX[k], help=texts.PLOTS_HELP[k])
    return columns, widths, how


def shortened(name: str, letters: int = _LETTERS) -> str:
    """Return a name with its middle left out if it is long: what tells it apart is at its ends.

    Files number the plots of one name at its end.

    Examples
    --------
    >>> shortened("apricot_orchards_north (12)"), shortened("Gate 2026")
    ('aprico…h (12)', 'Gate 2026')
    """
    half = letters // 2
    return name if len(name) <= letters + 1 else f"{name[:half]}…{name[-half:]}"


def _areas(plots: list[PlotState]) -> list[float]:
    """Return the areas of plots in the chosen unit, as numbers of three digits."""
    of_each = areas_m2(np.array([plot.outline for plot in plots], dtype=object))
    return [float(f"{m2 / AREAS_M2[units().area]:.3g}") for m2 in of_each.tolist()]


def _rounded(value: float | None) -> float | None:
    """Return an estimate as precise as `about` says it; a number, by which a table can sort."""
    return None if value is None else round(value, digits_of_estimate(value))
