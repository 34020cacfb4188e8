"""Planning all plots that are due: who works, what comes of it, and its files."""

from __future__ import annotations

import io
import zipfile
from contextlib import nullcontext
from dataclasses import replace
from datetime import timedelta
from functools import partial
from typing import TYPE_CHECKING, Any

import streamlit as st
from streamlit.delta_generator import DeltaGenerator

from fieldmon.io.writers.geojson import route_geojson
from fieldmon.monitoring.days.estate_routes import PLAN_TABLE, PlotLeftOut, plan_table, stems
from fieldmon.plot.local_clock import grid_clock

from ..state import shared_plots, widget_memory
from ..state.chosen_units import units
from ..state.shared_plots import EstateCrew, SharedPlots
from ..words import texts
from ..words.language import about, in_words, listed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..state.estate import NotAmong, PlotState
    from ..state.shared_plots import PlannedTurn

_ON = "plan all"
# more names than these are a wall of words
_MOST_NAMED = 5
# who is less late than that is not told
_LATE = timedelta(minutes=15)
#: least, most and step of each number that makes a crew
_LIMITS = {
    "robots": (0, 20, 1), "robot_hours": (0.5, 16.0, 0.5), "scouts": (0, 20, 1),
    "scout_hours": (0.5, 16.0, 0.5), "move_min": (0.0, 120.0, 5.0),
}  # fmt: skip


def is_on() -> bool:
    """Return whether the plan of all plots is shown."""
    return bool(st.session_state.get(_ON))


def show_button(plots: list[PlotState]) -> None:
    """Show the button that plans, or that goes back."""
    if is_on():
        st.button(texts.PLAN_ALL_OFF, key="plan_all_off", icon=":material/undo:", on_click=_set,
                  args=(False,))  # fmt: skip
    elif len(plots) > 1:
        st.button(texts.PLAN_ALL, key="plan_all", type="primary", icon=":material/route:",
                  on_click=_set, args=(True,))  # fmt: skip


def show(plots: list[PlotState], not_among: Iterable[NotAmong] = ()) -> SharedPlots:
    """Show who works and what comes of it; return the plan.

    `not_among` cannot be opened: the page says why, and the table too.
    """
    crew = _crew(shared_plots.usual_crew(plots))
    also = widget_memory.show(st.checkbox, texts.PLAN_ALL_ALSO, key="crew_also", default=False)
    wanted = shared_plots.due(plots, every=also)
    others = shared_plots.not_due(plots, wanted)
    for said in shared_plots.of_one_plot([one.source for one in plots if one.number is None]):
        st.warning(in_words(said))
    if not wanted:
        st.info(texts.PLAN_ALL_NONE)
        _say_left_out(others)
        return SharedPlots(())
    if not crew.members():
        st.info(texts.PLAN_ALL_NOBODY)
        return SharedPlots(())
    with st.empty():
        bar = st.progress(0.0, texts.PLAN_ALL_WORKING)
        made = shared_plots.planned(
            wanted, crew, lambda k, n: bar.progress(k / n, texts.PLAN_ALL_WORKING)
        )
        st.empty()
    made = replace(made, left_out=(*made.left_out, *others))
    _say(made, [PlotLeftOut(one.name, one.said) for one in not_among])
    return made


def _crew(usual: EstateCrew) -> EstateCrew:
    chosen, columns = dict[str, Any](), list[DeltaGenerator]()
    for k, (name, (least, most, step)) in enumerate(_LIMITS.items()):
        # each row has columns of its own: on a phone, how many and their hours stay together
        columns += st.columns(2) if k % 2 == 0 else []
        with columns[k]:
            chosen[name] = widget_memory.show(
                st.number_input, texts.PLAN_ALL_CREW[name], least, most, step=step,
                key=f"crew_{name}", default=getattr(usual, name),
            )  # fmt: skip
    return EstateCrew(
        **{name: getattr(usual, name) if v is None else v for name, v in chosen.items()}
    )


def _say(made: SharedPlots, not_among: Sequence[PlotLeftOut] = ()) -> None:
    plants = sum(one.plants for one in made.turns)
    finds = sum(one.route.expected_finds for one in made.turns)
    with st.container(key="lead"):
        lead = texts.PLAN_ALL_LEAD.format(
            plants=texts.PLANTS_COUNTED.format(n=plants),
            n=len({one.plot for one in made.turns}),
            finds=about(finds),
        )
        st.markdown(lead)
    for said in _times(made.turns):
        st.markdown(said)
    st.caption(texts.PLAN_ALL_RULE)
    _say_left_out(made.left_out)
    if made.free:
        many = texts.PLAN_ALL_FREE_MANY.format(n=len(made.free), all=made.n_members)
        said = texts.PLAN_ALL_FREE.format(names=listed(made.free))
        st.markdown(many if len(made.free) > _MOST_NAMED else said)
    if made.several_kinds:
        st.markdown(texts.PLAN_ALL_KINDS)
    for plot, members in made.teams:
        team = listed(texts.isolated(name) for name in members)
        st.markdown(texts.PLAN_ALL_TEAM.format(plot=texts.isolated(plot), names=team))
    problems = (f"{texts.isolated(one.plot)}: {one.why}" for one in made.problems)
    for problem in (*made.closed, *made.too_far, *problems):
        st.warning(problem)
    if made.turns:
        st.download_button(texts.PLAN_ALL_DOWNLOAD, partial(packed, made, not_among), "routes.zip",
                           "application/zip", key="plan_all_files", on_click="ignore")  # fmt: skip


def _times(turns: Sequence[PlannedTurn]) -> list[str]:
    """Say of which day the times are, from when on, and that they stand though it is later."""
    if not turns:
        return []
    first = min(turns, key=lambda one: one.begins)
    days = sorted({one.begins.date() for one in turns})
    on = listed(units().said_day(day) for day in days)
    said = [texts.PLAN_ALL_WHEN.format(day=on, start=f"{first.begins:%H:%M}")]
    now = grid_clock(first.route.aisles.grid).now()
    if now.date() == first.begins.date() and now - first.begins >= _LATE:
        said.append(texts.PLAN_ALL_LATE.format(now=f"{now:%H:%M}"))
    return said


def _say_left_out(plots: Sequence[PlotLeftOut]) -> None:
    """Name plots to which nobody goes, a line a reason; very many in a fold."""
    why = dict.fromkeys(one.why for one in plots)
    is_many = len(plots) > _MOST_NAMED
    with (
        st.expander(texts.PLAN_ALL_LEFT_OUT_MANY.format(n=len(plots))) if is_many else nullcontext()
    ):
        for one in why:
            names = listed(texts.isolated(each.plot) for each in plots if each.why == one)
            st.markdown(texts.PLAN_ALL_LEFT_OUT.format(why=one, names=names))


def packed(made: SharedPlots, not_among: Iterable[PlotLeftOut] = ()) -> bytes:
    """Return the routes as GeoJSON, a file each, and a table of them and of what is left out."""
    out = io.BytesIO()
    files = {f"{stem}.geojson": one for stem, one in stems(made.turns).items()}
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, one in files.items():
            archive.writestr(file, route_geojson(one.route, one.notes))
        left_out = (*made.left_out, *made.problems, *not_among)
        archive.writestr(PLAN_TABLE, plan_table(files, left_out, made.free))
    return out.getvalue()


def _set(on: bool) -> None:  # noqa: FBT001 - a callback's argument
    st.session_state[_ON] = on
