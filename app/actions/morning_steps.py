"""The morning's work, a line and a button a step; what comes next is the filled one."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING, Any

import streamlit as st

from fieldmon.reports.pdf import PAPERS, pdf_bytes

from ..show import day, report
from ..state import (
    browser,
    chosen_day,
    menu,
    morning_steps,
    notices,
    plot_source,
    widget_memory,
    work_day,
)
from ..state.morning_steps import BEGIN, LOOK_BACK, NEXT_DAY, PLAN, RECORD, REPORT, SEND
from ..words import texts
from ..words.language import listed
from . import acting, beginning, changing_strategy, handing_out, news

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date

    from fieldmon.monitoring import PlannedAndDone
    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices
    from ..state.morning_steps import Step


def show(choices: Choices, plan: DayPlan) -> None:
    """Show the steps of the day."""
    with st.container(key="steps", gap=None):
        for step in morning_steps.steps(choices, plan):
            with st.container(
                key=f"step_{step.name}", horizontal=True, vertical_alignment="center"
            ):
                st.markdown(f"{_sign(step)} {_said(choices, plan, step)}", width="stretch")
                _BUTTONS[step.name](choices, plan, step)


def _sign(step: Step) -> str:
    if step.done and step.nothing:
        return ":material/horizontal_rule:"
    if step.done:
        return ":green[:material/check_circle:]"
    return f":material/{'arrow_circle_right' if step.next else 'circle'}:"


# -- what is said of each


def _said(choices: Choices, plan: DayPlan, step: Step) -> str:
    name = texts.STEPS[step.name]
    if step.name == LOOK_BACK and (left := morning_steps.left_unsaid(choices)) is not None:
        name = texts.STEP_PLANNED_FOR.format(day=choices.units.said_day(left, choices.on))
        return f"**{name}** {texts.STEP_UNRECORDED}"
    if step.name == LOOK_BACK and not choices.is_past:
        name = texts.LAST_VISIT
    return f"**{name}** {_HOW_FAR.get(step.name, _nothing)(choices, plan)}"


def _visit(choices: Choices, _: DayPlan) -> str:
    on = morning_steps.last_visit(choices)
    if on is None:
        return texts.STEP_NO_VISIT
    was = chosen_day.figures(choices, str(on))
    said = choices.units.said_day(on, choices.on)
    what = _recorded(choices, str(on), was.found_today, was.inspected_today)
    return texts.VISIT_ON.format(day=said, what=what)


def _planned(choices: Choices, plan: DayPlan) -> str:
    """Return the plan kept of the day and what is left of it; else what there is to keep."""
    if _is_unused(choices):
        return texts.STEP_UNUSED
    rest = day.plan_in_short(plan) if len(plan.route) else ""
    if choices.season is None:
        return rest
    kept = chosen_day.planned_and_done(choices)
    said = ""
    if kept is not None:
        said = day.in_short(choices.plot.grid, kept.planned, kept.hours, kept.people)
    if not chosen_day.progress(choices).inspected_today:
        if kept is None or chosen_day.is_given_out(choices, plan):
            return said or rest
        return texts.STEP_OTHER.format(plan=rest or texts.STEP_NO_STOPS, kept=said)
    if kept is None:
        return rest and texts.STEP_REST.format(plan=rest)
    return _left_of(kept, len(plan.route), said)


def _left_of(kept: PlannedAndDone, now: int, said: str) -> str:
    """Return what is left of the plan kept of a day, and `now` on the route as that was planned."""
    # those who are out have routes of their own: the one that stands above is nobody's
    if kept.people > 1 or not now or now == kept.left:
        return texts.STEP_KEPT.format(plan=said, left=kept.left)
    return texts.STEP_KEPT_ANEW.format(plan=said, done=kept.done, left=kept.left, now=now)


def _today(choices: Choices, _: DayPlan) -> str:
    now, own = chosen_day.progress(choices), chosen_day.inspected_by_shown(choices)
    said = _recorded(choices, choices.day, own.found, own.inspected)
    if own.inspected == now.inspected_today:
        return said
    of_all = texts.STEP_FOUND.format(found=now.found_today, inspected=now.inspected_today)
    return texts.STEP_OF_ALL.format(own=said, all=of_all)


def _recorded(choices: Choices, on: str, found: int, inspected: int) -> str:
    said = [texts.STEP_FOUND.format(found=found, inspected=inspected)] if inspected else []
    if treated := chosen_day.treated(choices, on):
        said.append(texts.STEP_TREATED.format(n=treated))
    return listed(said) if said else texts.STEP_NOTHING


def _nothing(*_: object) -> str:
    return ""


_HOW_FAR: dict[str, Callable[[Choices, DayPlan], str]] = {
    LOOK_BACK: _visit, PLAN: _planned, RECORD: _today,
}  # fmt: skip


# -- the button of each


def _button(step: Step, label: str, action: Callable[..., None], *arguments: object) -> None:
    st.button(label, on_click=action, args=arguments, **_shown(step))


def _is_unused(choices: Choices) -> bool:
    """Return whether the plan goes by other settings than the boxes say: nobody means that one."""
    return choices.season is not None and changing_strategy.is_unused()


def _of_plan(choices: Choices, step: Step) -> dict[str, Any]:
    """Return how a button is shown that hands the plan on."""
    shown = _shown(step)
    return shown | {"disabled": True, "type": "secondary"} if _is_unused(choices) else shown


def _shown(step: Step) -> dict[str, Any]:
    return {"key": f"do_{step.name}", "type": "primary" if step.next else "secondary"}


def _look_back(choices: Choices, _: DayPlan, step: Step) -> None:
    if (left := morning_steps.left_unsaid(choices)) is not None:
        _button(step, texts.STEP_BUTTONS[RECORD], _record_of, left)
    else:
        _button(step, texts.STEP_BUTTONS[LOOK_BACK], menu.turn_to, "season")


def _record_of(on: date) -> None:
    work_day.choose(plot_source.chosen(), on)
    menu.open_page("record")


def _plan(choices: Choices, plan: DayPlan, step: Step) -> None:
    if len(plan.route) or choices.are_wishes_unused:
        acting.at_press(texts.STEP_BUTTONS[PLAN], _use_plan, choices, **_of_plan(choices, step))


@notices.reporting
def _use_plan(choices: Choices) -> str:
    """Keep the day's route with the season, so that the report can hold it to what was done."""
    handing_out.give_out(choices)
    return texts.PLAN_USED.format(day=choices.units.said_day(choices.day))


def _begin(choices: Choices, _: DayPlan, step: Step) -> None:
    acting.at_press(texts.STEP_BUTTONS[BEGIN], beginning.begin_or_ask, choices, "step",
                    at_once=False, **_shown(step))  # fmt: skip


def _note_sent(choices: Choices) -> None:
    """Note that the day is taken along where who looks at the codes has it already."""
    if handing_out.is_out(choices):
        morning_steps.note(choices, SEND)


def _send(choices: Choices, plan: DayPlan, step: Step) -> None:
    shown = _of_plan(choices, step)
    if st.button(texts.STEP_BUTTONS[SEND], on_click=_note_sent, args=(choices,), **shown):
        news.hold()
        st.dialog(texts.SEND_TITLE, on_dismiss="rerun")(handing_out.show)(choices, plan)


def _record(_: Choices, __: DayPlan, step: Step) -> None:
    if browser.is_phone():
        _button(step, texts.START_SCOUTING, menu.open_page, "scout")
    else:
        _button(step, texts.STEP_BUTTONS[RECORD], menu.open_page, "record")


def _report(choices: Choices, _: DayPlan, step: Step) -> None:
    paper = widget_memory.value("report paper", next(iter(PAPERS)))
    made = report.to_come(choices)
    # made when it is asked for: fonts are cut and plants are drawn, in a second or two
    st.download_button(
        texts.STEP_BUTTONS[REPORT], lambda: pdf_bytes(made(), paper),
        f"{choices.file_name('day')}.pdf", "application/pdf",
        on_click=morning_steps.note, args=(choices, REPORT), **_shown(step),
    )  # fmt: skip


def _next_day(choices: Choices, _: DayPlan, step: Step) -> None:
    # of its own day: pressed twice it is the day after that all the same
    st.button(texts.STEP_BUTTONS[NEXT_DAY], on_click=work_day.choose,
              args=(plot_source.chosen(), choices.on + timedelta(days=1)),
              **_shown(step) | {"key": f"do_next_day {choices.day}"})  # fmt: skip


_BUTTONS: dict[str, Callable[[Choices, DayPlan, Step], None]] = {
    LOOK_BACK: _look_back, PLAN: _plan, BEGIN: _begin, SEND: _send, RECORD: _record,
    REPORT: _report, NEXT_DAY: _next_day,
}  # fmt: skip
