"""Boxes for files, what their import says, and buttons that answer what a file leaves open."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.formats.signatures import USUAL_FILES
from fieldmon.io.import_report import Severity
from fieldmon.io.parse.result_words import words_in, words_told

from ..show import plot_place
from ..state import brought_files, chosen_day, drawn_plot, plot_source, rasters
from ..state.brought_files import (
    BLOCKS,
    PLANTS,
    PLOT,
    RECORDS,
    ROWS,
    FileMessage,
    answers,
    brought,
)
from ..state.tried_answers import tried_of_records
from ..words import texts
from ..words.answers import in_short
from ..words.language import in_words, listed, of_error
from ..words.signs import unformatted
from . import bringing_seasons

if TYPE_CHECKING:
    from fieldmon.errors import FieldmonError
    from fieldmon.io.import_report import ImportMessage, Remedy

    from ..state.brought_files import File
    from ..state.choices import Choices
    from ..state.tried_answers import TriedAnswer

_ICONS = {
    name: f":material/{icon}:"
    for name, icon in {
        "seen": "visibility", "repaired": "build", "guessed": "lightbulb", "dropped": "delete",
        "doubtful": "warning",
    }.items()
}  # fmt: skip
# questions that a box of their own answers: for another file, or beside the file
_OWN_BOXES = frozenset({"kind", "plots", "plants", "meaning"})
_MOST_BUTTONS = 12
# fewer plants than these are hardly a plot
_FEW_PLANTS = 10
# what may be answered of findings with a button: all others are boxes, or need a value
_OF_FINDINGS = frozenset({"found", "clean", "gone", "columns"})
# what a word for a result may mean, and the option that takes it so
_MEANINGS = {FOUND: "found", CLEAN: "clean"}


# -- boxes


def show() -> None:
    """Show the boxes for a plot's files; what was dropped is kept while the session lasts."""
    labels = {PLOT: texts.PLOT_FILE.format(formats=listed(USUAL_FILES)), RECORDS: texts.RECORD_FILE,
              PLANTS: texts.PLANT_FILE, ROWS: texts.ROWS_FILE,
              BLOCKS: texts.BLOCKS_FILE}  # fmt: skip
    for kind, label in labels.items():
        box = brought_files.box(kind)
        dropped = st.file_uploader(label, key=box, accept_multiple_files=True,
                                   on_change=_take, args=(kind, box))  # fmt: skip
        if not dropped:
            _kept(kind)
        if kind == PLOT:
            bringing_seasons.show()


def show_raster(label: str, kind: str) -> None:
    """Show a box for one raster."""
    _show_box_of_one(label, kind)


def show_kept_raster(kind: str) -> None:
    """Show which raster is kept and what is wrong with it; take it out on demand."""
    _kept_or(kind, rasters.problem(kind))


def show_one(label: str, kind: str, problem: FieldmonError | None) -> None:
    """Show a box for one file, which file is kept, and what is wrong with it."""
    _show_box_of_one(label, kind)
    _kept_or(kind, problem)


def _show_box_of_one(label: str, kind: str) -> None:
    box = brought_files.box(kind)
    st.file_uploader(label, key=box, on_change=_take_one, args=(kind, box))


def _kept_or(kind: str, problem: FieldmonError | None) -> None:
    _kept(kind)
    if kind in brought() and problem is not None:
        say(problem, brought()[kind].asked)


def _kept(kind: str) -> None:
    kept = brought().get(kind)
    if kept is not None:
        st.caption(texts.KEPT_FILE.format(name=listed(map(texts.isolated, kept.names))))
        st.button(texts.FORGET_FILE, key=f"forget {kind}", on_click=brought_files.take_out,
                  args=(kind,))  # fmt: skip


def _take(kind: str, box: str) -> None:
    parts = st.session_state.get(box) or []
    if kind != PLOT or not bringing_seasons.hold(parts):
        brought_files.keep(kind, parts)


def _take_one(kind: str, box: str) -> None:
    part = st.session_state.get(box)
    if part is not None:
        brought_files.keep(kind, [part])


# -- what imports say, and ask


def show_left_out(choices: Choices) -> None:
    """Say above a page which files it does without, and why; ask what they leave open."""
    for one in choices.left_out:
        with st.container(border=True):
            st.markdown(texts.LEFT_OUT.format(name=texts.isolated(one.file.name)))
            say(one.problem, one.file.asked, tried_of_records(one, choices.plot.field))


def say(
    error: FieldmonError, asked: str | None = None, tried: tuple[TriedAnswer, ...] = ()
) -> None:
    """Show a problem as its sentence; where the file leaves a choice, ask for it by buttons.

    What is `tried` is on the map, by the same numbers.
    """
    asking = brought_files.asking() if asked is None else asked
    if isinstance(error, ChoiceNeeded):
        tried = tried if any(one.leads for one in tried) else ()
        if tried:
            of_records = any(one.records is not None for one in tried)
            st.markdown(f"### {texts.RECORDS_ON_MAP if of_records else texts.CHOOSE_ON_MAP}")
            with st.expander(texts.CHOOSE):
                st.warning(of_error(error))
        else:
            st.warning(of_error(error))
        _ask(error, asking, {one.answer: one for one in tried})
    else:
        st.error(of_error(error))
    _offer_undo(asking)


def _ask(error: ChoiceNeeded, asking: str, tried: dict[str, TriedAnswer]) -> None:
    if asking.startswith(f"{PLOT} ") and (
        error.option in {"where", "outline"} or "plants" in error.choices
    ):
        st.button(texts.THESE_ARE_PLANTS, key=f"plants {asking}", type="primary", width="stretch",
                  on_click=brought_files.take_as_plants, args=(asking,))  # fmt: skip
    if error.option in _OWN_BOXES:
        return
    offered = [str(choice) for choice in error.choices]
    for number, answer in with_buttons(offered, tried):
        label = _label(number, in_short(answer, error.option), tried.get(answer))
        st.button(label, key=f"pick {asking} {answer}", width="stretch",
                  on_click=brought_files.answer, args=(asking, error.option, answer))  # fmt: skip
    label, widget = texts.CHOOSE_OTHER, f"ask {asking} {error.option}"
    with st.container(horizontal=True, vertical_alignment="bottom"):
        if error.choices:
            st.selectbox(label, offered, key=widget, accept_new_options=True,
                         format_func=partial(in_short, option=error.option))  # fmt: skip
        else:
            st.text_input(label, key=widget)
        st.button(texts.CHOOSE_BUTTON, key=f"use {asking} {error.option}",
                  on_click=_answer_from, args=(asking, error.option, widget))  # fmt: skip


def with_buttons(offered: list[str], tried: dict[str, TriedAnswer]) -> list[tuple[int, str]]:
    """Return the answers that have buttons, each under the number that it has on the map.

    What was seen to lead nowhere has none: it can be given as another answer.
    """
    numbered = enumerate(offered, start=1)
    some = [one for one in numbered if one[1] not in tried or tried[one[1]].leads]
    return some[:_MOST_BUTTONS]


def _label(number: int, answer: str, one: TriedAnswer | None) -> str:
    """Return what a button says: what is answered and, where it was tried, where that leads."""
    if one is None:
        return answer
    where = plot_place.of_zone(one.zone)
    if one.records is not None:
        said = texts.ANSWER_RECORDS.format(near=one.near, n=len(one.records), found=one.finds)
        where = said if one.near else f"{where}, {said}"
    return f"{number} · {answer} · {where}"


def _answer_from(key: str, option: str, widget: str) -> None:
    brought_files.answer(key, option, st.session_state.get(widget) or "")


def _offer_undo(key: str) -> None:
    """Offer to take the last answer about a file back, if there is one."""
    if key and answers(key):
        option, value = answers(key)[-1]
        st.button(texts.UNDO_ANSWER.format(answer=in_short(value, option)), key=f"back {key}",
                  icon=":material/undo:", on_click=brought_files.drop_answer,
                  args=(key,))  # fmt: skip


def show_doubts(choices: Choices) -> None:
    """Show, while no season is begun, all that is doubtful, and which records are left out."""
    show_doubts_of_plot(choices)
    show_doubts_of_records(choices)


def show_doubts_of_plot(choices: Choices) -> None:
    """Show, while no season is begun, what is doubtful about the plot: it may lie elsewhere."""
    if doubts := _doubts(choices, of_records=False):
        with st.container(border=True, key="doubts"):
            for number, one in doubts:
                _show_message(number, one)


def show_doubts_of_records(choices: Choices) -> None:
    """Show, while no season is begun, what is doubtful about records, and which are left out."""
    # those of the sample are part of it: under Plot & data they are said as well
    is_sample = plot_source.chosen() == plot_source.SAMPLE
    doubts = [] if is_sample else _doubts(choices, of_records=True)
    if doubts or (choices.season is None and chosen_day.messages_on_records(choices)):
        with st.container(border=True, key="doubts_of_records"):
            for number, one in doubts:
                _show_message(number, one)
            show_of_records(choices)


def _doubts(choices: Choices, *, of_records: bool) -> list[tuple[int, FileMessage]]:
    """Return what is doubtful, with the number of each message; in a season nothing is."""
    return [
        (number, one)
        for number, one in enumerate(choices.messages)
        if one.message.severity == Severity.DOUBTFUL
        and one.asked.startswith(f"{RECORDS} ") == of_records
        and choices.season is None
    ]


def show_of_records(choices: Choices) -> None:
    """Show which records planning cannot use."""
    said = [f"- {in_words(sentence)}" for sentence in chosen_day.messages_on_records(choices)]
    if said and choices.season is not None:
        begins = choices.units.said_day(choices.season.settings.begins, choices.on)
        st.markdown(texts.RECORDS_OF_BEGIN.format(day=begins))
    if said:
        st.markdown("\n".join(said))


def _show_message(number: int, one: FileMessage) -> None:
    """Show a message, its remedy as a button."""
    message = one.message
    place = f"{texts.isolated(message.feature)}: " if message.feature else ""
    mark = f"{_ICONS[message.severity]} **{texts.SEVERITIES[message.severity]}**"
    st.markdown(f"{mark} · {place}{in_words(message.sentence)}")
    remedy = message.remedy
    if remedy is not None and remedy.option == "found":
        _ask_of_words(number, one.asked, remedy)
    elif remedy is not None:
        key = f"remedy {number} {one.asked} {remedy.option} {remedy.value}"
        st.button(in_words(remedy.label), key=key, on_click=brought_files.answer,
                  args=(one.asked, remedy.option, remedy.value))  # fmt: skip


def ask_of_findings(file: File, said: tuple[ImportMessage, ...]) -> None:
    """Ask what a file of findings leaves open by what was said of it, and is not answered yet."""
    given = answers(file.asked)
    words = {word for told in _words_said(file.asked).values() for word in told}
    for number, message in enumerate(said):
        remedy = message.remedy
        if remedy is None or remedy.option not in _OF_FINDINGS:
            continue
        of_words = remedy.option == "found"
        is_answered = words.issuperset(words_in(remedy.value)) if of_words else (
            (remedy.option, remedy.value) in given)  # fmt: skip
        if not is_answered:
            _show_message(number, FileMessage(file.asked, message))
    _offer_undo(file.asked)


def _ask_of_words(number: int, asked: str, remedy: Remedy) -> None:
    """Ask of each word that says neither what it means, all at once."""
    known = {word for said in _words_said(asked).values() for word in said}
    words = [word for word in words_in(remedy.value) if word not in known][:_MOST_BUTTONS]
    keys = {word: f"word {number} {asked} {word}" for word in words}
    for word, key in keys.items():
        st.segmented_control(unformatted(word), _MEANINGS, key=key,
                             format_func=texts.HISTORY_RESULTS.__getitem__)  # fmt: skip
    st.button(texts.WORDS_TAKE, key=f"words {number} {asked}", on_click=_take_words,
              args=(asked, keys))  # fmt: skip


def _words_said(asked: str) -> dict[str, list[str]]:
    """Return the words that were said to mean found, and clean, in answers about a file."""
    said = dict(answers(asked))  # the last of each counts
    return {name: words_in(said.get(name)) for name in _MEANINGS.values()}


def _take_words(asked: str, keys: dict[str, str]) -> None:
    """Take what was chosen of words as answers about a file, beside those that were given."""
    said = _words_said(asked)
    for result, name in _MEANINGS.items():
        new = [word for word, key in keys.items() if st.session_state.get(key) == result]
        if new:
            brought_files.answer(asked, name, words_told([*said[name], *new]))


def show_of_plot(choices: Choices) -> None:
    """Show what the imports of a plot had to say, and whether hardly any plant stands on it."""
    n = len(np.unique(choices.plot.grid.vine))
    if n < _FEW_PLANTS:
        st.warning(texts.FEW_PLANTS.format(n=n))
    is_own = plot_source.chosen() == plot_source.FILES
    is_drawn = is_own and bool(drawn_plot.corners_of_plot())
    show_messages(choices.messages, texts.MESSAGES_DRAWN if is_drawn else "")


def show_messages(said: tuple[FileMessage, ...], none: str = "") -> None:
    """Show what imports had to say, the gravest first, each remedy as a button; or else `none`."""
    if not said:
        st.markdown(none or texts.MESSAGES_NONE)
    for number, one in enumerate(sorted(said, key=lambda one: -one.message.severity.rank)):
        _show_message(number, one)
    for asked in dict.fromkeys(one.asked for one in said):
        _offer_undo(asked)
