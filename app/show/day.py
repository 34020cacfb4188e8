"""A day in figures and words: what there is to do, what was done, what changed, and why there."""

from __future__ import annotations

import math
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from fieldmon.compute.wording import chance_figure
from fieldmon.infestation.inspections import FOUND
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring.estimates.day_figures import flagged_said
from fieldmon.monitoring.inspecting.contradictions import contradiction_lines
from fieldmon.planning.bound_wording import PROVED, share_above
from fieldmon.planning.explain import explain
from fieldmon.planning.skips import nothing_left_in_words
from fieldmon.plot.grid import plant_numbers
from fieldmon.reports import sentences

from ..state import assumptions, chosen_day
from ..words import texts
from ..words.language import about, in_words, listed, number, weekday
from ..words.units import hours
from . import cautions
from .assumed import mark

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.monitoring import DayFigures, Progress
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid

    from ..state.choices import Choices
    from ..state.chosen_day import DayRoute

_WEEK = 7
_MOST_OTHERWISE = 20


def stops(choices: Choices, shown: DayRoute) -> pd.DataFrame:
    """Return the stops of a day's route in order, as a table."""
    route = shown.route
    columns = {
        texts.COLUMN_ARRIVE: [f"{shown.at(s):%H:%M:%S}" for s in route.arrive_s.tolist()],
        **place_columns(choices.plot.grid, route.plant),
        texts.COLUMN_CHANCE: [in_words(chance_figure(p, 1)) for p in route.believed.tolist()],
    }
    if shown.worked:
        done = choices.open_season.history.inspections.on(choices.on)
        was = dict(zip(done.plant.tolist(), done.result.tolist(), strict=True))
        columns[texts.REPORT_WAS] = [texts.HISTORY_RESULTS[was[p]] for p in route.plant.tolist()]
    return pd.DataFrame(columns, pd.RangeIndex(1, len(route) + 1, name=texts.STOP_NUMBER))


def place_columns(grid: PlantGrid, plants: NDArray[np.integer]) -> dict[str, object]:
    """Return the columns of a table that say where plants stand, with the face of one of two.

    Rows are numbers, or texts where they have names; where there are none, there is no column.
    """
    numbered = plant_numbers(grid, plants)
    line = numbered.line
    row = [grid.line_signs[k] for k in line.tolist()] if grid.row_names else line
    face = {texts.COLUMN_FACE: faces(grid, plants)} if grid.has_faces else {}
    return {**({texts.COLUMN_ROW: row} if grid.in_rows else {}),
            texts.COLUMN_PLANT: numbered.number, **face}  # fmt: skip


def headline(choices: Choices, plan: DayPlan) -> str:
    """Return what there is to do on the day, in one sentence."""
    on = choices.units.said_day(choices.day, choices.today)
    if is_over(choices, plan):
        own = chosen_day.inspected_by_shown(choices)
        return texts.DAY_DONE.format(found=own.found, inspected=own.inspected, day=on)
    return in_words(sentences.headline(plan.route, on))


def is_over(choices: Choices, plan: DayPlan) -> bool:
    """Return whether the day was worked, and nothing is left of it."""
    if choices.season is None or len(plan.route):
        return False
    return chosen_day.progress(choices).inspected_today > 0


def plan_in_short(plan: DayPlan) -> str:
    """Return how many plants there are to inspect, and how long it takes."""
    return in_short(plan.scene.grid, len(plan.route), plan.route.end_s / 3600)


def in_short(grid: PlantGrid, plants: int, hours_h: float, people: int = 1) -> str:
    """Return so many plants, or faces, and hours in words, of several people added up."""
    time = hours(hours_h)
    if people > 1:
        time = texts.HOURS_IN_ALL.format(hours=time)
    counted = texts.FACES_COUNTED if grid.has_faces else texts.PLANTS_COUNTED
    return listed([counted.format(n=plants), time])


def route_figures(choices: Choices, plan: DayPlan) -> None:
    """Show the figures to decide by."""
    route, n = plan.route, len(choices.plot.grid)
    taken = assumptions.of(choices)
    rows, speed = ("row_spacing_m", "plant_spacing_m"), "speed_m_s"
    for_finds = (*rows, "background_chance", "edge_chance", "rate_per_day", "detects", "treated")
    to_inspect = texts.PLANTS_TO_INSPECT
    if choices.plot.grid.has_faces:
        to_inspect = texts.FACES_TO_INSPECT
    with st.container(horizontal=True):
        st.metric(mark(to_inspect, taken, rows),
                  f"{number(len(route), ',')} / {number(n, ',')}", width="content")  # fmt: skip
        st.metric(mark(texts.TIME, taken, (*rows, speed, "gate")), hours(route.end_s / 3600),
                  width="content")  # fmt: skip
        st.metric(mark(texts.DRIVE, taken, (*rows, "gate")), choices.units.metres(route.drive_m),
                  width="content")  # fmt: skip
        st.metric(mark(texts.FINDS, taken, for_finds), about(route.expected_finds),
                  width="content")  # fmt: skip
    if len(route) and (said := _bound(chosen_day.with_bound(choices, plan).route)):
        st.caption(said, help=texts.BOUND_HELP)


def _bound(route: Route) -> str:
    """Return what no other route can exceed, against the figures above it; rounded up."""
    if route.found_bound is None:
        return ""
    above = share_above(route.expected_finds, route.found_bound)
    if above <= PROVED:
        return texts.BOUND_BEST
    if math.isinf(above):
        return texts.BOUND_NONE.format(finds=about(route.found_bound))
    return texts.BOUND.format(share=number(math.ceil(1000.0 * above) / 10.0, ".1f"))


def say_of_day(choices: Choices, plan: DayPlan) -> None:
    """Say what was recorded of the day, and why there is no route where there is none.

    And which rows the robot is too wide for, and where its way leaves the plot.
    """
    for told in plan.route.ways_said:
        st.warning(in_words(told))
    if choices.season is not None:
        if len(plan.route) and _is_of_nobody(choices):
            st.info(texts.ROUTE_OF_NOBODY)
        own, over = chosen_day.inspected_by_shown(choices), is_over(choices, plan)
        if own.inspected or over:
            st.info(texts.TODAY_OVER if over else texts.TODAY_DONE.format(**own._asdict()))
            return
    if not len(plan.route) and not cautions.are_all_closed(choices, plan):
        known = nothing_left_in_words(plan.scene)
        st.warning(texts.NO_STOPS if known is None else in_words(known))


def say_otherwise(choices: Choices) -> None:
    """Show where two people said otherwise of one plant on the chosen day: both count as said."""
    if (season := choices.season) is None:
        return
    held = season.inspections.on(choices.on)
    said = contradiction_lines(held, season.plot.grid, texts.isolated)
    if not said:
        return
    lines = [f"- {in_words(one)}" for one in said[:_MOST_OTHERWISE]]
    if (more := len(said) - _MOST_OTHERWISE) > 0:
        lines.append(f"- {texts.AND_MORE.format(n=more)}")
    st.info("\n".join([texts.SAID_OTHERWISE, "", *lines]))


def _is_of_nobody(choices: Choices) -> bool:
    """Return whether the route shown is planned for one, while several are out with their own."""
    if choices.open_season.settings.team or chosen_day.route(choices).worked:
        return False
    kept = chosen_day.planned_and_done(choices)
    return kept is not None and kept.people > 1


def figures(choices: Choices, now: DayFigures, progress: Progress) -> None:
    """Show a season's figures as they stand on a day."""
    plants = len(choices.plot.grid)
    shares = now.share_found_pct(progress.found)
    detected, least, most = (in_words(chance_figure(pct / 100)) for pct in shares)
    star = " *" if assumptions.of(choices) else ""
    with st.container(horizontal=True):
        still = chosen_day.still_infested(choices, choices.day)
        low, high = (number(one, ",") for one in (still.low, still.high))
        expected = f"{about(still.expected)} ({low}–{high})"
        st.metric(f"{texts.EXPECTED_LEFT}{star}", expected,
                  help=texts.EXPECTED_HELP, width="content")  # fmt: skip
        st.metric(texts.FOUND_EVER, number(progress.found, ","), width="content")
        share = f"{detected} ({least}–{most})"
        if not progress.inspected:
            share = texts.NOT_KNOWN_YET
        st.metric(f"{texts.DETECTED}{star}", share, help=texts.DETECTED_HELP, width="content")
        seen = f"{number(progress.inspected, ',')} / {number(plants, ',')}"
        st.metric(texts.INSPECTED_EVER, seen, width="content")
        st.metric(
            f"{texts.CLEAN_CHANCE}{star}",
            in_words(chance_figure(now.chance_clean, 1)),
            width="content",
        )


def beside_figures(choices: Choices) -> None:
    """Say what a season's figures leave out: flagged plants, and what was found again."""
    progress = chosen_day.progress(choices)
    left = chosen_day.figures(choices, choices.day)
    for said in flagged_said(left, chosen_day.flagged(choices)):
        st.caption(in_words(said))
    for said in chosen_day.not_inspected_said(choices):
        st.caption(in_words(said))
    if (finds := progress.finds) > (plants := progress.found):
        st.caption(texts.FOUND_AGAIN.format(finds=finds, plants=plants, again=finds - plants))


def planned_only(choices: Choices) -> None:
    """Say which days up to the one shown were planned, and nothing is recorded of them."""
    if missing := chosen_day.planned_only(choices, choices.on):
        days = listed(choices.units.said_day(day, choices.on) for day in missing)
        st.caption(texts.UNRECORDED.format(days=days))


def changes(choices: Choices) -> tuple[str, list[str]]:
    """Return what changed since the last visit before the day: a title, and sentences."""
    season = choices.season
    if season is None:
        return "", []
    begins, said_day = season.settings.begins, choices.units.said_day
    visit = chosen_day.last_visit(choices, choices.on - timedelta(days=1))
    kind = "begun" if visit is None else "before" if choices.is_past else "visit"
    since = begins if visit is None else visit
    title = texts.CHANGED[kind].format(day=said_day(since, choices.on))
    if choices.on == begins:
        return title, [texts.CHANGED_FIRST]
    if visit is None:
        return title, [texts.CHANGED_NONE, *_changed(choices, since)]
    before = chosen_day.figures(choices, str(visit))
    finds = texts.CHANGED_FINDS.format(
        found=before.found_today, inspected=before.inspected_today, day=said_day(visit)
    )
    return title, [finds, *_changed(choices, since)]


def _changed(choices: Choices, since: date) -> list[str]:
    """Return what was treated since a day, and how what is believed changed since its evening."""
    said_day, days = choices.units.said_day, (str(since), choices.day)
    treated = {one.on for one in choices.open_season.treatments() if since <= one.on <= choices.on}
    said: list[str] = [
        texts.CHANGED_TREATED.format(n=chosen_day.treated(choices, str(day)), day=said_day(day))
        for day in sorted(treated)
    ]
    before, now = (about(chosen_day.still_infested(choices, day).expected) for day in days)
    said.append(texts.CHANGED_OUT.format(day=said_day(since), now=now, before=before))
    figures = chosen_day.figures(choices, choices.day)
    said += map(in_words, flagged_said(figures, chosen_day.flagged(choices)))
    spots_before, spots = (len(chosen_day.season_hot_spots(choices, day)) for day in days)
    if spots_before != spots:
        said.append(texts.CHANGED_HOT.format(now=spots, before=spots_before))
    if rows := _risen(choices, str(since)):
        said.append(texts.CHANGED_ROWS.format(rows=rows))
    return said


def _risen(choices: Choices, since: str) -> str:
    """Return the three rows whose mean chance rose most since an evening, in words."""
    grid = choices.plot.grid
    line = grid.row_line[grid.row]
    chances = [chosen_day.evening(choices, day) for day in (since, choices.day)]
    total = [np.bincount(line, chance) for chance in chances]
    rise = (total[1] - total[0]) / np.maximum(np.bincount(line), 1)
    top = [k for k in np.argsort(-rise)[:3] if rise[k] > 0.001]
    rises = [texts.isolated(f"+{number(100 * rise[k], '.1f')}") for k in top]
    return listed(
        f"{grid.line_signs[int(grid.line_number[k])]}\u00a0({said})"
        for k, said in zip(top, rises, strict=True)
    )


def reasons(choices: Choices, plan: DayPlan) -> list[str]:
    """Return what the stops of the day are for, in sentences."""
    season = choices.season
    if season is None or not len(plan.route):
        return []
    finds = _found_lately(choices)
    on = [_said_find(choices, day) for day in finds.values()]
    recorded = season.history.recorded
    seen = None if recorded is None else recorded >= 0
    told = explain(plan.scene, plan.work, np.array([*finds], np.int32), on, seen)
    return [in_words(one) for one in told]


def _found_lately(choices: Choices) -> dict[int, date]:
    """Return the plants found in the week up to the last visit, and when each was found last."""
    last = chosen_day.last_visit(choices, choices.on)
    if last is None:
        return {}
    done, until = choices.open_season.history.inspections, np.datetime64(last, "D")
    lately = (done.result == FOUND) & (done.date <= until) & (done.date > until - _WEEK)
    return dict(zip(done.plant[lately].tolist(), done.date[lately].tolist(), strict=True))


def _said_find(choices: Choices, day: date) -> str:
    """Return the day of a find: by its weekday where that is one of the last seven days."""
    if not choices.is_today or (choices.on - day).days >= _WEEK:
        return choices.units.said_day(day, choices.on)
    return texts.WHY_TODAY if day == choices.on else weekday(day)
