"""What a season's file keeps of an ancestry on a morning: arrays by name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.infestation.ancestry.ancestry import Ancestry
from fieldmon.infestation.ancestry.ancestry_rates import Rates
from fieldmon.infestation.ancestry.infestations import Infestations
from fieldmon.infestation.insects.jump_landing import SHARES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.pests.pest import Pest
    from fieldmon.plot.grid import PlantGrid


def arrays_of(of: Ancestry) -> dict[str, NDArray[np.generic]]:
    """Return what to keep of an ancestry on a morning, beside the plants."""
    return {
        "start": of.start,
        "missed": of.missed,
        "sends": of.sends,
        "last_find": of.last_find,
        "taken": of.taken,
        "infestations": np.array(of.infestations, np.int64),
        "rates": np.concatenate([of.rates.shares, of.rates[1:]]),
        "at_start": of.at_start,
        "since": np.array([of.arrived, of.began_anew, of.heard, of.idle]),
        "hiding": of.hiding,
        "earlier": of.earlier,
        "taught": of.taught,
        **({} if of.pest is None else {"nights": of.nights}),
    }


def ancestry_of(
    grid: PlantGrid, arrays: dict[str, NDArray[Any]], pest: Pest | None = None
) -> Ancestry:
    """Return what `arrays_of` has kept; raise `ValueError` if it is of other plants."""
    kept: dict[str, Any] = dict(arrays)
    plant, begins, ends, found, parent, children, there, earliest, seen = kept.pop("infestations")
    shares, others = np.split(kept.pop("rates"), [len(SHARES)])
    arrived, anew, heard, idle = kept.pop("since").tolist()
    n = len(grid)
    if any(kept[name].shape[-1:] != (n,) for name in ("start", "missed", "last_find", "taken")):
        raise ValueError(f"An ancestry of {n} plants must have arrays of so many.")
    infestations = Infestations(
        plant, begins, ends, found != 0, parent, children, there != 0, earliest, seen
    )
    rates = Rates(shares, *map(float, others))
    return Ancestry(
        grid, new=(), infestations=infestations, rates=rates,
        arrived=arrived, began_anew=bool(anew),
        heard=int(heard), idle=int(idle), pest=pest, **kept,
    )  # fmt: skip
