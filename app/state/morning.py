"""A morning's work in steps: which of them are done, and which one comes next."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING

import streamlit as st

from . import cached, chosen_day

if TYPE_CHECKING:
    from fieldmon.monitoring import DayFigures
    from fieldmon.planning.plan import DayPlan

    from .choices import Choices

#: the steps by their names, in order
LOOK_BACK, PLAN, BEGIN, SEND = "look_back", "plan", "begin", "send"
RECORD, REPORT, NEXT_DAY = "record", "report", "next_day"


@dataclass(frozen=True)
class Step:
    """A step of the day: its name, whether it is done, and whether it is what comes next.

    `nothing`: there was nothing to do.
    """

    name: str
    done: bool
    next: bool = False
    nothing: bool = False


def steps(choices: Choices, plan: DayPlan) -> list[Step]:
    """Return the steps of the day in order; one of them at most comes next."""
    done = _in_season(choices, plan) if choices.season is not None else _without(choices, plan)
    first = next((name for name, is_done in done.items() if not is_done), None)
    return [
        Step(name, is_done, name == first, name == LOOK_BACK and not day_before(choices).inspected)
        for name, is_done in done.items()
    ]


def _without(choices: Choices, plan: DayPlan) -> dict[str, bool]:
    """Return what there is to do while nothing is kept."""
    some = {BEGIN: False}
    if len(plan.route):
        some |= {SEND: did(choices, SEND), REPORT: did(choices, REPORT)}
    return some


def _in_season(choices: Choices, plan: DayPlan) -> dict[str, bool]:
    worked = chosen_day.progress(choices).inspected_today > 0
    over = not len(plan.route)
    done = {}
    if choices.on > choices.season.settings.begins:
        done[LOOK_BACK] = not left_unsaid(choices)
    done[PLAN] = worked or chosen_day.is_given_out(choices, plan)
    if not over:
        done[SEND] = worked or did(choices, SEND)
    done |= {RECORD: worked and over, REPORT: did(choices, REPORT)}
    return done | {NEXT_DAY: False} if worked and over else done


def day_before(choices: Choices) -> DayFigures:
    """Return the day before in figures."""
    return chosen_day.figures(choices, str(choices.on - timedelta(days=1)))


def left_unsaid(choices: Choices) -> bool:
    """Return whether a route was kept for the day before, and nothing recorded of it."""
    before = str(choices.on - timedelta(days=1))
    kept = cached.kept_route(choices.key, choices.revision, (before, choices.who), choices.season)
    return bool(len(kept)) and not day_before(choices).inspected


def did(choices: Choices, name: str) -> bool:
    """Return whether this session took a step that leaves no trace in the season."""
    return _key(choices, name) in st.session_state


def note(choices: Choices, name: str) -> None:
    """Note that such a step was taken."""
    st.session_state[_key(choices, name)] = True


def _key(choices: Choices, name: str) -> str:
    return f"did {name} {choices.key} {choices.day}"
