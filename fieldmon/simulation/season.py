"""Many working days while the insects spread."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.arguments import must_be_in
from fieldmon.compute.array_arguments import must_be_shaped
from fieldmon.compute.kinds import checked, must_be_of, must_hold_kinds
from fieldmon.compute.ranges import DAYS, AllowedRange
from fieldmon.errors import PlotError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread, night
from fieldmon.infestation.tracing.traced_pairs import TracedPairs, in_sight
from fieldmon.planning.workday import Workday, draw_detections, work_day
from fieldmon.samplers.base import NEVER, Scene, resting_place
from fieldmon.samplers.own import asked
from fieldmon.simulation.insects import NightInsects, PestInsects
from fieldmon.simulation.mornings import MorningBeliefs
from fieldmon.simulation.treating import Sprayed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Sampler, WouldFind
    from fieldmon.simulation.insects import PlotInsects
    from fieldmon.simulation.start import Start
    from fieldmon.simulation.treating import TreatmentRule

    Floats = NDArray[np.float64]
    #: who works for a day, given what each of them would find: all together, and each of a team
    Walk = Callable[[list[WouldFind]], tuple[Workday, tuple[Workday, ...]]]

_HOUR_S, _DAY_S = 3600.0, 86400.0

#: longer than any season
_HIDDEN = AllowedRange(0, 3650)


@checked
@dataclass(frozen=True)
class SimulationSettings:
    """What happens in a simulated season, beside the plot, the robot and the sampler.

    Parameters
    ----------
    n_days
        Days (thesis: 25).
    spread
        What the insects do at night.
    believed_spread
        What the chance map takes them to do; None: the same, also where `own_night` does otherwise.
    learning
        How findings change the chance map; None: with the robot's own detection.
    believe
        How plot and first chance map become a belief.
    own_night
        Which plants are infested the next morning, from the plants, those infested in the
        evening and the night's key; None: as `spread` says.
    hidden_nights
        Nights for which a new infestation spreads and no inspection finds it; 0 for those of the
        first morning.
    pest
        The pest, in the weather of the season's days; None: as `spread` and `own_night` say.
    believed_pest
        The pest and the weather that the chance map knows of; None: the same.
    treating
        By what rule it is treated in the evening, see `TreatmentRule`; None: never.
    visit_every
        Days from one visit to the next, the first on the first day; 1: a visit a day. On the days
        between, nobody inspects or treats.

    Raises
    ------
    SettingError
        If `n_days` or `visit_every` are not 1 to 3650, or `hidden_nights` not 0 to 3650.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.SimulationSettings(n_days=10, spread=fm.Spread(rate_per_day=0.05)).n_days
    10
    >>> weekly = fm.SimulationSettings(visit_every=7)
    >>> weekly.visits, weekly.visit_of(7), weekly.visit_of(8)
    (4, 1, None)
    """

    n_days: int = 25
    spread: Spread = field(default_factory=Spread)
    believed_spread: Spread | None = None
    learning: Learning | None = None
    believe: Callable[[PlantGrid, NDArray[np.float64]], Belief] = TracedPairs.of
    own_night: Callable[[PlantGrid, NDArray[np.bool_], np.uint64], NDArray[np.bool_]] | None = None
    hidden_nights: int = 0
    pest: PestInWeather | None = None
    believed_pest: PestInWeather | None = None
    treating: TreatmentRule | None = None
    visit_every: int = 1

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A season's")
        must_be_in("A season's n_days", DAYS, self.n_days)
        must_be_in("A season's hidden_nights", _HIDDEN, self.hidden_nights)
        must_be_in("A season's visit_every", DAYS, self.visit_every)

    @property
    def visits(self) -> int:
        """Return on how many of its days somebody comes."""
        return visits_in(self.n_days, self.visit_every)

    def visit_of(self, number: int) -> int | None:
        """Return the number of the visit of a day, both from 0; None: nobody comes."""
        visit, days_since = divmod(number, self.visit_every)
        return None if days_since else visit

    def night(
        self, grid: PlantGrid, infested: NDArray[np.bool_], key: np.uint64
    ) -> NDArray[np.bool_]:
        """Return which plants are infested the next morning, ``(n,)``.

        Parameters
        ----------
        grid
            The plants.
        infested
            ``(n,)`` which plants are infested in the evening.
        key
            The night's stream, see `RandomStreams.key`.
        """
        if self.own_night is not None:
            # it may write into what it is given
            morning: NDArray[np.bool_] = asked(
                "A season's own_night", self.own_night, grid, infested.copy(), key
            )
            must_be_of("What a season's own_night returns", "NDArray[np.bool_]", morning)
            must_be_shaped("The next morning's", {"infested plants": (morning, infested.shape)})
            return morning
        return night(grid, infested, self.spread, key)

    def insects(self, grid: PlantGrid, infested: NDArray[np.bool_]) -> PlotInsects:
        """Return what lives on a `grid` of plants, `infested` ``(n,)`` on the first morning."""
        if self.pest is not None:
            return PestInsects(grid, infested, self.pest)
        return NightInsects(grid, infested, self.night, self.hidden_nights)

    def believed_night(self, grid: PlantGrid) -> Callable[[int], Spread]:
        """Return what a chance map of a `grid` takes insects to do in the night after a day."""
        pest = self.believed_pest or self.pest
        if pest is not None and self.believed_spread is None:
            return lambda number: pest.spread(number, grid.frame)
        return lambda _: self.believed_spread or self.spread


def visits_in(n_days: int, visit_every: int) -> int:
    """Return how many visits there are in so many days, the first on the first day.

    Examples
    --------
    >>> visits_in(25, 7)
    4
    """
    return 1 + (n_days - 1) // visit_every


@dataclass(frozen=True, eq=False)
class SimulatedDay:
    """One day of a simulated season.

    Parameters
    ----------
    number
        From 0.
    work
        What was inspected, when, with what result.
    infested
        ``(n,)`` the truth in the morning.
    mornings
        What was believed on the season's mornings.
    last_inspected
        ``(n,)`` day of each plant's last inspection after today's work; -1: never.
    ever_infested
        Infestations so far, this morning's included (a plant infested again counts again).
    ever_found
        Finds so far, today's included.
    visit
        Number of today's visit, from 0; None: nobody came.
    each
        The working day of each of a team; of one alone it is `work`.
    evening
        ``(n,)`` the truth in the evening, where insects move by day; None: the morning's, but for
        the finds.
    sprayed
        What was treated in the evening; None: nothing.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
    >>> day = next(fm.simulate_days(plot, start, "naive"))
    >>> found = day.work.plant[day.work.found]
    >>> day.infested[found].all(), day.in_the_evening[found].any()
    (np.True_, np.False_)
    """

    number: int
    work: Workday
    infested: NDArray[np.bool_]
    mornings: MorningBeliefs
    last_inspected: NDArray[np.int32]
    ever_infested: int
    ever_found: int
    visit: int | None
    each: tuple[Workday, ...] = ()
    evening: NDArray[np.bool_] | None = None
    sprayed: Sprayed | None = None

    @property
    def worked_s(self) -> float:
        """Return the seconds worked today, of all together."""
        return sum(one.end_s for one in self.each or (self.work,))

    @property
    def belief(self) -> Belief:
        """Return what was believed in the morning; worked out now if the sampler did not ask."""
        return self.mornings.on(self.number)

    @property
    def chance(self) -> NDArray[np.float64]:
        """Return the chance of infestation as believed in the morning, ``(n,)``."""
        return self.belief.chance

    @property
    def found(self) -> int:
        """Return the number of plants found infested today."""
        return int(np.count_nonzero(self.work.found))

    @property
    def left(self) -> int:
        """Return the number of infested plants this evening, before the night."""
        return int(np.count_nonzero(self.in_the_evening))

    @property
    def in_the_evening(self) -> NDArray[np.bool_]:
        """Return which plants are infested before the night, ``(n,)``: not found nor cleaned."""
        evening = self.infested.copy() if self.evening is None else self.evening.copy()
        if self.evening is None:
            evening[self.work.plant[self.work.found]] = False
        if self.sprayed is not None:
            evening &= ~self.sprayed.cleaned
        return evening

    @property
    def detection_pct(self) -> float:
        """Return all finds so far in percent of all infestations so far (100 if none)."""
        return 100.0 * self.ever_found / self.ever_infested if self.ever_infested else 100.0

    @property
    def visited_pct(self) -> float:
        """Return the plants inspected today in percent of all plants."""
        return 100.0 * len(self.work) / len(self.infested)

    @property
    def ever_visited_pct(self) -> float:
        """Return the plants inspected so far in percent of all plants."""
        return 100.0 * float(np.mean(self.last_inspected >= 0))


def simulated_days(
    aisles: Aisles,
    robot: Robot,
    sampler: Sampler,
    start: Start,
    settings: SimulationSettings,
    streams: RandomStreams,
) -> Iterator[SimulatedDay]:
    """Yield the days of a season, one by one, as they happen.

    Found insects are destroyed at once; missed ones stay and spread at night. Random streams:
    ``inspect/day``, ``spread/day`` and ``sampler/day``, so that every sampler meets the same
    insects, and would find the same ones on a plant.
    """
    check_start(aisles, start)
    season = RunningSeason(aisles, robot, sampler, start, settings)
    keys = zip(*(streams.keys(name) for name in ("sampler", "inspect", "spread")), strict=True)
    for number, (own, inspect, overnight) in zip(range(settings.n_days), keys, strict=False):
        if settings.visit_of(number) is None:
            day = season.worked(number, Workday.of_nobody())
        elif season.moves_by_day:
            day = season.work_by_hour(number, own, inspect, overnight)
        else:
            day = season.work(number, own, inspect)
        yield day
        season.pass_night(day, overnight)


class RunningSeason:
    """A season on its way: what a day changes, and how."""

    def __init__(
        self,
        aisles: Aisles,
        robot: Robot,
        sampler: Sampler,
        start: Start,
        settings: SimulationSettings,
    ) -> None:
        self.aisles, self.robot, self.sampler, self.settings = aisles, robot, sampler, settings
        self.first_chance = start.chance
        self.insects = settings.insects(aisles.grid, start.infested)
        self.detects = sampler.inspection_times(robot).detects
        self.mornings = morning_beliefs(
            aisles.grid, robot, start, settings, chooses_time=len(self.detects) > 1
        )
        self.last_inspected = np.full(len(self.infested), NEVER, np.int32)
        self.ever_infested, self.ever_found = int(np.count_nonzero(self.infested)), 0
        self.trail = np.empty(0, np.int32)
        self.last_treated: int | None = None
        self._found_last: NDArray[np.int32] | None = None

    @property
    def infested(self) -> NDArray[np.bool_]:
        """Which plants are infested now, ``(n,)``."""
        return self.insects.infested

    @property
    def moves_by_day(self) -> bool:
        """Tell whether insects move while the robot works."""
        return isinstance(self.insects, PestInsects) and self.insects.by_hour

    def work(self, number: int, own_key: np.uint64, inspect_key: np.uint64) -> SimulatedDay:
        """Work for a day; return what came of it."""
        would_find = draw_detections(self.showing(number), self.detects, inspect_key)
        return self.worked(number, work_day(self.scene(number, own_key), self.sampler, would_find))

    def work_by_hour(
        self, number: int, own_key: np.uint64, inspect_key: np.uint64, spread_key: np.uint64
    ) -> SimulatedDay:
        """Work for a day in whose hours insects move; return what came of it."""
        scene = self.scene(number, own_key)

        def walk(would_find: list[WouldFind]) -> tuple[Workday, tuple[Workday, ...]]:
            return work_day(scene, self.sampler, would_find[0]), ()

        return self.by_hour(number, walk, [self.detects], (inspect_key, spread_key))

    def by_hour(
        self, number: int, walk: Walk, detects: list[Floats], keys: tuple[np.uint64, np.uint64]
    ) -> SimulatedDay:
        """Return what comes of a day in whose hours insects move while somebody works.

        A plant is as it is in the hour in which it is inspected.

        Parameters
        ----------
        walk
            Who works.
        detects
            What each of them detects, by inspection time.
        keys
            Name the coins of the day's inspections and of its insects.
        """
        inspect_key, spread_key = keys
        morning, insects = self.infested, self.insects

        def would_be_found() -> list[WouldFind]:
            showing = self.showing(number)
            return [draw_detections(showing, each, inspect_key) for each in detects]

        would_find = would_be_found()
        (work, each), gone_s = walk(would_find), 0.0
        seen = np.zeros(len(morning), np.bool_)
        while isinstance(insects, PestInsects) and gone_s + _HOUR_S <= min(work.end_s, _DAY_S):
            gone_s += _HOUR_S
            passed = (work.arrive_s < gone_s) & ~seen[work.plant]
            self.ever_infested += insects.pass_hour(
                work.plant[passed & work.found], number, spread_key
            )
            seen[work.plant[passed]] = True
            # what was seen stays seen; what lies ahead may be another matter now
            now = [np.where(seen, a, b) for a, b in zip(would_find, would_be_found(), strict=True)]
            ahead = work.plant[~seen[work.plant]]
            changed = any(
                (a[ahead] != b[ahead]).any() for a, b in zip(now, would_find, strict=True)
            )
            would_find = now
            if changed:
                work, each = walk(would_find)
        self._found_last = work.plant[~seen[work.plant] & work.found]
        evening = self.infested.copy()
        evening[self._found_last] = False
        return replace(self.worked(number, work, each), infested=morning, evening=evening)

    def showing(self, number: int) -> NDArray[np.bool_]:
        """Return where an inspection may find something on a day, ``(n,)``."""
        return self.insects.showing(number)

    def worked(self, number: int, work: Workday, each: tuple[Workday, ...] = ()) -> SimulatedDay:
        """Note what was done on a day; return it."""
        self.last_inspected = self.last_inspected.copy()
        self.last_inspected[work.plant] = number
        self.ever_found += int(np.count_nonzero(work.found))
        return SimulatedDay(
            number,
            work,
            self.infested,
            self.mornings,
            self.last_inspected,
            self.ever_infested,
            self.ever_found,
            self.settings.visit_of(number),
            each,
            sprayed=self._treat(number, work),
        )

    def _treat(self, number: int, work: Workday) -> Sprayed | None:
        """Return what is treated on an evening by the season's rule."""
        rule, last = self.settings.treating, self.last_treated
        if (
            rule is None
            or self.settings.visit_of(number) is None
            or (last is not None and number - last < rule.every_days)
        ):
            return None
        zones = rule.treated(self.aisles.grid, self.mornings.evening(number, work).chance)
        if zones is None:
            return None
        self.last_treated = number
        return Sprayed(zones, rule.cleaned(zones, number), rule.costs.works)

    def pass_night(self, day: SimulatedDay, key: np.uint64) -> None:
        """Destroy what was found or sprayed, and let the others spread."""
        work, number = day.work, self.mornings.known
        self.mornings.add(work, None if day.sprayed is None else day.sprayed.left)
        # what was found in an hour that has passed is destroyed; insects may have come since
        gone = work.plant[work.found] if self._found_last is None else self._found_last
        self._found_last = None
        if day.sprayed is not None:
            gone = np.union1d(gone, np.flatnonzero(day.sprayed.cleaned)).astype(np.int32)
        self.ever_infested += self.insects.pass_night(gone, number, key)
        self.trail = work.plant if len(work) else self.trail

    def scene(self, number: int, key: np.uint64) -> Scene:
        """Return the scene of a morning."""
        belief = self.mornings.on(number) if self.sampler.reads_chance else None
        belief = belief and in_sight(belief)
        return Scene(
            aisles=self.aisles,
            robot=self.robot,
            chance=self.first_chance if belief is None else belief.chance,
            pair_chance=None if belief is None else belief.pair_chance,
            traces=None if belief is None else belief.traces,
            last_inspected=self.last_inspected,
            day=number,
            at=resting_place(self.robot, self.trail),
            seconds_left=self.robot.day_s,
            trail=self.trail,
            key=key,
        )


def morning_beliefs(
    grid: PlantGrid,
    robot: Robot,
    start: Start,
    settings: SimulationSettings,
    *,
    chooses_time: bool,
) -> MorningBeliefs:
    """Return what will be believed on the mornings of a season."""
    usual = settings.learning or Learning(detection=robot.detects)

    def first() -> Belief:
        belief, pest = settings.believe(grid, start.chance), settings.believed_pest or settings.pest
        if pest is not None and isinstance(belief, TracedPairs):
            return belief.of_pest(pest.pest)
        return belief

    def learning(work: Workday) -> Learning:
        return replace(usual, detection=work.detects) if chooses_time else usual

    return MorningBeliefs(first, learning, settings.believed_night(grid))


def check_start(aisles: Aisles, start: Start) -> None:
    """Raise `PlotError` if a start is of another plot."""
    n = len(aisles.grid)
    for name, values in (("infested", start.infested), ("chance", start.chance)):
        if len(values) != n:
            raise PlotError(
                f"The start of a season must have one entry a plant ({n}), "
                f"but {name} has {len(values)}."
            )
