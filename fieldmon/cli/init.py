"""`fieldmon init`: a season begins. Heavy imports wait."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.files_to_plot import prepared
from fieldmon.cli.messages import tell_unusable
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import (
    Background,
    Every,
    Feature,
    MaybePlotFile,
    PlotFiles,
    RecordsFile,
    StartTime,
    sampler_settings,
)
from fieldmon.cli.pest_options import SAYS_ITSELF, PestOptions, prior_of
from fieldmon.cli.report_languages import Language, checked_language
from fieldmon.cli.sampler_names import OneSampler
from fieldmon.cli.team_files import members_of
from fieldmon.cli.times import WorkStart, clock, day
from fieldmon.cli.worker_options import Robots, TeamworkOptions, WorkerOptions
from fieldmon.compute.ranges import CHANCE, SEED
from fieldmon.compute.wording import counted, estimate
from fieldmon.errors import SettingError
from fieldmon.samplers import USUAL_SAMPLER

if TYPE_CHECKING:
    from datetime import datetime, time

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring import MonitoringSettings
    from fieldmon.monitoring.settings.belief_settings import BeliefSettings
    from fieldmon.planning.members import TeamMember


@dataclass(frozen=True)
class InitOptions:
    """What `fieldmon init` is told."""

    season: Annotated[Path, typer.Argument(help="File of the season to make: season.gpkg.")]
    plot: MaybePlotFile = None
    records: RecordsFile = None
    feature: Feature = None
    sampler: OneSampler = USUAL_SAMPLER
    every: Every = None
    begins: Annotated[
        str | None, typer.Option(help="First day of the season, YYYY-MM-DD; default: today.")
    ] = None
    start: StartTime = "06:00"
    flag_only: Annotated[
        bool,
        typer.Option(
            "--flag-only", help="Plants found infested are only flagged, not treated at once."
        ),
    ] = False
    spread: Annotated[
        float | None,
        typer.Option(
            help="Believed chance per night that a plant infests its neighbour: 0.02 if neither "
            "it nor --pest is given.",
            callback=within(CHANCE),
        ),
    ] = None
    background: Background = None
    seed: Annotated[
        int, typer.Option(help="Seed for samplers that draw at random.", callback=within(SEED))
    ] = 1
    robots: Robots = None
    teamwork: TeamworkOptions = field(default_factory=TeamworkOptions)
    earlier: Annotated[
        Path | None,
        typer.Option(
            help="File of an earlier season on the plot or the estate: what it learnt of the "
            "insects is a first guess, which counts little against this season's finds.",
        ),
    ] = None
    language: Language = None
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    pest_options: PestOptions = field(default_factory=PestOptions)
    files: PlotFiles = field(default_factory=PlotFiles)

    def team(self) -> tuple[tuple[TeamMember, ...], time]:
        """Return who works if several do, and when the first day's work starts, as told."""
        start = clock(self.start)
        if self.robots in {None, "1"}:
            return (), start
        return members_of(self.robots or "", start, self.worker)

    def settings(
        self, begins: datetime, team: tuple[TeamMember, ...], pest_in_weather: PestInWeather | None
    ) -> MonitoringSettings:
        """Return how the season is worked."""
        from fieldmon.monitoring import MonitoringSettings, Season
        from fieldmon.monitoring.settings.belief_settings import BeliefSettings
        from fieldmon.planning.members import Teamwork

        if self.spread is not None and pest_in_weather is not None:
            raise SettingError(f"--spread goes without --pest: {SAYS_ITSELF}.")
        earlier = None if self.earlier is None else Season(self.earlier).as_earlier()
        belief = BeliefSettings(treated=not self.flag_only, earlier=earlier)
        return MonitoringSettings(
            begins.date(),
            begins.time(),
            self.worker.robot(),
            self.sampler,
            sampler_settings(self.sampler, self.every),
            belief=belief if self.spread is None else _spreading(belief, self.spread),
            seed=self.seed,
            prior=prior_of(pest_in_weather, begins.date(), self.background),
            pest=None if pest_in_weather is None else pest_in_weather.pest,
            weather=None if pest_in_weather is None else pest_in_weather.weather,
            team=team,
            teamwork=self.teamwork.said_of(Teamwork(), team),
            language="" if self.language is None else checked_language(self.language),
        )


def _counting(records: Records, settings: MonitoringSettings) -> str:
    """Return how many records count, and of how many."""
    import numpy as np

    from fieldmon.infestation.records import usable

    n = len(usable(records, np.datetime64(settings.begins, "D")).records)
    if n == len(records):
        return counted(n, "record")
    return f"{n} of {counted(len(records), 'record')} {'counts' if n == 1 else 'count'}"


def _spreading(belief: BeliefSettings, rate: float) -> BeliefSettings:
    from dataclasses import replace

    return replace(belief, spread=replace(belief.spread, rate_per_day=rate))


@with_options
def init(options: InitOptions) -> None:
    """Begin a season on a plot: one GeoPackage that grows with every day's inspections.

    QGIS and QField can open it. Then, every day: fieldmon plan, the work, fieldmon record.

    With --robots each member of the team gets a route file of its own every day.

    With --pest the chance map follows that pest's spread, and with --weather the warmth of nights.

    With --earlier a season begins with what an earlier one learnt: detection, arrivals, jumps.

    Example: fieldmon init season.gpkg estate.zip --feature Gate --records mites.csv
    Example: fieldmon init season.gpkg estate.zip --feature Gate --robots 2
    Example: fieldmon init season.gpkg estate.zip --feature Gate --pest spider-mite
    Example: fieldmon init season.gpkg estate.zip --feature Gate --earlier last_year.gpkg
    """
    import numpy as np

    from fieldmon.monitoring import KeptMessage, Season
    from fieldmon.monitoring.estimates.what_was_told import earlier_season_note

    path, (team, at) = options.season, options.team()
    starts = WorkStart(day(options.begins, "--begins"), at)
    request = options.files.request(options.plot, options.feature, options.records)
    known = prepared(request)
    begins = starts.on_plot(known.plot.field)
    pest_in_weather = options.pest_options.in_weather(known.plot.field, begins.date())
    settings = options.settings(begins, team, pest_in_weather)
    tell_unusable(known.records, np.datetime64(settings.begins, "D"), settings.prior)
    messages = [KeptMessage.of(said.source, said.message) for said in known.messages]
    season = Season.create(path, known.plot, known.records, settings, messages, known.risk)
    ahead = season.status(settings.begins).estimate
    typer.echo(
        f"Season begun in {path}: {_counting(known.records, settings)}, about "
        f"{estimate(ahead.expected)} plants believed infested ({ahead.low:,} to {ahead.high:,})."
    )
    if (taught := earlier_season_note(season)) is not None:
        typer.echo(taught)
    typer.echo(f"Next: fieldmon plan {shlex.quote(str(path))} -o route.geojson")
