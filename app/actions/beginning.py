"""Beginning a season: from then on everything is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from fieldmon.monitoring.history import BeliefSettings

from ..state import (
    chosen_day,
    chosen_pest,
    notices,
    plot_source,
    seasons_folder,
    widget_memory,
    work_day,
)
from ..words import language, texts
from . import acting, assuming

if TYPE_CHECKING:
    from fieldmon.infestation.earlier_season import EarlierSeason

    from ..state.choices import Choices

#: the box for what happens with a find
_FINDS = "begin_finds"


def show(choices: Choices) -> None:
    """Offer to keep what is chosen as a season."""
    with st.container(border=True):
        st.markdown(f"### {texts.BEGIN_TITLE}")
        st.caption(texts.BEGIN_NOTE)
        # outside the form: it counts for the button above, too, which begins at once
        assuming.finds_are(widget_memory.show, _FINDS, default=True)
        pressed = _form(choices)
    acting.once(pressed, begin, choices)


def _form(choices: Choices) -> bool:
    with st.form("begin", border=False):
        st.text_input(texts.SEASON_NAME, _proposed(choices), key="season_name")
        if kept := seasons_folder.names():
            st.selectbox(
                texts.EARLIER, [None, *kept], key="season_earlier", help=texts.EARLIER_HELP,
                format_func=lambda name: texts.NO_EARLIER if name is None else name,
            )  # fmt: skip
        return bool(st.form_submit_button(texts.BEGIN))


def _proposed(choices: Choices) -> str:
    """Return what a season is called unless somebody says otherwise."""
    return f"{choices.plot.field.name} {choices.on.year}"


def _earlier() -> EarlierSeason | None:
    """Return what the season chosen for it learnt; None: none was."""
    chosen = st.session_state.get("season_earlier")
    return None if chosen is None else Season(seasons_folder.path_of(chosen)).as_earlier()


@notices.reporting
def begin(choices: Choices) -> str:
    """Keep what is chosen as a season from now on."""
    name = st.session_state.get("season_name", _proposed(choices)).strip()
    settings = MonitoringSettings(
        choices.on, chosen_day.STARTS, choices.robot, choices.sampler, prior=choices.prior,
        belief=BeliefSettings(treated=widget_memory.value(_FINDS, True), earlier=_earlier()),
        pest=chosen_pest.pest(), weather=chosen_pest.met(choices) if chosen_pest.pest() else None,
        language=language.current(),
    )  # fmt: skip
    said = [one.message for one in choices.messages]
    messages = [KeptMessage("import", str(m.severity), m.feature, m.sentence) for m in said]
    path = seasons_folder.new_path(name)
    Season.create(path, choices.plot, choices.records, settings, messages, choices.risk)
    plot_source.open_season(name)
    if choices.on != choices.clock.today():
        work_day.choose(name, choices.on)  # what is shown stays what it was
    return texts.BEGUN.format(name=texts.isolated(name), path=path)
