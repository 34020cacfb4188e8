"""`fieldmon record`: what was found. Heavy imports wait."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import FLAGS, Terminal
from fieldmon.cli.named_values import chosen
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.status import lines
from fieldmon.cli.times import day
from fieldmon.errors import ChoiceNeeded

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.monitoring import Season

FindingFiles = Annotated[
    list[Path],
    typer.Argument(
        help="Findings: CSV, Excel, GeoJSON, GPX, GeoPackage... with plants or positions; "
        "or the route file given out, filled in."
    ),
]
TakeDoubtful = Annotated[
    bool, typer.Option("--take-doubtful", help="Take doubtful positions at the nearest plant.")
]
Contradicting = Annotated[
    bool,
    typer.Option(
        "--contradicting",
        help="Record results too that contradict what is recorded of the same plants and day.",
    ),
]
FindingChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--finding-option",
        help="What the files leave open, as NAME=VALUE: zone=Asia/Jerusalem, accuracy_m=3, "
        "columns=count=Milben, found=WORD,WORD, clean=WORD.",
    ),
]


@dataclass(frozen=True)
class RecordFlags:
    """How `fieldmon record` takes what files say."""

    on: Annotated[
        str | None,
        typer.Option("--date", help="Day of findings whose file names none, YYYY-MM-DD."),
    ] = None
    who: Annotated[str, typer.Option(help="Who inspected.")] = ""
    take_doubtful: TakeDoubtful = False
    finding_option: FindingChoices = None
    contradicting: Contradicting = False


@with_options
def record(season: SeasonFile, files: FindingFiles, flags: RecordFlags) -> None:
    """Record what was found; the same findings twice change nothing.

    What contradicts results recorded of the same plants and day (clean against found) is listed,
    and nothing is recorded, unless --contradicting is given.

    Plants that are not in the files stay unknown. Positions are snapped to the nearest plant;
    doubtful ones are listed and left out, unless --take-doubtful is given.

    Example: fieldmon record season.gpkg route.csv --date 2026-04-06 --who Ann
    """
    from fieldmon.io.readers.inspection_options import InspectionOptions  # noqa: PLC0415
    from fieldmon.monitoring import Season  # noqa: PLC0415

    kept = Season(season)
    options = InspectionOptions(take_doubtful=flags.take_doubtful)
    if flags.on is not None:
        options = options.choose("day", str(day(flags.on)))
    options = chosen(options, flags.finding_option).on(kept.plot.field)
    last, read = None, _read(kept, files, options)
    if not flags.contradicting:
        _refuse_contradictions(kept, read)
    for file, inspections in zip(files, read, strict=True):
        done = kept.record(inspections, file.name, flags.who, confirmed=True)
        if len(inspections):
            last = max(last or inspections.date.max(), inspections.date.max())
        batch = "" if done.batch is None else f" (batch {done.batch})"
        typer.echo(f"{file.name}: {done.new} new, {done.known} known already{batch}")
    if last is not None:
        typer.echo("\n".join(lines(kept, kept.status(last.item()))))


def _refuse_contradictions(season: Season, read: list[Inspections]) -> None:
    """Refuse files that contradict the season, or one another, before any is recorded."""
    from fieldmon.monitoring.recorded_before import contradictions  # noqa: PLC0415

    held = season.history.inspections
    for inspections in read:
        contradictions(inspections, held).refuse(season.label)
        held = held.and_those(inspections)


def _read(season: Season, files: list[Path], options: InspectionOptions) -> list[Inspections]:
    """Return what is in files, all of them before any is recorded: nothing is left half-done."""
    from fieldmon.io.readers.inspections import read_inspections  # noqa: PLC0415
    from fieldmon.monitoring import counting_copy  # noqa: PLC0415
    from fieldmon.monitoring.transactions import is_season  # noqa: PLC0415

    with tempfile.TemporaryDirectory(prefix="fieldmon-") as folder:
        sources = [counting_copy(f, Path(folder)) if is_season(f) else f for f in files]
        read = []
        for file, source in zip(files, sources, strict=True):
            with Terminal().answering(), _naming(file):
                read.append(read_inspections(source, season.plot.grid, options))
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
