"""What is assumed of a plot's insects unless a person says otherwise, in boxes of any page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.planning.assumptions import assumed_by
from fieldmon.plot.assumed import Assumed

from . import widget_memory
from .row_settings import row_settings

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from .choices import Choices

#: the box for the chance of a plant of which nothing is known, percent
BACKGROUND = "background_pct"
#: what is said of rows in metres
SPACINGS = ("row_spacing_m", "plant_spacing_m")
_ASKED = "begin asks"


def prior() -> PriorSettings:
    """Return how records become chances, as far as a person said so."""
    percent = widget_memory.value(BACKGROUND)
    return PriorSettings() if percent is None else PriorSettings(background_chance=percent / 100)


def of(choices: Choices) -> tuple[Assumed, ...]:
    """Return what the figures of a day rest on though nobody said it."""
    if choices.season is not None:
        made = choices.season.assumed(choices.season.planned_by(choices.on))
    else:
        made = assumed_by(choices.plot.assumed, choices.prior, choices.robot, choices.plot.grid)
    usual, prior = PriorSettings(), choices.prior
    if (prior.edge_chance, prior.path_chance) == (usual.edge_chance, usual.path_chance):
        made = (*made, Assumed("edge_chance", prior.edge_chance))
    return (*made, *_of_gate(choices.plot))


def are_rows_assumed(choices: Choices) -> bool:
    """Return whether rows are laid as neither people nor files said; a season keeps them so."""
    plot = choices.plot
    if plot.field.plants is not None:
        return False
    spacing = any(one.setting in SPACINGS for one in plot.assumed)
    return spacing or (plot.grid.aisles_m is None and not _is_direction_said(choices))


def of_rows(plot: Plot) -> tuple[Assumed, ...]:
    """Return how rows are laid, said or not, and where the gate is if nobody said."""
    grid = plot.grid
    made = [Assumed(name, getattr(grid, name)) for name in SPACINGS]
    if grid.aisles_m is None:
        made.append(Assumed("row_bearing_deg", grid.frame.bearing_deg % 180.0))
    return (*made, *_of_gate(plot))


def _is_direction_said(choices: Choices) -> bool:
    field = choices.plot.field
    said = row_settings(choices.plot_key)["row_bearing_deg"], field.row_bearing_deg
    return any(one is not None for one in said) or len(field.row_lines.geoms) > 0


def _of_gate(plot: Plot) -> tuple[Assumed, ...]:
    return (Assumed("gate", 1.0),) if plot.field.gate is None else ()


def ask(choices: Choices, place: str) -> None:
    """Ask whether the rows are right where a season was begun on the page; nowhere: no more."""
    st.session_state[_ASKED] = choices.plot_key, place


def asked(choices: Choices) -> str:
    """Return where on the page it is asked whether the rows of this plot are right; or nothing."""
    plot, place = st.session_state.get(_ASKED, ("", ""))
    return place if plot == choices.plot_key and choices.season is None else ""
