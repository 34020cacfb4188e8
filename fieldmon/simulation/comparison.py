"""Samplers compared on a plot, over seasons in which all of them meet the same insects."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be_in, shown
from fieldmon.compute.array_arguments import chances_of, must_hold_shapes
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import PAIRED, SHARE
from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import SIMULATED_PER_DAY, Spread
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler_or_name
from fieldmon.samplers.checked_sampler import Checked
from fieldmon.samplers.own import label_of
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Memory, run
from fieldmon.simulation.paired_seasons import SameInsects, met_by_all, paired
from fieldmon.simulation.season import SimulationSettings
from fieldmon.simulation.statistics import paired_ratio, too_few_sentence
from fieldmon.simulation.treating import WHOLE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import NDArray
    from pandas import DataFrame

    from fieldmon.compute.array_arguments import Column
    from fieldmon.plot.plot import Plot
    from fieldmon.samplers.base import Sampler
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.statistics import Ratio

    Samplers = Sequence[str | Sampler] | Mapping[str, str | Sampler]

# arrays of a comparison, as they are called in a season
_COLUMNS = "detection_pct", "visited_pct", "found", "left", "worked_h"
# whom an infested plant infests, by `Spread.to`
_WHOM = {"each": "each neighbour", "one": "one neighbour", "all": "all neighbours"}


def _usual_season() -> SimulationSettings:
    """Return a season as the commands simulate it."""
    return SimulationSettings(spread=Spread(SIMULATED_PER_DAY))


@dataclass(frozen=True)
class CompareSettings:
    """On what seasons samplers are compared, and who works.

    Parameters
    ----------
    seeds
        Simulated seasons for each sampler, of seeds 1, 2 and so on: 2 or more.
    share
        Share of all plants infested at the start on average, above 0 and below 1.
    robot
        Who inspects.
    season
        Days, visits, and what insects do at night. By default an infested plant infests each
        neighbour with a chance of 0.1 a night, as in ``fieldmon compare`` and ``simulate``; a
        `SimulationSettings` of your own has the thesis's 0.5 unless you give `spread`.

    Examples
    --------
    >>> import fieldmon as fm
    >>> settings = fm.CompareSettings(seeds=50, season=fm.SimulationSettings(n_days=10))
    >>> settings.robot.hours
    12.0
    >>> fm.CompareSettings().season.spread.rate_per_day
    0.1
    """

    seeds: int = 20
    share: float = 0.02
    robot: Robot = field(default_factory=Robot)
    season: SimulationSettings = field(default_factory=_usual_season)

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A comparison's")
        must_be_in("A comparison's seeds", PAIRED, self.seeds)
        must_be_in("A comparison's share", SHARE, self.share)


@checked
@dataclass(frozen=True, eq=False)
class Comparison:
    """What k samplers came to in the same s simulated seasons of d days.

    Entry ``[i, j]`` of each array is of the i-th sampler and the j-th seed.

    Parameters
    ----------
    samplers
        The k names under which samplers were compared.
    seeds
        ``(s,)`` the seasons that every sampler has been through.
    detection_pct
        ``(k, s, d)`` all finds so far in percent of all infestations so far, each evening.
    visited_pct
        ``(k, s, d)`` plants inspected on each day in percent of all plants.
    found
        ``(k, s, d)`` plants found infested on each day.
    left
        ``(k, s, d)`` infested plants after each day's work.
    worked_h
        ``(k, s, d)`` hours worked on each day.
    season
        What the seasons were; None: nobody said.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> chance = fm.plan_day(plot, on="2026-11-18").chance
    >>> short = fm.CompareSettings(seeds=3, season=fm.SimulationSettings(n_days=4))
    >>> made = fm.compare(plot, chance, ("bouncy", "naive"), settings=short)
    >>> made.left.shape, made.infested_plant_days.shape
    ((2, 3, 4), (2, 3))
    """

    samplers: tuple[str, ...]
    seeds: NDArray[np.int64]
    detection_pct: NDArray[np.float64]
    visited_pct: NDArray[np.float64]
    found: NDArray[np.int64]
    left: NDArray[np.int64]
    worked_h: NDArray[np.float64]
    season: SimulationSettings | None = None

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A comparison's")
        days = len(self.samplers), len(self.seeds), self.left.shape[-1]
        must_hold_shapes(self, "A comparison's", dict.fromkeys(_COLUMNS, days))

    def __repr__(self) -> str:
        return f"<Comparison: {', '.join(self.samplers)}, {self._seasons('season')}>"

    def _seasons(self, what: str) -> str:
        n = len(self.seeds)
        return f"{n:,} {what}{'s' * (n != 1)}"

    @property
    def infested_plant_days(self) -> NDArray[np.int64]:
        """Return the sum over all evenings of the plants still infested, ``(k, s)``."""
        lost: NDArray[np.int64] = self.left.sum(axis=2)
        return lost

    def ratios(self, against: str) -> dict[str, Ratio]:
        """Return the infested plant-days of each other sampler over those of one.

        Each with its 95 % interval, by bootstrap over the seeds that both met.

        Parameters
        ----------
        against
            Name of the sampler that the others are held against.

        Raises
        ------
        SettingError
            If no sampler of that name was compared.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> chance = fm.plan_day(plot, on="2026-11-18").chance
        >>> short = fm.CompareSettings(seeds=3, season=fm.SimulationSettings(n_days=4))
        >>> made = fm.compare(plot, chance, ("bouncy", "naive"), settings=short)
        >>> ratio = made.ratios("naive")["bouncy"]
        >>> ratio.low <= ratio.value <= ratio.high
        True
        """
        if against not in self.samplers:
            raise SettingError(
                f"'against' must be one of {', '.join(self.samplers)}, which were compared, but it "
                f"is {shown(against)}."
            )
        lost = dict(zip(self.samplers, self.infested_plant_days.astype(np.float64), strict=True))
        return {
            name: paired_ratio(one, lost[against]) for name, one in lost.items() if name != against
        }

    def to_pandas(self) -> DataFrame:
        """Return a line for each sampler, seed and day (from 1), with a column for each array.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> chance = fm.plan_day(plot, on="2026-11-18").chance
        >>> short = fm.CompareSettings(seeds=3, season=fm.SimulationSettings(n_days=4))
        >>> days = fm.compare(plot, chance, ("bouncy", "naive"), settings=short).to_pandas()
        >>> days.groupby(["sampler", "seed"]).left.sum().shape
        (6,)
        """
        import pandas as pd  # noqa: PLC0415 - loaded when it is asked for

        shape = self.left.shape
        sampler, seed, day = (one.ravel() for one in np.indices(shape))
        columns = {name: getattr(self, name).ravel() for name in _COLUMNS}
        names = np.array(self.samplers, object)[sampler]
        return pd.DataFrame({"sampler": names, "seed": self.seeds[seed], "day": day + 1, **columns})

    def sentence(self, against: str) -> str:
        """Return the ratios for people, what the seasons were, and whether they are too few.

        Parameters
        ----------
        against
            As `ratios` takes it.

        Raises
        ------
        SettingError
            As `ratios` does.
        """
        ratios, n = self.ratios(against), len(self.seeds)
        if not n:
            return "No seed has been met by every sampler yet."
        seasons = self._seasons("simulated season")
        if not ratios:
            return f"Only {against} was compared, in {seasons}: there is no other to hold it to."
        said = "; ".join(f"{name} {ratio}" for name, ratio in ratios.items())
        of = "" if self.season is None else f" ({_in_words(self.season)})"
        first = f"Infested plant-days over those of {against}, in {seasons}{of}: {said}."
        return f"{first} {too_few_sentence(n, 'seeds')}".rstrip()


def _in_words(season: SimulationSettings) -> str:
    """Return for people what happens in a season: its insects, who comes when, treatments."""
    said = [_insects(season)]
    if season.pest is None and season.hidden_nights:
        said.append(f"new infestations hide for {counted(season.hidden_nights, 'night')}")
    if season.visit_every > 1:
        said.append(f"a visit every {season.visit_every} days")
    if season.treating is not None:
        what = "the plot" if season.treating.treats == WHOLE else "zones"
        said.append(f"{what} treated from {100 * season.treating.level:.3g} % infested on")
    return "; ".join(said)


def _insects(season: SimulationSettings) -> str:
    """Return for people what the insects of a season do at night."""
    if season.pest is not None:
        return f"pest {season.pest.pest.name}"
    if season.own_night is not None:
        return "insects of your own"
    whom, rate = _WHOM[season.spread.to], 100 * season.spread.rate_per_day
    said = f"infested plants infest {whom} with a chance of {rate:.3g} % a night"
    if arrivals := season.spread.arrivals_per_day:
        said += f", and {100 * arrivals:.3g} % of the others are infested from outside"
    return said


@checked
def compare(
    plot: Plot,
    chance: Column,
    samplers: Samplers = ("adaptive", "dynamic", "naive"),
    *,
    settings: CompareSettings | None = None,
    stop: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Comparison:
    """Compare samplers on a plot, in simulated seasons of the same insects.

    All samplers meet the insects of every seed: the same start, the same nights, and the same
    detection at the same plant. Seed s is the season that `simulate` makes of
    ``draw_start(plot, chance, share, seed=s)`` and ``seed=s``, so that seasons of two calls are
    paired, too.

    Parameters
    ----------
    plot
        Plants and the ways between them.
    chance
        ``(n,)`` chance of infestation as believed on the first morning, in 0..1, for instance
        `DayPlan.chance`.
    samplers
        Names of samplers, or samplers of your own, which go by the names of their classes; or a
        dict of them by names of your choice. Several threads simulate, unless one is your own.
    settings
        Seasons, share infested, robot, days; None: as `CompareSettings` has them.
    stop
        Asked before each season whether to stop. What every sampler has been through is returned.
    progress
        Told how many seasons are done, and of how many.

    Returns
    -------
    Comparison
        Arrays ``(k, s, d)``: samplers, seeds, days.

    Raises
    ------
    SettingError
        If there is no such sampler, two share a name, there is none, `chance` does not fit the
        plants, or one of your own names no plant on the first day.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> chance = fm.plan_day(plot, on="2026-11-18").chance
    >>> short = fm.CompareSettings(seeds=3, season=fm.SimulationSettings(n_days=4))
    >>> made = fm.compare(plot, chance, ("bouncy", "naive"), settings=short)
    >>> made
    <Comparison: bouncy, naive, 3 seasons>
    >>> made.sentence("naive").startswith("Infested plant-days over those of naive, in 3 simul")
    True
    """
    chosen, decide = settings or CompareSettings(), _by_name(samplers)
    insects = SameInsects(plot, chances_of(chance, plot.n_plants), chosen.share, chosen.season)
    experiment = paired(
        [*decide],
        range(1, chosen.seeds + 1),
        lambda name, seed: insects.season(decide[name], chosen.robot, seed),
    )
    made: Memory[SeasonMetrics] = Memory()
    # what one of a caller's own keeps in mind is of one season at a time
    own = any(isinstance(one, Checked) for one in decide.values())
    with nullcontext(executor.here()) if own else executor.threads() as workers:
        run(experiment, workers, made, progress, stop or (lambda: False))
    by_seed = met_by_all(experiment, made)
    shape = len(decide), len(by_seed), chosen.season.n_days
    columns: dict[str, Any] = {name: _column(name, by_seed.values(), shape) for name in _COLUMNS}
    seeds = np.array([*by_seed], np.int64)
    return Comparison(tuple(decide), seeds, **columns, season=chosen.season)


def _column(
    name: str, by_seed: Iterable[list[SeasonMetrics]], shape: tuple[int, int, int]
) -> NDArray[Any]:
    """Return one column of all seasons, ``(k, s, d)``."""
    columns = np.empty(shape, np.int64 if name in ("found", "left") else np.float64)
    for seed, seasons in enumerate(by_seed):
        columns[:, seed] = [getattr(season, name) for season in seasons]
    return columns


def _by_name(samplers: Samplers) -> dict[str, Sampler]:
    """Return samplers by the names under which they are compared."""
    if isinstance(samplers, dict):
        named = [*samplers.items()]
    elif isinstance(samplers, list | tuple):
        named = [(_name(one), one) for one in samplers]
    else:
        raise SettingError(
            "'samplers' of compare must be a list of names or samplers, or a dict of them by name, "
            f"but it is {shown(samplers)}. Give ('adaptive', 'naive')."
        )
    names = [name for name, _ in named]
    if not names or len(set(names)) < len(names) or not all(isinstance(n, str) for n in names):
        raise SettingError(
            "'samplers' of compare must have one sampler or more, of different names, but they are "
            f"{', '.join(map(str, names)) or 'none'}. Give a dict of them by name."
        )
    return {name: sampler_or_name(one) for name, one in named}


def _name(sampler: str | Sampler) -> str:
    return label_of(sampler) if isinstance(sampler, str) else type(sampler).__name__
