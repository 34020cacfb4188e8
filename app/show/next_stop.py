"""Where a scout goes next, in words. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import chance_figure

from ..words import texts
from ..words.language import in_words, place_in_words

if TYPE_CHECKING:
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Scene

    from ..words.units import UnitsInLanguage


@dataclass(frozen=True)
class NextStop:
    """The next plant, in words."""

    plant: int
    lonlat: list[float]
    place: str
    direction: str
    arrow: str
    chance: str


def next_stop(plan: DayPlan, done: int, units: UnitsInLanguage) -> NextStop:
    """Return where to go next, from where the last result was noted; `done` stops are done."""
    route, scene = plan.route, plan.scene
    grid, plant = scene.aisles.grid, int(route.plant[0])
    sector, lonlat = _heading(scene, plant)
    line_m = route.line_m[: int(route.line_stop[0]) + 1]
    drive_m = float(np.hypot(*np.diff(line_m, axis=0).T).sum())
    same = scene.at >= 0 and grid.row[scene.at] == grid.row[plant]
    left = timedelta(seconds=int(scene.seconds_left))
    return NextStop(
        plant,
        lonlat,
        (texts.NEXT_PLACE if grid.in_rows else texts.NEXT_ALONE).format(
            **place_in_words(grid, plant)
        ),
        texts.NEXT_WAY.format(
            metres=units.metres(drive_m), compass=texts.COMPASS[sector],
            along=_along(same=same) if grid.in_rows else "",
        ),
        texts.ARROWS[sector],
        texts.NEXT_CHANCE.format(
            chance=in_words(chance_figure(float(route.believed[0]), 1)), done=done,
            left=len(route), hours=str(left)[:-3],
        ),
    )  # fmt: skip


def _along(*, same: bool) -> str:
    return texts.NEXT_ALONG if same else texts.NEXT_AISLE


def _heading(scene: Scene, plant: int) -> tuple[int, list[float]]:
    """Return the eighth of the compass in which a plant lies, 0 is north, and its lon/lat."""
    grid: PlantGrid = scene.aisles.grid
    from_m = scene.aisles.gate_m if scene.at < 0 else grid.xy_m[scene.at]
    ends = grid.frame.lonlat(np.stack([np.asarray(from_m).reshape(2), grid.xy_m[plant]]))
    east = (ends[1, 0] - ends[0, 0]) * np.cos(np.deg2rad(ends[0, 1]))
    north = ends[1, 1] - ends[0, 1]
    return int(np.rint(np.rad2deg(np.arctan2(east, north)) / 45.0)) % 8, ends[1].tolist()
