"""What a day or a season goes by, each value with where it comes from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldmon.compute.wording import Worded, chance_figure, figure, joined, worded
from fieldmon.io.import_report import Severity
from fieldmon.monitoring.changes.earlier_settings import settings_on
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.robot import Robot, scout
from fieldmon.reports import words
from fieldmon.reports.content import Listing, Table
from fieldmon.samplers import USUAL_SAMPLER, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    from fieldmon.compute.units import Units
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.monitoring import Season
    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.assumed import Assumed
    from fieldmon.reports.content import Block

    Row = tuple[str, str, str]

_MOST_GUESSED = 3
# as many letters as a value may have in the table
_SHORT = 30


@dataclass(frozen=True)
class WorkSettings:
    """What a report says a day went by.

    Parameters
    ----------
    robot, sampler
        Who inspects, and who chooses the plants, by name.
    spacing_m
        From row to row, and from plant to plant.
    assumed
        What the figures rest on though nobody said it.
    prior
        How records become a chance.
    belief
        What is made of findings and nights; None where there is no season.
    guessed
        What the import of the plot had to guess, in sentences.
    pest_in_weather
        The pest in its weather, by which nights go; None: as `belief` has them.
    learnt_detection
        What inspections of `robot` detect, as the season learnt; None: it learnt nothing.
    chosen
        Which spacings somebody said by hand, by name (`Plot.chosen`).
    team
        Those who work together; empty: `robot` alone.
    """

    robot: Robot
    sampler: str
    prior: PriorSettings
    spacing_m: tuple[float, float]
    assumed: tuple[Assumed, ...] = ()
    belief: BeliefSettings | None = None
    guessed: tuple[str, ...] = ()
    pest_in_weather: PestInWeather | None = None
    learnt_detection: float | None = None
    chosen: tuple[str, ...] = ()
    team: tuple[TeamMember, ...] = ()

    @classmethod
    def of_season(cls, season: Season, on: date, *, worked: bool = False) -> WorkSettings:
        """Return what a season goes by on a day, and what had to be guessed when it began.

        Of a day that was `worked` it is what counted then. See also `with_learnt`.
        """
        settings = settings_on(season, on) if worked else season.planned_by(on)
        grid = season.plot.grid
        guessed = (one for one in season.messages() if one.severity == Severity.GUESSED)
        return cls(
            settings.robot, settings.sampler, settings.prior,
            (grid.row_spacing_m, grid.plant_spacing_m), season.assumed(settings),
            settings.belief, tuple(one.sentence for one in guessed), settings.pest_in_weather(),
            chosen=season.plot.chosen,
            team=settings.team,
        )  # fmt: skip

    def with_learnt(self, season: Season, on: date) -> WorkSettings:
        """Return these with what the season learnt up to the evening of `on`, of who inspects."""
        if self.team:
            return self
        learnt = {one.name: one.value for one in season.learnt(on, self.robot.detects)}
        return replace(self, learnt_detection=learnt.get("detection"))

    def origin(self, setting: str) -> str:
        """Return where the value of a setting comes from, by its name in `Assumed`."""
        return words.FROM_NOBODY if setting in self.names else words.FROM_CHOSEN

    @property
    def names(self) -> set[str]:
        """Names of what is assumed."""
        return {one.setting for one in self.assumed}


def changed_rows(before: WorkSettings, now: WorkSettings, units: Units) -> list[str]:
    """Return who worked and how otherwise than before, each with both values."""
    then = {name: value for name, value, _ in _of_work(before, units, whole=True)}
    return [
        worded(words.CHANGED, name=name, before=then[name], now=value)
        for name, value, _ in _of_work(now, units, whole=True)
        if then.get(name, value) != value
    ]


def settings_blocks(settings: WorkSettings, units: Units) -> Iterator[Block]:
    """Yield the settings with where each comes from, and what was guessed."""
    rows = (
        *_of_plot(settings, units),
        *_of_work(settings, units),
        *_of_belief(settings, units),
    )
    short = tuple(row for row in rows if len(row[1]) <= _SHORT)
    yield Table(
        words.SETTINGS, words.SETTING_COLUMNS, short, (0.46, 0.2, 0.34), flow=2,
        rest=words.REST, left=(0, 1, 2), whole=True,
    )  # fmt: skip
    # a column has no room for them
    below = [
        worded("{said} ({day})", said=worded("{what}: {said}", what=name, said=value), day=origin)
        for name, value, origin in rows
        if len(value) > _SHORT
    ]
    if below:
        yield Listing("", tuple(below))
    if settings.guessed:
        yield Listing(words.GUESSED, settings.guessed[:_MOST_GUESSED])


def assumed_sentence(settings: WorkSettings, units: Units) -> str:
    """Return what the figures rest on though nobody said it, in a sentence; empty: nothing."""
    rows = (*_of_plot(settings, units), *_of_work(settings, units), *_of_belief(settings, units))
    said = [
        worded("{name}: {value}", name=name, value=value)
        for name, value, origin in rows
        if origin == words.FROM_NOBODY
    ]
    return worded(words.ASSUMED, what=joined("; ", said)) if said else ""


def _of_plot(settings: WorkSettings, units: Units) -> Iterator[Row]:
    rows_m, plants_m = settings.spacing_m
    yield words.ROWS_APART, units.metres(rows_m, 1), _told(settings, "row_spacing_m")
    yield words.PLANTS_APART, units.metres(plants_m, 1), _told(settings, "plant_spacing_m")
    for one in settings.assumed:
        if one.setting == "row_bearing_deg":
            yield words.ROWS_RUN, worded(words.ROWS_RUN_SO, deg=one.value), words.FROM_NOBODY


def _told(settings: WorkSettings, setting: str) -> str:
    """Return where a spacing comes from."""
    if setting in settings.chosen:
        return words.FROM_CHOSEN
    return words.FROM_NOBODY if setting in settings.names else words.FROM_FILE


def _of_work(settings: WorkSettings, units: Units, *, whole: bool = False) -> Iterator[Row]:
    """Yield the rows of who works; what is as usual of a robot's ways only if `whole`."""
    yield (
        words.SAMPLER,
        Worded(kind_of(settings.sampler).title),
        _from(settings.sampler == USUAL_SAMPLER),
    )
    if settings.team:
        yield from _of_team(settings.team)
        return
    yield from _of_robot(settings, settings.robot)
    usual = dict(_of_ways(scout() if settings.robot.on_foot else Robot(), units))
    for name, value in _of_ways(settings.robot, units):
        if whole or value != usual[name]:
            yield name, value, _from(value == usual[name])


def _of_ways(robot: Robot, units: Units) -> Iterator[tuple[str, str]]:
    """Yield what a robot's ways cost beside driving, and its size: short, for most are usual."""
    times = robot.row_change_s, robot.turn_180_s, robot.stop_s
    yield words.TIMES, joined("; ", [figure(each_s, "g", " s") for each_s in times])
    yield words.WAY_BACK, words.YES if robot.returns else words.NO
    yield words.ON_FOOT, words.YES if robot.on_foot else words.NO
    size = {
        words.WIDTH: robot.width_m,
        words.LENGTH: robot.length_m,
        words.TURNING_RADIUS: robot.turning_radius_m,
    }
    for name, value_m in size.items():
        yield name, words.ARRIVALS_NONE if value_m is None else units.metres(value_m, 2)


def _of_team(team: tuple[TeamMember, ...]) -> Iterator[Row]:
    for one in team:
        name, robot = words.isolated(one.name), one.robot
        value = worded(words.MEMBER_VALUE, hours=robot.hours, look=robot.look_s)
        yield worded(words.MEMBER, name=name), value, words.FROM_CHOSEN
        detects = chance_figure(robot.detects)
        yield worded(words.MEMBER_DETECTS, name=name), detects, words.FROM_CHOSEN


def _of_robot(settings: WorkSettings, robot: Robot) -> Iterator[Row]:
    usual = scout() if robot.on_foot else Robot()
    yield words.HOURS, figure(robot.hours, "g"), _from(robot.hours == usual.hours)
    yield words.LOOK, figure(robot.look_s, "g"), _from(robot.look_s == usual.look_s)
    yield words.SPEED, worded("{n:.1f} km/h", n=robot.speed_m_s * 3.6), settings.origin("speed_m_s")
    told, learnt = chance_figure(robot.detects), settings.learnt_detection
    yield words.DETECTS, told, settings.origin("detects")
    if learnt is not None and (said := chance_figure(learnt)) != told:
        yield words.DETECTS_LEARNT, said, words.FROM_LEARNT


def _of_belief(settings: WorkSettings, units: Units) -> Iterator[Row]:
    background = figure(100 * settings.prior.background_chance, "g", " %")
    yield words.BACKGROUND, background, settings.origin("background_chance")
    if settings.belief is None:
        return
    if settings.pest_in_weather is None:
        yield from _of_nights(settings, settings.belief.spread)
    else:
        yield from _of_pest(settings.pest_in_weather, units)
    if (earlier := settings.belief.earlier) is not None:
        said = {"plot": words.isolated(earlier.plot), "until": earlier.until}
        yield words.EARLIER, worded(words.EARLIER_VALUE, **said), words.FROM_CHOSEN
    yield words.TREATED, words.TREATED_VALUES[settings.belief.treated], settings.origin("treated")


def _of_nights(settings: WorkSettings, spread: Spread) -> Iterator[Row]:
    rate = figure(100 * spread.rate_per_day, "g", " %")
    yield words.SPREAD, rate, settings.origin("rate_per_day")
    arrive, usual = spread.arrivals_per_day, BeliefSettings().spread.arrivals_per_day
    said = worded(words.ARRIVALS_VALUE, n=1 / arrive) if arrive else words.ARRIVALS_NONE
    yield words.ARRIVALS, said, _from(arrive == usual)


def _of_pest(pest_in_weather: PestInWeather, units: Units) -> Iterator[Row]:
    pest, weather = pest_in_weather.pest, pest_in_weather.weather
    title = worded(words.isolated("{pest}"), pest=Worded(pest.title or pest.name))
    yield words.PEST, title, words.FROM_CHOSEN
    for one in pest.assumed:
        yield words.SPREAD, figure(100 * one.value, "g", " %"), words.FROM_NOBODY
    if weather is None or not len(weather):
        yield words.WEATHER, words.WEATHER_NONE, words.FROM_USUAL
        return
    days = weather.local_days()
    first, last = units.day(str(days[0])), units.day(str(days[-1]))
    yield words.WEATHER, worded(words.WEATHER_DAYS, first=first, last=last), words.FROM_WEATHER


def _from(usual: bool) -> str:  # noqa: FBT001 - one question
    return words.FROM_USUAL if usual else words.FROM_CHOSEN
