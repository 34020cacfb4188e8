"""Many working days of a team while the insects spread."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.planning.members import Teamwork, team_of
from fieldmon.planning.team_day import merged, team_day
from fieldmon.planning.team_worker import Posted
from fieldmon.planning.workday import Workday, draw_detections
from fieldmon.samplers.base import resting_place
from fieldmon.simulation.season import RunningSeason, check_start, simulated_days

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.infestation.belief import Belief
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.team_news import Learn
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler, Scene, WouldFind
    from fieldmon.simulation.season import SimulatedDay, SimulationSettings
    from fieldmon.simulation.start import Start


@dataclass(frozen=True)
class Team:
    """So many robots of one kind, and how they work together.

    Parameters
    ----------
    robots
        How many.
    teamwork
        How aisles are given out among them, and when finds are heard of.
    """

    robots: int = 1
    teamwork: Teamwork = field(default_factory=Teamwork)

    def __post_init__(self) -> None:
        if self.robots < 1:
            raise SettingError(f"A team must have 1 robot or more, but it has {self.robots}.")

    def days(
        self,
        works: tuple[Plot, Robot],
        sampler: Sampler,
        start: Start,
        settings: SimulationSettings,
        streams: RandomStreams,
    ) -> Iterator[SimulatedDay]:
        """Return the days of a season, as `simulated_team_days` or, for one, `simulated_days`."""
        plot, robot = works
        if self.robots == 1:
            return simulated_days(plot.aisles, robot, sampler, start, settings, streams)
        team = team_of(self.robots, robot), self.teamwork
        return simulated_team_days(plot, team, sampler, start, settings, streams)


ONE = Team()


def simulated_team_days(
    plot: Plot,
    team: tuple[Sequence[TeamMember], Teamwork],
    sampler: Sampler,
    start: Start,
    settings: SimulationSettings,
    streams: RandomStreams,
) -> Iterator[SimulatedDay]:
    """Yield the days of a team's season, one by one, as they happen.

    As `simulated_days`, of whose random streams it draws: a team meets the insects that one alone
    does, and of a team of one the season is the same. Seconds of a day's `work` count from the
    start of the first who begins; those of `each` from its own.
    """
    check_start(plot.aisles, start)
    season = _TeamSeason(plot, team, sampler, start, settings)
    names = ("inspect", "spread")
    keys = zip(*(streams.keys(name) for name in names), strict=True)
    for number, (inspect, overnight) in zip(range(settings.n_days), keys, strict=False):
        if settings.visit_of(number) is None:
            day = season.worked(number, Workday.of_nobody())
        else:
            day = season.day(number, streams, inspect, overnight)
        yield day
        season.pass_night(day, overnight)


class _TeamSeason(RunningSeason):
    """A season of a team on its way."""

    def __init__(
        self,
        plot: Plot,
        team: tuple[Sequence[TeamMember], Teamwork],
        sampler: Sampler,
        start: Start,
        settings: SimulationSettings,
    ) -> None:
        self.members, self.teamwork = team
        if not self.members:
            raise SettingError("A team must have 1 member or more, but it has 0.")
        robot = self.members[0].robot
        super().__init__(plot.aisles, robot, sampler, start, settings)
        # robots may differ in what they detect: each inspection is learned from by its own
        self.mornings.learning = self._learning
        self.of_each = [
            plot.aisles if one.gate is None else plot.with_gate(one.gate).aisles
            for one in self.members
        ]
        self.trails = [np.empty(0, np.int32) for _ in self.members]

    def day(
        self, number: int, streams: RandomStreams, inspect_key: np.uint64, spread_key: np.uint64
    ) -> SimulatedDay:
        """Work for a day; return what came of it."""
        scenes = [self._scene(number, k, streams) for k in range(len(self.members))]
        starts_s = [one.starts_s for one in self.members]
        learn = self._learner(number) if self.sampler.reads_chance else None

        def walk(would_find: list[WouldFind]) -> tuple[Workday, tuple[Workday, ...]]:
            posts = [Posted(*one) for one in zip(scenes, starts_s, would_find, strict=True)]
            each = team_day(posts, self.sampler, self.teamwork, learn)
            return merged(each, starts_s), each

        detects = [self.sampler.inspection_times(one.robot).detects for one in self.members]
        if self.moves_by_day:
            day = self.by_hour(number, walk, detects, (inspect_key, spread_key))
        else:
            showing = self.showing(number)
            work, each = walk([draw_detections(showing, one, inspect_key) for one in detects])
            day = self.worked(number, work, each)
        self.trails = [
            work.plant if len(work) else trail
            for work, trail in zip(day.each, self.trails, strict=True)
        ]
        return day

    def _scene(self, number: int, k: int, streams: RandomStreams) -> Scene:
        """Return what the k-th of the team knows in the morning."""
        own, robot = (number,) if k == 0 else (number, k), self.members[k].robot
        return replace(
            self.scene(number, streams.key("sampler", *own)),
            aisles=self.of_each[k], robot=robot, seconds_left=robot.day_s,
            at=resting_place(robot, self.trails[k]), trail=self.trails[k],
        )  # fmt: skip

    def _learning(self, work: Workday) -> Learning:
        return self.settings.learning or Learning(detection=work.detects)

    def _learner(self, number: int) -> Learn:
        morning = self.mornings.on(number)

        def learn(
            plants: NDArray[np.int32], found: NDArray[np.bool_], detects: NDArray[np.float64]
        ) -> Belief:
            return morning.learn(
                plants, found, self.settings.learning or Learning(detection=detects)
            )

        return learn
