"""`fieldmon record`: what was found. Heavy imports wait."""

from __future__ import annotations

import shlex
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import FLAGS, Terminal, tell_drafts, tell_found_again
from fieldmon.cli.named_values import chosen
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.season_files import season_of
from fieldmon.cli.status import lines
from fieldmon.cli.times import day
from fieldmon.compute.wording import first_few
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import ChoiceNeeded, ContradictionError, ObservationError, SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    import numpy as np

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.season.inspection_import import BroughtFile

FindingFiles = Annotated[
    list[Path],
    typer.Argument(
        help="Inspections: CSV, Excel, GeoJSON, GPX, GeoPackage... with plants or positions; "
        "the route file given out, filled in; or what a phone saved as not sent."
    ),
]
TakeDoubtful = Annotated[
    bool,
    typer.Option(
        "--take-doubtful",
        help="Also record doubtful results: positions assigned to the nearest plant, days to come.",
    ),
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
        typer.Option("--date", help="Day of inspections whose file names no day, YYYY-MM-DD."),
    ] = None
    who: Annotated[
        str,
        typer.Option(
            help="Who inspected, whatever the files say; in a copy of the season, who corrected."
        ),
    ] = ""
    take_doubtful: TakeDoubtful = False
    finding_option: FindingChoices = None
    contradicting: Contradicting = False


@with_options
def record(season: SeasonFile, files: FindingFiles, flags: RecordFlags) -> None:
    """Record what was found; recording the same inspections twice changes nothing.

    What contradicts results recorded of the same plants and day (clean against found) is listed,
    and nothing is recorded, unless --contradicting is given.

    Plants that are not in the files stay unknown. Write gone as the result of one that is dead or
    pulled out. Positions are snapped to the nearest plant;
    doubtful ones are listed and left out, unless --take-doubtful is given.

    Example: fieldmon record season.gpkg route.csv --date 2026-04-06 --who Ann
    """
    from fieldmon.io.sandbox import process
    from fieldmon.monitoring.estimates.last_days import last_date

    process.warm("fieldmon.io.sandbox.tasks")  # it loads while the season is read
    import numpy as np

    from fieldmon.io.readers.inspection_options import InspectionOptions

    kept = season_of(season)
    work_day = None if flags.on is None else np.datetime64(day(flags.on), "D")
    options = InspectionOptions(work_day=work_day, take_doubtful=flags.take_doubtful)
    options = chosen(options, flags.finding_option).on(kept.plot.field)
    tell_drafts(kept.drafts)
    with working_folder() as folder:
        read = _read(kept, files, options, Path(folder), confirmed=flags.contradicting)
        if work_day is not None:
            _tell_other_days(read, work_day)
        last = _record(kept, [one for one in read if one.saved is None], flags, len(read))
    saved = [(one.name, one.saved) for one in read if one.saved is not None]
    for name, one in saved:
        _take_saved(kept, name, one, flags.who)
    on = last_date(kept) if saved else last
    if on is not None:
        with kept.store.one_moment():
            typer.echo("\n".join(lines(kept, kept.status(on))))
            tell_found_again(kept, on)


def _read(
    season: Season, files: list[Path], options: InspectionOptions, folder: Path, *, confirmed: bool
) -> list[BroughtFile]:
    """Return what is in files, all of them before any is recorded: nothing is left half-done."""
    from fieldmon.io.readers.other_plots import left_out
    from fieldmon.monitoring.season.inspection_import import read_brought

    read = []
    for k, file in enumerate(files):
        (own := folder / str(k)).mkdir()
        with Terminal().answering(), _naming(file):
            read.append(read_brought(season, file, options, own))
    if not confirmed:
        _refuse_changed(season, files, read)
    for one in read:
        for message in one.messages:
            typer.echo(f"{one.name}: {message.line(FLAGS['findings'])}", err=True)
    for one in read:
        why = left_out(one.messages)
        if why and not len(one.findings) and not one.corrections:
            raise SettingError(
                f"{one.name} must hold records of {season.plot.field.name}, but none could be "
                f"taken, and nothing was recorded. {why} Leave the file away, or say that they "
                f"are of this plot: {FLAGS['findings']} columns=plot="
            )
    return read


def _leaves_out(brought: BroughtFile) -> bool:
    """Return whether a file has results that were not taken."""
    return any(one.severity.is_loss for one in brought.messages)


def _tell_other_days(read: list[BroughtFile], told: np.datetime64) -> None:
    """Say of which files the day of --date is not, as they name their own.

    Raise `SettingError` where it is of no result: whoever gave it takes them for that day's.
    """
    dated = [one for one in read if len(one.findings)]
    others = [one for one in dated if not (one.findings.date == told).any()]
    named = [
        f"{one.name} names the days of its results: "
        f"{first_few(sorted({str(day) for day in one.findings.date}))}"
        for one in others
    ]
    if dated and len(others) == len(dated):
        raise SettingError(
            f"--date must be the day of results whose file names none, but {'; '.join(named)}, and "
            f"none is of {told}. Nothing was recorded. Leave --date away if that is right. If they "
            f"are of {told}, and these days are those of the plan, write {told} into a column date."
        )
    for said in named:
        typer.echo(f"seen: {said}; --date {told} is not of them.", err=True)
    for one in read:
        if one.saved is not None:
            typer.echo(f"seen: {one.name} names its days; --date {told} is not of them.", err=True)


def _refuse_changed(season: Season, files: list[Path], read: list[BroughtFile]) -> None:
    """Refuse inspections of the season itself that were changed: no file says what is meant."""
    for file, one in zip(files, read, strict=True):
        if one.changed:
            n, s = one.changed, "" if one.changed == 1 else "s"
            raise ContradictionError(
                f"What is recorded must be new, but {n} inspection{s} in {one.name} "
                f"{'was' if n == 1 else 'were'} exported from {season.path.name} and changed, and "
                "nothing was recorded. Take what was changed as corrections with: fieldmon correct "
                f"{shlex.quote(str(season.path))} {shlex.quote(str(file))} --who NAME. Where "
                "plants were inspected again, both hold with: --contradicting"
            )


def _record(
    season: Season, read: list[BroughtFile], flags: RecordFlags, n_files: int
) -> date | None:
    """Record what files say, all of it or nothing; return the last day of it.

    Raise `SettingError` where none of `n_files` gave anything: others are what phones saved.
    """
    if not read:
        return None
    # in a copy of this season, who is named corrected
    found = [
        one.findings if one.is_copy else _of(flags.who, one.findings, one.name) for one in read
    ]
    named = [(inspections, one.name) for inspections, one in zip(found, read, strict=True)]
    copies = [one.copy if one.corrections else None for one in read]
    try:
        every = season.record_all(named, flags.who, confirmed=flags.contradicting, copies=copies)
    except ContradictionError as error:
        raise ContradictionError(f"{error} Confirm with: --contradicting") from None
    for one, done in zip(read, every, strict=True):
        if one.corrections:
            n = done.corrected
            typer.echo(f"{one.name}: {n} correction{'' if n == 1 else 's'} taken, by {flags.who}")
        batch = "" if done.batch is None else f" (batch {done.batch})"
        more = f", {done.more}" if done.more else ""
        typer.echo(f"{one.name}: {done.new} new, {done.known} known already{more}{batch}")
    took = any(one.new + one.known + one.corrected for one in every)
    # a sheet that nobody filled in lacks nothing
    if len(read) == n_files and not took and any(_leaves_out(one) for one in read):
        names = " or ".join(one.name for one in read)
        raise SettingError(
            f"At least one result must be taken, but all in {names} were left out: see above. "
            "Nothing was recorded."
        )
    days = [inspections.date.max().item() for inspections in found if len(inspections)]
    return max(days, default=None)


def _take_saved(season: Season, name: str, saved: PhoneFile, who: str) -> None:
    """Record what a phone saved, as what it sends."""
    from fieldmon.monitoring.season.inspection_import import record_saved

    done, said = record_saved(season, _saved_of(who, season, saved, name), who)
    typer.echo(f"{name}: {done.new} new, {done.known} known already")
    for sentence in said:
        typer.echo(f"{name}: {sentence}", err=True)


def _of(who: str, read: Inspections, file: str) -> Inspections:
    """Return the inspections of a file as those of somebody, and say whose they were by it."""
    import numpy as np

    from fieldmon.compute.wording import counted
    from fieldmon.monitoring.settings.shift_work import made_by

    if not (who := who.strip()):
        return read
    others = len(read) - len(made_by(read, who)) - len(made_by(read, ""))
    if others:
        names = sorted({str(name) for name in read.who} - {"", who})
        _tell_others(file, names, counted(others, "inspection"), who)
    return replace(read, who=np.full(len(read), who, object))


def _saved_of(who: str, season: Season, saved: PhoneFile, file: str) -> PhoneFile:
    """Return what a phone saved as that of somebody, and say whose it was by it."""
    from fieldmon.compute.wording import counted

    if not (who := who.strip()):
        return saved
    here = saved.of(season.path.stem)
    others = [one.who for one in (*here.findings, *here.photos) if one.who not in {"", who}]
    if others:
        _tell_others(file, sorted({*others}), counted(len(others), "record"), who)
    return saved.by(who)


def _tell_others(file: str, names: list[str], what: str, who: str) -> None:
    typer.echo(
        f"{file}: seen: By the file {', '.join(names)} made {what}; taken as those of {who}, "
        "as --who says.",
        err=True,
    )


@contextmanager
def _naming(file: Path) -> Iterator[None]:
    """Say with a question which of several files asks it, and of which one dates are none."""
    try:
        yield
    except ObservationError as refused:
        raise ObservationError(f"{file.name}: {refused}") from None
    except ChoiceNeeded as asked:
        said = f"{file.name}: {asked}"
        raise ChoiceNeeded(said, asked.option, asked.choices, "findings") from None
