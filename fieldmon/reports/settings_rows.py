"""What a day or a season goes by, each value with where it comes from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.io.import_report import Severity
from fieldmon.monitoring.history import BeliefSettings
from fieldmon.plot.robot import Robot, scout
from fieldmon.reports import words
from fieldmon.reports.content import Listing, Table
from fieldmon.samplers import USUAL, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fieldmon.infestation.prior import PriorSettings
    from fieldmon.monitoring import KeptMessage
    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.reports.content import Block

    Row = tuple[str, str, str]

_MOST_GUESSED = 3


@dataclass(frozen=True)
class WorkSettings:
    """What a report says a day went by.

    Parameters
    ----------
    robot, sampler
        Who inspects, and who chooses the plants, by name.
    prior
        How records become a chance.
    belief
        What is made of findings and nights; None where there is no season.
    guessed
        What the import of the plot had to guess, in sentences.
    """

    robot: Robot
    sampler: str
    prior: PriorSettings
    belief: BeliefSettings | None = None
    guessed: tuple[str, ...] = ()

    @classmethod
    def of_season(
        cls, settings: MonitoringSettings, messages: Iterable[KeptMessage]
    ) -> WorkSettings:
        """Return what a season goes by, and what had to be guessed when it began."""
        guessed = tuple(one.sentence for one in messages if one.severity == Severity.GUESSED)
        return cls(settings.robot, settings.sampler, settings.prior, settings.belief, guessed)


def settings_blocks(settings: WorkSettings) -> Iterator[Block]:
    """Yield the settings with where each comes from, and what was guessed."""
    rows = (*_of_work(settings), *_of_belief(settings))
    yield Table(
        words.SETTINGS, words.SETTING_COLUMNS, rows, (0.46, 0.2, 0.34), flow=2,
        rest=words.FOUND_REST, left=(0, 1, 2), whole=True,
    )  # fmt: skip
    if settings.guessed:
        yield Listing(words.GUESSED, settings.guessed[:_MOST_GUESSED])


def _of_work(settings: WorkSettings) -> Iterator[Row]:
    robot = settings.robot
    usual = scout() if robot.turn_180_s == scout().turn_180_s else Robot()
    yield words.SAMPLER, kind_of(settings.sampler).title, _from(settings.sampler == USUAL)
    yield words.HOURS, f"{robot.hours:g}", _from(robot.hours == usual.hours)
    yield words.LOOK, f"{robot.look_s:g}", _from(robot.look_s == usual.look_s)
    speed = f"{robot.speed_m_s * 3.6:.1f} km/h"
    yield words.SPEED, speed, _from(robot.speed_m_s == usual.speed_m_s)
    printed = robot.detection is None and robot.viewpoints == usual.viewpoints
    yield words.DETECTS, f"{robot.detects:.0%}", words.FROM_THESIS if printed else words.FROM_CHOSEN


def _of_belief(settings: WorkSettings) -> Iterator[Row]:
    background = settings.prior.background_chance
    assumed = background == type(settings.prior)().background_chance
    yield words.BACKGROUND, f"{100 * background:g} %", _from(assumed, words.FROM_NOBODY)
    if settings.belief is None:
        return
    spread, usual = settings.belief.spread, BeliefSettings().spread
    rate = f"{100 * spread.rate_per_day:g} %"
    yield words.SPREAD, rate, _from(spread.rate_per_day == usual.rate_per_day, words.FROM_NOBODY)
    arrive = spread.arrivals_per_day
    said = words.ARRIVALS_VALUE.format(n=1 / arrive) if arrive else words.ARRIVALS_NONE
    yield words.ARRIVALS, said, _from(arrive == usual.arrivals_per_day, words.FROM_NOBODY)
    treated = settings.belief.treated
    yield words.TREATED, words.TREATED_VALUES[treated], _from(treated == BeliefSettings().treated)


def _from(usual: bool, said: str = words.FROM_USUAL) -> str:  # noqa: FBT001 - one question
    return said if usual else words.FROM_CHOSEN
