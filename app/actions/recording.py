"""Recording what was found: one plant, the stops of the route, or a file; and taking it back."""

from __future__ import annotations

import zlib
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import ContradictionError, FieldmonError, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.options import Upload
from fieldmon.io.parse import result_words
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring.changes.transactions import MAGIC
from fieldmon.monitoring.season.inspection_import import read_brought, record_saved
from fieldmon.plot.grid import plant_at, plant_numbers
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.named_rows import plant_meant

from ..show import cautions, day, plant_history, recorded_batches
from ..show.recorded_batches import GONE
from ..state import brought_files, chosen_day, fresh_boxes, kept_files, notices, unconfirmed
from ..state.fresh_boxes import FreshBoxes
from ..state.unconfirmed import Unconfirmed
from ..words import texts
from ..words.language import in_words
from . import acting, bringing_files, choosing, correcting, treating

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents, Recorded
    from fieldmon.monitoring.season.inspection_import import BroughtFile

    from ..state.choices import Choices

# batches shown, the last ones, and so many more at each press
_MOST = 20
_SAID_OF_FILE = "said of a file of findings"
# who inspected where nobody said so
_NOBODY = ""
_UNDO_ASKED, _SHOWN = "undo asked", "batches shown"
#: what a season's file calls what was typed in here, whatever the page's language
TYPED_IN, _ROUTE_TABLE = "typed in", "route table"
# the forms
_ONE, _ROUTE, _FILE = "one_plant", "route", "file"
# row and number of the plant that was tapped: no name of another row is meant by them
_TAPPED = "one_tapped"


def show(choices: Choices) -> None:
    """Show the ways of recording, and of noting a treatment."""
    fresh_boxes.turn(choices)
    st.markdown(f"**{texts.RECORD} · {choices.units.said_day(choices.day)}**")
    moved = st.container()
    ask_about_contradictions(choices)
    one, route, file, treat = st.tabs(
        [texts.RECORD_ONE, texts.RECORD_ROUTE, texts.RECORD_UPLOAD, texts.TREAT]
    )
    with one:
        _show_one(choices)
    with route:
        _show_route(choices)
    with file:
        _show_file(choices)
    with treat:
        treating.show(choices)
    if fresh_boxes.hold_of_another_day(choices):
        moved.info(texts.MOVED_HERE.format(day=choices.units.said_day(choices.day)))
    # below: on a phone what is filled in has the first screen
    st.caption(texts.RECORD_NOTE)
    kept_files.sync()  # marks are known once their table is shown


# -- one plant


def take_plant(choices: Choices, layer: str, index: int) -> None:
    """Take the plant that was tapped as the one to be recorded; nothing is recorded by it."""
    if layer.startswith("plants"):
        plant = np.array([min(index, len(choices.plot.grid) - 1)])
        numbered, face = plant_numbers(choices.plot.grid, plant), faces(choices.plot.grid, plant)
        boxes = FreshBoxes(_ONE, choices)
        boxes.empty()  # a result that was said of another plant is none of this one
        row, number = int(numbered.line[0]), int(numbered.number[0])
        typed = f"{row}" if choices.plot.grid.row_names else row
        boxes.put("one_row", typed)
        boxes.put("one_plant", number)
        boxes.put("one_face", int(face[0]) or None)
        boxes.put(_TAPPED, (typed, number))
        plant_history.take_plant(choices, layer, index)


def _show_one(choices: Choices) -> None:
    st.caption(texts.HISTORY_TAP)
    boxes = FreshBoxes(_ONE, choices)
    show = boxes.show
    # no form: what is typed into one is the browser's alone until it is sent
    left, right = st.columns(2)
    # empty: what nobody said must not be recorded by one click
    if choices.plot.grid.row_names:
        show(left.text_input, texts.HISTORY_ROW, box="one_row", default="")
    else:
        show(left.number_input, texts.HISTORY_ROW, 0, None, box="one_row")
    show(right.number_input, texts.HISTORY_PLANT, 0, None, box="one_plant")
    if choices.plot.grid.has_faces:
        show(st.segmented_control, texts.HISTORY_FACE, [1, 2], box="one_face")
    show(
        st.segmented_control, texts.RESULT, [FOUND, CLEAN, SKIPPED, GONE],
        box="one_result", format_func=texts.RESULTS_OF.__getitem__,
    )  # fmt: skip
    show(st.number_input, texts.COUNT, 0, None, box="one_count")
    _ask_who(boxes, stays=True)
    acting.at_press(texts.RECORD_BUTTON, _record_one, choices, key="record_one", boxes=boxes)
    correcting.show(choices, _plant_typed(choices))


def _plant_typed(choices: Choices) -> int | None:
    """Return the plant of which row and number are typed in; None: there is none yet."""
    said = FreshBoxes(_ONE, choices).said
    row, number = said("one_row"), said("one_plant")
    if {None, ""} & {row, number}:
        return None
    try:
        return _plant_meant(choices, row, number, said("one_face"))
    except FieldmonError:  # it is said once a result is to be recorded
        return None


def _plant_meant(choices: Choices, row: str | int, number: int, face: int | None) -> int:
    grid = choices.plot.grid
    if tuple(FreshBoxes(_ONE, choices).said(_TAPPED) or ()) == (row, number):
        plant = plant_at(grid, int(row), number)
    else:
        plant = plant_meant(grid, f"{row}", int(number))
    if face is None and grid.twin[plant] >= 0:
        raise SettingError(texts.ONE_FACE_UNSAID)
    return plant_history.of_face(grid, plant, face or 1)


@notices.reporting
def _record_one(choices: Choices) -> str:
    said = FreshBoxes(_ONE, choices).said
    row, number, result, count = map(said, ("one_row", "one_plant", "one_result", "one_count"))
    if {None, ""} & {row, number, result}:
        raise SettingError(texts.ONE_UNSAID)
    plant = _plant_meant(choices, row, number, said("one_face"))
    counted = np.array([np.nan if count is None or result != FOUND else float(count)])
    result, note = as_kept(result)
    results = Inspections.of(
        np.array([plant]), np.array([result]), np.datetime64(choices.day),
        count=counted, notes=np.array([note], object),
    )  # fmt: skip
    done = recorded(choices, results, TYPED_IN, _ONE, who=_signed(FreshBoxes(_ONE, choices)))
    return said_of(choices, done, results)


def as_kept(result: int) -> tuple[int, str]:
    """Return a result as a season keeps it, with its note."""
    return (SKIPPED, result_words.GONE) if result == GONE else (result, "")


# -- the stops of the route


def _show_route(choices: Choices) -> None:
    """Show the route given out for the day, or the one planned, to be marked stop by stop.

    One of a team has a route of their own, and signs for it.
    """
    choosing.whose_day(choices)
    kept, plan = chosen_day.given_out(choices), choices.plan()
    plants = kept if len(kept) else plan.route.plant
    boxes = FreshBoxes(_ROUTE, choices)
    # what was marked on another route is none of this one
    of = zlib.crc32(np.ascontiguousarray(plants).tobytes())
    st.caption(texts.RECORD_REST)
    if len(kept) and len(plan.route) and not chosen_day.is_given_out(choices, plan):
        st.caption(texts.RECORD_GIVEN_OUT)
    boxes.show(st.number_input, texts.RECORD_STOPS, 0, len(plants), box=f"stops_done {of}")
    marks = _Marks(boxes.key(f"marks {of}"))
    with st.container(key="route_marks"):
        table = partial(marks.show, choices, plants)
        boxes.show(table, box=f"marked {of}", default=[])
    acting.at_press(texts.RECORD_BUTTON, _record_stops, choices, plants, (of, marks),
                    key="record_route", boxes=boxes, type="primary")  # fmt: skip


class _Marks:
    """The table of a route's stops in which those are marked at which something was found."""

    def __init__(self, editor: str) -> None:
        self._editor, self._begun = editor, frozenset[int]()

    def show(
        self, choices: Choices, plants: np.ndarray, *, value: list[int], key: str
    ) -> list[int]:
        """Show the stops, those of `value` marked already; return those marked now."""
        stops = np.arange(len(plants)) + 1
        self._begun = frozenset(value)
        table = pd.DataFrame(
            {
                **day.place_columns(choices.plot.grid, plants),
                texts.LEGEND_STATES["found"]: np.isin(stops, value),
            },
            index=pd.Index(stops, name=texts.STOP_NUMBER),
        )
        st.data_editor(table, height=230, disabled=list(table.columns[:-1]), key=self._editor)
        found = self.now()
        # what is known of it on another page: no table takes a value by its own key
        st.session_state[key] = found
        return found

    def now(self) -> list[int]:
        """Return the numbers of the stops marked now, also before the table is shown again."""
        edits = st.session_state.get(self._editor, {}).get("edited_rows", {})
        marked = set(self._begun)
        for row, columns in edits.items():
            for is_found in columns.values():  # there is one that can be edited
                (marked.add if is_found else marked.discard)(int(row) + 1)
        return sorted(marked)


@notices.reporting
def _record_stops(choices: Choices, plants: np.ndarray, told: tuple[int, _Marks]) -> str:
    """Record the stops marked as found, and the others of the first so many as clean."""
    of, marks = told
    done = int(FreshBoxes(_ROUTE, choices).said(f"stops_done {of}") or 0)
    found = marks.now()
    stops = np.arange(len(plants)) + 1
    is_found = np.isin(stops, found)
    said = is_found | (stops <= done)
    if not said.any():
        raise SettingError(texts.RECORD_UNSAID)
    result = np.where(is_found, FOUND, CLEAN)[said]
    results = Inspections.of(plants[said], result, np.datetime64(choices.day))
    kept = recorded(choices, results, _ROUTE_TABLE, _ROUTE, who=choices.whose_day or "")
    return said_of(choices, kept, results)


# -- a file


def _show_file(choices: Choices) -> None:
    boxes = FreshBoxes(_FILE, choices)
    key = boxes.key
    brought = st.file_uploader(texts.RECORD_FILE_IN, key=key("findings_file"))
    st.checkbox(texts.TAKE_DOUBTFUL, key=key("take_doubtful"))
    if brought is not None:
        _ask_who(boxes, texts.INSPECTED_BY_HELP)
        if brought.getvalue().startswith(MAGIC):
            st.text_input(texts.CORRECTED_BY, key=key("corrected_by"),
                          help=texts.CORRECTED_BY_HELP)  # fmt: skip
        acting.at_press(texts.RECORD_BUTTON, _record_file, choices, key="record_file",
                        boxes=boxes, type="primary")  # fmt: skip
        if unconfirmed.refused(_corrections_in(choices, brought.name, brought.getvalue())):
            acting.at_press(texts.CORRECT_BOTH, _record_file_both, choices, key="correct_both",
                            boxes=boxes)  # fmt: skip
        asked, said = st.session_state.get(_SAID_OF_FILE, ("", ()))
        if asked and (file := _file(brought.name, brought.getvalue())).asked == asked:
            bringing_files.ask_of_findings(file, said)


def _file(name: str, data: bytes) -> brought_files.File:
    return brought_files.file_of(brought_files.FINDINGS, (Upload(name, data),))


def _corrections_in(choices: Choices, name: str, data: bytes) -> tuple[object, ...]:
    """Return of which corrections a file brought to a season is."""
    return choices.key, _file(name, data).asked


@notices.reporting
def _record_file(choices: Choices) -> str:
    return _file_recorded(choices, confirmed=False)


@notices.reporting
def _record_file_both(choices: Choices) -> str:
    """Record a file with corrections that contradict what else is recorded."""
    return _file_recorded(choices, confirmed=True)


def _file_recorded(choices: Choices, *, confirmed: bool) -> str:
    """Record findings from a file: a route filled in, a table, positions, a copy of the season."""
    from fieldmon.io.readers.inspection_options import InspectionOptions  # noqa: PLC0415 - late

    boxes, season = FreshBoxes(_FILE, choices), choices.open_season
    brought = boxes.said("findings_file")
    if brought is None:  # taken out again
        return ""
    name, data = brought.name, brought.getvalue()
    options = InspectionOptions(
        work_day=np.datetime64(choices.day), take_doubtful=bool(boxes.said("take_doubtful"))
    ).on(choices.plot.field)
    file = _file(name, data)
    with working_folder() as folder:
        options = brought_files.answered(file, options)
        read = read_brought(season, Upload(name, data), options, Path(folder))
        with unconfirmed.of_corrections(_corrections_in(choices, name, data)):
            corrected = _corrected(choices, read, boxes, confirmed=confirmed)
    st.session_state[_SAID_OF_FILE] = file.asked, read.messages
    messages = [message.sentence for message in read.messages]
    _warn_of_lost(read.messages)
    if read.saved is None:
        # what was said of a file may be answered: it stays to be read again
        form = "" if messages else _FILE
        done = recorded(choices, read.findings, name, form, read.messages, _signed(boxes))
        said = said_of(choices, done, read.findings)
    else:
        done, more = record_saved(season, read.saved, _signed(boxes))
        said, messages = said_of(choices, done), [*messages, *more]
        if more:
            notices.warn()
        if not messages:
            boxes.empty()
    said = said + _listed(messages) if said else ""
    return "\n\n".join(part for part in (corrected, said) if part)


def _warn_of_lost(messages: Iterable[ImportMessage]) -> None:
    """Let what is returned be no success where something of a file was left out or is doubtful."""
    if any(message.severity.is_loss for message in messages):
        notices.warn()


def _listed(sentences: Iterable[str]) -> str:
    """Return what was said of a file, a line for each sentence."""
    return "".join(f"\n- {in_words(sentence)}" for sentence in sentences)


def _corrected(choices: Choices, read: BroughtFile, boxes: FreshBoxes, *, confirmed: bool) -> str:
    """Take what another program corrected or deleted in a copy; return how many were new."""
    if read.copy is None or not read.corrections:
        return ""
    who = str(boxes.said("corrected_by") or "").strip()
    if not who:
        raise SettingError(texts.CORRECTED_UNSAID)
    season = choices.open_season
    n = season.take_corrections(read.copy, read.name, who, confirmed=confirmed)
    return texts.CORRECTED.format(n=n)


def _ask_who(boxes: FreshBoxes, help_: str | None = None, *, stays: bool = False) -> None:
    """Ask where a team works who inspected: nobody, unless one of it or another name is said.

    Who `stays` inspected what is recorded next, too: the box says so.
    """
    if team := boxes.choices.team_that_day:
        boxes.show(
            st.selectbox, texts.INSPECTED_BY, [_NOBODY, *team], box="who", stays=stays,
            default=_NOBODY, help=help_, accept_new_options=True,
            format_func=lambda who: who or texts.NOBODY_SAID,
        )  # fmt: skip


def _signed(boxes: FreshBoxes) -> str:
    """Return who is said to have inspected; empty: nobody is."""
    return str(boxes.said("who") or _NOBODY).strip()


def recorded(
    choices: Choices, results: Inspections, source: str, form: str = "",
    messages: tuple[ImportMessage, ...] = (), who: str = "",
) -> Recorded | None:  # fmt: skip
    """Record results, and empty the form that they are from; `who` inspected, unless they say so.

    None where some contradict what is recorded: they wait for a word on it, and what was said of
    their file waits with them.
    """
    try:
        done = choices.open_season.record(results, source, who)
    except ContradictionError:
        of = choices.key, choices.day
        unconfirmed.keep(Unconfirmed(*of, results, source, form, messages, who))
        return None
    unconfirmed.drop()
    if form:
        FreshBoxes(form, choices).empty()
    return done


def said_of(choices: Choices, done: Recorded | None, results: Inspections | None = None) -> str:
    """Return what recording did, and of which days if not of that shown.

    Nothing where results wait for a word.
    """
    if done is None:
        return ""
    corrected: list[str] = [texts.CORRECTED.format(n=done.corrected)] if done.corrected else []
    if done.new or done.known or not corrected:
        said = [texts.RECORDED.format(new=done.new, known=done.known)]
        more = (
            *((texts.NOTED, done.noted), (texts.COMPLETED, done.filled)),
            (texts.BY_A_SECOND, done.seen_by_another),
        )
        corrected.append(" ".join([*said, *(text.format(n=n) for text, n in more if n)]))
    if results is not None:
        corrected += _of_days(choices, results)
    return "\n\n".join(corrected)


def _of_days(choices: Choices, results: Inspections) -> Iterator[str]:
    """Yield of which days results are, if not of that shown, and that one has not come."""
    days = results.date[~np.isnat(results.date)]
    if not len(days):
        return
    first, last = days.min().item(), days.max().item()
    # past midnight the page is about the next day already
    shown = local_clock(choices.plot.field).today() if choices.is_today else choices.on
    if {first, last} != {shown}:
        said = choices.units.said_days(first, last, shown)
        day = choices.units.said_day(shown)
        yield texts.RECORDED_OF.format(days=said, day=day)
    if ahead := cautions.not_come(choices, last):
        notices.warn()
        yield ahead


# -- what contradicts


def ask_about_contradictions(choices: Choices) -> None:
    """Show what waits because it contradicts what is recorded, and what can be done with it."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return
    season = choices.open_season
    against = season.contradictions(waiting.results)
    said = against.sentences(season.plot.grid)
    if not said:  # what they contradicted was taken back since
        _ask_anew(choices, waiting)
        return
    others = waiting.results.take(_but(against.which, len(waiting.results)))
    new = season.count_new(others)
    source = recorded_batches.source(waiting.source)
    st.warning(texts.CONTRADICTING.format(n=len(said), source=source))
    st.markdown("\n".join(f"- {in_words(sentence)}" for sentence in said[:_MOST]))
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
            if key != "leave_out" or len(others):
                st.button(label, key=key, on_click=action, args=(choices,))


def _ask_anew(choices: Choices, waiting: Unconfirmed) -> None:
    """Ask whether to record what waited and contradicts nothing any more."""
    n, source = len(waiting.results), recorded_batches.source(waiting.source)
    st.warning(texts.CONTRADICTING_NO_MORE.format(n=n, source=source))
    with st.container(horizontal=True):
        st.button(texts.RECORD_THESE.format(n=n), key="record_these", on_click=_record_these,
                  args=(choices,))  # fmt: skip
        st.button(texts.RECORD_NONE, key="record_none", on_click=_drop, args=(choices,))


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
    """Record what does not contradict."""
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    against = choices.open_season.contradictions(waiting.results).which
    return _settled(choices, _but(against, len(waiting.results)))


def _but(against: np.ndarray, n: int) -> np.ndarray:
    """Return the numbers of so many results but for those that contradict."""
    return np.setdiff1d(np.arange(n), against)


def _settled(choices: Choices, which: np.ndarray | slice) -> str:
    waiting = unconfirmed.of(choices.key, choices.day)
    if waiting is None:
        return ""
    taken = waiting.results.take(which)
    done = choices.open_season.record(taken, waiting.source, waiting.who, confirmed=True)
    return _end_waiting(choices, waiting, done)


def _end_waiting(choices: Choices, waiting: Unconfirmed, done: Recorded) -> str:
    """Let nothing wait any more; return what was done."""
    unconfirmed.drop()
    if waiting.form:
        FreshBoxes(waiting.form, choices).empty()
    return _said_at_last(choices, waiting, done)


def _said_at_last(choices: Choices, waiting: Unconfirmed, done: Recorded | None) -> str:
    """Return what was done with results that waited, and what was said of their file."""
    if done is None:
        return ""
    _warn_of_lost(waiting.messages)
    return said_of(choices, done, waiting.results) + _listed(
        message.sentence for message in waiting.messages
    )


def _drop(choices: Choices) -> None:  # noqa: ARG001 - as the others
    unconfirmed.drop()


# -- what was recorded


def show_batches(choices: Choices) -> None:
    """Show what was recorded, if anything was, the last one first, each with its undo."""
    kept = [batch for batch in choices.open_season.batches() if batch.rows]
    if not kept:
        return
    shown = kept[: _MOST + _more_shown(choices)]
    contents = choices.open_season.contents([batch.number for batch in shown])
    with st.expander(texts.BATCHES, expanded=True):
        for batch in shown:
            _show_batch(choices, batch, contents.get(batch.number))
        if more := len(kept) - len(shown):
            st.button(texts.BATCHES_MORE.format(n=min(more, _MOST)), key="batches_more",
                      on_click=_show_more, args=(choices,))  # fmt: skip


def _more_shown(choices: Choices) -> int:
    """Return how many batches are shown beside the last ones."""
    key, more = st.session_state.get(_SHOWN, ("", 0))
    return more if key == choices.key else 0


def _show_more(choices: Choices) -> None:
    st.session_state[_SHOWN] = choices.key, _more_shown(choices) + _MOST


def _show_batch(choices: Choices, batch: Batch, contents: BatchContents | None) -> None:
    said = recorded_batches.line(choices, batch, contents)
    why = recorded_batches.why_to_ask(choices, batch, contents)
    n, asked = batch.number, _undo_asked(choices) == batch.number and not batch.undone
    # side by side, not in columns: a button takes what its word needs in each language
    with st.container(horizontal=True, vertical_alignment="center", key=f"batch_{n}"):
        st.markdown(said, width="stretch")
        if batch.undone:
            st.button(texts.REDO, key=f"redo {n}", on_click=redo, help=said, args=(choices, n))
        elif not asked:
            act = _ask_undo if why else undo
            st.button(texts.UNDO, key=f"undo {n}", on_click=act, help=said, args=(choices, n))
    if asked:
        st.warning(" ".join([texts.UNDO_ASK, *why]))
        with st.container(horizontal=True, key=f"undo_asked_{n}"):
            st.button(texts.UNDO_YES, key=f"undo_yes {n}", on_click=undo, args=(choices, n))
            st.button(texts.UNDO_NO, key=f"undo_no {n}", on_click=_ask_no_undo)


def _undo_asked(choices: Choices) -> int | None:
    """Return the batch of which it is asked whether it is to be undone."""
    key, batch = st.session_state.get(_UNDO_ASKED, ("", None))
    return batch if key == choices.key else None


def _ask_undo(choices: Choices, batch: int) -> None:
    st.session_state[_UNDO_ASKED] = choices.key, batch


def _ask_no_undo() -> None:
    st.session_state.pop(_UNDO_ASKED, None)


@notices.reporting
def undo(choices: Choices, batch: int, who: str = "") -> str:
    """Take a batch back, unless somebody did so in another window; `who` does, for the log."""
    _ask_no_undo()
    if batch not in {one.number for one in choices.open_season.batches() if not one.undone}:
        raise SettingError(texts.UNDONE_BEFORE)
    return recorded_batches.undone(choices.open_season.undo(batch, who=who))


@notices.reporting
def redo(choices: Choices, batch: int) -> str:
    """Let a batch that was undone count again, unless somebody did so in another window."""
    if batch not in {one.number for one in choices.open_season.batches() if one.undone}:
        raise SettingError(texts.REDONE_BEFORE)
    return recorded_batches.undone(choices.open_season.redo(batch))
