"""Seasons given to commands: which options go with them, and each once. Heavy imports wait."""

from __future__ import annotations

import csv
import json
import shlex
import sqlite3
from contextlib import ExitStack, closing, contextmanager
from contextvars import ContextVar
from itertools import combinations
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.messages import tell_not_come
from fieldmon.cli.times import day_on
from fieldmon.compute.wording import first_few
from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem, SettingError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence
    from datetime import date
    from pathlib import Path

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring import Season
    from fieldmon.planning.members import TeamMember

# what the command that runs holds until it ends; None: none runs
_HELD: ContextVar[ExitStack | None] = ContextVar("held", default=None)
# formats of routes that are read whole to see whether results are in them
_READ_WHOLE = frozenset({".gpx", ".kml", ".zip"})
# questions about words in a result column: somebody wrote them
_OF_RESULTS = frozenset({"found", "clean", "gone"})
# inspections of a day that has not come, of which the numbers are shown
_NUMBERS_SHOWN = 5


@contextmanager
def until_the_end() -> Iterator[None]:
    """Hold what a command opens until this block ends."""
    with ExitStack() as held:
        before = _HELD.set(held)
        try:
            yield
        finally:
            _HELD.reset(before)


def season_of(file: Path) -> Season:
    """Open a season; until the command ends its file is not opened again for each thing read."""
    from fieldmon.monitoring import Season, kept_open

    if (held := _HELD.get()) is not None:
        held.enter_context(kept_open())
    return Season(file)


def opened(files: Iterable[Path]) -> list[Season]:
    """Open the seasons that go into one table or report.

    Raise `SettingError` where two are copies of one: what both hold would stand there twice. Say
    where two seasons are of one plot.
    """
    from fieldmon.monitoring.merging.other_seasons import is_copy, of_one_plot

    seasons = [season_of(file) for file in files]
    for one, other in combinations(seasons, 2):
        if is_copy(one, other.path):
            raise SettingError(
                f"Each season must be given once, but {one.path} and {other.path} are the same or "
                f"copies of one: what both hold would stand there twice. {_instead(one, other)}"
            )
    for said in of_one_plot(seasons):
        typer.echo(f"seen: {said}", err=True)
    return seasons


def _instead(one: Season, other: Season) -> str:
    """Return what to do with two copies of a season of which each is to count once."""
    from fieldmon.monitoring.merging.other_seasons import is_of_another_pest

    if is_of_another_pest(one, other.path):
        return (
            "They look for different pests by now: leave one away, or undo in one of them what was "
            "recorded before it was copied."
        )
    pasted = shlex.join([str(one.path), str(other.path)])
    return f"Leave one away, or bring them together first: fieldmon merge {pasted}"


def default_date(season: Season, told: date | None, flag: str = "--date") -> date:
    """Return the day that was told, else the last one up to today; say where later ones are kept.

    `flag` names the option that tells it. A later day that was recorded is doubted in any case.
    """
    from fieldmon.monitoring.estimates import last_days

    last, today = last_days.last_date(season), day_on(season.plot.field, None)
    if (recorded := last_days.recorded_ahead(season)) is not None:
        _tell_recorded_ahead(season, recorded)
    if told is not None:
        return told
    meant, was = last_days.default_date(season), "recorded" if last == recorded else "planned"
    if last <= max(today, season.settings.begins):
        return meant
    typer.echo(
        f"seen: {last} was {was} already, and it is {today} on the plot: this is of {meant}. "
        f"For another day give {flag} YYYY-MM-DD.",
        err=True,
    )
    return meant


def _tell_recorded_ahead(season: Season, recorded: date) -> None:
    """Print that the last day recorded has not come, and how to mend one of its inspections."""
    field, what = season.plot.field, "the last day recorded"
    if not (numbers := [one.number for one in season.numbered(recorded)]):
        tell_not_come(recorded, field, what)
        return
    path, one = str(season.path), ["--inspection", str(numbers[0])]
    dated = shlex.join(["fieldmon", "correct", path, "--who", "NAME", *one, "--date"])
    dated = f"with: {dated} YYYY-MM-DD"
    undone = shlex.join(["fieldmon", "undo", path, *one])
    todo = f"correct inspection {numbers[0]} {dated}, or take it back with: {undone}"
    if len(numbers) > 1:
        shown = ", ".join(map(str, numbers[:_NUMBERS_SHOWN]))
        more = "" if len(numbers) <= _NUMBERS_SHOWN else ", ..."
        todo = (
            f"correct each of its {len(numbers):,} inspections ({shown}{more}) {dated}, or take "
            f"each back with: {undone}, or the last recording with: fieldmon undo {path}"
        )
    tell_not_come(recorded, field, what, todo)


def learnt_of_each(season: Season, on: date) -> Iterator[tuple[str, str, str]]:
    """Yield whose inspections find how much by what was told, and as the season learnt.

    Of a team they are those who were told alike; empty: all who inspect on a day.
    """
    from fieldmon.compute.wording import chance_figure

    settings = season.planned_by(on)
    names: dict[float, list[str]] = {}
    for member in settings.team:
        names.setdefault(member.robot.detects, []).append(member.name)
    for detects, whose in (names or {settings.robot.detects: []}).items():
        by = f" by {', '.join(whose)}" * (len(names) > 1)
        for one in season.learnt(on, detects):
            if one.name == "detection":
                yield by, str(chance_figure(detects)), str(chance_figure(one.value))


def refuse_too_wide(season: Season, team: Iterable[TeamMember]) -> None:
    """Raise `SettingError` where one of a season's team can drive nowhere, with who and what to do.

    Seasons refuse such a robot from version 0.2 on; one of before may have it.
    """
    from fieldmon.planning import members

    try:
        members.refuse_too_wide(team, season.plot)
    except SettingError as error:
        pasted = shlex.join(["fieldmon", "change", str(season.path), "--robots"])
        raise SettingError(f"{error} Give the team anew with: {pasted} TEAM.csv") from error


def is_told(context: typer.Context, name: str) -> bool:
    """Return whether a parameter of a command was given to it."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def refuse_what_was_chosen(context: typer.Context, takes: Collection[str]) -> None:
    """Raise `SettingError` where an option was given that a season has kept since it began.

    `takes` names the parameters of a command that do go with a season.
    """
    told = {name for name in context.params if is_told(context, name)}
    if more := sorted(told.difference(takes)):
        flags = ", ".join(f"--{name.replace('_', '-')}" for name in more)
        raise SettingError(
            f"A season keeps what was chosen when it began, but {flags} was given too. "
            "Leave it away, or choose otherwise for the days to come with: fieldmon change"
        )


def refuse_unrecorded(season: Season | None, files: Iterable[Path]) -> None:
    """Raise `SettingError` where a file to be written over was filled in and never recorded.

    Every command asks this of files that it writes, if `fieldmon record` reads such. Without a
    season nothing is recorded.
    """
    from fieldmon.monitoring.inspecting.known_inspections import count_never_recorded

    filled_in = [file for file in files if file.is_file() and _is_filled_in(file)]
    if season is None:
        if not filled_in:
            return
        some = first_few([str(file) for file in filled_in])
        were = "were" if len(filled_in) > 1 else "was"
        raise SettingError(
            f"{some} would be written over, but {were} filled in, and only a season records "
            "results. Choose another name or folder, or move away what was filled in."
        )
    for file in filled_in:
        said, left_out = _results_in(file, season)
        if n := count_never_recorded(season, said):
            pasted = shlex.join([str(season.path), str(file)])
            results = "1 result" if n == 1 else f"{n} results"
            raise SettingError(
                f"{file} would be written over, but it was filled in and holds {results} that "
                f"nobody recorded. Record them first: fieldmon record {pasted}; or choose another "
                "name, or move it away."
            )
        if left_out:
            raise SettingError(
                f"{file} would be written over, but it was filled in for another plot. {left_out} "
                "Choose another name, or move it away."
            )
        if not len(said):
            raise SettingError(
                f"{file} would be written over, but it was filled in, though no result could be "
                "read in it. Look at what is written there, and record it; or choose another "
                "name, or move it away."
            )


def refuse_unrecorded_in_any(seasons: Sequence[Season], files: Collection[Path]) -> None:
    """Do `refuse_unrecorded` where a table is of several seasons: one may hold all of a file."""
    for file in files:
        refused = []
        for season in seasons:
            try:
                refuse_unrecorded(season, [file])
            except SettingError as error:
                refused.append(error)
        if len(refused) == len(seasons) > 0:
            raise refused[0]


def _is_filled_in(file: Path) -> bool:
    """Return whether a file given out may hold results, in any format that is recorded."""
    ending = file.suffix.lower()
    if ending == ".csv":
        text = file.read_text(encoding="utf-8-sig", errors="replace")
        mark = max(",;\t", key=text.partition("\n")[0].count)
        rows = csv.DictReader(text.splitlines(), delimiter=mark)
        # a table of days has finds, too
        of_plants = bool({"row", "plant", "lon"} & {*(rows.fieldnames or ())})
        return of_plants and any(
            (row.get("found") or "").strip() or (row.get("count") or "") for row in rows
        )
    if ending in {".geojson", ".json"}:
        return _is_geojson_filled_in(file)
    if ending in _READ_WHOLE:
        return _holds_results(file)
    if ending != ".gpkg":
        return False
    wanted = "SELECT 1 FROM stops WHERE found IS NOT NULL OR count IS NOT NULL"
    try:
        with closing(sqlite3.connect(file)) as db:
            return db.execute(wanted).fetchone() is not None
    except sqlite3.Error:
        return False


def _is_geojson_filled_in(file: Path) -> bool:
    try:
        stops = json.loads(file.read_bytes())["features"]
        told = [stop["properties"].get(name) for stop in stops for name in ("found", "count")]
    except (ValueError, LookupError, TypeError, AttributeError):
        return False
    return any(one is not None and one != "" for one in told)


def _holds_results(file: Path) -> bool:
    """Return whether a file holds results as it is recorded, or asks what its words mean."""
    from fieldmon.io.read import read_inspection_rows
    from fieldmon.io.readers.inspection_options import InspectionOptions

    try:
        return len(read_inspection_rows(file, InspectionOptions()).value.result) > 0
    except ChoiceNeeded as asked:
        return asked.option in _OF_RESULTS
    except FieldmonError:  # no file of results
        return False


def _results_in(file: Path, season: Season) -> tuple[Inspections, str]:
    """Return what a file says of this season's plants, as it is recorded; nothing of other files.

    Beside it why records of other plots are none of this season; empty where there are none.
    Raise `SettingError` if it was torn: what it says nobody could record.
    """
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.readers.other_plots import left_out
    from fieldmon.monitoring.season.inspection_import import read_findings

    try:
        read = read_findings(season, file)
    except FileProblem as torn:
        raise SettingError(
            f"{file} would be written over, but it was filled in and cannot be read. {torn} Then "
            "record it; or choose another name, or move it away."
        ) from torn
    except FieldmonError:
        return Inspections.none(), ""
    return read.value, left_out(read.messages)
