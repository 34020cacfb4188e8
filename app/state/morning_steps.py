"""A morning's work in steps: which of them are done, and which one comes next."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.monitoring.phones import scouts

from . import chosen_day

if TYPE_CHECKING:
    from datetime import date

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
        Step(name, is_done, name == first, _was_nothing(choices, name))
        for name, is_done in done.items()
    ]


def _was_nothing(choices: Choices, name: str) -> bool:
    """Return whether a step was passed by: no visit before, or nothing taken along."""
    if name == SEND:
        has_codes = choices.season is not None and scouts.scouts_of(choices.season)
        return not (has_codes or did(choices, SEND))
    return name == LOOK_BACK and last_visit(choices) is None


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
    if choices.on > choices.open_season.settings.begins:
        done[LOOK_BACK] = left_unsaid(choices) is None
    is_used = worked or chosen_day.is_given_out(choices, plan)
    done[PLAN] = is_used and not choices.are_wishes_unused
    if not over:
        done[SEND] = worked or did(choices, SEND)
    done |= {RECORD: worked and over, REPORT: did(choices, REPORT)}
    return done | {NEXT_DAY: False} if worked and over else done


def last_visit(choices: Choices) -> date | None:
    """Return the last day before the one shown on which any plant was inspected."""
    return chosen_day.last_visit(choices, _day_before(choices))


def left_unsaid(choices: Choices) -> date | None:
    """Return the last planned day of which nothing is recorded, if nothing is of a later one."""
    before = _day_before(choices)
    missing = chosen_day.planned_only(choices, before)
    recorded = choices.open_season.history.inspections.date
    recorded = recorded[recorded <= np.datetime64(before, "D")]
    is_last = missing and (not len(recorded) or missing[-1] > recorded[-1].item())
    return missing[-1] if is_last else None


def _day_before(choices: Choices) -> date:
    return choices.on - timedelta(days=1)


def did(choices: Choices, name: str) -> bool:
    """Return whether this session took a step that leaves no trace in the season."""
    return _key(choices, name) in st.session_state


def note(choices: Choices, name: str) -> None:
    """Note that such a step was taken."""
    st.session_state[_key(choices, name)] = True


def _key(choices: Choices, name: str) -> str:
    return f"did {name} {choices.key} {choices.day}"
