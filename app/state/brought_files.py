"""What a session brought: files, and what was answered about them. Other sessions never see it."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import streamlit as st

from fieldmon.compute.digest import digest
from fieldmon.io.options import ReadOptions, Upload

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from streamlit.runtime.uploaded_file_manager import UploadedFile

    from fieldmon.errors import FieldmonError
    from fieldmon.io.import_report import Imported, ImportMessage

PLOT, RECORDS, PLANTS, FINDINGS = "plot", "record", "plant", "findings"
ROWS, BLOCKS = "rows", "blocks"
#: what a plot that was drawn here is called as a file
DRAWN = "drawn.geojson"
_BROUGHT, _ASKING = "brought", "asking"


@dataclass(frozen=True, eq=False)
class File:
    """A file to read: what stands for it in keys, where it is or its bytes, and what it is for."""

    key: str
    source: Path | Upload | tuple[Upload, ...]
    kind: str = ""

    @property
    def asked(self) -> str:
        """Return what stands for it in answers: the same file may be plot and records."""
        return f"{self.kind} {self.key}"

    @property
    def name(self) -> str:
        """Return its name; that of the first one, where several make one file."""
        return self.names[0]

    @property
    def names(self) -> list[str]:
        """Return the names of all that make it up."""
        parts = self.source if isinstance(self.source, tuple) else (self.source,)
        return [part.name for part in parts]

    @property
    def is_drawn(self) -> bool:
        """Return whether it is the file of a plot that was drawn here, whose name is a column."""
        own = self.source
        named = b'"properties": {"name": '
        return isinstance(own, Upload) and own.name == DRAWN and named in own.data

    @property
    def files(self) -> int:
        """Return how many files make it up."""
        return len(self.source) if isinstance(self.source, tuple) else 1


@dataclass(frozen=True, eq=False)
class FileMessage:
    """What an import has to say, and the file it is about, as it stands in answers."""

    asked: str
    message: ImportMessage


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A file that could not be used for a plot, and why."""

    file: File
    problem: FieldmonError


def messages_of(file: File, imported: Imported[Any]) -> tuple[FileMessage, ...]:
    """Return what an import had to say about a file."""
    return tuple(FileMessage(file.asked, message) for message in imported.messages)


# -- the files


def brought() -> dict[str, File]:
    """Return the files of this session by what they are: a plot, records, plants, rasters."""
    files: dict[str, File] = st.session_state.setdefault(_BROUGHT, {})
    return files


def keep(kind: str, parts: Iterable[UploadedFile]) -> None:
    """Keep what was dropped into a box, the parts of one file; nothing: take it out."""
    keep_uploads(kind, tuple(Upload(part.name, part.getvalue()) for part in parts))


def keep_uploads(kind: str, uploads: tuple[Upload, ...]) -> None:
    """Keep a file of these parts; none: take it out."""
    if not uploads:
        take_out(kind)
        return
    brought()[kind] = file_of(kind, uploads)


def file_of(kind: str, uploads: tuple[Upload, ...]) -> File:
    """Return the file of these parts, at least one."""
    key = digest(b"".join(u.name.encode() + b"\0" + u.data for u in uploads))
    return File(key, uploads[0] if len(uploads) == 1 else uploads, kind)


def take_out(kind: str) -> None:
    """Forget a file; its box is empty then, too: what is dropped next is no part of it."""
    brought().pop(kind, None)
    st.session_state[_emptied(kind)] = st.session_state.get(_emptied(kind), 0) + 1


def take_as_plants(asked: str) -> None:
    """Take the plot's file as measured plants, with what was answered about how to read it."""
    file = brought()[PLOT]
    take_out(PLOT)
    take_out(PLANTS)
    brought()[PLANTS] = plants = replace(file, kind=PLANTS)
    known = {option.name for option in fields(ReadOptions)}
    said = tuple(one for one in answers(asked) if one[0] in known)
    st.session_state[f"answers {plants.asked}"] = said


def box(kind: str) -> str:
    """Return the key of a box for files: an empty one, once its file was taken out."""
    emptied = st.session_state.get(_emptied(kind), 0)
    return f"{kind}_file {emptied}" if emptied else f"{kind}_file"


def _emptied(kind: str) -> str:
    """Return the key of how often a box was emptied."""
    return f"emptied {kind}_file"


# -- what was answered about them


def settled(file: File, options: Any) -> Any:  # noqa: ANN401 - any of four kinds of options
    """Return the options with what was answered for this file before; it is the one asked about."""
    ask_about(file.asked)
    return answered(file, options)


def answered(file: File, options: Any) -> Any:  # noqa: ANN401 - any of five kinds of options
    """Return the options with what was answered for this file before."""
    for option, value in answers(file.asked):
        options = options.choose(option, value)
    return options


def ask_about(asked: str) -> None:
    """Let whatever is asked next be about this file."""
    st.session_state[_ASKING] = asked


def asking() -> str:
    """Return the file that is asked about, as it stands in answers; empty: none."""
    key: str = st.session_state.get(_ASKING, "")
    return key


def answers(asked: str) -> tuple[tuple[str, str], ...]:
    """Return what was answered about a file, in order: option and value."""
    said: tuple[tuple[str, str], ...] = st.session_state.get(f"answers {asked}", ())
    return said


def answer(asked: str, option: str, value: str) -> None:
    """Add an answer about a file; an empty one is none."""
    if value:
        st.session_state[f"answers {asked}"] = (*answers(asked), (option, value))


def drop_answer(asked: str) -> None:
    """Drop the last answer about a file."""
    st.session_state[f"answers {asked}"] = answers(asked)[:-1]
