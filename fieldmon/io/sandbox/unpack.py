"""From a path, an upload, a folder or an archive to its data sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.signatures import READABLE, FileKind, kind_of, workbook_kind
from fieldmon.io.options import Source, source_name
from fieldmon.io.sandbox.archives import expand
from fieldmon.io.sandbox.file_entries import FILES_BESIDE, TASK_FILE, Member, entries_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.io.sandbox.file_entries import FileEntry
    from fieldmon.io.sandbox.workroom import Workroom

# files of which it is said why they cannot be read
_NAMED = 10


def members(source: Source, workroom: Workroom) -> tuple[Member, ...]:
    """Return the data sets that a source holds; raise `FileProblem` where there is none."""
    found, problems = _sorted_out(source, workroom)
    if found:
        return tuple(found)
    if problems and (len(problems) == 1 or is_of_several(source)):
        raise of_all(problems)
    raise FileProblem(
        worded(
            "{source_name} must hold {readable}, but nothing of the kind is "
            "in it. Choose another file.",
            source_name=source_name(source),
            readable=READABLE,
        )
    )


def is_of_several(source: Source) -> bool:
    """Return whether several files were brought at once."""
    return isinstance(source, tuple) and len(source) > 1


def unread(source: Source, workroom: Workroom) -> list[FileProblem]:
    """Return why files that were brought with others cannot be read, by their first bytes."""
    return _sorted_out(source, workroom)[1] if is_of_several(source) else []


def of_all(problems: Sequence[FileProblem]) -> FileProblem:
    """Return one problem of several files, which says what is wrong with each."""
    if len(problems) == 1:
        return problems[0]
    said = [problem.args[0] for problem in problems[:_NAMED]]
    if (more := len(problems) - _NAMED) > 0:
        said.append(worded("{n} more {n:file|files} cannot be read.", n=more))
    return FileProblem(joined(" ", said))


def _sorted_out(source: Source, workroom: Workroom) -> tuple[list[Member], list[FileProblem]]:
    """Return the data sets of a source, and why other files of it cannot be read."""
    if not is_of_several(source):
        return _group(list(expand(entries_of(source), workroom, depth=0)))
    entries: list[FileEntry] = []
    damaged: list[FileProblem] = []
    for entry in entries_of(source):
        try:
            entries += expand([entry], workroom, depth=0)
        except FileProblem as problem:
            damaged.append(problem)
    found, problems = _group(entries)
    return found, [*damaged, *problems]


def choose_member(found: tuple[Member, ...], wanted: str | None, name: str) -> Member:
    """Return the one member, or the named one; raise `ChoiceNeeded` where several could be."""
    if wanted is not None:
        fitting = [m for m in found if m.name == wanted] or [
            m for m in found if m.name.lower().endswith(wanted.lower())
        ]
        if len(fitting) == 1:
            return fitting[0]
    elif len(found) == 1:
        return found[0]
    names = tuple(m.name for m in found)
    missing = "" if wanted is None else f", but none alone is called {wanted!r}"
    raise ChoiceNeeded(
        worded(
            "{name} holds {n} files that can be read{missing}. Choose one of: {names}.",
            name=name,
            n=len(found),
            missing=missing,
            names=", ".join(names[:20]),
        ),
        "member",
        names,
    )


def _group(entries: list[FileEntry]) -> tuple[list[Member], list[FileProblem]]:
    """Put together what belongs together; keep the reasons why the rest cannot be read."""
    found = _geodatabases(entries)
    taken = {entry.name for member in found for entry in member.entries}
    rest = [entry for entry in entries if entry.name not in taken]
    by_place: dict[tuple[str, str], dict[str, FileEntry]] = {}
    for entry in rest:
        place = (str(entry.path.parent), entry.path.stem.lower())
        by_place.setdefault(place, {})[entry.path.suffix.lower()] = entry
    problems = []
    for entry in rest:
        beside = by_place[str(entry.path.parent), entry.path.stem.lower()]
        if any(entry.path.suffix.lower() in FILES_BESIDE.get(main, ()) for main in beside):
            continue
        try:
            kind = kind_of(entry.head(), entry.name)
        except FileProblem as problem:
            problems.append(problem)
            continue
        if kind is FileKind.ARCHIVE:
            kind = workbook_kind(entry.head())
        belongings = [beside[part] for part in FILES_BESIDE.get(kind.value, ()) if part in beside]
        if kind is FileKind.ISOXML:
            belongings = [
                other
                for other in rest
                if other.path.parent == entry.path.parent and TASK_FILE.fullmatch(other.path.name)
            ]
        found.append(Member(entry.name, kind, (entry, *belongings)))
    return found, problems


def _geodatabases(entries: list[FileEntry]) -> list[Member]:
    folders: dict[str, list[FileEntry]] = {}
    for entry in entries:
        if entry.path.parent.suffix.lower() == ".gdb":
            folders.setdefault(str(entry.path.parent), []).append(entry)
    return [
        Member(name, FileKind.GEODATABASE, tuple(files))
        for name, files in folders.items()
        if any(f.path.suffix.lower() == ".gdbtable" for f in files)
    ]
