"""`fieldmon record`: what was found. Heavy imports wait."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import FLAGS, Terminal, tell_drafts
from fieldmon.cli.named_values import chosen
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.status import lines
from fieldmon.cli.times import day
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import ChoiceNeeded, ContradictionError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.monitoring import Season

FindingFiles = Annotated[
    list[Path],
    typer.Argument(
        help="Findings: CSV, Excel, GeoJSON, GPX, GeoPackage... with plants or positions; "
        "the route file given out, filled in; or what a phone saved as not sent."
    ),
]
TakeDoubtful = Annotated[
    bool, typer.Option("--take-doubtful", help="Assign doubtful positions to the nearest plant.")
]
Contradicting = Annotated[
    bool,
    typer.Option(
        "--contradicting",
        help="Also record results that contradict those of the same plants and day.",
    ),
]
FindingChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--finding-option",
        help="What the files do not say, as NAME=VALUE: zone=Asia/Jerusalem, accuracy_m=3, "
        "columns=count=Milben, found=WORD,WORD, clean=WORD.",
    ),
]


@dataclass(frozen=True)
class RecordFlags:
    """How `fieldmon record` takes what files say."""

    on: Annotated[
        str | None,
        typer.Option("--date", help="Day of findings whose file names no day, YYYY-MM-DD."),
    ] = None
    who: Annotated[
        str, typer.Option(help="Who inspected, whatever the files say; in a copy, who corrected.")
    ] = ""
    take_doubtful: TakeDoubtful = False
    finding_option: FindingChoices = None
    contradicting: Contradicting = False


@with_options
def record(season: SeasonFile, files: FindingFiles, flags: RecordFlags) -> None:
    """Record what was found; recording the same findings twice changes nothing.

    What contradicts results recorded of the same plants and day (clean against found) is listed,
    and nothing is recorded, unless --contradicting is given.

    Plants that are not in the files stay unknown. Positions are snapped to the nearest plant;
    doubtful ones are listed and left out, unless --take-doubtful is given.

    Example: fieldmon record season.gpkg route.csv --date 2026-04-06 --who Ann
    """
    from fieldmon.io.sandbox import process

    process.warm("fieldmon.io.sandbox.tasks")  # it loads while the season is read
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import is_phone_file
    from fieldmon.monitoring import Season

    kept = Season(season)
    saved = [file for file in files if is_phone_file(file)]
    files = [file for file in files if file not in saved]
    options = InspectionOptions(take_doubtful=flags.take_doubtful)
    if flags.on is not None:
        options = options.choose("day", str(day(flags.on)))
    options = chosen(options, flags.finding_option).on(kept.plot.field)
    tell_drafts(kept.drafts)
    told = [(file, _read_saved(file)) for file in saved]
    with working_folder() as folder:
        copies = _copies(files, Path(folder))
        last, read = None, _read(kept, files, options, copies)
        if not flags.contradicting:
            _refuse_contradictions(kept, read)
        _take_corrections(kept, copies, flags.who)
    read = [
        one if file in copies else _of(flags.who, one, file)
        for one, file in zip(read, files, strict=True)
    ]
    named = [(one, file.name) for one, file in zip(read, files, strict=True)]
    with _naming_confirmation():  # somebody may have recorded since
        every = kept.record_all(named, flags.who, confirmed=flags.contradicting)
    for file, inspections, done in zip(files, read, every, strict=True):
        if len(inspections):
            last = max(last or inspections.date.max(), inspections.date.max())
        batch = "" if done.batch is None else f" (batch {done.batch})"
        typer.echo(f"{file.name}: {done.new} new, {done.known} known already{batch}")
    for file, one in told:
        _take_saved(kept, file, one, flags.who)
    on = kept.last_date() if told else None if last is None else last.item()
    if on is not None:
        with kept.one_moment():
            typer.echo("\n".join(lines(kept, kept.status(on))))


def _read_saved(file: Path) -> PhoneFile:
    """Return what a phone saved, and say what of it cannot be read."""
    from fieldmon.io.read import read_phone_file

    read = read_phone_file(file)
    for message in read.messages:
        typer.echo(f"{file.name}: {message.line(FLAGS['findings'])}", err=True)
    return read.value


def _take_saved(season: Season, file: Path, saved: PhoneFile, who: str) -> None:
    """Record what a phone saved, as what it sends."""
    from fieldmon.monitoring.findings import of_others, take_saved

    taken = take_saved(season, _saved_of(who, season, saved, file))
    new, known = (
        sum(one.new is is_new and not one.problem for one in taken) for is_new in (True, False)
    )
    typer.echo(f"{file.name}: {new} new, {known} known already")
    for said in (*of_others(season, saved), *sorted({one.problem for one in taken} - {""})):
        typer.echo(f"{file.name}: {said}", err=True)


def _of(who: str, read: Inspections, file: Path) -> Inspections:
    """Return the inspections of a file as those of somebody, and say whose they were by it."""
    import numpy as np

    from fieldmon.compute.wording import counted
    from fieldmon.monitoring.history import made_by

    if not (who := who.strip()):
        return read
    others = len(read) - len(made_by(read, who)) - len(made_by(read, ""))
    if others:
        names = sorted({str(name) for name in read.who} - {"", who})
        _tell_others(file, names, counted(others, "inspection"), who)
    return replace(read, who=np.full(len(read), who, object))


def _saved_of(who: str, season: Season, saved: PhoneFile, file: Path) -> PhoneFile:
    """Return what a phone saved as that of somebody, and say whose it was by it."""
    from fieldmon.compute.wording import counted

    if not (who := who.strip()):
        return saved
    here = saved.of(season.path.stem)
    others = [one.who for one in (*here.findings, *here.photos) if one.who not in {"", who}]
    if others:
        _tell_others(file, sorted({*others}), counted(len(others), "record"), who)
    return saved.by(who)


def _tell_others(file: Path, names: list[str], what: str, who: str) -> None:
    typer.echo(
        f"{file.name}: seen: By the file {', '.join(names)} made {what}; taken as those of {who}, "
        "as --who says.",
        err=True,
    )


def _refuse_contradictions(season: Season, read: list[Inspections]) -> None:
    """Refuse files that contradict the season, or one another, before any is recorded."""
    from fieldmon.monitoring.recorded_before import contradictions

    every = read[0] if read else None
    for inspections in read[1:]:
        every = inspections if every is None else every.and_those(inspections)
    if every is not None:
        with _naming_confirmation():
            contradictions(every, season.history.inspections).refuse(season.label)


@contextmanager
def _naming_confirmation() -> Iterator[None]:
    """Say of contradictions how they are confirmed here."""
    try:
        yield
    except ContradictionError as error:
        raise ContradictionError(f"{error} Confirm with: --contradicting") from None


def _copies(files: list[Path], folder: Path) -> dict[Path, Path]:
    """Return copies to read of the files that are seasons."""
    from fieldmon.monitoring.transactions import copy_season, is_season

    copies = {}
    for k, file in enumerate(files):
        if is_season(file):
            (folder / str(k)).mkdir()
            copies[file] = folder / str(k) / file.name
            copy_season(file, copies[file])
    return copies


def _take_corrections(season: Season, copies: dict[Path, Path], who: str) -> None:
    """Take what QGIS or QField corrected and deleted in copies of this season."""
    for file, copy in copies.items():
        if season.corrections_in(copy):
            n = season.take_corrections(copy, file.name, who)
            typer.echo(f"{file.name}: {n} correction{'' if n == 1 else 's'} taken, by {who}")


def _read(
    season: Season, files: list[Path], options: InspectionOptions, copies: dict[Path, Path]
) -> list[Inspections]:
    """Return what is in files, all of them before any is recorded: nothing is left half-done."""
    from fieldmon.io.readers.inspections import dated, read_inspections
    from fieldmon.monitoring import counting_copy

    with working_folder() as folder:
        sources = dict(zip(files, files, strict=True))
        for k, (file, copy) in enumerate(copies.items()):
            (Path(folder) / str(k)).mkdir()
            # what was corrected there is no new finding
            corrected = [one.row for one in season.corrections_in(copy)]
            sources[file] = counting_copy(copy, Path(folder) / str(k), corrected)
        read = []
        for file in files:
            with Terminal().answering(), _naming(file):
                read.append(dated(read_inspections(sources[file], season.plot.grid, options)))
    for file, found in zip(files, read, strict=True):
        for message in found.messages:
            typer.echo(f"{file.name}: {message.line(FLAGS['findings'])}", err=True)
    return [found.value for found in read]


@contextmanager
def _naming(file: Path) -> Iterator[None]:
    """Say with a question which of several files asks it."""
    try:
        yield
    except ChoiceNeeded as asked:
        said = f"{file.name}: {asked}"
        raise ChoiceNeeded(said, asked.option, asked.choices, "findings") from None
