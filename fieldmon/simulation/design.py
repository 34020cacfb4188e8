"""What a study compares, and how it is cut into chunks that take seconds."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields, replace
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

from fieldmon.compute.arguments import must_be_in
from fieldmon.compute.digest import digest
from fieldmon.compute.ranges import DAYS
from fieldmon.errors import SettingError
from fieldmon.plot.robot import USUAL_TIMES, Robot
from fieldmon.samplers import COMPARED, kind_of, sampler_or_name
from fieldmon.samplers.own import is_own, label_of, labels_of, own_text
from fieldmon.simulation.experiment import Experiment
from fieldmon.simulation.season import visits_in
from fieldmon.simulation.start import must_be_start_share
from fieldmon.simulation.study_plot import DIGITS, Combination, StudyPlot, as_written
from fieldmon.simulation.worker import simulate_chunk

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.simulation.worker import ChunkSeasons, Setting

# a chunk takes about so long; what seasons cost was measured, see docs/benchmarks
_CHUNK_S = 4.0
_S_PER_DAY = 3e-4
# likewise for each plant, of a sampler of which nothing is known
_S_OF_OWN = 1e-5
# changes when seasons come out differently, so that old chunks are not taken for new ones
_VERSION = "4"


@dataclass(frozen=True)
class Design:
    """All that is compared: every sampler with every setting and every seed.

    Parameters
    ----------
    samplers
        Names in `fieldmon.samplers.SAMPLERS`, or files of your own as ``my_sampler.py:Mine``.
    hours, look_s, infested, spread
        The levels of each factor, see `Combination`.
    n_days, visit_every
        Days of a season, and how many from one visit to the next.
    n_seeds, first_seed
        Seasons of each combination; season k starts from seed ``first_seed + k`` in all of them.
    robot_times
        What the robot is charged besides driving and inspecting, see `Robot.with_times`.
    """

    samplers: tuple[str, ...] = COMPARED
    hours: tuple[float, ...] = (12.0,)
    look_s: tuple[float, ...] = (40.0,)
    infested: tuple[float, ...] = (0.02,)
    spread: tuple[float, ...] = (0.1,)
    n_days: int = 25
    n_seeds: int = 100
    first_seed: int = 1
    robot_times: str = USUAL_TIMES
    visit_every: int = 1

    def __post_init__(self) -> None:
        for name in self.samplers:
            sampler_or_name(name)
        Robot().with_times(self.robot_times)
        labels_of(self.samplers)
        for named in fields(self)[:5]:
            values = getattr(self, named.name)
            if not values or len(set(values)) < len(values):
                raise SettingError(
                    f"A study needs one value of {named.name} or more, each once, "
                    f"but they are {values}."
                )
        if self.n_days < 1 or self.n_seeds < 1 or self.first_seed < 0:
            raise SettingError(
                "A study needs 1 day and 1 seed or more, seeds from 0, but it has "
                f"days {self.n_days} and seeds {self.n_seeds}, from {self.first_seed}."
            )
        must_be_in("A study's visit_every", DAYS, self.visit_every)
        for share in self.infested:
            must_be_start_share(share)

    @property
    def content(self) -> dict[str, Any]:
        """Return what it says, as folders of studies keep it.

        What later versions added counts only where it is said: studies of before can go on.
        """
        said = asdict(self)
        usual = {"robot_times": USUAL_TIMES, "visit_every": 1, "own_code": {}}
        own = [name for name in self.samplers if is_own(name)]
        said["own_code"] = {label_of(name): digest(own_text(name), length=DIGITS) for name in own}
        return {name: value for name, value in said.items() if value != usual.get(name)}

    @property
    def combinations(self) -> tuple[Combination, ...]:
        """Return every level of each factor with every level of the others."""
        values = (self.samplers, self.hours, self.look_s, self.infested, self.spread)
        return tuple(Combination(*each) for each in product(*values))


def study_of(plots: Sequence[StudyPlot], design: Design) -> Experiment[Setting, ChunkSeasons]:
    """Return a design on plots as an experiment, every plot with every combination.

    Its keys are a sampler and a digest of all that its seasons depend on, and of nothing else.
    """
    (n_days, every), times = (design.n_days, design.visit_every), design.robot_times
    unusual = [times] if times != USUAL_TIMES else []
    unusual += [f"a visit every {every} days"] if every > 1 else []
    visits = visits_in(n_days, every)
    # an own sampler's seasons hang on its text, read once for all chunks
    own = {name: (own_text(name),) if is_own(name) else () for name in design.samplers}

    def key(setting: Setting, seeds: range) -> tuple[str, str]:
        plot, levels = setting
        label = label_of(levels.sampler)
        written = as_written(replace(levels, sampler=label))
        parts = (
            plot.digest,
            written,
            (seeds.start, seeds.stop),
            n_days,
            *own[levels.sampler],
            *unusual,
        )
        return label, digest(_VERSION, *parts, length=DIGITS)

    return Experiment(
        settings=list(product(plots, design.combinations)),
        seeds=range(design.first_seed, design.first_seed + design.n_seeds),
        simulate=partial(simulate_chunk, n_days=n_days, robot_times=times, visit_every=every),
        chunk_size=lambda setting: _seasons(setting[1].sampler, setting[0].about_plants, visits),
        key=key,
    )


def _seasons(sampler: str, n_plants: int, n_days: int) -> int:
    """Return how many seasons take about `_CHUNK_S`."""
    per_plant_s = _S_OF_OWN if is_own(sampler) else kind_of(sampler).s_per_plant_day
    day_s = _S_PER_DAY + n_plants * per_plant_s
    return math.ceil(_CHUNK_S / (n_days * day_s))
