"""Watch robots that drive now: where they are heard, which they are, and how they stand."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.drive.vda5050.mqtt import Broker, BrokerError, Watched
from fieldmon.drive.vda5050.versions import USUAL_VERSION, VERSIONS
from fieldmon.errors import FieldmonError

from ..show import robots_watched
from ..state import cached_simulations, chosen_day, widget_memory
from ..words import texts
from ..words.language import of_error
from . import background_work

if TYPE_CHECKING:
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Scene

    from ..state.choices import Choices
    from ..state.live_drive import LiveDrive


def robots(key: str, choices: Choices, scene: Scene) -> LiveDrive | None:
    """Ask which robots are to be watched; return their day, or None where that is not said."""
    st.caption(texts.DRIVE_LIVE)
    above = st.container()  # who watches looks at the robots, not at the boxes
    team = _team(choices)
    try:
        broker, watched = _whom(team)
    except FieldmonError as error:
        st.error(of_error(error))
        return None
    live = cached_simulations.live_drive(key, broker, watched, scene, team)
    at_work = background_work.buttons(
        live, texts.DRIVE_WATCH, key="drive_watch", over=False, stop=texts.DRIVE_WATCH_STOP
    )
    if at_work and live.ends is None:
        live.ends = _planned_ends(choices, team, watched)
    watch = st.fragment(_standing, run_every=1.0 if at_work else None)
    with above:
        watch(live, watched, dark=choices.dark, at_work=at_work)
    return live


def _team(choices: Choices) -> dict[str, Robot]:
    """Return the robots of the day's team, by name; people of it walk."""
    if choices.season is None:
        return {}
    team = choices.season.planned_by(choices.on).team
    return {one.name: one.robot for one in team if not one.robot.on_foot}


def _whom(team: dict[str, Robot]) -> tuple[Broker, Watched]:
    """Ask where robots are heard, and which of them; raise `SettingError` where it cannot be."""
    show = widget_memory.show
    where = show(st.text_input, texts.DRIVE_BROKER, key="drive_broker", default="127.0.0.1:1883")
    maker = show(
        st.text_input, texts.DRIVE_MANUFACTURER, key="drive_manufacturer", default="fieldmon"
    )
    whose = show(
        st.segmented_control, texts.DRIVE_WHOSE, list(texts.DRIVE_WHOSE_KINDS), key="drive_whose",
        default="named", required=True, format_func=texts.DRIVE_WHOSE_KINDS.__getitem__,
    )  # fmt: skip
    serials = None
    if whose == "named":
        proposed = ", ".join(team) or "robot1"  # as `fieldmon drive` calls them
        serials = show(
            st.text_input, texts.DRIVE_SERIALS, key=f"drive_serial {proposed}", default=proposed
        )
    version = show(
        st.segmented_control, texts.DRIVE_VDA, list(VERSIONS), key="drive_vda",
        default=USUAL_VERSION, required=True,
    )  # fmt: skip
    return Broker.of(where), Watched.of(maker, serials, version)


def _planned_ends(choices: Choices, team: dict[str, Robot], watched: Watched) -> dict[str, str]:
    """Return when each robot's day is planned to end, where that is known: by its name."""
    whose: dict[str, str | None] = {name: name for name in team}
    if not team and len(watched.serials) == 1:
        whose = {watched.serials[0]: None}
    known = {}
    for name, who in whose.items():
        with suppress(FieldmonError):  # Today says why there is no plan
            known[name] = f"{chosen_day.ends(choices, who):%H:%M}"
    return known


def _said(problem: FieldmonError) -> str:
    """Return what is wrong: of a broker by the box in which it is said."""
    if not isinstance(problem, BrokerError):
        return of_error(problem)
    said = texts.DRIVE_NOT_LET_IN if problem.answers else texts.DRIVE_NO_BROKER
    return said.format(where=texts.isolated(problem.where))


def _standing(live: LiveDrive, watched: Watched, *, dark: bool, at_work: bool) -> None:
    """Say how the robots stand, and how old that is."""
    if at_work and not live.running:
        st.rerun()
    if live.problem is not None:
        st.error(_said(live.problem))
    if not live.running:
        return
    if live.is_cut_off:
        st.warning(texts.DRIVE_CUT_OFF)
    seen = live.seen()
    if not seen:
        maker = texts.isolated(watched.manufacturer)
        st.info(texts.DRIVE_NOBODY.format(manufacturer=maker))
        return
    st.html(robots_watched.as_html(seen, live.ends or {}, dark=dark))
    for caution in robots_watched.cautions(seen):
        st.warning(caution)
