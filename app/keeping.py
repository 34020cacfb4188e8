"""What writes into a season: beginning one, recording what was found, undoing."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.options import Upload
from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from fieldmon.plot.grid import plant_at

from . import cached, panels, seasons, texts, verdicts
from .choices import open_season

if TYPE_CHECKING:
    from collections.abc import Callable

    from .choices import Choices

__all__ = ["CLEAN", "FOUND", "SKIPPED"]


def note(kind: str, sentence: str) -> None:
    """Keep a sentence for the next run, which shows it above the page."""
    st.session_state["said"] = (kind, sentence)


def said() -> None:
    """Show what was kept to be said."""
    kind, sentence = st.session_state.pop("said", (None, ""))
    if kind is not None:
        getattr(st, kind)(sentence)


def begin(choices: Choices) -> None:
    """Offer to keep what is chosen as a season."""
    with st.form("begin", border=True):
        st.markdown(f"**{texts.BEGIN_TITLE}**")
        st.caption(texts.BEGIN_NOTE)
        proposed = f"{choices.plot.field.name} {choices.on.year}"
        st.text_input(texts.SEASON_NAME, proposed, key="season_name")
        st.form_submit_button(texts.BEGIN, type="primary", on_click=_create, args=(choices,))


def _create(choices: Choices) -> None:
    name = st.session_state["season_name"].strip()
    settings = MonitoringSettings(choices.on, panels.STARTS, choices.robot, choices.sampler)
    messages = [
        KeptMessage("import", str(h.finding.severity), h.finding.feature, h.finding.sentence)
        for h in choices.heard
    ]
    try:
        path = seasons.new_path(name)
        Season.create(path, choices.plot, choices.records, settings, messages, choices.risk)
    except FieldmonError as error:
        note("error", str(error))
        return
    open_season(name)
    note("success", texts.BEGUN.format(name=texts.isolated(name), path=path))


def saying(action: Callable[..., str]) -> Callable[..., None]:
    """Return a callback that notes the sentence its action returns, or the problem it meets."""

    def callback(*arguments: object) -> None:
        try:
            note("success", action(*arguments))
        except FieldmonError as error:
            note("error", str(error))

    return callback


@saying
def record_one(choices: Choices) -> str:
    """Record the plant that was typed in."""
    state = st.session_state
    plant = plant_at(choices.plot.grid, int(state["one_row"]), int(state["one_plant"]))
    result, count = state["one_result"], state["one_count"]
    counted = np.array([np.nan if count is None or result != FOUND else float(count)])
    results = Inspections.of(
        np.array([plant]), np.array([result]), np.datetime64(choices.day), count=counted
    )
    return _recorded(choices, results, texts.TYPED_IN)


@saying
def record_stops(choices: Choices, plants: np.ndarray, found: list[int]) -> str:
    """Record the first stops of the route: those marked as found, the others as clean."""
    done = plants[: int(st.session_state["stops_done"])]
    result = np.where(np.isin(np.arange(len(done)) + 1, found), FOUND, CLEAN)
    results = Inspections.of(done, result, np.datetime64(choices.day))
    return _recorded(choices, results, texts.ROUTE_TABLE)


@saying
def record_file(choices: Choices, name: str, data: bytes) -> str:
    """Record findings from a file: a route given out and filled in, a table, positions."""
    # what reads files is half a second to import
    from fieldmon.io.readers.inspection_options import InspectionOptions  # noqa: PLC0415
    from fieldmon.io.readers.inspections import read_inspections  # noqa: PLC0415

    options = InspectionOptions(take_doubtful=bool(st.session_state.get("take_doubtful")))
    options = options.choose("day", choices.day)
    read = read_inspections(Upload(name, data), choices.plot.grid, options)
    remarks = "".join(f"\n- {finding.sentence}" for finding in read.messages)
    return _recorded(choices, read.value, name) + remarks


def _recorded(choices: Choices, results: Inspections, source: str) -> str:
    done = choices.project.record(results, source)
    return texts.RECORDED.format(new=done.new, known=done.known)


@saying
def undo(choices: Choices, batch: int) -> str:
    """Take a batch back."""
    return choices.project.undo(batch)


@saying
def treat(choices: Choices) -> str:
    """Note that the whole plot was treated."""
    state = st.session_state
    share, product = state["efficacy"] / 100, state["product"]
    done = choices.project.treat(choices.on, share, product=product)
    return texts.TREATED if done.new else texts.TREATED_BEFORE


@saying
def use(choices: Choices, sampler: str, hours: float, look_s: float) -> str:
    """Work with this sampler, these hours and this time at a plant from now on."""
    if choices.project is not None:
        setup = choices.project.settings
        robot = replace(setup.robot, hours=hours, look_s=look_s)
        choices.project.change(replace(setup, robot=robot, sampler=sampler), setup)
    else:
        who = st.session_state.get("who", texts.ROBOT)
        st.session_state["sampler"] = sampler
        st.session_state[f"hours {who}"] = hours
        st.session_state[f"look {who}"] = int(look_s)
    return texts.NOW_USED.format(name=verdicts.arm_name(sampler, hours, look_s))


def local(at: datetime) -> datetime:
    """Return a moment in the time of the person's browser, without a zone."""
    minutes = st.context.timezone_offset
    if minutes is None:
        return at.astimezone().replace(tzinfo=None)
    return at.astimezone(UTC).replace(tzinfo=None) - timedelta(minutes=minutes)


def batches(choices: Choices) -> None:
    """Show what was recorded, the last one first, each with its undo."""
    for batch in choices.project.batches()[:20]:
        if not batch.rows:
            continue
        left, right = st.columns([4, 1], vertical_alignment="center")
        at = local(datetime.fromisoformat(batch.at))
        said = texts.BATCHES_SAID[batch.kind].format(
            day=choices.units.day(at.date()), time=f"{at:%H:%M}", n=batch.rows,
            source=texts.isolated(batch.source) if batch.source else "",
        )  # fmt: skip
        left.markdown(said + (f" ({texts.UNDONE})" if batch.undone else ""))
        if not batch.undone:
            right.button(texts.UNDO, key=f"undo {batch.number}", on_click=undo,
                         args=(choices, batch.number))  # fmt: skip


def figures(choices: Choices) -> list:
    """Return the days up to the one chosen on which something happened, and that one."""
    own = (choices.key, choices.revision)
    days = cached.kept_figures(*own, choices.project)
    kept = [figures for day, figures in days.items() if day < choices.day]
    return [*kept, cached.day_in_figures(*own, choices.day, choices.project)]
