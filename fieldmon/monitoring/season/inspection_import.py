"""A file of findings brought to a season: what it says, and what is asked about it."""

from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.import_report import doubtful
from fieldmon.io.options import Upload, source_name
from fieldmon.monitoring.changes.transactions import MAGIC, copy_season, is_season
from fieldmon.monitoring.file.connections import connect
from fieldmon.monitoring.inspecting import repeated_recordings
from fieldmon.monitoring.inspecting.batches import Recorded
from fieldmon.monitoring.merging.other_seasons import brought_season, own_names, take_all
from fieldmon.monitoring.phones import findings
from fieldmon.monitoring.season.exported_inspections import edits_in, own_rows, read_exported
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.import_report import Imported, ImportMessage
    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.merging.other_seasons import BroughtSeason


@dataclass(frozen=True, eq=False)
class BroughtFile:
    """A file of findings as it was read; nothing of it is recorded yet.

    `Season.record_all` takes corrections and then findings, and refuses what contradicts the season
    unless that is confirmed.

    Parameters
    ----------
    name
        The file's.
    findings
        What is to be recorded; what a copy of the season says anew.
    messages
        What the import has to say.
    saved
        What a phone saved, instead of findings; `record_saved` takes it.
    copy
        A copy of the file to read where it is a season, else None.
    is_copy
        Whether that is a copy of this season.
    corrections
        How many inspections another program corrected or deleted in that copy. Who did is asked.
    changed
        How many inspections exported from the season say otherwise of their plant and day, or not
        for sure of which: whether as corrections, or made again, no file says. See
        `exported_inspections`.
    """

    name: str
    findings: Inspections
    messages: tuple[ImportMessage, ...] = ()
    saved: PhoneFile | None = None
    copy: Path | None = None
    is_copy: bool = False
    corrections: int = 0
    changed: int = 0


def counting_copy(season: Path, folder: Path, besides: Iterable[int] = ()) -> Path:
    """Return a copy of a season with only the inspections that were not undone there.

    Each says all that was said beside it. Rows `besides` them are left out too.
    """
    copy = folder / season.name
    copy_season(season, copy)
    with closing(connect(copy)) as db:
        db.execute("BEGIN")
        repeated_recordings.write_out(db)
        db.execute("DELETE FROM inspections WHERE undone <> 0")
        db.executemany("DELETE FROM inspections WHERE fid = ?", [(row,) for row in besides])
        db.execute("COMMIT")
    return copy


def read_brought(
    season: Season, source: Source, options: InspectionOptions, folder: Path
) -> BroughtFile:
    """Read a file brought to a season: a table, positions, a copy of it, or what a phone saved.

    Inspections without a date are left out where others have one: they get the `work_day` of the
    options only where the whole file names none. So are those of before the season's first day,
    where others are of it, and those of days that have not come, unless the season has not begun
    either or they are taken (`take_doubtful`). Of a copy, what was corrected there is no new
    finding.

    Parameters
    ----------
    season
        The season.
    source
        The file.
    options
        How it is read.
    folder
        An empty one, for copies; it is needed until the file is recorded.

    Raises
    ------
    FileProblem
        If it is a season that looks for another pest, or a copy of this one in which inspections
        were corrected, among others.
    """
    # what reads files is half a second to import
    from fieldmon.io.read import read_inspection_rows, read_phone_file  # noqa: PLC0415
    from fieldmon.io.readers.phone_file import is_phone_file  # noqa: PLC0415

    name = source_name(source)
    if is_phone_file(source):
        saved = read_phone_file(source)
        return BroughtFile(name, Inspections.none(), saved.messages, saved=saved.value)
    copy = season_copied(source, folder)
    if copy is not None:
        held = brought_season(season, copy, name)
        corrected = [one.row for one in held.corrections]
        (folder / "new").mkdir()
        rows = read_inspection_rows(counting_copy(copy, folder / "new", corrected), options)
        read = _dated_on_plot(season, rows, options)
        messages = (*read.messages, *_about_copy(season, held, name))
        return BroughtFile(
            name, read.value, messages, None, copy, held.is_copy, corrections=len(corrected)
        )
    rows = read_exported(season, source, options)
    read, n_changed = _dated_on_plot(season, rows, options), 0
    if rows.value.exported.any():
        here, _ = own_rows(season, rows.value, options)
        edits = edits_in(season, here, options)
        n_changed = sum(one.is_seen_otherwise for one in edits.changed) + len(edits.unsure)
    messages = (*read.messages, *_about_changed(n_changed))
    return BroughtFile(name, read.value, messages, changed=n_changed)


def _about_changed(n: int) -> list[ImportMessage]:
    """Return a doubt about so many inspections of the season itself that were changed."""
    if not n:
        return []
    said = worded(
        "{n} {n:inspection was|inspections were} exported from this season and changed: recorded, "
        "{n:it counts|they count} beside what stands there. As corrections {n:it comes|they come} "
        "with: fieldmon correct",
        n=n,
    )
    return [doubtful(said)]


def read_findings(
    season: Season, source: Source, options: InspectionOptions | None = None
) -> Imported[Inspections]:
    """Return what a file says of a season's plants; what names another plot is left out.

    Dates, and what is raised, as in `read_brought` and `read_inspections`.
    """
    from fieldmon.io.read import read_inspection_rows  # noqa: PLC0415 - as above
    from fieldmon.io.readers.inspection_options import InspectionOptions  # noqa: PLC0415

    options = options or InspectionOptions()
    return _dated_on_plot(season, read_inspection_rows(source, options), options)


def _dated_on_plot(
    season: Season, rows: Imported[InspectionRows], options: InspectionOptions
) -> Imported[Inspections]:
    from fieldmon.io.readers.date_doubts import come, since  # noqa: PLC0415 - as above
    from fieldmon.io.readers.inspections import dated, on_plot  # noqa: PLC0415 - as above

    begins, today = season.settings.begins, local_clock(season.plot.field).today()
    read = since(dated(on_plot(rows, season.plot.grid, options, own_names(season))), begins)
    # before a season begins it is a rehearsal
    return read if begins > today else come(read, options, today)


def _about_copy(season: Season, held: BroughtSeason, name: str) -> list[ImportMessage]:
    """Return doubts about what of another season is not taken: only its findings are asked for."""
    about = _about_treatments(season, held, name)
    if n := held.taken_back:
        said = worded(
            "{n} {n:inspection was|inspections were} taken back in that copy, and {n:counts|count} "
            "on here. {remedy}",
            n=n,
            remedy=take_all(season, name),
        )
        about.append(doubtful(said))
    return about


def _about_treatments(season: Season, held: BroughtSeason, name: str) -> list[ImportMessage]:
    if not held.treatments:
        return []
    named = [
        worded(
            "{product} on {day}",
            product=product or worded("a product that nobody named"),
            day=day,
        )
        for product, day in held.treatments
    ]
    told = {"n": len(named), "some": first_few(named)}
    if held.is_copy:
        said = worded(
            "{n} {n:treatment|treatments} of that copy {n:is|are} not taken ({some}), nor "
            "{n:its|their} waiting periods. {remedy}",
            remedy=take_all(season, name),
            **told,
        )
    else:
        said = worded(
            "{n} {n:treatment|treatments} of that season {n:is|are} not taken ({some}), nor "
            "{n:its|their} waiting periods. Record {n:it|them} here, too.",
            **told,
        )
    return [doubtful(said)]


def season_copied(source: Source, folder: Path) -> Path | None:
    """Return a copy of a source that is a season, in a folder; None: it is none."""
    if isinstance(source, Upload):
        if not source.data.startswith(MAGIC):
            return None
        copy = folder / "copy.gpkg"
        copy.write_bytes(source.data)
        return copy if is_season(copy) else None
    if not isinstance(source, str | Path) or not is_season(source):
        return None
    copy = folder / Path(source).name
    copy_season(Path(source), copy)
    return copy


def record_saved(
    season: Season, saved: PhoneFile, who: str = ""
) -> tuple[Recorded, tuple[str, ...]]:
    """Record what a phone saved, as what it sends; return what that did, and what there is to say.

    `who` and what is raised as in `take_saved`.
    """
    taken = findings.take_saved(season, saved, who)
    good = [one.new for one in taken if not one.problem]
    said = *findings.of_others(season, saved), *sorted({one.problem for one in taken} - {""})
    return Recorded(None, sum(good), len(good) - sum(good)), said
