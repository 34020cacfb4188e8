"""`fieldmon compare`: is a further robot worth it? Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.files_to_plot import believed, prepared
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import (
    Feature,
    InfestedAtStart,
    MaybePlotFile,
    PlotFiles,
    RecordsFile,
    SeasonDays,
    VisitEvery,
    WorkDate,
)
from fieldmon.cli.pest_options import PestOptions, prior_of
from fieldmon.cli.progress import counting
from fieldmon.cli.sampler_names import known
from fieldmon.cli.study_output import can_be_folder, going_on, write_all
from fieldmon.cli.times import day, day_on
from fieldmon.cli.worker_options import Contact, LeastGain, Passing, WorkerOptions
from fieldmon.compute.ranges import CHANCE, PAIRED
from fieldmon.errors import SettingError
from fieldmon.samplers import USUAL_SAMPLER, kind_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.plot import Plot
    from fieldmon.studies.teams.seasons import TeamOutcome, TeamScenario, TeamSetting

_MOST_ROBOTS = 20


@dataclass(frozen=True)
class CompareOptions:
    """What `fieldmon compare` is told."""

    plot: MaybePlotFile = None
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the tables and the report.")
    ] = Path()
    records: RecordsFile = None
    feature: Feature = None
    robots: Annotated[str, typer.Option(help="How many robots: 1-5, or 1,2,4.")] = "1-3"
    hectares: Annotated[
        list[float] | None,
        typer.Option(
            help="Size in hectares of a square plot, instead of a file; repeat for more.",
            callback=within(0, 1000, above=True, unit=" ha"),
        ),
    ] = None
    sampler: Annotated[
        list[str] | None,
        typer.Option(
            help="What chooses the plants; repeat to compare numbers of robots with each. Default: "
            f"{USUAL_SAMPLER}.",
            callback=known,
        ),
    ] = None
    sections: Annotated[
        bool,
        typer.Option(
            "--sections",
            help="Also simulate teams with fixed, even sections of rows and no contact.",
        ),
    ] = False
    contact: Contact = 30.0
    least_gain: LeastGain = 0.5
    passing: Passing = None
    days: SeasonDays = 25
    visit_every: VisitEvery = 1
    seeds: Annotated[
        int, typer.Option(help="Simulated seasons of each.", callback=within(PAIRED))
    ] = 10
    infested: InfestedAtStart = 0.02
    spread: Annotated[
        list[float] | None,
        typer.Option(
            help="Chance per night; repeat for more. 0.1 if neither it nor --pest is given.",
            callback=within(CHANCE),
        ),
    ] = None
    to: Annotated[
        str | None,
        typer.Option(
            help="What an infested plant infests: each neighbour, one, or all. Default: each."
        ),
    ] = None
    on: WorkDate = None
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    pest_options: PestOptions = field(default_factory=PestOptions)
    files: PlotFiles = field(default_factory=PlotFiles)


@with_options
def compare(options: CompareOptions) -> None:
    """Compare numbers of robots: what each further one saves, in simulated seasons.

    All of them meet the same insects, on a plot of your own or on square plots of several sizes.
    A comparison that was stopped continues where its table ends. Samplers are compared by
    fieldmon study run.

    With --pest and --weather the insects are that pest in that weather, and the chance map knows.
    With --visit-every 7 all of them work on days 1, 8, 15 and 22, and insects spread on all.

    Example: fieldmon compare vines.zip --feature 3 --pest spider-mite --weather station.csv
    Example: fieldmon compare vines.zip --feature 3 --records mites.csv --robots 1-3
    Example: fieldmon compare --hectares 1 --hectares 5 --spread 0.1 --spread 0.3 --robots 1-5
    """
    from fieldmon.studies.teams.report import report_html
    from fieldmon.studies.teams.summary import rows, sentences, table

    can_be_folder(options.output)
    sizes = robot_numbers(options.robots)
    _tell_compared(sizes, options.sampler or [])
    settings = [each for one in _scenarios(options) for each in _settings(one, sizes, options)]
    made = rows(_outcomes(settings, options), options.days, options.visit_every)
    for sentence in sentences(made):
        typer.echo(sentence)
    write_all(options.output, {"robots.md": table(made), "robots.html": report_html(made)})


def _tell_compared(sizes: list[int], samplers: list[str]) -> None:
    """Print what is compared with what: people expect samplers, too, where there are several."""
    typer.echo(f"Numbers of robots compared: {', '.join(map(str, sizes))}", err=True)
    if len(samplers) > 1:
        each = f"They are compared with each sampler by itself: {', '.join(samplers)}."
        typer.echo(f"{each} Samplers are compared by fieldmon study run.", err=True)


def robot_numbers(text: str) -> list[int]:
    """Return the numbers of robots that ``1-5`` or ``1,2,4`` says."""
    try:
        low, dash, high = text.partition("-")
        sizes = [*range(int(low), int(high) + 1)] if dash else [int(n) for n in text.split(",")]
    except ValueError:
        sizes = []
    if not sizes or min(sizes) < 1 or max(sizes) > _MOST_ROBOTS:
        raise SettingError(
            f"--robots must be as 1-5 or 1,2,4, from 1 to {_MOST_ROBOTS}, but it is {text!r}."
        )
    return sorted(set(sizes))


def _scenarios(options: CompareOptions) -> list[TeamScenario]:
    """Return every plot with every spread."""
    from fieldmon.infestation.insects.spread import SIMULATED_PER_DAY, Spread
    from fieldmon.studies.teams.seasons import (
        TeamScenario,
        square_plot,
        unknown_chance,
    )

    if options.hectares and options.plot is not None:
        raise SettingError("Give a plot file or --hectares, but not both.")
    options.pest_options.check_alone(spread=options.spread, to=options.to)
    robot = options.pest_options.seen(options.worker.robot())
    plots = [square_plot(hectares) for hectares in options.hectares or ()]
    known = [(plot, unknown_chance(plot)) for plot in plots]
    if plots:  # all of them lie in one place
        field = plots[0].field
        pest_in_weather = options.pest_options.in_weather(field, day_on(field, day(options.on)))
    else:
        own, pest_in_weather = _own(options)
        known = [own]
    return [
        TeamScenario(
            plot, chance,
            Spread(rate, options.to or "each"),  # type: ignore[arg-type]
            robot, options.infested, options.days, pest_in_weather, options.visit_every,
        )
        for plot, chance in known
        for rate in options.spread or [SIMULATED_PER_DAY]
    ]  # fmt: skip


def _own(
    options: CompareOptions,
) -> tuple[tuple[Plot, NDArray[np.float64]], PestInWeather | None]:
    """Return the plot of the command's files with what is believed of it, and its pest."""
    told = day(options.on)
    known = prepared(options.files.request(options.plot, options.feature, options.records))
    begins = day_on(known.plot.field, told)
    pest_in_weather = options.pest_options.in_weather(known.plot.field, begins)
    chance = believed(known, begins, prior_of(pest_in_weather, begins))
    return (known.plot, chance), pest_in_weather


def _settings(
    scenario: TeamScenario, sizes: list[int], options: CompareOptions
) -> list[TeamSetting]:
    """Return the teams that work in a scenario."""
    from fieldmon.planning.members import Teamwork
    from fieldmon.simulation.team_season import Team
    from fieldmon.studies.teams.seasons import TeamSetting

    passing_m = options.passing or 0.0
    together = Teamwork(True, 60.0 * options.contact, options.least_gain, passing_m)
    apart = Teamwork(together=False, passing_m=passing_m)
    made = []
    for name in options.sampler or [USUAL_SAMPLER]:
        reads = kind_of(name).reads_chance
        ways = [*([together] if reads else []), *([apart] if options.sections or not reads else [])]
        for k in sizes:
            # alone there is one way to work
            own = ways[:1] if k == 1 else ways
            made += [TeamSetting(scenario, name, Team(k, way)) for way in own]
    return made


def _outcomes(settings: list[TeamSetting], options: CompareOptions) -> list[TeamOutcome]:
    """Simulate what the table lacks, and keep it there; return the outcomes asked for."""
    from fieldmon.simulation import executor
    from fieldmon.simulation.experiment import run
    from fieldmon.studies.outcome_table import OutcomeTable
    from fieldmon.studies.teams.seasons import TeamOutcome, study_of

    study = study_of(settings, range(1, options.seeds + 1))
    file = options.output / "robots.csv"
    table = OutcomeTable(file, [chunk.key for chunk in study.chunks()], TeamOutcome)
    with going_on(file), counting("Seasons") as count, table, executor.threads() as workers:
        run(study, workers, table, count)
    typer.echo(f"Seasons written to {file}")
    return table.asked()
