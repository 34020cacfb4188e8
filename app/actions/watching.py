"""Watch a robot that drives now: where it is heard, and how it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.drive.vda5050.mqtt import Broker, BrokerError, RobotName
from fieldmon.drive.vda5050.versions import USUAL_VERSION, VERSIONS
from fieldmon.drive.vda5050.watcher import FAILED, LOST, PAUSED, WAITING
from fieldmon.errors import FieldmonError

from ..state import cached_simulations, widget_memory
from ..words import texts
from ..words.language import of_error
from . import background_work

if TYPE_CHECKING:
    from fieldmon.samplers.base import Scene

    from ..state.live_drive import LiveDrive


def robot(key: str, scene: Scene) -> LiveDrive | None:
    """Ask which robot is to be watched; return its day, or None where it is not said rightly."""
    st.caption(texts.DRIVE_LIVE)
    show = widget_memory.show
    where = show(st.text_input, texts.DRIVE_BROKER, key="drive_broker", default="127.0.0.1:1883")
    first, second = st.columns(2)
    maker = show(
        first.text_input, texts.DRIVE_MANUFACTURER, key="drive_manufacturer", default="fieldmon"
    )
    serial = show(second.text_input, texts.DRIVE_SERIAL, key="drive_serial", default="robot1")
    version = show(
        st.segmented_control, texts.DRIVE_VDA, list(VERSIONS), key="drive_vda",
        default=USUAL_VERSION, required=True,
    )  # fmt: skip
    try:
        name, broker = RobotName(maker, serial, version), Broker.of(where)
        name.check()
    except FieldmonError as error:
        st.error(of_error(error))
        return None
    live = cached_simulations.live_drive(key, broker, name, scene)
    at_work = background_work.buttons(
        live, texts.DRIVE_WATCH, key="drive_watch", over=False, stop=texts.DRIVE_WATCH_STOP
    )
    st.fragment(_standing, run_every=1.0 if at_work else None)(live, at_work=at_work)
    return live


def _said(problem: FieldmonError) -> str:
    """Return what is wrong: of a broker by the box in which it is said."""
    if not isinstance(problem, BrokerError):
        return of_error(problem)
    said = texts.DRIVE_NOT_LET_IN if problem.answers else texts.DRIVE_NO_BROKER
    return said.format(where=texts.isolated(problem.where))


def _standing(live: LiveDrive, *, at_work: bool) -> None:
    """Say how the robot stands, and how old that is."""
    if at_work and not live.running:
        st.rerun()
    if live.problem is not None:
        st.error(_said(live.problem))
    if not live.running:
        return
    heard = live.heard()
    seconds = "" if heard.lag_s is None else f"{heard.lag_s:.0f}"
    if heard.standing == LOST:
        st.warning(texts.DRIVE_LOST.format(seconds=seconds))
    elif heard.standing == WAITING or heard.lag_s is None:
        st.info(texts.DRIVE_NOT_HEARD)
    elif heard.standing == FAILED:
        st.error(texts.DRIVE_FAILED.format(said=heard.said))
    else:
        st.caption(texts.DRIVE_LAG.format(seconds=seconds))
        if heard.standing == PAUSED:
            st.info(texts.DRIVE_PAUSED)
