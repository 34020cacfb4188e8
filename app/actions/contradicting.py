"""Results that wait because they contradict what is recorded, and what is done with them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring.inspecting.contradictions import contradicting, contradictions
from fieldmon.monitoring.inspecting.known_inspections import count_new
from fieldmon.monitoring.season import season_inspections, undoing

from ..show import recorded_batches
from ..state import notices, unconfirmed
from ..state.fresh_boxes import FreshBoxes
from ..words import texts
from ..words.language import in_words, place_in_words
from .recording_results import listed, recorded, said_of, warn_of_lost

if TYPE_CHECKING:
    from fieldmon.monitoring.inspecting.batches import Recorded
    from fieldmon.monitoring.inspecting.contradictions import Contradictions

    from ..state.choices import Choices
    from ..state.unconfirmed import Unconfirmed

# contradictions that are shown
_MOST = 20


def ask_about_contradictions(choices: Choices) -> None:
    """Show what waits because it contradicts what is recorded, and what can be done with it."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        _say_lost(choices)
        return
    season = choices.open_season
    against = contradictions(waiting.results, season.inspections)
    said = against.sentences(season.plot.grid)
    if not said:  # what they contradicted was taken back since
        _ask_anew(choices, waiting)
        return
    others = waiting.results.take(~against.concerns(waiting.results))
    hidden = set() if len(others) else {"leave_out"}
    if against.both_brought(waiting.results):  # neither of them is the new one
        hidden |= {"holds"}
    new = count_new(season, others)
    source = recorded_batches.source(waiting.source)
    st.warning(texts.CONTRADICTING.format(n=len(said), source=source))
    if len(said) > 1:
        _ask_each(choices, against, said)
    else:
        st.markdown(f"- {in_words(said[0])}")
    if len(said) > _MOST:
        st.caption(texts.AND_MORE.format(n=len(said) - _MOST))
    with st.container(horizontal=True):
        for key, label, action in (
            (
                "leave_out",
                texts.LEAVE_OUT.format(n=new) if new else texts.LEAVE_OUT_ONLY,
                _leave_out,
            ),
            ("holds", texts.HOLDS.format(n=len(said)), _record_instead),
            ("confirm", texts.CONFIRM.format(n=len(said)), _confirm),
            ("record_none", texts.RECORD_NONE, _drop),
        ):
            if key not in hidden:
                st.button(label, key=key, on_click=action, args=(choices,))


def _ask_each(choices: Choices, against: Contradictions, said: list[str]) -> None:
    """Ask of each plant and day that contradicts which holds, beside what is asked of all."""
    asked: set[tuple[int, np.datetime64]] = set()
    told = zip(against.plant.tolist(), against.date, against.together, said, strict=True)
    for plant, date, together, sentence in list(told)[:_MOST]:
        with st.container(key=f"against_{plant}_{date}_{len(asked)}", gap=None):
            st.markdown(in_words(sentence))
            if (plant, date) in asked:
                continue
            asked.add((plant, date))
            labels = {
                "leave": texts.LEAVE_OUT_ONLY if together else texts.RECORDED_HOLDS,
                "new": texts.HOLDS.format(n=1),
                "both": texts.CONFIRM.format(n=1),
            }
            if together:  # neither of them is the new one
                del labels["new"]
            with st.container(horizontal=True):
                for which, label in labels.items():
                    st.button(label, key=f"{which} {plant} {date}", on_click=_settle_one,
                              args=(choices, plant, date, which), type="tertiary",
                              help=in_words(sentence))  # fmt: skip


def _say_lost(choices: Choices) -> None:
    """Say what waited before the page was loaded anew: it was not recorded."""
    if lost := unconfirmed.lost(choices.key, choices.day):
        n, source = lost
        st.warning(texts.NOT_RECORDED.format(n=n, source=recorded_batches.source(source)))
        st.button(texts.RECORD_NONE, key="record_none", on_click=_drop, args=(choices,))


def _ask_anew(choices: Choices, waiting: Unconfirmed) -> None:
    """Ask whether to record what waited and contradicts nothing any more."""
    n, source = len(waiting.results), recorded_batches.source(waiting.source)
    st.warning(texts.CONTRADICTING_NO_MORE.format(n=n, source=source))
    with st.container(horizontal=True):
        st.button(texts.RECORD_THESE.format(n=n), key="record_these", on_click=_record_these,
                  args=(choices,))  # fmt: skip
        st.button(texts.RECORD_NONE, key="record_none", on_click=_drop, args=(choices,))


def settle(choices: Choices) -> None:
    """Offer of each plant that is clean and found as recorded of the day to say which holds."""
    held = contradicting(choices.open_season.inspections.on(choices.on))
    for plant in np.unique(held.plant)[:_MOST].tolist():
        place = _place(choices, plant)
        with st.container(horizontal=True, vertical_alignment="center", key=f"settle_{plant}"):
            st.markdown(place, width="stretch")
            for result, label in ((FOUND, texts.FOUND_HOLDS), (CLEAN, texts.CLEAN_HOLDS)):
                st.button(label, key=f"holds {plant} {result}", on_click=_let_hold, help=place,
                          args=(choices, plant, result))  # fmt: skip


def _place(choices: Choices, plant: int) -> str:
    return texts.SETTLE_PLACE.format(**place_in_words(choices.plot.grid, plant))


@notices.reporting
def _let_hold(choices: Choices, plant: int, result: int) -> str:
    """Take back what says otherwise of a plant on the day."""
    n = undoing.let_hold(choices.open_season, plant, choices.on, result)
    return texts.SETTLED.format(place=_place(choices, plant), n=n)


@notices.reporting
def _settle_one(choices: Choices, plant: int, date: np.datetime64, which: str) -> str:
    """Let what waits of a plant and day hold or not; what else waits goes on waiting."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    here = (waiting.results.plant == plant) & (waiting.results.date == date)
    one, rest = waiting.results.take(here), waiting.results.take(~here)
    season, by, done = choices.open_season, (waiting.source, waiting.who), None
    if which == "new":
        done = season.record_instead(one, *by)
    elif which == "both":
        done = season_inspections.recorded(season, one, *by, confirmed=True)
    if len(rest):
        unconfirmed.keep(replace(waiting, results=rest))
        said = said_of(choices, done, one)
    else:
        said = _end_waiting(choices, waiting, done)
    return said if which != "leave" else texts.LEFT_OUT_CONTRADICTING.format(n=len(one))


@notices.reporting
def _record_these(choices: Choices) -> str:
    """Record what waited, as if it were brought now."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    results, source, who = waiting.results, waiting.source, waiting.who
    done = recorded(choices, results, source, waiting.form, waiting.messages, who)
    return _said_at_last(choices, waiting, done)


@notices.reporting
def _confirm(choices: Choices) -> str:
    """Record what contradicts too: both counts as said."""
    return _settled(choices, slice(None))


@notices.reporting
def _record_instead(choices: Choices) -> str:
    """Record all, and let what contradicts hold in place of what was recorded."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    done = choices.open_season.record_instead(waiting.results, waiting.source, waiting.who)
    return _end_waiting(choices, waiting, done)


@notices.reporting
def _leave_out(choices: Choices) -> str:
    """Record what is of other plants and days than those that contradict."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    against = contradictions(waiting.results, choices.open_season.inspections)
    out = against.concerns(waiting.results)
    said = _settled(choices, ~out)
    return f"{said}\n\n{texts.LEFT_OUT_CONTRADICTING.format(n=int(out.sum()))}" if said else ""


def _settled(choices: Choices, which: np.ndarray | slice) -> str:
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    taken = waiting.results.take(which)
    done = season_inspections.recorded(
        choices.open_season, taken, waiting.source, waiting.who, confirmed=True
    )
    return _end_waiting(choices, waiting, done)


def _end_waiting(choices: Choices, waiting: Unconfirmed, done: Recorded | None) -> str:
    """Let nothing wait any more; return what was done."""
    unconfirmed.drop()
    if waiting.form:
        FreshBoxes(waiting.form, choices).empty()
    return _said_at_last(choices, waiting, done)


def _said_at_last(choices: Choices, waiting: Unconfirmed, done: Recorded | None) -> str:
    """Return what was done with results that waited, and what was said of their file."""
    if done is None:
        return ""
    warn_of_lost(waiting.messages)
    return said_of(choices, done, waiting.results) + listed(
        message.sentence for message in waiting.messages
    )


def _drop(choices: Choices) -> None:  # noqa: ARG001 - as the others
    unconfirmed.drop()
