"""Everything that is chosen for a season, as values and as JSON."""

from __future__ import annotations

import json
from copy import copy
from dataclasses import asdict, dataclass, field, fields, replace
from datetime import date, time
from functools import lru_cache
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be_in, must_be_known
from fieldmon.compute.day_arguments import day_of
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import SEED, AllowedRange
from fieldmon.compute.wording import chance_figure, joined, worded
from fieldmon.errors import FieldmonError, FileProblem, SettingError
from fieldmon.infestation.earlier_season import Believed, EarlierSeason, earlier_from
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.pest_prior import prior_of_now
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.settings.pest_json import (
    kept_weather,
    pest_json,
    pest_of_json,
    weather_json,
)
from fieldmon.pests.pest import (
    Citation,
    Entry,
    Increase,
    Movement,
    Pest,
    Stage,
    seen_by_pest,
    tells_detection,
)
from fieldmon.planning.members import TeamMember, Teamwork, must_differ, person_key
from fieldmon.plot.robot import ROBOT_TIMES, Robot, Viewpoints
from fieldmon.samplers import SAMPLERS, USUAL_SAMPLER, sampler
from fieldmon.samplers.checked_sampler import must_detect

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from datetime import datetime

    from fieldmon.pests.weather import Weather
    from fieldmon.samplers.base import Sampler

#: a season of a perennial crop fits into it twice; a slip in a date does not
MOST_DAYS = 800
#: four years of hours: they are read with every look into the file
MOST_WEATHER = 36_000


@checked
@dataclass(frozen=True)
class MonitoringSettings:
    """What is chosen for a season.

    Parameters
    ----------
    begins
        The first day; its morning's chances come from the records alone.
    starts
        Local time at which a day's work starts.
    robot
        Who inspects.
    sampler, sampler_settings
        Who decides which plants come next: a name of `fieldmon.samplers.SAMPLERS`.
    prior
        How records, edges and paths become a chance of infestation.
    belief
        What is made of findings and nights.
    seed
        For samplers that draw.
    team
        Who works, if several do; each starts so long after `starts` as it says. Empty: one works,
        `robot`.
    teamwork
        How they work together.
    pest
        What is looked for; None: nobody said, and nights are as `belief` has them. In a season
        whoever works detects it as its file says, if it does.
    weather
        What the pest met and is forecast to meet; None: it is as the pest's figures hold. In a
        season earlier records count half after its last generation, unless `prior` says otherwise.
    harvest
        The first day of harvest, which treatments have to wait for; None: not known.
    language
        Code of the language of its reports, as ``"he"``; empty: English.

    Examples
    --------
    >>> from datetime import date
    >>> import fieldmon as fm
    >>> settings = fm.MonitoringSettings(begins=date(2026, 11, 18), robot=fm.Robot(hours=4))
    >>> settings.day(date(2026, 11, 20)), settings.sampler
    (2, 'adaptive')
    """

    begins: date
    starts: time = time(6)
    robot: Robot = field(default_factory=Robot)
    sampler: str = USUAL_SAMPLER
    sampler_settings: dict[str, float] = field(default_factory=dict)
    prior: PriorSettings = field(default_factory=PriorSettings)
    belief: BeliefSettings = field(default_factory=BeliefSettings)
    seed: int = 1
    team: tuple[TeamMember, ...] = ()
    teamwork: Teamwork = field(default_factory=Teamwork)
    pest: Pest | None = None
    weather: Weather | None = None
    harvest: date | None = None
    language: str = ""

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A season's")
        must_be_in("A season's seed", SEED, self.seed)
        if self.harvest is not None and self.harvest < self.begins:
            raise SettingError(
                worded(
                    "Harvest must not be before the season begins on {begins}, but it is {on}.",
                    begins=self.begins,
                    on=self.harvest,
                )
            )
        if self.team:
            must_differ([one.name for one in self.team])
        if self.pest is not None and not self.belief.traces:
            raise SettingError(
                worded(
                    "A pest needs its finds traced, but this season goes without. Trace them with: "
                    "fieldmon change --trace"
                )
            )
        if self.weather is not None and len(self.weather) > MOST_WEATHER:
            raise SettingError(
                worded(
                    "A season keeps {most} hours or days of weather at most, but there are {n}. "
                    "Leave out years long ago.",
                    most=MOST_WEATHER,
                    n=len(self.weather),
                )
            )
        if len(self.decides().inspection_times(self.robot).detects) > 1:
            raise SettingError(
                worded(
                    "The sampler of a season must look equally long at every "
                    "plant, for that is what its findings are read by, but "
                    "{sampler!r} chooses. Take another sampler.",
                    sampler=self.sampler,
                )
            )

    def pest_in_weather(self) -> PestInWeather | None:
        """Return the pest in its weather, day by day; None: no pest was named."""
        return None if self.pest is None else _pest_in_weather(self.pest, self.weather, self.begins)

    def of_its_pest(self, before: MonitoringSettings | None = None) -> MonitoringSettings:
        """Return these as the pest has them, and the weather: whoever works sees it as it says.

        And earlier records count half after its generation, unless a half-life was chosen.

        Parameters
        ----------
        before
            What counted until now: what is no other than in it stays; None: nothing did.
        """
        made, was = self, (None, None) if before is None else (before.pest, before.weather)
        if (now := (self.pest, self.weather)) != was:
            made = replace(made, prior=prior_of_now(self.prior, self.begins, now, was))
        if before is not None and (self.pest, self.robot, self.team) == (
            before.pest,
            before.robot,
            before.team,
        ):
            return made

        def seeing(robot: Robot) -> Robot:
            # a detection that is told to hold from now on, of the pest looked for, is that
            told = before is not None and self.pest == was[0] and tells_detection(robot)
            return robot if told else seen_by_pest(robot, self.pest, was[0])

        team = tuple(replace(one, robot=seeing(one.robot)) for one in self.team)
        return replace(made, robot=seeing(self.robot), team=team)

    def unlike_its_pest(self) -> tuple[str, ...]:
        """Return what the pest says otherwise, though nobody chose it, in a sentence; or none.

        So are seasons that Python began before a season took its pest's values.
        """
        if self.pest is None:
            return ()
        told, usual = [], self.prior.half_life_days == PriorSettings().half_life_days
        for robot in dict.fromkeys(one.robot for one in self.team) or [self.robot]:
            its = self.pest.seen_by(robot).detects
            if not tells_detection(robot) and its != robot.detects:
                told.append(
                    worded(
                        "an inspection finds {its} of what is there, not {ours}",
                        its=chance_figure(its),
                        ours=chance_figure(robot.detects),
                    )
                )
        half = self.of_its_pest().prior.half_life_days
        if usual and half != self.prior.half_life_days:
            told.append(
                worded(
                    "records count half after {its:g} days, not {ours:g}",
                    its=half,
                    ours=self.prior.half_life_days,
                )
            )
        if not told:
            return ()
        return (
            worded(
                "This season was begun before seasons took what their pest says: {told}. To go by "
                "the pest: fieldmon change --pest none, then fieldmon change --pest with its name.",
                told=joined("; ", dict.fromkeys(told)),
            ),
        )

    def decides(self) -> Sampler:
        """Return the sampler; raise `SettingError` if there is none of that name."""
        return sampler(self.sampler, **self.sampler_settings)

    def with_sampler(self, name: str) -> MonitoringSettings:
        """Return these with the sampler called `name`, as it comes: each takes its own settings."""
        return replace(self, sampler=name, sampler_settings={})

    def must_detect(self) -> None:
        """Raise `SettingError` unless whoever works can find something."""
        for robot in [one.robot for one in self.team] or [self.robot]:
            must_detect(self.decides(), robot)

    def member(self, who: str) -> TeamMember:
        """Return the one of the team whose name is `who`; raise `SettingError` if there is none."""
        if (named := self.named(who)) is not None:
            return named
        raise SettingError(
            worded(
                "One of the team must be named ({names}), but it is {who!r}.",
                names=", ".join(one.name for one in self.team),
                who=who,
            )
        )

    def named(self, who: str) -> TeamMember | None:
        """Return the one of the team whose name is `who`; None if there is none."""
        names = (one for one in self.team if person_key(one.name) == person_key(who))
        return next(names, None)

    def at_work(self, who: str) -> TeamMember | None:
        """Return the one of the team who is named, or the first if nobody is; None: no such one."""
        return self.named(who) if who else next(iter(self.team), None)

    def day(self, on: date) -> int:
        """Return the number of the day `on`, from 0; raise `SettingError` outside the season."""
        number = (on - self.begins).days
        if number < 0:
            raise SettingError(
                worded(
                    "The day must be of this season, which began on {begins}, "
                    "but it is {on}. Check the date.",
                    begins=self.begins,
                    on=on,
                )
            )
        if number > MOST_DAYS:
            raise SettingError(
                worded(
                    "A season lasts {most_days} days at most, but {on} is "
                    "{number} days after it began on {begins}. Check the "
                    "date, or begin a new season.",
                    most_days=MOST_DAYS,
                    on=on,
                    number=number,
                    begins=self.begins,
                )
            )
        return number

    def date(self, day: int) -> date:
        """Return the date of a `day`, from 0; raise `SettingError` outside a season."""
        must_be_in("A season's day", AllowedRange(0, MOST_DAYS), day)
        return (np.datetime64(self.begins, "D") + day).astype(date)  # type: ignore[no-any-return]


@lru_cache(maxsize=4)
def _pest_in_weather(pest: Pest, weather: Weather | None, begins: date) -> PestInWeather:
    """Return a pest in its weather, made once: a year of hours takes half a second to lay out."""
    return PestInWeather(pest, weather, begins)


def seconds(at: time) -> float:
    """Return the seconds since midnight."""
    return at.hour * 3600.0 + at.minute * 60.0 + at.second


def settings_from(
    chosen: dict[str, Any], local: Callable[[datetime], datetime] | None = None
) -> MonitoringSettings:
    """Return settings from a caller's choices by name; days may be given as ``"2026-11-18"``.

    Or as times of a zone, where `local` turns these into the plot's.
    Raise `SettingError` where there is no such setting, or it is of another kind.

    Examples
    --------
    >>> settings_from({"begins": "2026-11-18"}).begins
    datetime.date(2026, 11, 18)
    """
    must_be_known("A season's settings", chosen, [each.name for each in fields(MonitoringSettings)])
    days = {
        name: day_of(f"A season's {name}", chosen[name], local)
        for name in ("begins", "harvest")
        if name in chosen
    }
    return MonitoringSettings(**(chosen | days))


def as_json(settings: MonitoringSettings) -> dict[str, str]:
    """Return each part of the settings as JSON, by its name in season files."""
    plain: dict[str, Any] = {
        "robot": _plain_robot(settings.robot),
        "prior": asdict(settings.prior),
        "beliefs": asdict(settings.belief),
    }
    if settings.belief.earlier is None:
        del plain["beliefs"]["earlier"]
    else:
        plain["beliefs"]["earlier"]["until"] = settings.belief.earlier.until.isoformat()
    plain["season"] = {
        "begins": settings.begins.isoformat(),
        "starts": settings.starts.isoformat(),
        "seed": settings.seed,
    }
    if settings.harvest is not None:
        plain["season"]["harvest"] = settings.harvest.isoformat()
    if settings.language:
        plain["season"]["language"] = settings.language
    members = [asdict(each) | {"robot": _plain_robot(each.robot)} for each in settings.team]
    together = {"teamwork": asdict(settings.teamwork)} if members else {}
    plain["team"] = {"members": members, **together}
    if settings.pest is not None:
        plain["pest"] = pest_json(settings.pest)
    if settings.weather is not None:
        plain["weather"] = weather_json(settings.weather)
    plain["sampler"] = {"name": settings.sampler, "settings": dict(settings.sampler_settings)}
    return {name: json.dumps(part, sort_keys=True) for name, part in plain.items()}


def from_json(parts: dict[str, str]) -> MonitoringSettings:
    """Return the settings that `as_json` wrote; raise `FileProblem` where it cannot be read."""
    settings = copy(_kept_settings(tuple(parts.items())))
    # the one thing in them that a caller could change
    object.__setattr__(settings, "sampler_settings", dict(settings.sampler_settings))
    return settings


@lru_cache(maxsize=16)
def _kept_settings(written: tuple[tuple[str, str], ...]) -> MonitoringSettings:
    """Return the settings of a season file, which are read at every look into the file."""
    parts = dict(written)
    try:
        plain = {name: json.loads(text) for name, text in parts.items() if name != "weather"}
        _must_be_known_here(plain)
        season, chooses = plain["season"], plain["sampler"]
        team = plain.get("team", {"members": []})
        # before finds were traced, seasons knew of neighbours only, and go on so
        belief = {"traces": False, **plain["beliefs"]}
        parts_of_belief = {
            "spread": Spread(**belief["spread"]),
            "earlier": earlier_from(belief.get("earlier")),
        }
        return MonitoringSettings(
            begins=date.fromisoformat(season["begins"]),
            starts=time.fromisoformat(season["starts"]),
            robot=_robot(plain["robot"]),
            sampler=chooses["name"],
            sampler_settings=chooses["settings"],
            prior=PriorSettings(**plain["prior"]),
            belief=BeliefSettings(**{**belief, **parts_of_belief}),
            seed=season["seed"],
            team=tuple(_member(one) for one in team["members"]),
            teamwork=Teamwork(**team.get("teamwork", {})),
            pest=pest_of_json(plain.get("pest")),
            weather=kept_weather(parts.get("weather", "null")),
            harvest=date.fromisoformat(season["harvest"]) if "harvest" in season else None,
            language=str(season.get("language", "")),
        )
    except FileProblem:
        raise
    except (KeyError, TypeError, ValueError, FieldmonError) as error:
        raise FileProblem(
            worded(
                "The season's settings must be as fieldmon wrote them, but "
                "they are not ({error}). Was the file changed by hand? Save "
                "what can be saved with: fieldmon salvage",
                error=error,
            )
        ) from error


# by its name in a season's file, of what a setting is made
_MADE_OF: dict[str, tuple[str, ...]] = {
    "season": ("begins", "starts", "seed", "harvest", "language"),
    "sampler": ("name", "settings"),
    "team": ("members", "teamwork"),
} | {
    name: tuple(each.name for each in fields(kind))
    for name, kind in (
        ("robot", Robot), ("viewpoints", Viewpoints), ("prior", PriorSettings),
        ("beliefs", BeliefSettings), ("spread", Spread), ("earlier", EarlierSeason),
        ("believed", Believed), ("members", TeamMember), ("teamwork", Teamwork), ("pest", Pest),
        ("stages", Stage), ("generation", Stage), ("increase", Increase), ("movement", Movement),
        ("entry", Entry), ("citations", Citation),
    )
}  # fmt: skip
# a season's file has these by themselves, and the weather
_PARTS = ("season", "sampler", "team", "robot", "prior", "beliefs", "pest")


def _must_be_known_here(plain: dict[str, Any]) -> None:
    """Raise `FileProblem` where a season's file has a setting, or a sampler, that is not known."""
    unknown = [*_unknown(plain, _PARTS), *_unknown_of_sampler(**plain["sampler"])]
    if unknown:
        raise FileProblem(
            worded(
                "The season's settings must be ones that this fieldmon knows, but it does not know "
                "{names}. The file was probably written by a newer fieldmon: update this one.",
                names=", ".join(unknown),
            )
        )


def _unknown(plain: dict[str, Any], known: tuple[str, ...], path: str = "") -> Iterator[str]:
    """Yield the paths of what is not among the known names; what is null is not said."""
    for name, value in plain.items():
        if value is not None and name not in known:
            yield f"{path}{name}"
        for one in value if isinstance(value, list) else [value]:
            if name in known and name in _MADE_OF and isinstance(one, dict):
                yield from _unknown(one, _MADE_OF[name], f"{path}{name} ")


def _unknown_of_sampler(name: str, settings: dict[str, float], **_: object) -> Iterator[str]:
    """Yield the sampler that is not known, or what it is set to that it does not take."""
    if name not in SAMPLERS:
        yield f"sampler {name}"
    elif settings:
        takes = signature(SAMPLERS[name].load()).parameters
        yield from (f"sampler settings {each}" for each in settings if each not in takes)


# what a robot was charged while seasons did not yet keep all of its times
_TIMES_OF_OLD = ROBOT_TIMES["thesis"]._asdict()


def _plain_robot(robot: Robot) -> dict[str, Any]:
    """Return a robot as JSON has it; what turns on the spot says nothing of a turning radius.

    And nothing of who walks, where that is as its times have it.
    """
    plain = asdict(robot)
    if robot.on_foot == robot.on_foot_by_times:
        del plain["on_foot"]
    if robot.turning_radius_m is None:
        del plain["turning_radius_m"]
    return plain


def _robot(plain: dict[str, Any]) -> Robot:
    robot = Robot(**{**_TIMES_OF_OLD, **plain, "viewpoints": _viewpoints(plain)})
    return robot if "on_foot" in plain else replace(robot, on_foot=robot.on_foot_by_times)


def told_to_detect(plain: dict[str, Any], pest: Pest | None = None) -> float:
    """Return what a robot of earlier settings is told to find of what is there.

    Of a `pest` it sees what can be seen of that. It need not be a robot that may be chosen now.
    """
    given, seen_by = plain["detection"], _viewpoints(plain)
    if pest is not None and pest.viewpoints is not None:
        given, seen_by = None, pest.viewpoints
    if pest is not None and pest.detection is not None:
        given = pest.detection
    return float(seen_by.detection(plain["look_s"]) if given is None else given)


def _viewpoints(plain: dict[str, Any]) -> Viewpoints:
    steps = tuple((float(s), float(p)) for s, p in plain["viewpoints"]["steps"])
    return Viewpoints(steps, plain["viewpoints"]["longer"])


def _member(plain: dict[str, Any]) -> TeamMember:
    gate = plain["gate"]
    lonlat = None if gate is None else (float(gate[0]), float(gate[1]))
    return TeamMember(plain["name"], _robot(plain["robot"]), lonlat, float(plain["starts_s"]))
