"""Beginning a season: from then on everything is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season

from ..state import chosen_day, notices, plot_source, seasons_folder, work_day
from ..words import texts

if TYPE_CHECKING:
    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Offer to keep what is chosen as a season."""
    with st.form("begin", border=True):
        st.markdown(f"### {texts.BEGIN_TITLE}")
        st.caption(texts.BEGIN_NOTE)
        proposed = f"{choices.plot.field.name} {choices.on.year}"
        st.text_input(texts.SEASON_NAME, proposed, key="season_name")
        st.form_submit_button(texts.BEGIN, type="primary", on_click=_begin, args=(choices,))


@notices.reporting
def _begin(choices: Choices) -> str:
    name = st.session_state["season_name"].strip()
    settings = MonitoringSettings(
        choices.on, chosen_day.STARTS, choices.robot, choices.sampler, prior=choices.prior
    )
    said = [one.message for one in choices.messages]
    messages = [KeptMessage("import", str(m.severity), m.feature, m.sentence) for m in said]
    path = seasons_folder.new_path(name)
    Season.create(path, choices.plot, choices.records, settings, messages, choices.risk)
    plot_source.open_season(name)
    if choices.on != choices.clock.today():
        work_day.choose(name, choices.on)  # what is shown stays what it was
    return texts.BEGUN.format(name=texts.isolated(name), path=path)
