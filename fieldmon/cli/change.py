"""`fieldmon change`: a season goes on otherwise. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import Background, SeasonFile, sampler_settings
from fieldmon.cli.pest_options import SAYS_ITSELF, PestOptions, tell_half_life, tell_pest
from fieldmon.cli.report_languages import Language, checked_language
from fieldmon.cli.season_files import season_of
from fieldmon.cli.team_files import members_of
from fieldmon.cli.times import clock, day
from fieldmon.cli.worker_options import RobotOptions, Robots, TeamworkOptions, WorkerOptions
from fieldmon.compute.ranges import CHANCE
from fieldmon.errors import SettingError
from fieldmon.samplers import EVERY

if TYPE_CHECKING:
    from fieldmon.monitoring import MonitoringSettings, Season
    from fieldmon.monitoring.settings.belief_settings import BeliefSettings
    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.field import Field


@dataclass(frozen=True)
class ChangeOptions:
    """What `fieldmon change` is told."""

    season: SeasonFile
    sampler: Annotated[str | None, typer.Option(help="What chooses the plants.")] = None
    every: Annotated[
        int | None,
        typer.Option(help="Every N-th plant or stop, as in plan.", callback=within(EVERY)),
    ] = None
    worker: RobotOptions = field(default_factory=RobotOptions)
    robots: Robots = None
    teamwork: TeamworkOptions = field(default_factory=TeamworkOptions)
    start: Annotated[str | None, typer.Option(help="Local time at which work starts, HH:MM.")] = (
        None
    )
    spread: Annotated[
        float | None,
        typer.Option(
            help="Believed chance per night that a plant infests its neighbour.",
            callback=within(CHANCE),
        ),
    ] = None
    background: Background = None
    trace: Annotated[
        bool | None,
        typer.Option(
            "--trace/--no-trace",
            help="Trace finds beyond the plants next to them, and learn how far insects jump.",
        ),
    ] = None
    flag_only: Annotated[
        bool | None,
        typer.Option(
            "--flag-only/--treat-finds",
            help="Plants found infested are only flagged, or treated at once; for all days.",
        ),
    ] = None
    harvest: Annotated[
        str | None,
        typer.Option(
            help="First day of harvest, YYYY-MM-DD, against which treatments are checked; or none."
        ),
    ] = None
    language: Language = None
    who: Annotated[str, typer.Option(help="Who makes the change.")] = ""
    pest_options: PestOptions = field(default_factory=PestOptions)

    def changed(self, settings: MonitoringSettings, plot: Field) -> MonitoringSettings:
        """Return a season's settings as they are to be."""
        from dataclasses import replace

        new = self._of_who_inspects(settings)
        new = replace(new, teamwork=self.teamwork.said_of(new.teamwork, new.team))
        if self.sampler is not None:
            new = new.with_sampler(self.sampler)
        if self.every is not None:
            new = replace(new, sampler_settings=sampler_settings(new.sampler, self.every))
        if self.start is not None:
            new = replace(new, starts=clock(self.start))
        if self.spread is not None and self.pest_options.pest != "none":
            self._must_spread(settings)
        new = replace(new, belief=self._believed(new.belief))
        if self.background is not None:
            new = replace(new, prior=replace(new.prior, background_chance=self.background))
        if self.harvest is not None:
            none = self.harvest.casefold() == "none"
            new = replace(new, harvest=None if none else day(self.harvest, "--harvest"))
        if self.language is not None:
            new = replace(new, language=checked_language(self.language))
        return self._of_pest(new, plot)

    @property
    def of_worker(self) -> bool:
        """Whether anything is said of who inspects."""
        return self.worker != RobotOptions()

    def _of_who_inspects(self, settings: MonitoringSettings) -> MonitoringSettings:
        """Return settings with the robot or the team told."""
        from dataclasses import replace

        worker = self.worker
        new = replace(settings, robot=worker.said_of(settings.robot))
        if self.robots is not None:
            return self._of_several(new)
        if settings.team and self.of_worker:
            self._must_be_alike(settings.team)
        team = tuple(replace(one, robot=worker.said_of(one.robot)) for one in settings.team)
        return replace(new, team=team)

    def _must_be_alike(self, team: tuple[TeamMember, ...]) -> None:
        """Refuse what is said of everybody where members of a team differ, or find by a table."""
        from fieldmon.monitoring.settings.settings_words import worker_in_words

        told = self.worker.look is not None and any(one.robot.detection is not None for one in team)
        if len({one.robot for one in team}) == 1 and not told:
            return
        each = "; ".join(worker_in_words(one) for one in team)
        raise SettingError(
            "What is said of hours, times and size is of one robot, or of members that are "
            f"alike, but this season's team is {each}. Give all of it anew with: fieldmon change "
            "--robots TEAM.csv"
        )

    def _believed(self, belief: BeliefSettings) -> BeliefSettings:
        from dataclasses import replace

        if self.spread is not None:
            rate = replace(belief.spread, rate_per_day=self.spread)
            belief = replace(belief, spread=rate)
        if self.trace is not None:
            belief = replace(belief, traces=self.trace)
        if self.flag_only is not None:
            belief = replace(belief, treated=not self.flag_only)
        return belief

    def _must_spread(self, settings: MonitoringSettings) -> None:
        """Refuse a rate of spread where a pest says how it spreads."""
        if settings.pest is not None or self.pest_options.pest is not None:
            raise SettingError(
                f"--spread goes without a pest: {SAYS_ITSELF}. Take the pest out with: "
                "fieldmon change --pest none"
            )

    def _of_pest(self, settings: MonitoringSettings, plot: Field) -> MonitoringSettings:
        """Return settings with the pest and the weather told; ``none`` takes the pest out."""
        from dataclasses import replace

        new, told = settings, self.pest_options
        if told.pest == "none":
            new = replace(new, pest=None)
        elif (pest := told.named()) is not None:
            tell_pest(pest)
            new = replace(new, pest=pest)
        if (weather := told.met(plot)) is None:
            return new
        if new.pest is None:
            raise SettingError(
                "--weather goes with a pest, which says what warmth does, but this season has "
                "none. Give one too, as --pest spider-mite."
            )
        return replace(new, weather=weather)

    def _of_several(self, settings: MonitoringSettings) -> MonitoringSettings:
        """Return settings with the team of ``--robots``; one robot is no team."""
        from dataclasses import replace

        from fieldmon.planning.members import team_of

        robots = self.robots or ""
        if robots.isdecimal():
            n = int(robots)
            return replace(settings, team=() if n == 1 else team_of(n, settings.robot))
        team, first = members_of(robots, settings.starts, WorkerOptions(**vars(self.worker)))
        return replace(settings, team=team, starts=first)


@with_options
def change(options: ChangeOptions) -> None:
    """Change a season's settings; earlier ones stay in its file.

    --pest none removes a pest; a newer weather file replaces the one before.

    Example: fieldmon change season.gpkg --hours 6 --sampler naive
    Example: fieldmon change season.gpkg --pest spider-mite --weather station.csv
    """
    from fieldmon.monitoring.estimates.told_anew import telling_anew

    season = season_of(options.season)
    seen = season.settings
    new = options.changed(seen, season.plot.field)
    if new == seen:
        typer.echo("Nothing was changed.")
        return
    with telling_anew(season, seen, new, typer.echo):
        season.change(new, seen, options.who)
        whom = f" for {', '.join(m.name for m in new.team)}" if options.of_worker else ""
        typer.echo(f"Changed{whom if new.team else ''}; fieldmon plan uses it from now on.")
        tell_half_life(season.settings.prior, seen.prior)
        _tell_day_of_before(season)


def _tell_day_of_before(season: Season) -> None:
    """Print how the last recorded day comes to be planned by what was changed, if it is over."""
    from fieldmon.monitoring.settings.settings_words import changed

    if not len(recorded := season.inspections.date):
        return
    on = recorded[-1].item()
    if changed(season.planned_by(on), season.settings):
        typer.echo(
            f"{on} and days before it go on by what counted then; to plan the rest of one by what "
            "counts now: fieldmon plan --as-now --date DAY."
        )
