"""Ask and tell: a sampler asked plant by plant, by a robot or by a simulator of one's own.

Nothing is kept on disk; see `fieldmon.monitoring.season.season_file` for a season that lasts.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Self

import numpy as np

from fieldmon.compute.arguments import must_be_in
from fieldmon.compute.array_arguments import chances_of
from fieldmon.compute.arrays import as_seen
from fieldmon.compute.kinds import checked, must_be_of
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.compute.ranges import DAYS
from fieldmon.decisions.map_verdict import verdict_of
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.forecast import NIGHTS, forecast
from fieldmon.infestation.insects.pest_in_weather import seen_in_weather
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.infestation.tracing.traced_pairs import in_hindsight, in_sight
from fieldmon.monitoring.estimates.asked_day import AskedDay, PlantToInspect, plant_to_inspect
from fieldmon.monitoring.estimates.still_infested import not_found_yet, still_certain
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.planning.plan import plan_in
from fieldmon.planning.skips import Skips, without_flagged, without_skipped
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.plot import must_be_plot
from fieldmon.plot.robot import Robot, must_be_robot
from fieldmon.samplers import sampler_or_name
from fieldmon.samplers.base import NEVER, Scene, resting_place
from fieldmon.samplers.checked_sampler import must_detect

if TYPE_CHECKING:
    from types import TracebackType

    from numpy.typing import NDArray

    from fieldmon.compute.array_arguments import Column
    from fieldmon.decisions.map_verdict import MapVerdict
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.plot import Plot
    from fieldmon.samplers.base import Sampler, Stops, WouldFind

# told clocks are compared with charged ones to a millisecond
_SAME_S = 1e-3


class Monitor:
    """A season in memory: days that are asked and told, and nights that are believed.

    Asked and told as the simulator draws, a day is the compiled one, stop for stop.

    Parameters
    ----------
    plot
        The plot and its plants.
    sampler
        Name of a sampler, or one of your own (see `fieldmon.samplers.base.Sampler`).
    robot
        Who inspects; None: the usual `Robot`, which sees the `pest` as its file says.
    chance
        ``(n,)`` chance of infestation on the first morning; None: what is believed of a plot
        without records.
    belief_settings
        What the insects are taken to do at night, and whether finds are treated; None: the
        defaults of a monitored season.
    seed
        For samplers that draw.
    pest
        What is looked for, in the weather of the days to come, which then says what insects do at
        night; None: as `belief_settings` says.

    Raises
    ------
    SettingError
        If `plot` is none, there is no such sampler, `chance` does not fit the plants, inspections
        of the robot can find nothing, or a pest's finds are not traced.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> monitor = fm.Monitor(plot, sampler="naive", robot=fm.Robot(hours=1))
    >>> with monitor.day() as day:
    ...     while (stop := day.ask()) is not None:
    ...         day.tell(found=stop.plant % 20 == 0)
    >>> len(day.plants), int(day.found.sum())
    (72, 4)
    >>> monitor.night()
    >>> monitor.chance.shape == (len(plot.grid),)
    True
    """

    def __init__(  # noqa: PLR0913 - each has its default, and is named where it has not
        self,
        plot: Plot,
        sampler: str | Sampler = "adaptive",
        robot: Robot | None = None,
        chance: Column | None = None,
        belief_settings: BeliefSettings | None = None,
        seed: int = 1,
        *,
        pest: PestInWeather | None = None,
    ) -> None:
        must_be_plot(plot)
        must_be_robot(robot)
        must_be_of("'belief_settings' of Monitor", "BeliefSettings | None", belief_settings)
        must_be_of("A seed", "int", seed)
        must_be_of("'pest' of Monitor", "PestInWeather | None", pest)
        self.plot = plot
        self.robot = robot or seen_in_weather(Robot(), pest)
        self.belief_settings = belief_settings or BeliefSettings()
        if pest is not None and not self.belief_settings.traces:
            raise SettingError("A pest needs its finds traced. Give BeliefSettings(traces=True).")
        self.pest = pest
        self.day_number = 0
        self._sampler = sampler_or_name(sampler)
        must_detect(self._sampler, self.robot)
        self._streams = RandomStreams(int(seed))
        first = _first_chance(plot, chance)
        self._belief: Belief = self.belief_settings.first_morning(
            plot.grid, first, None if pest is None else pest.pest, self.robot.detects
        )
        self._last_inspected = np.full(len(plot.grid), NEVER, np.int32)
        # (2, k) plants that could not be inspected, and the day of each
        self._skipped = np.empty((2, 0), np.int64)
        self._trail = np.empty(0, np.int32)
        self._found = np.zeros(len(plot.grid), np.bool_)
        self._last_told = self._belief, self._belief
        self._day: MonitorDay | None = None

    def __repr__(self) -> str:
        """Say which plot, who decides, and how far the season is."""
        who = type(getattr(self._sampler, "own", self._sampler)).__name__
        return f"<Monitor {self.plot.field.name}: {who}, day {self.day_number + 1}>"

    @property
    def chance(self) -> NDArray[np.float64]:
        """Believed chance of infestation now, ``(n,)``; it cannot be written to.

        While a day is under way, that of its morning.
        """
        return as_seen(self._told.chance)

    @checked
    def estimate(self, sure: float = 0.9) -> PlotEstimate:
        """Return how many plants are believed infested and not found yet, as `Season.status` does.

        Parameters
        ----------
        sure
            Chance that the interval holds the number.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> made = fm.Monitor(plot).estimate()
        >>> made.low < made.expected < made.high, round(made.chance_clean, 2)
        (True, 0.0)
        """
        return not_found_yet(self.plot.grid, self._told, self._left, sure)

    @checked
    def verdict(self, level: float, sure: float = 0.9) -> MapVerdict:
        """Return whether treating pays from a share `level` of infested plants on; see `Season`.

        Parameters
        ----------
        level
            Share of infested plants from which treating pays, between 0 and 1.
        sure
            How likely the answer must be to be right.
        """
        said = verdict_of(self.plot.grid, self._told, level, sure, self._left)
        return said.where(inspected=bool((self._last_inspected != NEVER).any()))

    @checked
    def forecast(self, nights: int = NIGHTS) -> Forecast:
        """Return how many are infested after each of so many `nights` if nobody inspects."""
        must_be_in("A forecast's nights", DAYS, nights)
        ahead, known, measured = range(self.day_number, self.day_number + nights), None, 0
        if (pest := self.pest) is not None and pest.weather is not None:
            known = sum(pest.known(number) for number in ahead)
            measured = sum(pest.measured(number) for number in ahead)
        spreads = [self._spread(number) for number in ahead]
        now = estimate_of(self.plot.grid, self._told, found=self._left)
        made = forecast(self._belief, self.plot.grid, spreads, known, now, self._left)
        return replace(made, measured=measured)

    def _spread(self, number: int) -> Spread:
        """Return what the insects are taken to do in the night after a day."""
        if self.pest is None:
            return self.belief_settings.spread
        return self.pest.spread(number, self.plot.grid.frame)

    @property
    def _told(self) -> Belief:
        """What is told of the belief: what finds say of other plants counts, see `Season`."""
        belief, told = self._last_told
        if belief is not self._belief:
            told = in_hindsight(self._belief, self._spread(self.day_number))
            self._last_told = self._belief, told
        return told

    @property
    def _left(self) -> NDArray[np.bool_] | None:
        """Plants that were found and are not treated, ``(n,)``; None: all are treated."""
        return None if self.belief_settings.treated else self._found

    @property
    def _known(self) -> NDArray[np.bool_] | None:
        """Those of which it is certain, as nobody treated the plot since; None: there are none."""
        return still_certain(self._belief, self._left)

    @property
    def last_inspected(self) -> NDArray[np.int32]:
        """Day of each plant's last inspection, from 0; -1: never, ``(n,)``; read-only."""
        return as_seen(self._last_inspected)

    @property
    def left_out(self) -> NDArray[np.bool_]:
        """Plants left out of this day's plan, ``(n,)``: skipped, or found and only flagged.

        Those that nobody could inspect are asked for again after 1 day, and after 2, 4, 8 ... if
        they were told None again.
        """
        skipped = self._skips.left_out(self.day_number)
        return as_seen(skipped if self._known is None else skipped | self._known)

    @property
    def _skips(self) -> Skips:
        plants, days = self._skipped
        return Skips.of(plants, days, self._last_inspected)

    def plan(self) -> DayPlan:
        """Return the day ahead as it is planned before anything is seen there.

        Clean inspections of the day say something, too, so a day on which nothing is found may go
        on otherwise: `MonitorDay.ahead` follows it.
        """
        return plan_in(self._scene(), self._sampler)

    def day(self) -> MonitorDay:
        """Begin a day; use it in a ``with`` statement, at whose end the belief learns.

        Raises
        ------
        SettingError
            If a day is under way, or the last one's night has not passed.
        """
        if self._day is not None:
            raise SettingError(
                "A day must end and its night pass before the next begins. Call night() first."
            )
        self._day = MonitorDay(self, self._scene(), self._sampler)
        return self._day

    @checked
    def day_in(self, scene: Scene) -> MonitorDay:
        """Begin the day, or the rest of it, that a scene stands in: as of a season on disk."""
        self.day_number, self._last_inspected = scene.day, scene.last_inspected
        self._trail = scene.trail
        self._day = MonitorDay(self, scene, self._sampler)
        return self._day

    def night(self) -> None:
        """Let a night pass: what is believed of the next morning.

        Raises
        ------
        SettingError
            If the day has not ended yet.
        """
        if self._day is not None and not self._day.ended:
            raise SettingError("The day must end before the night. Leave its with statement first.")
        self._belief = self._belief.overnight(self._spread(self.day_number))
        self._day = None
        self.day_number += 1

    def _scene(self) -> Scene:
        believed = in_sight(self._belief)
        scene = Scene(
            aisles=self.plot.aisles,
            robot=self.robot,
            chance=believed.chance,
            pair_chance=believed.pair_chance,
            traces=believed.traces,
            last_inspected=self._last_inspected,
            day=self.day_number,
            at=resting_place(self.robot, self._trail),
            seconds_left=self.robot.day_s,
            trail=self._trail,
            key=self._streams.key("sampler", self.day_number),
        )
        return without_skipped(without_flagged(scene, self._known), self._skips)

    def _learn(self, day: MonitorDay) -> None:
        """Take in what was told on a day."""
        self._belief = self._believed_after(day)
        skipped = np.stack([day.skipped, np.full(len(day.skipped), self.day_number)])
        self._skipped = np.concatenate([self._skipped, skipped], axis=1)
        if len(day.plants):
            self._last_inspected = self._last_inspected.copy()
            self._last_inspected[day.plants] = self.day_number
            self._found[day.plants[day.found]] = True
            self._trail = day.plants

    def _believed_after(self, day: MonitorDay) -> Belief:
        """Return what is believed after what was told on a day so far."""
        alike = (day.detects == self.robot.detects).all()
        detects = self.robot.detects if alike else day.detects
        return self.belief_settings.evening(self._belief, day.plants, day.found, detects)


class MonitorDay(AskedDay):
    """A day that is asked for the next plant and told what was seen there; see `Monitor`.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> day = fm.Monitor(plot, sampler="naive").day()
    >>> first = day.ask()
    >>> day.tell(found=True)
    >>> day.ask().plant != first.plant, day.found.tolist()
    (True, [True])
    """

    late_s = _SAME_S

    @checked
    def __init__(self, monitor: Monitor, scene: Scene, sampler: Sampler) -> None:
        super().__init__(0.0)
        self.ended, sampler = False, sampler_or_name(sampler)
        self._monitor, self._sampler = monitor, sampler
        self._times = sampler.inspection_times(scene.robot)
        self._told: list[tuple[PlantToInspect, bool | None]] = []
        self._stops: Stops | None = None
        self._would_find: WouldFind
        self._begin(scene, 0.0)

    def __enter__(self) -> Self:
        """Begin to work."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the day: what was told is learnt, also where an error ended it."""
        if not self.ended:
            self.ended = True
            self._monitor._learn(self)  # noqa: SLF001 - two halves of one thing

    def __repr__(self) -> str:
        """Say how much was inspected and found."""
        return f"<MonitorDay: {len(self.plants)} inspected, {int(self.found.sum())} found>"

    @property
    def plants(self) -> NDArray[np.int32]:
        """Plants inspected so far, in order, ``(k,)``."""
        return np.array([stop.plant for stop, seen in self._told if seen is not None], np.int32)

    @property
    def found(self) -> NDArray[np.bool_]:
        """Whether each of `plants` was found infested, ``(k,)``."""
        return np.array([seen for _, seen in self._told if seen is not None], np.bool_)

    @property
    def skipped(self) -> NDArray[np.int32]:
        """Plants that could not be inspected, in order, ``(k,)``."""
        return np.array([stop.plant for stop, seen in self._told if seen is None], np.int32)

    @property
    def detects(self) -> NDArray[np.float64]:
        """Chance with which each of `plants` was inspected to find what is there, ``(k,)``."""
        return np.array([stop.detects for stop, seen in self._told if seen is not None])

    @property
    def at(self) -> int:
        """Where the robot stands: the last plant told of, or where the day began (-1: gate)."""
        return self._told[-1][0].plant if self._told else self._scene.at

    @property
    def gone_s(self) -> float:
        """Seconds of the day that are gone, as charged or as told."""
        return self._clock_s

    @checked
    def ahead(self, n: int) -> list[int]:
        """Return up to n plants that follow the one asked for if nothing is found."""
        if self._stops is None or self._asked is None:
            return []
        after = self._stops.plant[self._next + 1 : self._next + 1 + n]
        plants: list[int] = after.tolist()
        return plants

    def ask(self) -> PlantToInspect | None:
        """Return the plant to inspect next; None where hours allow no other, or none is named.

        The same one until it is told what was seen there. Raise `SettingError` for a sampler of
        one's own that names none on the first day, though the hours reach some.
        """
        if self.ended:
            return None
        if self._asked is None:
            if self._stops is None:
                self._stops = self._sampler.walk(self._scene, self._would_find)
            if self._next < len(self._stops.plant):
                self._asked = self._stop(self._stops, self._next)
        return self._asked

    def tell(self, found: bool | None, at_s: float | None = None) -> None:  # noqa: FBT001 - a result
        """Say what was seen at the plant that was asked for.

        Parameters
        ----------
        found
            Whether it is infested; None: it could not be inspected, and stays unknown.
        at_s
            Seconds since the day began, by the robot's own clock, when the inspection was done.
            None: as charged. The rest of the day is planned anew where it differs.

        Raises
        ------
        ObservationError
            If no plant was asked for, the day has ended, `found` is neither, or the clock goes
            backwards.
        """
        if self.ended:
            raise ObservationError(
                "A plant must be told of before its day ends, for the day is learnt then. Tell "
                "within its with statement."
            )
        self._tell(found, at_s)

    def _take(self, stop: PlantToInspect, found: bool | None, now_s: float) -> None:  # noqa: ARG002, FBT001
        self._told.append((stop, found))

    def _go_on(self, stop: PlantToInspect, found: bool | None, *, is_late: bool) -> None:  # noqa: FBT001
        if found is None or is_late:
            self._plan_on(stop.plant, self._clock_s)
            return
        if found:
            self._would_find[stop.plant] = self._level(self._next) + 1
            self._stops = None
        self._next += 1

    def _begin(self, scene: Scene, since_s: float) -> None:
        self._scene, self._since_s, self._next = scene, since_s, 0
        # what an inspection would find; of plants not inspected yet a sampler reads nothing
        self._would_find = np.zeros(len(scene.chance), np.uint8)
        self._stops = None

    def _plan_on(self, at: int, now_s: float) -> None:
        """Begin again where the robot stands, from what is believed after all that was told."""
        monitor = self._monitor
        believed = in_sight(monitor._believed_after(self))  # noqa: SLF001 - as above
        last = self._scene.last_inspected.copy()
        last[[stop.plant for stop, _ in self._told]] = monitor.day_number
        scene = replace(
            self._scene,
            chance=believed.chance,
            pair_chance=believed.pair_chance,
            traces=believed.traces,
            last_inspected=last,
            at=at,
            seconds_left=max(0.0, monitor.robot.day_s - now_s),
        )
        self._begin(scene, now_s)

    def _level(self, k: int) -> int:
        """Return which of its inspection times the sampler took at a stop, from 0."""
        if self._stops is None or self._stops.time is None:
            return 0
        return int(self._stops.time[k])

    def _stop(self, stops: Stops, k: int) -> PlantToInspect:
        level, times = self._level(k), self._times
        arrive_s = self._since_s + float(stops.arrive_s[k])
        long = float(times.stop_s[level]), float(times.detects[level])
        return plant_to_inspect(self._scene.grid, int(stops.plant[k]), arrive_s, *long)


def _first_chance(plot: Plot, chance: Column | None) -> NDArray[np.float64]:
    if chance is None:
        none, day = Records.none(), np.datetime64(local_clock(plot.field).today())
        return prior_chance(plot.grid, plot.field, none, day, PriorSettings())
    return chances_of(chance, len(plot.grid))
