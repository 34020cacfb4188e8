"""A file that is a copy of a season, merged into it, or tried on a copy of it first."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import Worded, worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import FileProblem
from fieldmon.io.options import Upload
from fieldmon.monitoring.changes import outside_changes
from fieldmon.monitoring.changes.transactions import copy_season
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.merging.other_seasons import is_copy
from fieldmon.monitoring.season.season_file import Season

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.monitoring.merging.merge import Merged


class ChangedElsewhere(FileProblem):
    """A copy of the season that cannot be merged, as another program changed what stands in it."""


class MergedFile(NamedTuple):
    """What came of a file that was merged.

    Parameters
    ----------
    merged
        What came of merging.
    entered
        Who was where before entry was allowed, as is known since: one copy may know who, the other
        why.
    """

    merged: Merged
    entered: tuple[str, ...]


def merge_file(season: Season, source: Path | Upload) -> MergedFile:
    """Merge a copy of a season into it; the file itself stays as it is, one of old, too.

    Raise `FileProblem` if it is no copy of this season, `ChangedElsewhere` if another program
    changed it: what was changed there can be recorded as corrections.
    """
    early = _entered_early(season)
    with _opened(source) as there:
        try:
            merged = season.merge(there)
        except FileProblem as problem:
            if _is_changed(there) and is_copy(season, there.path):
                raise ChangedElsewhere(*problem.args) from problem
            raise
    return MergedFile(merged, tuple(one for one in _entered_early(season) if one not in early))


def merge_ahead(season: Season, source: Path | Upload) -> MergedFile:
    """Return what merging a file would bring; the season stays as it is.

    It is merged into a copy of the season: nothing is said that merging would not do.
    """
    with working_folder() as folder:
        copy = Path(folder) / season.path.name
        copy_season(season.path, copy)
        return merge_file(Season(copy), source)


@contextmanager
def _opened(source: Path | Upload) -> Iterator[Season]:
    """Give a copy of a season's file; what is wrong with that is said of the file itself."""
    with working_folder() as folder:
        if isinstance(source, Upload):
            copy = _written(source, Path(folder))
        else:
            copy = Path(folder) / source.name
            copy_season(source, copy)
        try:  # one of an earlier version is brought up to date in the copy
            season = Season(copy)
        except FileProblem as problem:
            named = source.name if isinstance(source, Upload) else str(source)
            raise FileProblem(_said_of(problem.args[0], str(copy), named)) from problem
        yield season


def _written(upload: Upload, folder: Path) -> Path:
    """Write an upload into a folder, by another name where no file here can have its own."""
    try:
        copy = folder / Path(upload.name).name
        copy.write_bytes(upload.data)
    except (OSError, ValueError):
        copy = folder / "copy.gpkg"
        copy.write_bytes(upload.data)
    return copy


def _is_changed(season: Season) -> bool:
    with season.store.reading() as db:
        return bool(outside_changes.waiting(db))


def _said_of(sentence: str, path: str, named: str) -> str:
    """Return a sentence that names a file by another name."""
    if not isinstance(sentence, Worded) or sentence.parts:
        return str(sentence).replace(path, named)
    values = {
        name: named if str(value) == path else value for name, value in sentence.values.items()
    }
    return worded(sentence.words, **values)


def _entered_early(season: Season) -> list[str]:
    """Return who was where before entry was allowed."""
    beware = season.cautions(last_date(season))
    return [one.sentence for one in beware if one.kind == "entered"]
