"""What a session brought, said of it, typed and did not use or record yet, or wants, is kept here.

A reload finds it again.
The way back is a long random word in the address. Whoever has it sees the files; who does not
cannot guess it. Who came by it changes nothing for others who did: the first change is kept under
a word of one's own. What nobody came back to for a day is removed.
"""

from __future__ import annotations

import getpass
import json
import os
import re
import secrets
import shutil
import stat
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import streamlit as st

from fieldmon.io.atomic_write import write_whole
from fieldmon.io.options import Upload

from . import (
    brought_files,
    fresh_boxes,
    plot_edits,
    strategy_boxes,
    told_team,
    unconfirmed,
    widget_memory,
    wishes,
)
from .brought_files import File

#: the word in the address that leads back to the files
KEY = "files"
KEEP_S = 86_400.0
_WORD = re.compile(r"[\w-]{22}")
# what is made in the folder: of sessions, and maps in tiles (`written`)
_MADE = re.compile(rf"{_WORD.pattern}|ground-.+")
_SESSION, _CAME_BY, _SAVED = "files key", "files came by", "files saved"
_MANIFEST = "files.json"
# what was said and is not used or recorded yet
_UNUSED: dict[str, Any] = {
    "unfinished": fresh_boxes, "wishes": wishes, "strategy": strategy_boxes, "team": told_team,
    "waiting": unconfirmed,
}  # fmt: skip
#: boxes that say how files are read and plants are laid
_BOXES = frozenset(
    {"row_bearing", "row_spacing", "plant_spacing", "headland", "both_faces", "feature"}
    | {"ground_shows", "missing_below", "risk_meaning", "risk_share", "risk_low", "background_pct"}
)


def sync() -> None:
    """Take what an earlier session kept, once; then keep what this one has."""
    if _SESSION not in st.session_state:
        st.session_state[_SESSION] = ""
        _restore(st.query_params.get(KEY) or "")
    _keep()
    _keep_in_address()


def folder() -> Path:
    """Return the folder of all sessions' files, which nobody else on this machine can read.

    Its name can be known in advance: where somebody else put something there, it is another.
    """
    parent = Path(tempfile.gettempdir())
    path = parent / f"fieldmon-files-{getpass.getuser()}"
    with suppress(FileExistsError):
        path.mkdir(mode=0o700)
    if _is_ours(path):
        return path
    others = (other for other in parent.iterdir() if other.name.startswith(f"{path.name}-"))
    own = next(filter(_is_ours, others), None)
    return own or Path(tempfile.mkdtemp(prefix=f"{path.name}-"))


def clean(now: float) -> None:
    """Remove what was kept here and nobody came back to for a day."""
    for kept in folder().iterdir():
        with suppress(OSError):
            if _MADE.fullmatch(kept.name) and now - kept.lstat().st_mtime > KEEP_S:
                shutil.rmtree(kept)


def written(name: str, file: str, data: bytes) -> Path:
    """Return where some bytes lie as a file of this person's own; they are written once."""
    here = folder() / name
    here.mkdir(mode=0o700, exist_ok=True)
    os.utime(here)
    if not (here / file).exists():
        write_whole(here / file, data)
    return here / file


def _restore(word: str) -> None:
    """Take the files that this word leads to, and what was said of them."""
    if not _WORD.fullmatch(word) or not _can_keep():
        return
    here = folder() / word
    try:
        said = json.loads((here / _MANIFEST).read_text(encoding="utf-8"))
        files = {kind: _file(here, kind, *one) for kind, one in said["files"].items()}
        edits = {
            key: tuple(plot_edits.Edit(kind, tuple(map(tuple, at))) for kind, at in drawn)
            for key, drawn in said["edits"].items()
        }
    except (OSError, ValueError, KeyError, TypeError):
        return  # gone, or half of it is: the boxes are empty, as they would be
    brought_files.brought().update(files)
    for key, answers in said["answers"].items():
        st.session_state[key] = tuple(map(tuple, answers))
    st.session_state.update(edits)
    for key, value in said["boxes"].items():
        widget_memory.first(key, value)
    for of, kept in _UNUSED.items():
        kept.take(said.get(of, {}))
    st.session_state[_CAME_BY], st.session_state[_SAVED] = word, _said(brought_files.brought())
    os.utime(here)


def _file(here: Path, kind: str, key: str, names: list[str]) -> File:
    parts = [
        Upload(name, (here / f"{key}-{number}").read_bytes()) for number, name in enumerate(names)
    ]
    return File(key, parts[0] if len(parts) == 1 else tuple(parts), kind)


def _keep() -> None:
    """Write what changed since it was written last; nothing to keep: remove it."""
    files = brought_files.brought()
    said = _said(files)
    if st.session_state.get(_SAVED) == said or not _can_keep():
        return
    word, came_by = st.session_state[_SESSION], st.session_state.pop(_CAME_BY, "")
    if not files and not any(said[of] for of in _UNUSED):
        if word:
            shutil.rmtree(folder() / word, ignore_errors=True)
        st.session_state[_SESSION], st.session_state[_SAVED] = "", said
        return
    clean(time.time())
    word = word or secrets.token_urlsafe(16)
    here = folder() / word
    if came_by:
        with suppress(OSError):  # what cannot be linked is written
            shutil.copytree(folder() / came_by, here, copy_function=os.link)
    here.mkdir(mode=0o700, exist_ok=True)
    wanted = {_MANIFEST}
    for file in files.values():
        for number, part in enumerate(_parts(file)):
            wanted.add(f"{file.key}-{number}")
            if not (here / f"{file.key}-{number}").exists():
                write_whole(here / f"{file.key}-{number}", part.data)
    write_whole(here / _MANIFEST, json.dumps(said).encode())
    for old in here.iterdir():
        if old.name not in wanted:
            old.unlink(missing_ok=True)
    st.session_state[_SESSION], st.session_state[_SAVED] = word, said


def _said(files: dict[str, File]) -> dict[str, Any]:
    """Return what is kept beside the files' bytes, as it is written."""
    keys = [str(key) for key in st.session_state]
    answers = {key: st.session_state[key] for key in keys if key.startswith("answers ")}
    edits = {
        key: [(edit.kind, edit.lonlat) for edit in st.session_state[key]]
        for key in keys
        if key.startswith("edits ")
    }
    named = {k: (file.key, [part.name for part in _parts(file)]) for k, file in files.items()}
    boxes = widget_memory.values_of(_BOXES)
    unused = {of: kept.said() for of, kept in _UNUSED.items()}
    return {"files": named, "answers": answers, "edits": edits, "boxes": boxes, **unused}


def _parts(file: File) -> tuple[Upload, ...]:
    source = file.source
    return source if isinstance(source, tuple) else (source,)  # type: ignore[return-value]


def _is_ours(path: Path) -> bool:
    """Return whether a folder is this person's own: in another's, files could be read or forged."""
    try:
        found = path.lstat()
    except OSError:
        return False
    if not stat.S_ISDIR(found.st_mode):  # also a link: it may lead to a folder of ours
        return False
    return not hasattr(os, "getuid") or (found.st_uid == os.getuid() and not found.st_mode & 0o077)


def _can_keep() -> bool:
    try:
        folder()
    except OSError:
        return False
    return True


def _keep_in_address() -> None:
    word = st.session_state[_SESSION] or st.session_state.get(_CAME_BY)
    if not word:
        st.query_params.pop(KEY, None)
    elif st.query_params.get(KEY) != word:
        st.query_params[KEY] = word
