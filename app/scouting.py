"""What scout mode knows and does; all of it is in the season's file, nothing in the page."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.settings import seconds
from fieldmon.plot.grid import row_label

from . import cached, keeping, panels, texts
from .keeping import CLEAN, FOUND, SKIPPED

if TYPE_CHECKING:
    from fieldmon.planning.plan import DayPlan

    from .choices import Choices
    from .figures import Known

__all__ = ["CLEAN", "FOUND", "SKIPPED"]
SOURCE = "scout mode"


@dataclass(frozen=True)
class Step:
    """The next plant, in words."""

    plant: int
    lonlat: list[float]
    place: str
    way: str
    arrow: str
    chance: str


def now() -> datetime:
    """Return the local time where the scout stands, as the browser tells it."""
    return keeping.local(datetime.now(UTC)).replace(microsecond=0)


def give_out(choices: Choices) -> None:
    """Keep the day's route with the season when the scouting begins."""
    route = cached.season_route(choices.key, choices.revision, choices.day, choices.project)
    if not len(route):
        choices.project.plan(choices.on)


def status(choices: Choices) -> Known:
    """Return what is known by now."""
    return cached.known(choices.key, choices.revision, choices.day, choices.project)


def next_step(choices: Choices, today: DayPlan) -> Step:
    """Return where to go next, from where the last result was noted."""
    route, grid, scene = today.route, choices.plot.grid, today.scene
    plant = int(route.plant[0])
    label = row_label(grid, route.plant[:1])
    from_m = scene.aisles.gate_m if scene.at < 0 else grid.xy_m[scene.at]
    ends = grid.frame.lonlat(np.stack([np.asarray(from_m).reshape(2), grid.xy_m[plant]]))
    east = (ends[1, 0] - ends[0, 0]) * np.cos(np.deg2rad(ends[0, 1]))
    north = ends[1, 1] - ends[0, 1]
    sector = int(np.rint(np.rad2deg(np.arctan2(east, north)) / 45.0)) % 8
    line_m = route.line_m[: int(route.line_stop[0]) + 1]
    way_m = float(np.hypot(*np.diff(line_m, axis=0).T).sum())
    same = scene.at >= 0 and grid.row[scene.at] == grid.row[plant]
    left = timedelta(seconds=int(scene.seconds_left))
    return Step(
        plant,
        ends[1].tolist(),
        texts.NEXT_PLACE.format(row=label.line[0], plant=label.number[0]),
        texts.NEXT_WAY.format(
            metres=choices.units.metres(way_m), compass=texts.COMPASS[sector],
            along=texts.NEXT_ALONG if same else texts.NEXT_AISLE,
        ),
        texts.ARROWS[sector],
        texts.NEXT_CHANCE.format(
            chance=float(route.chance[0]), done=status(choices).inspected_today,
            left=len(route), hours=str(left)[:-3],
        ),
    )  # fmt: skip


def _second(choices: Choices, plant: int) -> float:
    """Return the second of the day of a tap: the clock's today, else what the plan says."""
    clock = now()
    if clock.date() == choices.on:
        return clock.hour * 3600.0 + clock.minute * 60.0 + clock.second
    today = choices.today()
    begins = panels.starts(choices, today)
    stop = np.flatnonzero(today.route.plant == plant)
    gone = float(today.route.leave_s[stop[0]]) if stop.size else 0.0
    start_s = (begins - datetime.combine(choices.on, datetime.min.time())).total_seconds()
    return min(start_s + gone, 86_399.0)


@keeping.saying
def _tap(choices: Choices, plant: int, result: int) -> str:
    count = st.session_state.get("scout_count")
    counted = float(count) if result == FOUND and count is not None else np.nan
    second = _second(choices, plant)
    results = Inspections.of(
        np.array([plant]), np.array([result]), np.datetime64(choices.day),
        second=np.array([second]), count=np.array([counted]),
    )  # fmt: skip
    choices.project.record(results, SOURCE)
    return ""


def tap(choices: Choices, plant: int, result: int) -> None:
    """Record a tap at once."""
    _tap(choices, plant, result)
    if st.session_state.get("said") == ("success", ""):
        del st.session_state["said"]
    st.session_state["scout_count"] = None


def last_tap(choices: Choices) -> int | None:
    """Return the batch of the last tap that counts, or None."""
    taps = (b.number for b in choices.project.batches() if b.source == SOURCE and not b.undone)
    return next(taps, None)


def last_said(choices: Choices) -> str:
    """Return what was recorded last on this day, in words."""
    done = choices.project.history.inspections.on(choices.on)
    if not len(done):
        return ""
    label = row_label(choices.plot.grid, done.plant[-1:])
    result = texts.HISTORY_RESULTS[int(done.result[-1])]
    return texts.SCOUT_LAST.format(row=label.line[0], plant=label.number[0], result=result)


@keeping.saying
def undo(choices: Choices, batch: int) -> str:
    """Take the last tap back."""
    return choices.project.undo(batch)


@keeping.saying
def longer(choices: Choices) -> str:
    """Make the working day an hour longer than it is, and than the work has taken so far."""
    setup, history = choices.project.settings, choices.project.history
    second = history.inspections.on(choices.on).second
    # a scout who came in the evening is hours beyond the end
    gone_s = np.nanmax(np.append(second, 0.0)) - seconds(setup.starts)
    hours = max(setup.robot.hours, np.ceil(gone_s / 1800.0) / 2) + 1.0
    robot = replace(setup.robot, hours=float(min(hours, 24.0)))
    choices.project.change(replace(setup, robot=robot), setup)
    return texts.NOW_USED.format(name=f"{robot.hours:g} h")


def ask_start(choices: Choices) -> None:
    """Where the work begins later than planned, offer to begin now."""
    setup, clock = choices.project.settings, now()
    begun = len(choices.project.history.inspections.on(choices.on))
    late = clock.date() == choices.on and clock.time() > setup.starts
    if not begun and late:
        st.info(texts.SCOUT_START.format(start=f"{setup.starts:%H:%M}", now=f"{clock:%H:%M}"))
        st.button(texts.SCOUT_NOW, key="begin_now", on_click=_begin_now, args=(choices,))


@keeping.saying
def _begin_now(choices: Choices) -> str:
    setup = choices.project.settings
    starts = now().replace(second=0, microsecond=0).time()
    choices.project.change(replace(setup, starts=starts), setup)
    return texts.NOW_USED.format(name=f"{starts:%H:%M}")
