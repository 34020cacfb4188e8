"""A plot as MuJoCo knows it: plants as posts with canopies on level or uneven ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.drive.ground import MARGIN_M
from fieldmon.plot.clearance import half_canopy_m

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.drive.ground import UnevenGround
    from fieldmon.plot.grid import PlantGrid

    Float = NDArray[np.float64]

_HEIGHT_M = 1.5
# ground below the lowest height, so that nothing falls through
_DEEP_M = 1.0


def world_xml(grid: PlantGrid, step_s: float, ground: UnevenGround | None = None) -> str:
    """Return a plot in MuJoCo's own format; its robot is put in by `RobotBody`.

    Plants are ``p0`` on, in the order of the grid; twin faces are one plant. Heights of uneven
    ground are filled in by `lay_ground` once it is compiled.
    """
    alone = [k for k in range(len(grid)) if grid.vine[k] == k]
    xy_m = grid.xy_m[alone]
    stand_m = np.zeros(len(alone)) if ground is None else ground.at(xy_m)
    plants = "".join(
        f'<geom name="p{k}" class="plant" pos="{x:.3f} {y:.3f} {z + _HEIGHT_M / 2:.3f}"/>'
        for k, (x, y), z in zip(alone, xy_m.tolist(), stand_m.tolist(), strict=True)
    )
    low, high = grid.xy_m.min(axis=0) - MARGIN_M, grid.xy_m.max(axis=0) + MARGIN_M
    (x, y), (wide, deep) = (low + high) / 2, (high - low) / 2
    reach = max(half_canopy_m(grid), 0.02)
    surface, lies = _surface(ground, (x, y, wide, deep))
    return f"""<mujoco model="plot">
<option timestep="{step_s}" integrator="implicitfast" cone="elliptic"/>
<visual><global offwidth="1280" offheight="720"/><map zfar="400" znear=".05"/></visual>
<statistic center="{x} {y} 0" extent="30"/>
<asset><texture name="soil" type="2d" builtin="checker" rgb1=".55 .45 .33" rgb2=".52 .42 .3"
 width="256" height="256"/><material name="soil" texture="soil" texrepeat="{wide} {deep}"/>
{surface}</asset>
<default><default class="plant">
 <geom type="cylinder" size="{reach} {_HEIGHT_M / 2}" rgba=".2 .5 .2 1"/></default></default>
<worldbody><light directional="true" pos="0 0 20" dir=".3 .2 -1" diffuse=".8 .8 .8"/>
{lies}{plants}</worldbody></mujoco>"""


def lay_ground(model: object, ground: UnevenGround) -> None:
    """Fill heights in where a compiled world of `world_xml` keeps them: shares of the highest."""
    most_m = max(float(ground.height_m.max()), 1e-3)
    model.hfield_data[:] = (ground.height_m / most_m).ravel()  # type: ignore[attr-defined]


def _surface(
    ground: UnevenGround | None, level: tuple[float, float, float, float]
) -> tuple[str, str]:
    """Return what the ground is made of, and where it lies."""
    x, y, wide, deep = level
    if ground is None:
        lies = f'type="plane" pos="{x} {y} 0" size="{wide} {deep} .1"'
        return "", f'<geom name="ground" {lies} material="soil"/>'
    rows, columns = ground.height_m.shape
    half_x, half_y = ((n - 1) * ground.cell_m / 2 for n in (columns, rows))
    most_m = max(float(ground.height_m.max()), 1e-3)
    place = f"{ground.low_m[0] + half_x} {ground.low_m[1] + half_y} 0"
    made = (
        f'<hfield name="ground" nrow="{rows}" ncol="{columns}" '
        f'size="{half_x} {half_y} {most_m} {_DEEP_M}"/>'
    )
    return (
        made,
        f'<geom name="ground" type="hfield" hfield="ground" pos="{place}" material="soil"/>',
    )
