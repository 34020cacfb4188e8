"""From a plot and its records to today's route: the chain behind the commands and the app."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import date, datetime, time
from types import NoneType
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be
from fieldmon.compute.arrays import as_seen
from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records, must_be_records
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.io.readers.nearby import warn_of_left_out
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.plot import must_be_plot
from fieldmon.plot.robot import Robot, must_be_robot
from fieldmon.samplers import sampler_or_name
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Sampler, Scene
from fieldmon.samplers.checked_sampler import must_detect

_STARTS = time(6)

if TYPE_CHECKING:
    import pydeck
    from geopandas import GeoDataFrame
    from numpy.typing import NDArray

    from fieldmon.compute.array_arguments import Column
    from fieldmon.planning.route import Route
    from fieldmon.planning.wishes import Wishes
    from fieldmon.planning.workday import Workday
    from fieldmon.plot.plot import Plot


@dataclass(frozen=True)
class PlanSettings:
    """How a day is planned.

    Parameters
    ----------
    robot
        Who inspects.
    sampler
        Who decides which plants come next.
    prior
        How records, edges and paths become a chance of infestation.
    """

    robot: Robot = field(default_factory=Robot)
    sampler: Sampler = field(default_factory=Adaptive)
    prior: PriorSettings = field(default_factory=PriorSettings)


@dataclass(frozen=True, eq=False)
class DayPlan:
    """A planned day: what is believed, where to go, and the scene it was planned in.

    Parameters
    ----------
    scene
        All that was known when it was planned.
    work
        Which plants are inspected when, ``(k,)`` each, as planned before anything is seen there.
    route
        The same as it is driven, for files and maps.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1))
    >>> day.chance.shape, len(day.route) == len(day.work.plant)
    ((3825,), True)
    """

    scene: Scene
    work: Workday
    route: Route

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A day's")

    def __repr__(self) -> str:
        length_km, hours = self.route.drive_m / 1000, self.route.end_s / 3600
        stops = f"{len(self.route)} of {counted(len(self.scene.grid), 'plant')}"
        return f"<DayPlan: {stops}, {length_km:.2f} km, {hours:.2f} h>"

    @property
    def chance(self) -> NDArray[np.float64]:
        """Return the chance of every plant by which the day was planned, ``(n,)``.

        It is of infestations that an inspection can see. In a season that takes some to hide yet,
        `Season.morning` and the column ``morning`` of `Season.to_geopandas` are of all, so more.
        """
        return as_seen(self.scene.chance)

    @property
    def plants(self) -> GeoDataFrame:
        """Return every plant as a point, EPSG:4326, with its chance and its place on the route.

        Columns ``plant``, ``row``, ``number``, ``chance`` (that of the day: see there), ``order``
        (from 1; missing where the plant is not on the route) and ``arrive_s``.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> plants = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1)).plants
        >>> bool(plants.order.notna().sum() == plants.order.max())
        True
        """
        import pandas as pd  # noqa: PLC0415 - loaded when it is asked for

        from fieldmon.plot.frames import plant_frame  # noqa: PLC0415 - likewise

        frame, stops = plant_frame(self.scene.grid), self.route.plant
        order = pd.array([pd.NA] * len(frame), dtype="Int64")
        order[stops] = np.arange(1, len(stops) + 1)
        arrive_s = np.full(len(frame), np.nan)
        arrive_s[stops] = self.route.arrive_s
        for name, values in (("chance", self.chance), ("order", order), ("arrive_s", arrive_s)):
            frame.insert(len(frame.columns) - 1, name, values)
        return frame

    def explore(self) -> pydeck.Deck:
        """Return a map for a notebook: plants by their chance, the route, stops that say why.

        The map's ground is empty; pydeck's page itself comes from the internet.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> deck = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1)).explore()
        >>> [layer.id for layer in deck.layers]
        ['plot', 'plants', 'route', 'stops']
        """
        from fieldmon.planning.notebook_map import deck_of  # noqa: PLC0415 - loads pydeck

        return deck_of(self.route, self.chance)


def plan_day(
    plot: Plot,
    records: Records | None = None,
    on: str | date | datetime | np.datetime64 | None = None,
    *,
    robot: Robot | None = None,
    sampler: str | Sampler = "adaptive",
    risk: Column | None = None,
) -> DayPlan:
    """Plan a day on a plot of which nothing but records is known.

    Parameters
    ----------
    plot
        Plants and the ways between them.
    records
        Dated pest records; None: every plant has the chance of a plot without any.
    on
        The day, as ``"2026-11-18"``, a date, or a datetime that says when work starts (else
        06:00), in the plot's time zone unless it names one; None: today, there. A pandas
        timestamp at midnight is a date: pandas has no other.
    robot
        Who inspects; None: the usual `Robot`, 12 h. `scout()` is a person on foot.
    sampler
        Name of a sampler in `SAMPLERS`, or one of your own.
    risk
        ``(n,)`` one more chance of infestation in 0..1, from a raster for instance; NaN where it
        says nothing.

    Warns
    -----
    ImportDoubt
        For records that are left out: of a later day, neither infested nor clean, of no position,
        or more than 100 m away; and for those placed so roughly that they say nothing.

    Returns
    -------
    DayPlan
        The route and its stops, the chance of each plant, and who goes where in a table.

    Raises
    ------
    SettingError
        If `plot` is none, there is no such day or sampler, inspections find nothing, the hours do
        not reach a plant and back, or a sampler of your own names none.
    ObservationError
        If all records are too far away to say anything, or `risk` does not fit the plants.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=2), sampler="naive")
    >>> len(day.route)
    156
    """
    must_be_plot(plot)
    must_be_robot(robot)
    must_be_records(records)
    starts = starts_at(on, plot)
    decides = sampler_or_name(sampler)
    plans = PlanSettings(robot or Robot(), decides)
    given = Records.none() if records is None else records
    day = np.datetime64(starts.date(), "D")
    warn_of_left_out(given, day, plot.field)
    held: Any = risk  # to its kind where it becomes chances
    today = first_day(plot, given, day, plans, held)
    if not len(today.route):
        raise SettingError(
            worded(
                "The working day must be long enough to reach a plant and "
                "come back, but {hours:g} h are not. Give more hours.",
                hours=plans.robot.hours,
            )
        )
    who = sampler if isinstance(sampler, str) else type(sampler).__name__
    notes = RouteNotes(plot.field.name, who, starts)
    return replace(today, route=replace(today.route, notes=notes))


def starts_at(on: str | date | datetime | np.datetime64 | None, plot: Plot) -> datetime:
    """Return the local date and time at which work starts, see `plan_day`."""
    kinds = str, date, np.datetime64, NoneType
    must_be("A day must be as 2026-11-18", on, kinds, 'Give "2026-11-18".')
    clock = local_clock(plot.field)
    if on is None:
        return datetime.combine(clock.today(), _STARTS)
    text = str(on)
    if isinstance(on, datetime) and type(on).__module__.startswith("pandas"):
        text = text.removesuffix(" 00:00:00")
    try:
        if len(text) <= len("2026-11-18"):
            return datetime.combine(date.fromisoformat(text), _STARTS)
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise SettingError(
            worded("A day must be as 2026-11-18, but it is {on!r}.", on=text)
        ) from error
    return moment if moment.tzinfo is None else clock.at(moment)


def first_day(
    plot: Plot,
    records: Records,
    on_day: np.datetime64,
    plans: PlanSettings,
    risk: NDArray[np.float64] | None = None,
) -> DayPlan:
    """Plan a day on a plot of which nothing but records is known, and perhaps a risk ``(n,)``."""
    chance = prior_chance(plot.grid, plot.field, records, on_day, plans.prior, risk)
    return plan_from(plot, chance, plans)


def plan_from(plot: Plot, chance: NDArray[np.float64], plans: PlanSettings) -> DayPlan:
    """Plan a first day from a chance map ``(n,)``."""
    # as a season believes: it goes the same way on its first day
    return plan_believed(plot, (chance, TracedPairs.of(plot.grid, chance)), plans)


def plan_believed(
    plot: Plot,
    known: tuple[NDArray[np.float64], TracedPairs],
    plans: PlanSettings,
    wishes: Wishes | None = None,
) -> DayPlan:
    """Plan a first day from a chance map ``(n,)`` and what a season believes that begins with it.

    Whoever plans the same morning again, for other hours, need not work that out again.
    """
    chance, believed = known
    scene = Scene(
        aisles=plot.aisles,
        robot=plans.robot,
        chance=chance,
        last_inspected=np.full(len(plot.grid), NEVER, np.int32),
        seconds_left=plans.robot.day_s,
        pair_chance=believed.pair_chance,
        traces=believed.traces,
    )
    return plan_in(scene, plans.sampler, wishes)


def plan_in(scene: Scene, sampler: Sampler, wishes: Wishes | None = None) -> DayPlan:
    """Plan the rest of the day that a scene stands in, before anything is seen there.

    A day on which nothing is found may go on otherwise: clean inspections say something, too.
    Wishes change where it goes, not what is believed of the plants.
    """
    must_detect(sampler, scene.robot)
    work = plan_work(scene if wishes is None else wishes.applied_to(scene), sampler)
    return DayPlan(scene, work, route_of(scene, work))
