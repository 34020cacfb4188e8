"""What a sampler answers, and whether a robot could do it.

Those of this package keep their promises by their tests. One of somebody's own is checked on each
day: a plant that is none, or a drive in no time, would give a season that nobody could have.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import shown
from fieldmon.compute.arrays import as_seen
from fieldmon.compute.jit import loop
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.plot.travel import GATE, travel_s
from fieldmon.samplers.base import NEVER, InspectionTimes, Sampler, Stops
from fieldmon.samplers.own import asked

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Clock
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.base import Scene, WouldFind

# seconds by which rounding may put an arrival earlier; a day has hundreds of legs
_CLOSE_S = 0.01


class Checked(Sampler):
    """A sampler of somebody's own, whose answers are checked.

    Parameters
    ----------
    own
        The sampler.
    """

    def __init__(self, own: Sampler) -> None:
        self.own = own
        self._who = type(own).__name__

    def __repr__(self) -> str:
        return f"<{self._who}>"

    @property
    def reads_chance(self) -> bool:  # type: ignore[override] # a class says it of all its own
        """Tell whether it reads the chances of a scene."""
        return self.own.reads_chance

    def inspection_times(self, robot: Robot) -> InspectionTimes:
        """Return its times; raise `SettingError` if no inspection can be so."""
        times = asked(self._who, self.own.inspection_times, robot)
        stop_s, detects = np.asarray(times.stop_s, float), np.asarray(times.detects, float)
        if not (np.isfinite(stop_s) & (stop_s > 0)).all() or stop_s.size != detects.size:
            raise SettingError(
                f"{self._who} must inspect for more than 0 s each time, but it has {times}."
            )
        if not ((detects >= 0) & (detects <= 1)).all():
            raise SettingError(
                f"{self._who} must detect with chances from 0 to 1, but it has {times}."
            )
        return InspectionTimes(stop_s, detects)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return its stops in a `scene`, by what it `would_find`, see `Sampler.walk`.

        It is asked first as if nothing were found: where nothing is on the way, that is its day.
        Where there is, it is asked with everything, and `_must_not_peek` asks again.

        Raises
        ------
        SettingError
            If no robot can do that, it knows what it has not seen, or it names no plant of a plot
            that nobody has seen.
        """
        stops = blind = self._stops(scene, np.zeros_like(would_find))
        on_the_way = would_find[blind.plant].any() if blind.plant.size else would_find.any()
        if on_the_way:
            stops = self._stops(scene, would_find)
        times = self.inspection_times(scene.robot)
        _must_be_driven(self._who, stops, scene, times)
        if on_the_way:
            self._must_not_peek(scene, would_find, (stops.plant, blind.plant))
        if not stops.plant.size:
            _must_name_plants(self._who, scene, float(times.stop_s.min()))
        return stops

    def _stops(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return what it answers; it cannot write to what others read."""
        answer = asked(self._who, self.own.walk, scene.seen(), as_seen(would_find))
        stops = _as_stops(self._who, answer)
        _must_be_plants(self._who, stops, scene)
        return stops

    def _must_not_peek(
        self,
        scene: Scene,
        would_find: WouldFind,
        answers: tuple[NDArray[np.int32], NDArray[np.int32]],
    ) -> None:
        """Raise unless its plants ``(k,)`` follow from what those before them showed.

        Of its `answers`, with everything and as if nothing were found, it is asked for two more:
        with the finds before one that the scene's key draws, and last with those of its own plants
        alone. So what it keeps in mind is what a robot would know.
        """
        plants, blind = answers
        finds = np.flatnonzero(would_find[plants])

        def asked_with(known: NDArray[np.intp]) -> NDArray[np.int32]:
            told = np.zeros_like(would_find)
            told[plants[known]] = would_find[plants[known]]
            return self._stops(scene, told).plant

        ends = [*(finds + 1).tolist(), len(plants)]
        agree: list[tuple[NDArray[np.int32], int | None]] = [(blind, ends[0])]
        if finds.size > 1:
            k = 1 + int(scene.key) % (finds.size - 1)
            agree.append((asked_with(finds[:k]), ends[k]))
        agree.append((asked_with(finds), None))
        if not all(np.array_equal(other[:end], plants[:end]) for other, end in agree):
            raise SettingError(
                f"{self._who} must choose each plant by what was found at those before it, and the "
                "same ones each time, but it does not. Read would_find only of plants that were "
                "reached, and draw by scene.key."
            )


def _must_name_plants(who: str, scene: Scene, stop_s: float) -> None:
    """Raise for a sampler that names none of a plot nobody has seen, though hours reach one.

    Those of this package name what their hours reach.
    """
    robot, ways = scene.robot, scene.aisles.for_robot(scene.robot)
    plants = np.flatnonzero(~ways.too_narrow)
    was_seen = (scene.last_inspected[plants] != NEVER).any()
    if scene.at != GATE or was_seen or not plants.size:
        return
    way_s = ways.distance_m(GATE, plants) / robot.speed_m_s
    if way_s.min() * (2 if robot.returns else 1) + stop_s <= scene.seconds_left:
        raise SettingError(
            worded(
                "{who} must name plants to inspect, but it names none, though {hours:g} h reach "
                "some. Let its walk return Stops with plants.",
                who=who,
                hours=float(f"{scene.seconds_left / 3600:.3g}"),
            )
        )


def must_detect(sampler: Sampler, robot: Robot) -> None:
    """Raise `SettingError` unless inspections can find anything: too short a look finds nothing.

    Examples
    --------
    >>> import fieldmon as fm
    >>> from fieldmon.samplers import sampler
    >>> must_detect(sampler("naive"), fm.Robot(look_s=10))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    fieldmon.errors.SettingError: An inspection must be able to find something, but 10 s at a ...
    """
    if np.max(sampler.inspection_times(robot).detects, initial=0.0) > 0.0:
        return
    steps = robot.viewpoints.steps
    least_s = next((one for one, chance in steps if chance > 0.0), steps[-1][0])
    raise SettingError(
        worded(
            "An inspection must be able to find something, but {look_s:g} s at a plant find 0 %: "
            "those of less than {least_s:g} s do. Give more seconds, or the chance of detection.",
            look_s=robot.look_s,
            least_s=least_s,
        )
        if robot.detection is None
        else worded("An inspection must be able to find something, but its chance is 0 %.")
    )


def _as_stops(who: str, answer: object) -> Stops:
    """Return an answer as stops of the usual kinds."""
    whole = isinstance(answer, tuple) and len(answer) in (2, 3)
    columns: list[Any] = [np.asarray(one) for one in answer if one is not None] if whole else []  # type: ignore[attr-defined]
    kinds = ("iu", "iuf", "iu")
    fits = len(columns) > 1 and all(
        column.ndim == 1
        and column.size == columns[0].size
        and (column.dtype.kind in kind or not column.size)
        for column, kind in zip(columns, kinds, strict=False)
    )
    if not fits:
        given = ", ".join(f"{one.dtype} {one.shape}" for one in columns) or shown(answer)
        raise SettingError(
            f"{who} must answer Stops(plant, arrive_s): whole numbers and seconds, (k,) each, but "
            f"it answers {given}."
        )
    plant, arrive_s, *time = columns
    if plant.size and not -1 < int(plant.min()) <= int(plant.max()) < np.iinfo(np.int32).max:
        raise SettingError(f"{who} must answer plants from 0 on, but {plant.min()} is among them.")
    return Stops(
        plant.astype(np.int32),
        arrive_s.astype(np.float64),
        time[0].astype(np.uint8) if time else None,
    )


def _must_be_plants(who: str, stops: Stops, scene: Scene) -> None:
    """Raise unless each plant is one of the plot, and inspected once today."""
    n = len(scene.chance)
    if stops.plant.size and int(stops.plant.max()) >= n:
        raise SettingError(
            f"{who} must answer plants of the plot, 0 to {n - 1}, but {stops.plant.max()} is among "
            "them."
        )
    plants, times = np.unique(stops.plant, return_counts=True)
    again = plants[(times > 1) | (scene.last_inspected[plants] == scene.day)]
    if again.size:
        raise SettingError(
            f"{who} must send nobody to a plant twice a day, but plant {again[0]} is answered "
            "twice, or was inspected today (scene.last_inspected) or cannot be reached."
        )


def _must_be_driven(who: str, stops: Stops, scene: Scene, times: InspectionTimes) -> None:
    """Raise unless the robot can be at each plant when it is said to be, and home in time."""
    k = len(stops.plant)
    level = np.zeros(k, np.intp) if stops.time is None else stops.time.astype(np.intp)
    if level.size and int(level.max()) >= times.stop_s.size:
        raise SettingError(
            f"{who} must choose among its {times.stop_s.size} inspection times, but it chooses "
            f"number {level.max()}, from 0."
        )
    travel, clock = scene.aisles.travel, scene.clock
    early, end_s = _first_too_early(travel, clock, scene.at, stops, times.stop_s[level])
    if early >= 0:
        raise SettingError(
            f"{who} must be at plant {stops.plant[early]} when a robot can be there, but it says "
            f"{stops.arrive_s[early]:.1f} s. Scene.travel_s has the time from one plant to "
            "another; the inspection comes on top."
        )
    if scene.robot.returns and level.size:
        end_s += travel_s(travel, clock, int(stops.plant[-1]), GATE)
    if end_s > scene.seconds_left + _CLOSE_S:
        raise SettingError(
            f"{who} must end the day within {scene.seconds_left:.0f} s, the way back included, but "
            f"it takes {end_s:.0f} s."
        )


@loop
def _first_too_early(
    travel: TravelTable, clock: Clock, at: int, stops: Stops, stop_s: NDArray[np.float64]
) -> tuple[int, float]:
    """Return the first stop that nobody can reach so soon, or -1, and when the last is left."""
    now_s = 0.0
    for k in range(stops.plant.size):
        now_s += travel_s(travel, clock, at, stops.plant[k])
        if not now_s - _CLOSE_S <= stops.arrive_s[k] < np.inf:
            return k, now_s
        at, now_s = stops.plant[k], stops.arrive_s[k] + stop_s[k]
    return -1, now_s
