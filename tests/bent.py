"""Real vines on plots as they are: rows bent, blocks turned, positions off, plants missing.

The survey is tiled: row after row and vine after vine keep the irregularities of those measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import shapely
from hypothesis import assume
from hypothesis import strategies as st

from fieldmon.plot.bent_layout import bent_grid
from fieldmon.plot.planting import Planting
from fieldmon.plot.polylines import Polylines
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import frame_around, rows_from_plants
from fieldmon.plot.row_lines import Ground, RowLines

if TYPE_CHECKING:
    from pathlib import Path

FRAME = Frame(-0.5241, 53.2681)
VINES = "riseholme_vines/riseholme_vineyard_lat_long_vines.csv"


@dataclass(frozen=True)
class Vines:
    """Where vines stand, east and north in metres, and the true block, row and place of each."""

    xy_m: np.ndarray
    block: np.ndarray
    row: np.ndarray
    along_m: np.ndarray

    @property
    def lonlat(self) -> np.ndarray:
        return FRAME.lonlat(self.xy_m)

    def take(self, which: np.ndarray) -> Vines:
        return Vines(self.xy_m[which], self.block[which], self.row[which], self.along_m[which])


def surveyed(shared: Path) -> np.ndarray:
    """Return ``(10, 12, 2)``: metres along and across the rows of the vines as surveyed."""
    table = pd.read_csv(shared / VINES)
    lonlat = table[["Longitude", "Latitude"]].to_numpy()
    bearing_deg = rows_from_plants(lonlat).bearing_deg
    xy_m = frame_around(lonlat).turned(bearing_deg).xy_m(lonlat)
    row = table["Vine Row"].str.removeprefix("row_").astype(int).to_numpy()
    order = np.lexsort((xy_m[:, 0], row))
    grid = xy_m[order].reshape(10, 12, 2)
    up = grid[-1, :, 1].mean() > grid[0, :, 1].mean()
    return grid if up else grid[::-1]


def tiled(vines: np.ndarray, n_rows: int, n_vines: int) -> np.ndarray:
    """Return ``(n_rows, n_vines, 2)``: the survey repeated in both directions about (0, 0)."""
    step_x = (vines[:, -1, 0] - vines[:, 0, 0]).mean() * 12 / 11
    step_y = (vines[-1, :, 1] - vines[0, :, 1]).mean() * 10 / 9
    k, j = np.meshgrid(np.arange(n_rows), np.arange(n_vines), indexing="ij")
    many = vines[k % 10, j % 12] + np.stack([j // 12 * step_x, k // 10 * step_y], axis=2)
    return many - many.reshape(-1, 2).mean(axis=0)


def bent(vines: np.ndarray, radius_m: float | None, turn_deg: float = 0.0, block: int = 0) -> Vines:
    """Return a block whose middle row is bent to a radius; places along the rows stay."""
    x, y = vines.reshape(-1, 2).T
    row = np.repeat(np.arange(len(vines)), vines.shape[1])
    xy_m = np.stack([x, y], axis=1)
    if radius_m is not None:
        angle = x / (radius_m + y)
        xy_m = np.stack(
            [(radius_m + y) * np.sin(angle), (radius_m + y) * np.cos(angle) - radius_m], axis=1
        )
    return Vines(turned(xy_m, turn_deg), np.full(len(row), block), row, x)


def turned(xy_m: np.ndarray, turn_deg: float) -> np.ndarray:
    turn = np.deg2rad(turn_deg)
    return xy_m @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])


def side_by_side(*blocks: Vines, gap_m: float = 7.0) -> Vines:
    """Return blocks one after the other, west to east, their nearest vines a gap apart."""
    placed, first_row, east = [], 0, 0.0
    for number, block in enumerate(blocks):
        xy_m = block.xy_m + np.array([east - block.xy_m[:, 0].min(), 0.0])
        east = xy_m[:, 0].max() + gap_m
        placed.append(Vines(xy_m, np.full(len(xy_m), number), block.row + first_row, block.along_m))
        first_row += block.row.max() + 1
    return Vines(
        np.concatenate([b.xy_m for b in placed]),
        np.concatenate([b.block for b in placed]),
        np.concatenate([b.row for b in placed]),
        np.concatenate([b.along_m for b in placed]),
    )


def measured(vines: Vines, noise_m: float, missing: float = 0.1, seed: int = 1) -> Vines:
    """Return the vines as a receiver measures them, some missing, in any order."""
    rng = np.random.default_rng(seed)
    kept = rng.permutation(np.flatnonzero(rng.random(len(vines.row)) >= missing))
    left = vines.take(kept)
    off_m = rng.normal(scale=noise_m, size=left.xy_m.shape) if noise_m else 0.0
    return Vines(left.xy_m + off_m, left.block, left.row, left.along_m)


def right_share(found: np.ndarray, true: np.ndarray) -> float:
    """Return the share of plants in the row that is theirs: each found row is one true row."""
    pairs, times = np.unique(np.stack([found, true], axis=1), axis=0, return_counts=True)
    taken_found, taken_true, right = set(), set(), 0
    for k in np.argsort(-times):
        f, t = pairs[k].tolist()
        if f < 0 or f in taken_found or t in taken_true:
            continue
        taken_found.add(f)
        taken_true.add(t)
        right += int(times[k])
    return right / len(found)


# -- made up, for properties -------------------------------------------------------------------

_share = st.floats(0.0, 1.0)


@st.composite
def bent_grids(draw, *, faces: tuple[int, ...] = (1, 2)):
    """Draw the plants of a plot of one to three blocks, each bent and turned anyhow."""
    planting = Planting(
        row_spacing_m=draw(st.floats(1.5, 5.0)),
        plant_spacing_m=draw(st.floats(0.8, 4.0)),
        headland_m=draw(st.floats(1.0, 6.0)),
        faces=draw(st.sampled_from(faces)),
    )
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    lines, xy_m, row, block = [], [], [], []
    east, jitter = 0.0, 0.1 * min(planting.row_spacing_m, planting.plant_spacing_m)
    for number in range(draw(st.integers(1, 3))):
        rows = _block_rows(draw, planting, rng)
        turn = draw(st.floats(0.0, 180.0))
        rows = [turned(line, turn) for line in rows]
        by = np.array([east - min(r[:, 0].min() for r in rows), 0.0])
        rows = [line + by for line in rows]
        east = max(r[:, 0].max() for r in rows) + planting.headland_m * (1.0 + draw(_share)) + 3.0
        for line in rows:
            kept = rng.random(len(line)) > 0.15
            kept[rng.integers(len(line))] = True
            off_m = rng.uniform(-jitter, jitter, (int(kept.sum()), 2))
            xy_m.append(line[kept] + off_m)
            row.append(np.full(len(off_m), len(lines)))
            lines.append(line)
            block.append(number)
    rows = RowLines(Polylines.each(lines), np.array(block))
    plants, row = np.concatenate(xy_m), np.concatenate(row)
    pond = _pond(draw, plants)
    # nobody plants beside it, where no robot could come
    shore_m = planting.row_spacing_m + planting.plant_spacing_m
    dry = ~shapely.contains_xy(shapely.buffer(pond, shore_m), plants)
    assume(dry.any())
    return bent_grid(FRAME, rows, (plants[dry], row[dry]), Ground(None, pond), planting)


def _block_rows(draw, planting: Planting, rng: np.random.Generator) -> list[np.ndarray]:
    """Return rows of a block, plant by plant, each where it may begin and end."""
    n_rows, n_plants = draw(st.integers(1, 8)), draw(st.integers(2, 30))
    half_m = n_plants * planting.plant_spacing_m / 2
    deep_m = n_rows * planting.row_spacing_m
    # at most a third of a circle, and no inner row tighter than 10 m
    least_m = max(half_m, 10.0) + deep_m
    radius_m = least_m / max(draw(_share), 0.01)
    rows = []
    for k in range(n_rows):
        first, last = sorted(rng.integers(0, n_plants, 2)) if draw(st.booleans()) else (0, n_plants)
        x = (np.arange(first, max(last, first + 2)) - n_plants / 2) * planting.plant_spacing_m
        at = radius_m + (k - n_rows / 2) * planting.row_spacing_m
        rows.append(np.stack([at * np.sin(x / at), at * np.cos(x / at) - radius_m], axis=1))
    return rows


def _pond(draw, xy_m: np.ndarray) -> shapely.Geometry:
    """Return something in the way, or nothing."""
    if draw(st.booleans()):
        return shapely.MultiPolygon()
    at = xy_m.min(axis=0) + np.ptp(xy_m, axis=0) * [draw(_share), draw(_share)]
    return shapely.buffer(shapely.points(at), 1.0 + 4.0 * draw(_share), quad_segs=3)
