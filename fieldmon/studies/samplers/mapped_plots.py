"""Samplers on mapped plots: how many infested plants the first 5, 10, 20 and 40 % looks find."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.errors import FileProblem
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.planning.workday import work_day
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.plant_maps import PUBLIC_MAPS, read_plant_map

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Sampler
    from fieldmon.studies.plant_maps import PlantMap

SHARES = (0.05, 0.10, 0.20, 0.40)
# what is believed before the first look, of every map (our choice; nothing is known of it)
_FLAT = 0.1
# a day lasts for a twentieth of the plants, with some time to drive
_DAY, _DRIVING = 0.05, 1.3


FILES = (
    "citrus_ctv_IVI3and4.csv",
    "hop_viruses_HpLV.csv",
    "gumpertz.pepper.txt",
    "beall.webworms.txt",
)
"""The public maps that are inspected, see `plant_maps.PUBLIC_MAPS`."""


class DatedMap(NamedTuple):
    """A mapped plot on one date: what it is called, its plants, and ``(n,)`` who is infested."""

    name: str
    aisles: Aisles
    infested: NDArray[np.bool_]


def plots_in(folder: Path) -> list[DatedMap]:
    """Return the plots that a folder has public maps of, one for each date."""
    files = [folder / name for name in FILES if (folder / name).is_file()]
    if not files:
        raise FileProblem(f"{folder} must hold one of {', '.join(FILES)}, but it does not.")
    maps = [each for file in files for each in read_plant_map(file, PUBLIC_MAPS[file.name])]
    return [
        DatedMap(_name(each, date), each.aisles(), infested)
        for each in maps
        for date, infested in zip(each.dates, each.infested, strict=True)
    ]


def _name(of: PlantMap, date: str) -> str:
    """Return the name of a map's file without its ending, and its part or its date."""
    file, _, part = of.name.partition(" ")
    return f"{file.split('.', maxsplit=1)[0]} {part or date}".strip()


def found_at(plot: DatedMap, sampler: Sampler) -> list[int]:
    """Return how many infested plants were found when each of `SHARES` was inspected.

    No plant is inspected twice, every infested one inspected is found, and none infects another.
    """
    n = len(plot.infested)
    robot = Robot(detection=1.0, returns=False)
    belief = PairApproximation.of(plot.aisles.grid, np.full(n, _FLAT))
    seen = np.zeros(n, np.bool_)
    order = np.empty(0, np.int32)
    while len(order) < SHARES[-1] * n:
        scene = Scene(
            plot.aisles,
            robot,
            belief.chance,
            np.where(seen, 0, NEVER).astype(np.int32),
            at=int(order[-1]) if len(order) else -1,
            seconds_left=max(_DAY * n, 2.0) * robot.visit_s * _DRIVING,
            trail=order,
            pair_chance=belief.pair_chance,
        )
        work = work_day(scene, sampler, plot.infested)
        if not len(work):
            break
        order = np.concatenate([order, work.plant])
        seen[work.plant] = True
        belief = belief.learn(work.plant, work.found, Learning(detection=1.0))
    finds = np.cumsum(plot.infested[order])
    return [int(finds[min(round(share * n), len(order)) - 1]) for share in SHARES]


def table(plots: list[DatedMap]) -> list[tuple[str, str, list[float]]]:
    """Return finds per inspected plant at `SHARES`: map, sampler, ``(4,)``.

    Means over the four corners from which work can begin; for random looks the expected share.
    """
    samplers: dict[str, Sampler] = {"adaptive": Adaptive(), "dynamic": Dynamic(), "naive": Naive()}
    rows = []
    for each in plots:
        n = len(each.infested)
        for who, sampler in samplers.items():
            looks = [round(share * n) for share in SHARES]
            finds = np.mean([found_at(turned, sampler) for turned in _turned(each)], axis=0)
            rows.append((each.name, who, [f / k for f, k in zip(finds, looks, strict=True)]))
        rows.append((each.name, "random", [float(each.infested.mean())] * len(SHARES)))
    return rows


def table_csv(rows: list[tuple[str, str, list[float]]]) -> str:
    """Return such a table as CSV."""
    head = ",".join(["map", "sampler", *(f"finds_per_look_at_{share:.0%}" for share in SHARES)])
    lines = [f"{name},{who}," + ",".join(f"{v:.4f}" for v in values) for name, who, values in rows]
    return "\n".join([head.replace("%", "_pct"), *lines, ""])


def _turned(each: DatedMap) -> list[DatedMap]:
    """Return a plot and its three mirror images: the gate at another corner each."""
    rows = each.infested.reshape(each.aisles.grid.n_rows, -1)
    mirrored = (rows, rows[::-1], rows[:, ::-1], rows[::-1, ::-1])
    return [each._replace(infested=np.ravel(image)) for image in mirrored]
