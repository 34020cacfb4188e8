"""Every command on a long season: ``python -m tests.benchmarks.long_season`` prints a table.

300 days, some 100 000 plants and 500 000 inspections: 1 667 a day, one row after the other, each
day a batch with its entry in the log. Of the days before the last one the figures are made up,
since to estimate them takes minutes. The one route is the next day's, which is worked on when
the commands are given. Each command runs on a fresh copy of the file, as a person runs it: seconds
by the clock, seconds of work (of all its processes), and the most memory that one of these held.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from datetime import date, timedelta
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.estimates.derived_layers import map_digest
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert
from fieldmon.monitoring.inspecting import batches, inspection_table
from fieldmon.planning.workday import draw_detections
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from tests.benchmarks.test_bench_grid import crooked_plot

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fieldmon.plot.grid import PlantGrid

BEGINS = date(2026, 1, 5)
N_PLANTS, N_DAYS, A_DAY = 101_000, 300, 1_667
WHO = ("Ann", "Ben")
# a pest that is kept down by being treated where it is found: each row is seen once in two months
TRUTH = Spread(rate_per_day=0.003, arrivals_per_day=0.00005)


class Took(NamedTuple):
    """What a command took, and how it ended."""

    clock_s: float
    work_s: float
    memory_mb: float
    code: int
    said: str


def made(file: Path, n_plants: int = N_PLANTS, n_days: int = N_DAYS, a_day: int = A_DAY) -> Season:
    """Begin a season in a file and let all its days pass."""
    plot = Plot.of(crooked_plot(n_plants), Planting(row_bearing_deg=33.0, headland_m=1.0))
    season = Season.create(file, plot, settings=MonitoringSettings(BEGINS, robot=Robot(hours=12)))
    last, settings = n_days - 1, season.settings
    work = list(days_work(plot.grid, settings, n_days, a_day))
    with season.changing() as change:
        for day, seen in enumerate(work):
            _write(season, change.db, (day, settings), seen)
        insert(change.db, schema.DAYS, [_figures(day, seen) for day, seen in enumerate(work)][1:])
        change.reaches(last)
    digests = [(map_digest(season.morning(on(day))), day) for day in range(1, last)]
    with season.changing() as change:
        change.db.executemany("UPDATE days SET digest = ? WHERE day = ?", digests)
    season.plan(on(last + 1))
    return season


def _figures(day: int, seen: Inspections) -> tuple[object, ...]:
    """Return the figures of a day but for those that take minutes for all days together."""
    found = int(np.count_nonzero(seen.result == FOUND))
    return (day, str(on(day)), len(seen), found, 50.0, 30, 80, 0.0, "", None)


def on(day: int) -> date:
    """Return the date of a day."""
    return BEGINS + timedelta(days=day)


def days_work(
    grid: PlantGrid, settings: MonitoringSettings, n_days: int, a_day: int
) -> Iterator[Inspections]:
    """Give what is inspected each day, plant by plant along the rows, and let nights pass."""
    robot, streams = settings.robot, RandomStreams(1)
    infested = streams.of("start").random(len(grid)) < 0.01
    for day in range(n_days):
        plants = (np.arange(a_day) + day * a_day).astype(np.int32) % len(grid)
        detects = np.array([robot.detects])
        found = draw_detections(infested, detects, streams.key("inspect", day))[plants] > 0
        yield Inspections.of(
            plants,
            np.where(found, FOUND, CLEAN),
            np.datetime64(on(day)),
            who=np.full(a_day, WHO[day % 2]),
        )
        infested[plants[found]] = False
        infested = night(grid, infested, TRUTH, streams.key("spread", day))


def _write(
    season: Season,
    db: sqlite3.Connection,
    when: tuple[int, MonitoringSettings],
    seen: Inspections,
) -> None:
    """Write a day's inspections as `Season.record` does, without working anything out."""
    day, settings = when
    source, who = f"route-{on(day)}.csv", WHO[day % 2]
    batch = batches.begin(db, "findings", source, who)
    rows = inspection_table.rows(
        seen, season.plot.grid, season.plant_numbers, settings, (batch, who)
    )
    batches.end(db, batch, int(inspection_table.store(db, rows).sum()))
    season_log.append(
        db, "seen", who, states=season_log.states(db, [batch]), batch=batch, source=source,
        **inspection_table.in_words(seen, []),
    )  # fmt: skip


class Prepared(NamedTuple):
    """A command, what must be done to its copy of the season before, and what it needs."""

    name: str
    words: list[str]
    before: Callable[[Path], object] = lambda _: None


def commands(season: Path, work: Path) -> list[Prepared]:
    """Return every command that takes a season; `SEASON` stands for the copy."""
    known = Season(season)
    last, numbered = last_date(known), known.plant_numbers
    two = known.plan(last, keep=False).route.plant[:2].tolist()
    rows = [
        f"{numbered.line[p]},{numbered.number[p]},{r}" for p, r in zip(two, (1, 0), strict=True)
    ]
    (work / "two.csv").write_text("\n".join(["row,number,found", *rows, ""]))
    (work / "labels.csv").write_text("product,max dose,unit,waiting days\nsoap,5,l/ha,3\n")
    day, tomorrow = str(last), str(last + timedelta(days=1))
    other = shutil.copy(season, work / "other.gpkg")
    _quietly("record", other, work / "two.csv", "--date", day, "--who", "Cas")
    first = known.store  # rows are named by their numbers in the file
    with first.reading() as db:
        (newest,) = db.execute("SELECT max(fid) FROM inspections").fetchone()
    treated = ["treat", "SEASON", "--efficacy", "0.8", "--product", "soap"]
    record = ["record", "SEASON", "two.csv", "--date", day, "--who", "Cas"]

    def first_of(*words: str) -> Callable[[Path], object]:
        return lambda copy: _quietly(*(str(copy) if w == "SEASON" else w for w in words), at=work)

    return [
        Prepared("status", ["status", "SEASON"]),
        Prepared("status --batches", ["status", "SEASON", "--batches"]),
        Prepared("plan, the same again", ["plan", "SEASON", "--date", day]),
        Prepared("plan, a new route", ["plan", "SEASON", "--date", tomorrow]),
        Prepared("plan, handed off in three formats", [
            "plan", "SEASON", "--date", day, "-o", "r.csv", "-o", "r.gpx", "-o", "r.kml"]),
        Prepared("record, two results", record),
        Prepared("undo, of these", ["undo", "SEASON"], first_of(*record)),
        Prepared("undo, the last day's 1 667", ["undo", "SEASON"]),
        Prepared("undo, one inspection", ["undo", "SEASON", "--inspection", str(newest)]),
        Prepared("decide", ["decide", "SEASON", "--threshold", "5%"]),
        Prepared("decide, with zones", [
            "decide", "SEASON", "--threshold", "0.1%", "--per-ha", "1",
            "-o", "zones.xml.zip"]),
        Prepared("report of the season", ["report", "SEASON", "-o", "season.pdf"]),
        Prepared("report of a day", ["report", "SEASON", "-o", "day.pdf", "--date", day]),
        Prepared("report for a certifier", [
            "report", "SEASON", "-o", "certifier.pdf", "--certification"]),
        Prepared("treat, all of the plot", [*treated, "--date", day]),
        Prepared("treat, twenty rows", [*treated, "--date", day, "--rows", "1-20"]),
        Prepared("labels", ["labels", "SEASON", "labels.csv"]),
        Prepared("change --hours", ["change", "SEASON", "--hours", "6"]),
        Prepared("undo --change", ["undo", "SEASON", "--change"],
                 first_of("change", "SEASON", "--hours", "6")),
        Prepared("log", ["log", "SEASON"]),
        Prepared("log --mornings", ["log", "SEASON", "--mornings"]),
        Prepared("export of the inspections", [
            "export", "SEASON", "--of", "inspections", "-o", "all.csv"]),
        Prepared("export of the log", ["export", "SEASON", "--of", "log", "-o", "log.csv"]),
        Prepared("export of treatments", ["export", "SEASON", "-o", "treated.csv"],
                 first_of(*treated, "--date", day, "--rows", "1-20")),
        Prepared("merge, two results more", ["merge", "SEASON", "other.gpkg"]),
        Prepared("correct, of the last day", ["correct", "SEASON", "--who", "Ann"],
                 lambda copy: _edited(copy, newest)),
        Prepared("backup", ["backup", "SEASON", "-o", "backup.gpkg"]),
        Prepared("salvage", ["salvage", "SEASON", "-o", "rescued.gpkg"]),
        Prepared("drive, made up, a day", [
            "drive", "SEASON", "--made-up", "--date", tomorrow]),
        Prepared("change --spread: every morning anew", ["change", "SEASON", "--spread", "0.03"]),
        Prepared("correct, of the first day", ["correct", "SEASON", "--who", "Ann"],
                 lambda copy: _edited(copy, 1)),
    ]  # fmt: skip


#: what works every morning of the season out again, and takes minutes: asked for by name
LONG = ("log --mornings", "change --spread: every morning anew", "correct, of the first day")


def _edited(copy: Path, row: int) -> None:
    """Change a row as QGIS does."""
    with closing(sqlite3.connect(copy)) as db:
        db.execute("UPDATE inspections SET count = 7, result = 'found' WHERE fid = ?", (row,))
        db.commit()


def _command(*words: object) -> list[str]:
    return [sys.executable, "-m", "fieldmon", *map(str, words)]


def _quietly(*words: object, at: Path | None = None) -> None:
    subprocess.run(_command(*words), cwd=at, check=True, capture_output=True, env=_here())


def _here() -> dict[str, str]:
    """Let a command in another folder be of this one's code, kept compiled as a person's is."""
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PYTHONPATH": str(Path(__file__).parents[2])}


#: run by a small process of its own: a child's most memory is at least that of who begins it
_WAITS = """
import json, resource, subprocess, sys, time
begun = time.perf_counter()
code = subprocess.run(sys.argv[2:], stderr=subprocess.STDOUT).returncode
clock_s, used = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
took = clock_s, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, code
open(sys.argv[1], "w").write(json.dumps(took))
"""


def took(words: list[str], at: Path) -> Took:
    """Run a command in a folder; return what it took."""
    figures = at / "took.json"
    command = [sys.executable, "-S", "-c", _WAITS, str(figures), *_command(*words)]
    ran = subprocess.run(command, cwd=at, check=True, capture_output=True, text=True, env=_here())
    return Took(*json.loads(figures.read_text()), ran.stdout)


def measured(season: Path, one: Prepared, times: int, work: Path) -> Took:
    """Return the middle of several runs, each on a fresh copy; compiled loops are there already."""
    runs = []
    for run in range(times):
        folder = work / f"run-{run}"
        folder.mkdir()
        for file in work.glob("*.*"):
            os.link(file, folder / file.name)
        copy = folder / season.name
        shutil.copy(season, copy)
        one.before(copy)
        words = [copy.name if word == "SEASON" else word for word in one.words]
        runs.append(took(words, folder))
        shutil.rmtree(folder)
    middle = (statistics.median(run[k] for run in runs) for k in range(2))
    return Took(*middle, max(run.memory_mb for run in runs), runs[-1].code, runs[-1].said)


def main() -> None:
    say = partial(print, flush=True)
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--season", type=Path, help="where the season is kept; made if missing")
    asked.add_argument("--times", type=int, default=3, help="runs of each command")
    asked.add_argument("--only", help="commands with this in their name")
    asked.add_argument("--long", action="store_true", help="also what takes minutes")
    asked.add_argument("--said", action="store_true", help="show what each command says")
    asked.add_argument("--without", nargs="*", default=[], help="commands with this in their name")
    chosen = asked.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        season = (chosen.season or work / "made" / "season.gpkg").resolve()
        if not season.exists():
            season.parent.mkdir(parents=True, exist_ok=True)
            begun = time.perf_counter()
            made(season)
            say(f"made in {time.perf_counter() - begun:.0f} s")
        known = Season(season)
        say(
            f"{len(known.plot.grid):,} plants, {len(known.history.inspections):,} inspections, "
            f"{season.stat().st_size / 1e6:.0f} MB"
        )
        say("| command | clock | work | memory |\n|---|---|---|---|")
        for one in commands(season, work):
            if chosen.only and chosen.only not in one.name:
                continue
            if any(word in one.name for word in chosen.without):
                continue
            if one.name in LONG and not chosen.long:
                continue
            got = measured(season, one, 1 if one.name in LONG else chosen.times, work)
            wrong = f" (exit code {got.code})" if got.code else ""
            row = f"{got.clock_s:.1f} s | {got.work_s:.1f} s | {got.memory_mb:.0f} MB"
            say(f"| {one.name}{wrong} | {row} |")
            if chosen.said or got.code:
                say(got.said)


if __name__ == "__main__":
    main()
