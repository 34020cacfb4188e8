"""A few seconds of a study: the seasons of one chunk."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior import PriorSettings, prior_chance
from fieldmon.infestation.spread import Spread
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import LEVELS_PCT, figures
from fieldmon.simulation.season import SeasonSettings, days
from fieldmon.simulation.start import season_start

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.simulation.design import Chunk, Site
    from fieldmon.simulation.metrics import SeasonFigures

_LEVELS = {f"d{level:g}": level for level in LEVELS_PCT}
SCHEMA = pa.schema(
    [
        *((name, pa.string()) for name in ("plot", "sampler")),
        *((name, pa.float64()) for name in ("hours", "look_s", "infested", "spread")),
        *((name, pa.int64()) for name in ("seed", "days", "plants")),
        *((name, pa.float64()) for name in ("detection_pct", "visited_pct", "ever_visited_pct")),
        *((name, pa.int64()) for name in ("infestations", "found", "left", "infested_plant_days")),
        *((name, pa.int32()) for name in _LEVELS),
        *((name, pa.list_(pa.int32())) for name in ("found_by_day", "left_by_day")),
    ]
)
# sites laid and kept by a process, for the next chunk
_KEPT = 4


def run_chunk(chunk: Chunk) -> pa.Table | FieldmonError:
    """Simulate the seasons of a chunk; return a row of `SCHEMA` for each, by seed.

    It depends on the chunk alone: all samplers meet the same insects of a seed. A plot that cannot
    carry plants comes back as its error, for thousands of others are none the worse for it.
    """
    try:
        plot, chance = _laid(chunk.site.digest, _Held(chunk.site))
    except FieldmonError as error:
        return error
    rows = [_row(chunk, plot, chance, seed) for seed in range(*chunk.seeds)]
    return pa.Table.from_pylist(rows, SCHEMA)


class _Held:
    """Something beside the key of a cache: equal to anything of its kind."""

    def __init__(self, site: Site) -> None:
        self.site = site

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Held)

    def __hash__(self) -> int:
        return 0


@lru_cache(maxsize=_KEPT)
def _laid(digest: str, held: _Held) -> tuple[Plot, NDArray[np.float64]]:  # noqa: ARG001 - the key
    """Return the plot of a site and its chances of infestation."""
    site = held.site
    plot = Plot.of(site.field, site.planting)
    prior = prior_chance(plot.grid, plot.field, site.observations, site.day, PriorSettings())
    return plot, prior


def _row(chunk: Chunk, plot: Plot, chance: NDArray[np.float64], seed: int) -> dict[str, Any]:
    case, streams = chunk.case, RandomStreams(seed)
    settings = SeasonSettings(n_days=chunk.n_days, spread=Spread(case.spread))
    robot = Robot(hours=case.hours, look_s=case.look_s)
    start = season_start(plot.grid, chance, case.infested, streams)
    season = figures(days(plot.aisles, robot, sampler(case.sampler), start, settings, streams))
    return {
        "plot": plot.field.name,
        **vars(case),
        "seed": seed,
        "days": chunk.n_days,
        "plants": len(plot.grid),
        **_measures(season),
    }


def _measures(season: SeasonFigures) -> dict[str, Any]:
    return {
        "detection_pct": float(season.detection_pct[-1]),
        "visited_pct": float(season.visited_pct.mean()),
        "ever_visited_pct": float(season.ever_visited_pct[-1]),
        "infestations": int(season.new.sum()),
        "found": int(season.found.sum()),
        "left": int(season.left[-1]),
        "infested_plant_days": season.infested_plant_days,
        **{name: season.first_day(level) for name, level in _LEVELS.items()},
        "found_by_day": season.found.tolist(),
        "left_by_day": season.left.tolist(),
    }
