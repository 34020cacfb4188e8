"""Recording what was found: one plant, the stops of the route, or a file."""

from __future__ import annotations

import zlib
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import streamlit as st

from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FieldmonError, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.options import Upload
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring.changes.transactions import MAGIC
from fieldmon.monitoring.season.inspection_import import read_brought, record_saved
from fieldmon.plot.grid import plant_at, plant_numbers
from fieldmon.plot.named_rows import plant_meant

from ..show import day, plant_history
from ..show.recorded_batches import GONE
from ..state import brought_files, chosen_day, fresh_boxes, kept_files, notices, unconfirmed
from ..state.fresh_boxes import FreshBoxes
from ..words import language, texts
from . import acting, bringing_files, choosing, contradicting, correcting, merging, treating
from .recording_results import as_kept, listed, recorded, said_of, warn_of_lost

if TYPE_CHECKING:
    from fieldmon.monitoring.season.inspection_import import BroughtFile

    from ..state.choices import Choices

_SAID_OF_FILE = "said of a file of findings"
# who inspected where nobody said so; another than those of the team: no name is a new line
_NOBODY, _ANOTHER = "", "\n"
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
    contradicting.ask_about_contradictions(choices)
    one, route, file, treat = st.tabs(
        [texts.RECORD_ONE, texts.RECORD_ROUTE, texts.RECORD_UPLOAD, texts.TREAT],
        key=f"record_tabs {language.current()}", on_change="rerun",
    )  # fmt: skip
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
    counted = np.array([np.nan if count is None else float(count)])
    result, note = as_kept(result)
    results = Inspections.of(
        np.array([plant]), np.array([result]), np.datetime64(choices.day),
        count=counted, notes=np.array([note], object),
    )  # fmt: skip
    done = recorded(choices, results, TYPED_IN, _ONE, who=_signed(FreshBoxes(_ONE, choices)))
    return said_of(choices, done, results)


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
    if brought is None:
        merging.show_last(choices)
    else:
        _ask_who(boxes, texts.INSPECTED_BY_HELP)
        merges = merging.show(choices, boxes, brought)
        if brought.getvalue().startswith(MAGIC):
            st.text_input(texts.CORRECTED_BY, key=key("corrected_by"),
                          help=texts.CORRECTED_BY_HELP)  # fmt: skip
        acting.at_press(texts.RECORD_BUTTON, _record_file, choices, key="record_file",
                        boxes=boxes, type="secondary" if merges else "primary")  # fmt: skip
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
    name, data, who = brought.name, brought.getvalue(), _signed(boxes)
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
    warn_of_lost(read.messages)
    if read.saved is None:
        # what was said of a file may be answered: it stays to be read again
        form = "" if messages else _FILE
        done = recorded(choices, read.findings, name, form, read.messages, who)
        said = said_of(choices, done, read.findings)
    else:
        done, more = record_saved(season, read.saved, who)
        said, messages = said_of(choices, done), [*messages, *more]
        if more:
            notices.warn()
        if not messages:
            boxes.empty()
    said = said + listed(messages) if said else ""
    return "\n\n".join(part for part in (corrected, said) if part)


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
    team = boxes.choices.team_that_day
    if not team:
        return
    named = {_NOBODY: texts.NOBODY_SAID, _ANOTHER: texts.INSPECTED_BY_ANOTHER}
    said = boxes.said("who") or _NOBODY
    others = [said] if said not in {*named, *team} else []  # of a team before
    # a list that takes new names loses one that is left without Enter
    who = boxes.show(
        st.selectbox, texts.INSPECTED_BY, [_NOBODY, *team, *others, _ANOTHER], box="who",
        stays=stays, default=_NOBODY, help=help_, format_func=lambda who: named.get(who, who),
    )  # fmt: skip
    if who == _ANOTHER:
        boxes.show(st.text_input, texts.INSPECTED_BY_NAME, box="who_else", stays=stays, default="")


def _signed(boxes: FreshBoxes) -> str:
    """Return who is said to have inspected; empty: nobody is."""
    who = boxes.said("who") or _NOBODY
    if who != _ANOTHER:
        return str(who).strip()
    named = str(boxes.said("who_else") or "").strip()
    if not named:
        raise SettingError(texts.INSPECTED_BY_UNSAID)
    return named
