"""A field with its plants and the ways between them: what everything else is worked out on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.plot.field import Field
from fieldmon.plot.layout import Planting, found_planting, grid_from_plants, lay
from fieldmon.plot.missing_plants import without
from fieldmon.plot.travel import Aisles

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid


def planting_of(field: Field, **given: float | None) -> Planting:
    """Return how a field is planted: as given by hand, else as the field states, else the default.

    Parameters
    ----------
    field
        Its ``row_bearing_deg``, ``row_spacing_m`` and ``plant_spacing_m`` count where not None.
    given
        Settings of `Planting`; None: not given.
    """
    stated = {
        name: getattr(field, name)
        for name in ("row_bearing_deg", "row_spacing_m", "plant_spacing_m")
    }
    by_hand = {name: value for name, value in given.items() if value is not None}
    known = {name: value for name, value in stated.items() if value is not None} | by_hand
    return Planting(**known)


@dataclass(frozen=True, eq=False)
class Plot:
    """A field with its plants and the ways between them."""

    field: Field
    aisles: Aisles

    def __repr__(self) -> str:
        return f"<Plot {self.field.name}: {self.grid.counts}>"

    @property
    def grid(self) -> PlantGrid:
        """Return the plants."""
        return self.aisles.grid

    @classmethod
    def of(cls, field: Field, planting: Planting | None = None) -> Plot:
        """Take a field's measured plants, or lay some, and find the ways between them."""
        if field.plants is not None:
            found = None if planting is None else found_planting(field.plants, planting)
            return cls._with(field, grid_from_plants(field.plants, found, field))
        return cls._with(field, lay(field, planting or planting_of(field)))

    @classmethod
    def around(
        cls,
        name: str,
        plants: NDArray[np.float64],
        planting: Planting | None = None,
        gate: tuple[float, float] | None = None,
    ) -> Plot:
        """Return the plot of measured plants ``(n, 2)`` lon/lat whose boundary nobody drew."""
        found = None if planting is None else found_planting(plants, planting)
        grid = grid_from_plants(plants, found)
        boundary = grid.frame.geometry_lonlat(grid.drivable_m)
        return cls._with(Field(name, boundary, gate=gate, plants=plants), grid)

    def without(self, missing: NDArray[np.bool_]) -> Plot:
        """Return the plot without the plants marked ``(n,)``, which are not there."""
        if not missing.any():
            return self
        return self._with(self.field, without(self.grid, missing))

    @classmethod
    def _with(cls, field: Field, grid: PlantGrid) -> Plot:
        gate = None if field.gate is None else grid.frame.xy_m(field.gate)[0]
        gate_xy_m = None if gate is None else (float(gate[0]), float(gate[1]))
        return cls(field, Aisles.of(grid, gate_xy_m, grid.frame.geometry_m(field.no_go)))
