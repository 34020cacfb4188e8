"""What a session brought: files, and what was answered about them. Other sessions never see it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import streamlit as st

from fieldmon.errors import ChoiceNeeded, FieldmonError
from fieldmon.io.options import Upload
from fieldmon.io.rasters.values import RasterOptions

from . import cached, texts

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fieldmon.io.import_report import Imported, ImportMessage
    from fieldmon.io.options import Source
    from fieldmon.plot.plot import Plot

S = TypeVar("S")
T = TypeVar("T")
PLOT, RECORDS, PLANTS = "plot", "record", "plant"
_ICONS = {"seen": "👁", "repaired": "🔧", "guessed": "💡", "dropped": "🗑", "doubtful": "⚠️"}


@dataclass(frozen=True, eq=False)
class File:
    """A file to read: what stands for it in keys, and where it is or its bytes."""

    key: str
    source: Path | Upload | tuple[Upload, ...]


@dataclass(frozen=True, eq=False)
class Heard:
    """A finding of an import, and the file it is about."""

    key: str
    finding: ImportMessage


def brought() -> dict[str, File]:
    """Return the files of this session by what they are."""
    files: dict[str, File] = st.session_state.setdefault("brought", {})
    return files


def bring() -> None:
    """Show the boxes for files; what was dropped is kept while the session lasts."""
    labels = {PLOT: texts.PLOT_FILE, RECORDS: texts.RECORD_FILE, PLANTS: texts.PLANT_FILE}
    columns = st.columns(3)
    for column, (kind, label) in zip(columns, labels.items(), strict=True):
        with column:
            dropped = st.file_uploader(label, key=f"{kind}_file", accept_multiple_files=True,
                                       on_change=_take, args=(kind,))  # fmt: skip
            kept = brought().get(kind)
            if kept is not None and not dropped:
                st.caption(texts.KEPT_FILE.format(name=texts.isolated(_name(kept))))
                st.button(texts.FORGET_FILE, key=f"forget {kind}", on_click=_forget, args=(kind,))


def _take(kind: str) -> None:
    parts = st.session_state.get(f"{kind}_file") or []
    if not parts:
        brought().pop(kind, None)
        return
    uploads = tuple(Upload(part.name, part.getvalue()) for part in parts)
    key = cached.digest(b"".join(u.name.encode() + b"\0" + u.data for u in uploads))
    brought()[kind] = File(key, uploads[0] if len(uploads) == 1 else uploads)


def bring_one(label: str, kept_as: str) -> None:
    """Show a box for a single file, which the session keeps under a name."""
    st.file_uploader(label, key=f"{kept_as}_file", on_change=_take_one, args=(kept_as,))


def kept_one(kept_as: str) -> None:
    """Show which file is kept under a name and what is wrong with it; take it out on demand."""
    kept: File | None = st.session_state.get(kept_as)
    if kept is None:
        return
    st.caption(texts.KEPT_FILE.format(name=texts.isolated(kept.source.name)))
    st.button(texts.FORGET_FILE, key=f"forget {kept_as}", on_click=_forget_one, args=(kept_as,))
    problem = st.session_state.get(f"{kept_as} problem")
    if problem is not None:
        st.session_state["asking"] = kept.key
        say(problem)


def read_kept(
    kept_as: str,
    key: str,
    settings: Callable[[], S],
    read: Callable[[str, RasterOptions, S, Source, Plot], Imported[T]],
    plot: Plot,
) -> tuple[T | None, tuple[Heard, ...], str]:
    """Return what the raster kept under a name says of a plot, its findings, and the longer key.

    None if there is none. One that cannot be used is left out; `kept_one` says why.
    """
    file: File | None = st.session_state.get(kept_as)
    if file is None:
        return None, (), key
    st.session_state[f"{kept_as} problem"] = None
    try:
        how, options = settings(), settled(file, RasterOptions())
        longer = f"{key} {kept_as} {file.key} {how} {options}"
        imported = read(longer, options, how, file.source, plot)
    except FieldmonError as error:
        st.session_state[f"{kept_as} problem"] = error
        return None, (), key
    heard = tuple(Heard(file.key, finding) for finding in imported.messages)
    return imported.value, heard, longer


def _forget_one(kept_as: str) -> None:
    st.session_state.pop(kept_as, None)


def _take_one(kept_as: str) -> None:
    part = st.session_state.get(f"{kept_as}_file")
    if part is not None:
        data = part.getvalue()
        st.session_state[kept_as] = File(cached.digest(data), Upload(part.name, data))


def _forget(kind: str) -> None:
    brought().pop(kind, None)


def _name(file: File) -> str:
    first = file.source[0] if isinstance(file.source, tuple) else file.source
    return first.name


def settled(file: File, options: Any) -> Any:  # noqa: ANN401 - any of three options
    """Return the options with what was answered for this file before."""
    for option, value in _answers(file.key):
        options = options.choose(option, value)
    st.session_state["asking"] = file.key
    return options


def _answers(key: str) -> tuple[tuple[str, str], ...]:
    answers: tuple[tuple[str, str], ...] = st.session_state.get(f"answers {key}", ())
    return answers


def _answer(key: str, option: str, value: str) -> None:
    if value:
        st.session_state[f"answers {key}"] = (*_answers(key), (option, value))


def _take_back(key: str) -> None:
    st.session_state[f"answers {key}"] = _answers(key)[:-1]


def _answer_from(key: str, option: str, widget: str) -> None:
    _answer(key, option, st.session_state.get(widget) or "")


def say(error: FieldmonError) -> None:
    """Show a problem as its sentence; where the file leaves a choice, ask for it by buttons."""
    asking = st.session_state.get("asking", "")
    if not isinstance(error, ChoiceNeeded):
        st.error(str(error))
        undo_answer(asking)
        return
    st.warning(str(error))
    label = f"{texts.CHOOSE}: {error.option}"
    widget = f"ask {asking} {error.option}"
    if error.choices and error.option != "columns":
        st.markdown(texts.CHOOSE_QUICK)
        with st.container(horizontal=True):
            for choice in error.choices[:4]:
                st.button(str(choice), key=f"pick {asking} {choice}", on_click=_answer,
                          args=(asking, error.option, str(choice)))  # fmt: skip
        st.selectbox(label, error.choices, key=widget, accept_new_options=True)
    else:
        hint = ", ".join(error.choices)
        st.text_input(label, placeholder="date=Datum", help=hint or None, key=widget)
    st.button(texts.CHOOSE_BUTTON, key=f"use {asking} {error.option}", type="primary",
              on_click=_answer_from, args=(asking, error.option, widget))  # fmt: skip
    undo_answer(asking)


def undo_answer(key: str) -> None:
    """Offer to take the last answer about a file back, if there is one."""
    if key and _answers(key):
        option, value = _answers(key)[-1]
        st.button(texts.UNDO_ANSWER.format(option=option, value=value), key=f"back {key}",
                  icon=":material/undo:", on_click=_take_back, args=(key,))  # fmt: skip


def show_findings(heard: tuple[Heard, ...]) -> None:
    """Show what imports had to say, each remedy as a button."""
    if not heard:
        st.markdown(texts.FINDINGS_NONE)
    for number, one in enumerate(sorted(heard, key=lambda h: -h.finding.severity.rank)):
        finding = one.finding
        place = f"{texts.isolated(finding.feature)}: " if finding.feature else ""
        mark = f"{_ICONS[finding.severity]} **{texts.SEVERITIES[finding.severity]}**"
        st.markdown(f"{mark} · {place}{finding.sentence}")
        remedy = finding.remedy
        if remedy is not None:
            st.button(remedy.label, key=f"remedy {number} {one.key} {remedy.option} {remedy.value}",
                      on_click=_answer, args=(one.key, remedy.option, remedy.value))  # fmt: skip
    for key in dict.fromkeys(one.key for one in heard):
        undo_answer(key)
