"""Samplers on mapped plots: how many infested plants the first 5, 10, 20 and 40 % looks find."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import FileProblem
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.planning.workday import work_day
from fieldmon.plot.layout import Planting, rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Naive

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.samplers.base import Sampler

SHARES = (0.05, 0.10, 0.20, 0.40)
# what is believed before the first look, of every map (our choice; nothing is known of it)
_FLAT = 0.1
# a day lasts for a twentieth of the plants, with some time to drive
_DAY, _DRIVING = 0.05, 1.3


@dataclass(frozen=True)
class Layout:
    """Which columns of a table of plants say what.

    Parameters
    ----------
    row, place
        Columns with the number of the row, and of the plant within it, from 1.
    infested
        Column with the finding, and from which value on (or by which word) it is an infested one.
    maps
        Column that tells the maps of one table apart, if there are several.
    row_m, plant_m
        Distances between rows and between plants.
    """

    row: str
    place: str
    infested: tuple[str, str | int]
    maps: str | None
    row_m: float
    plant_m: float


# spacings of pepper and webworms are not in the tables: a metre either way
LAYOUTS = {
    "citrus_ctv_IVI3and4.csv": Layout("y", "x", ("i", 1), "t", 6.0, 2.0),
    "hop_viruses_HpLV.csv": Layout("x", "y", ("i", 1), "t", 2.1, 1.8),
    "gumpertz.pepper.txt": Layout("row", "quadrat", ("disease", "Y"), "field", 1.0, 1.0),
    "beall.webworms.txt": Layout("row", "col", ("y", 1), None, 1.0, 1.0),
}


@dataclass(frozen=True, eq=False)
class PlantMap:
    """A plot of which every plant was looked at."""

    name: str
    aisles: Aisles
    infested: NDArray[np.bool_]


def maps_from(name: str, text: str) -> list[PlantMap]:
    """Return the maps in a table whose name is one of `LAYOUTS`."""
    if name not in LAYOUTS:
        raise FileProblem(f"{name} must be one of {', '.join(LAYOUTS)}.")
    layout = LAYOUTS[name]
    rows = list(csv.DictReader(io.StringIO(text), delimiter="\t" if "\t" in text else ","))
    kinds = list(dict.fromkeys(row[layout.maps] for row in rows)) if layout.maps else [""]
    return [
        _map(
            f"{name.split('.', maxsplit=1)[0]} {kind}".strip(),
            [row for row in rows if layout.maps is None or row[layout.maps] == kind],
            layout,
        )
        for kind in kinds
    ]


def found_at(plant_map: PlantMap, sampler: Sampler) -> list[int]:
    """Return how many infested plants were found when each of `SHARES` was inspected.

    No plant is inspected twice, every infested one inspected is found, and none infects another.
    """
    n = len(plant_map.infested)
    robot = Robot(detection=1.0, returns=False)
    belief = PairApproximation.of(plant_map.aisles.grid, np.full(n, _FLAT))
    seen = np.zeros(n, np.bool_)
    order = np.empty(0, np.int32)
    while len(order) < SHARES[-1] * n:
        scene = Scene(
            plant_map.aisles,
            robot,
            belief.chance,
            np.where(seen, 0, NEVER).astype(np.int32),
            at=int(order[-1]) if len(order) else -1,
            seconds_left=max(_DAY * n, 2.0) * robot.visit_s * _DRIVING,
            trail=order,
            pair_chance=belief.pair_chance,
        )
        work = work_day(scene, sampler, plant_map.infested)
        if not len(work):
            break
        order = np.concatenate([order, work.plant])
        seen[work.plant] = True
        belief = belief.learn(work.plant, work.found, Learning(detection=1.0))
    finds = np.cumsum(plant_map.infested[order])
    return [int(finds[min(round(share * n), len(order)) - 1]) for share in SHARES]


def table(maps: list[PlantMap]) -> list[tuple[str, str, list[float]]]:
    """Return finds per inspected plant at `SHARES`: map, sampler, ``(4,)``.

    Means over the four corners from which work can begin; for random looks the expected share.
    """
    samplers: dict[str, Sampler] = {"adaptive": Adaptive(), "dynamic": Dynamic(), "naive": Naive()}
    rows = []
    for each in maps:
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


def _turned(each: PlantMap) -> list[PlantMap]:
    """Return a map and its three mirror images: the gate at another corner each."""
    rows = each.infested.reshape(each.aisles.grid.n_rows, -1)
    mirrored = (rows, rows[::-1], rows[:, ::-1], rows[::-1, ::-1])
    return [PlantMap(each.name, each.aisles, np.ravel(image)) for image in mirrored]


def _map(name: str, rows: list[dict[str, str]], layout: Layout) -> PlantMap:
    row = np.array([int(each[layout.row]) for each in rows])
    place = np.array([int(each[layout.place]) for each in rows])
    column, infested_from = layout.infested
    cells = [each[column] for each in rows]
    if isinstance(infested_from, str):
        found = np.array([cell == infested_from for cell in cells])
    else:
        found = np.array([float(cell) >= infested_from for cell in cells])
    grid = rectangle(
        int(row.max()),
        int(place.max()),
        Planting(row_spacing_m=layout.row_m, plant_spacing_m=layout.plant_m),
    )
    infested = np.zeros(len(grid), np.bool_)
    infested[(row - 1) * place.max() + place - 1] = found
    return PlantMap(name, Aisles.of(grid), infested)
