"""`fieldmon plan --all`: the same day on every plot of a file, side by side on all cores."""

from __future__ import annotations

import csv
import io
import re
import signal
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Executor, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from multiprocessing import get_context
from typing import TYPE_CHECKING, Any

import typer

from fieldmon.cli.messages import assumed_in_words, tell_assumed_of_plots
from fieldmon.cli.progress import progress
from fieldmon.cli.season_files import refuse_unrecorded
from fieldmon.cli.stopped import STOPPED_CODE
from fieldmon.compute.cores import cores
from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.io.atomic_write import write_whole
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.io.prepare import lay
from fieldmon.io.writers.csv import safe_cell
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.io.writers.file_names import plain_name
from fieldmon.planning.assumptions import assumed_by
from fieldmon.planning.many_plots import plan_task
from fieldmon.samplers.own import label_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from concurrent.futures import Future
    from datetime import datetime
    from pathlib import Path

    from fieldmon.io.prepared_plots import Estate, EstateRecords
    from fieldmon.planning.many_plots import Orders, Task

SUMMARY = "summary.csv"
#: the exit code where plots were refused; what was planned is written
SOME_REFUSED = 1
_COLUMNS = (
    *("plot", "state", "file", "plants", "rows", "stops", "hours", "drive_km"),
    *("infested_expected", "sentence", "digest", "assumed"),
)
# the summary on disk is never older than this while plots are planned
_EVERY_S = 2.0
# tasks handed to the pool at once, so that no worker waits for the next
_AHEAD = 32
# up to so many plots are planned here: starting other processes takes longer
_FEW = 6
# plots refused for one reason that are told one by one; of more there is one line
_NAMED = 3

Row = dict[str, Any]
Work = Callable[[str, "Task"], Row]
# within which tasks are handed over
Handing = Callable[[], AbstractContextManager[None]]


@dataclass(frozen=True, eq=False)
class EstateDay:
    """What every worker process knows before its first plot.

    Parameters
    ----------
    records
        Those of all plots.
    folder
        Where the routes go.
    began
        Local date and time of the start.
    """

    records: EstateRecords
    folder: Path
    began: datetime


# of a worker process alone: what it was begun with, which is not sent with each plot
_BEGUN_WITH: list[EstateDay] = []


def plan_all(plots: Estate, orders: Orders, day: EstateDay, workers: int | None = None) -> None:
    """Plan every plot; write a route file each, and `SUMMARY` in the same folder.

    A plot that cannot be planned is refused with its sentence, and the others go on; the exit code
    is `SOME_REFUSED` then. What an earlier run finished with the same plot, records and orders is
    not planned again.
    """
    tasks = _tasks(plots, orders)
    day.folder.mkdir(parents=True, exist_ok=True)
    digests = {
        name: task.digest(plots.records.candidates(task.plot.name)) for name, task in tasks.items()
    }
    files = {task.plot.name: name for name, task in tasks.items()}
    rows = _finished(day.folder, files, digests)
    left = {name: task for name, task in tasks.items() if name not in rows}
    refuse_unrecorded(None, (day.folder / name for name in left))
    if len(left) < len(tasks):
        typer.echo(f"{len(tasks) - len(left)} of {len(tasks)} plots were planned already.")
    write = partial(_write, day.folder, tasks, rows)
    write()  # from now on routes of an earlier run are not those of its summary
    try:
        _plan(left, rows, digests, day, workers or cores(), write)
    except KeyboardInterrupt as end:
        _tell_stopped(rows, tasks, day.folder)
        raise SystemExit(STOPPED_CODE) from end  # what was written is said already
    finally:
        write()
    _tell(rows, day.folder)
    if any(row["state"] == "refused" for row in rows.values()):
        raise typer.Exit(SOME_REFUSED)


def _tasks(plots: Estate, orders: Orders) -> dict[str, Task]:
    """Return the tasks by the names of their files."""
    from fieldmon.planning.many_plots import (
        Task,
    )

    digits = len(str(len(plots.fields)))
    tasks = {}
    for number, plot in enumerate(plots.fields, 1):
        crew = plots.crew(plot)
        stated = {"hours": crew.hours, "look_s": crew.look_s}
        stated["speed_m_s"] = None if crew.speed_km_h is None else crew.speed_km_h / 3.6
        known = {name: value for name, value in stated.items() if value is not None}
        tasks[f"{number:0{digits}d}-{plain_name(plot.name)}.geojson"] = Task(
            plot, crew.who, known, orders, crew.wrong or {}, crew.left_aside or {}
        )
    return tasks


def _finished(folder: Path, files: dict[str, str], digests: dict[str, str]) -> dict[str, Row]:
    """Return the rows of an earlier run that still hold, by the names of their files.

    `files` names those of each plot: the row of a plot that was refused names none.
    """
    try:
        text = (folder / SUMMARY).read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        why = "it is no text in UTF-8" if isinstance(error, ValueError) else error.strerror
        raise FileProblem(
            f"{folder / SUMMARY} must be readable, but it is not: {why}. Delete it, and all plots "
            "are planned anew."
        ) from error
    written = {safe_cell(plot): (plot, name) for plot, name in files.items()}
    same = {}
    for row in csv.DictReader(io.StringIO(text)):
        if "digest" in row and row["plot"] in written:
            plot, name = written[row["plot"]]
            same[name] = row | {"plot": plot, "file": name}
    return {
        name: row
        for name, row in same.items()
        if digests.get(name) == row["digest"]
        and (row["state"] == "refused" or (folder / name).is_file())
    }


def _plan(
    tasks: dict[str, Task],
    rows: dict[str, Row],
    digests: dict[str, str],
    day: EstateDay,
    workers: int,
    write: Callable[[], None],
) -> None:
    """Plan tasks in worker processes, a few ahead of them, and keep `rows` and the disk current.

    `write` writes the summary.
    """
    if not tasks:
        return

    def keep(one: Future[Row]) -> None:
        # also those that end while a stop is on its way
        if not one.cancelled() and one.exception() is None:
            row = one.result()
            rows[row["file"]] = row | {"digest": digests[row["file"]]}

    planning = _pool(min(workers, len(tasks)), day) if len(tasks) > _FEW else _here(day)
    pool, work, handing = planning

    def submit(name: str, task: Task) -> Future[Row]:
        return pool.submit(work, name, task)

    names, saved = list(tasks), time.monotonic()
    with progress("Planning", len(names)) as bar:
        try:
            for one in _ended(submit, tasks.items(), keep, handing):
                one.result()
                bar.update(1)
                if time.monotonic() - saved > _EVERY_S:
                    write()
                    saved = time.monotonic()
        except BrokenProcessPool as error:
            raise FileProblem(
                "A working process ended before its plot was planned (was it killed, or is the "
                "memory full?). What is finished is kept: run the same command again to go on."
            ) from error
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _pool(workers: int, day: EstateDay) -> tuple[Executor, Work, Handing]:
    """Return worker processes that know the day, and what each does."""
    from fieldmon.simulation.executor import ctrl_c_waits

    pool = ProcessPoolExecutor(workers, get_context("spawn"), _prepare, (day,))
    # a process may be started for each task, and hears Ctrl-C before it is told to pass it by
    return pool, _work_as_begun, ctrl_c_waits


def _here(day: EstateDay) -> tuple[Executor, Work, Handing]:
    """Return this process: a few plots are planned before others have started."""
    from fieldmon.simulation.executor import here

    return here().pool, partial(_work, day), nullcontext


def _ended(
    submit: Callable[[str, Task], Future[Row]],
    tasks: Iterable[tuple[str, Task]],
    keep: Callable[[Future[Row]], None],
    handing: Handing,
) -> Iterator[Future[Row]]:
    """Hand over tasks, some ahead; yield each as it ends, `keep` hears of it before.

    Tasks are handed over within `handing`.
    """
    waiting = iter(tasks)

    def more(n: int) -> set[Future[Row]]:
        handed: set[Future[Row]] = set()
        with handing():
            for item in islice(waiting, n):
                one = submit(*item)
                one.add_done_callback(keep)
                handed.add(one)
        return handed

    running = more(_AHEAD)
    while running:
        done, running = wait(running, return_when=FIRST_COMPLETED)
        running |= more(len(done))
        yield from done


def _prepare(day: EstateDay) -> None:
    """Make a worker process ready; the stop key is for the process that waits for it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _BEGUN_WITH[:] = [day]


def _work_as_begun(name: str, task: Task) -> Row:
    """Plan one plot on the day with which this worker process was begun."""
    (day,) = _BEGUN_WITH
    return _work(day, name, task)


def _work(day: EstateDay, name: str, task: Task) -> Row:
    """Plan one plot and write its route; return its row of the summary."""
    row = dict.fromkeys(_COLUMNS, "") | {"plot": task.plot.name, "file": name}
    try:
        choices = PlantingChoices(**task.orders.planting)  # type: ignore[arg-type]
        laid = lay(task.plot, choices)
        today = plan_task(task, laid.plot, day.records.on(task.plot))
    except FieldmonError as error:
        (day.folder / name).unlink(missing_ok=True)
        return row | {"state": "refused", "sentence": str(error)}
    route = today.route
    notes = RouteNotes(task.plot.name, label_of(task.orders.sampler), day.began)
    robot, grid = today.scene.robot, route.aisles.grid
    assumed = assumed_by((*laid.assumed, *task.assumed(robot)), task.orders.prior, robot, grid)
    assumed = tuple(dict.fromkeys(assumed))
    replace(route, notes=notes).to_file(day.folder / name, "geojson")
    return row | {
        "state": "planned",
        "plants": len(grid),
        "rows": grid.n_lines,
        "stops": len(route),
        "hours": round(route.end_s / 3600, 3),
        "drive_km": round(route.drive_m / 1000, 3),
        "infested_expected": round(float(route.believed.sum()), 3),
        "sentence": " ".join(filter(None, task.left_aside.values())),
        "assumed": assumed_in_words(assumed),
    }


def _write(folder: Path, tasks: dict[str, Task], rows: dict[str, Row]) -> None:
    """Write the summary: a line for the plot of each task, by the names of their files."""
    text = io.StringIO()
    table = csv.DictWriter(text, _COLUMNS)
    table.writeheader()
    for name, task in tasks.items():
        row = rows.get(name) or {"plot": task.plot.name, "state": "not planned"}
        # no file is written for a plot that was refused
        table.writerow(_safe(row | ({} if row["state"] == "planned" else {"file": ""})))
    # the mark at the beginning tells a spreadsheet that names may be in any script
    write_whole(folder / SUMMARY, text.getvalue().encode("utf-8-sig"))


def _safe(row: Row) -> Row:
    """Return a row whose texts no spreadsheet runs."""
    return {
        key: safe_cell(value) if isinstance(value, str) else value for key, value in row.items()
    }


def _tell_stopped(rows: dict[str, Row], tasks: Iterable[str], folder: Path) -> None:
    """Print what is finished of a run that somebody stopped, and which routes are of another."""
    from fieldmon.compute.wording import counted

    names = list(tasks)
    n = sum(row["state"] == "planned" for row in rows.values())
    said = f"{n} of {counted(len(names), 'plot')} planned; the same command goes on from there."
    if old := [name for name in names if name not in rows and (folder / name).exists()]:
        some = ", ".join([*old[:_NAMED], *["..."][: len(old) - _NAMED]])
        of_them = "is 1 route" if len(old) == 1 else f"are {len(old)} routes"
        said += f" Of an earlier run there {of_them} still in {folder}: {some}."
    typer.echo(said, err=True)


def _tell(rows: dict[str, Row], folder: Path) -> None:
    from fieldmon.compute.wording import counted

    planned = [row for row in rows.values() if row["state"] == "planned"]
    tell_assumed_of_plots({row["plot"]: row.get("assumed") or "" for row in planned})
    for line in _refusals([row for row in rows.values() if row["state"] == "refused"]):
        typer.echo(line, err=True)
    stops = sum(int(row["stops"]) for row in planned)
    hours = sum(float(row["hours"]) for row in planned)
    typer.echo(
        f"{len(planned)} of {counted(len(rows), 'plot')} planned, {counted(stops, 'plant')} in "
        f"{round(hours, 1):g} h. Routes and {SUMMARY} in {folder}"
    )


def _refusals(refused: list[Row]) -> Iterator[str]:
    """Yield a line for each reason: those that differ in numbers and names only are one."""
    by_reason: dict[str, list[Row]] = {}
    for row in refused:
        bare = re.sub(r"'[^']*'|[\d.,]+", "", row["sentence"].replace(row["plot"], ""))
        by_reason.setdefault(bare, []).append(row)
    for same in by_reason.values():
        if len(same) <= _NAMED:
            yield from (f"refused: {row['plot']}: {row['sentence']}" for row in same)
            continue
        some = ", ".join(row["plot"] for row in same[:_NAMED])
        yield f"refused: {len(same)} plots ({some}, ...): {same[0]['sentence']}"
