"""`fieldmon simulate`: a season of insects and samplers on a plot. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.files_to_plot import believed, prepared
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import (
    Every,
    Feature,
    InfestedAtStart,
    MaybePlotFile,
    PlotFiles,
    RecordsFile,
    SeasonDays,
    VisitEvery,
    WorkDate,
    refuse_idle_every,
)
from fieldmon.cli.pest_options import PestOptions, prior_of
from fieldmon.cli.sampler_names import OWN, known_or_own
from fieldmon.cli.season_files import refuse_unrecorded
from fieldmon.cli.times import day, day_on
from fieldmon.cli.worker_options import WorkerOptions
from fieldmon.compute.ranges import CHANCE, SEED, SHARE
from fieldmon.compute.wording import counted
from fieldmon.samplers import COMPARED, sampler_with
from fieldmon.samplers.own import label_of

if TYPE_CHECKING:
    from fieldmon.decisions.sprayer import TreatmentCosts
    from fieldmon.decisions.zones import Zones
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.simulation.season import SimulatedDay, SimulationSettings
    from fieldmon.simulation.start import Start
    from fieldmon.simulation.treating import TreatmentRule

_HEADER = "sampler,day,detection_pct,visited_pct,ever_visited_pct,found,infested_left"
# more of those whose visits are days apart
_OF_VISITS = ",visit,hours"


@dataclass(frozen=True)
class SimulateOptions:
    """What `fieldmon simulate` is told."""

    plot: MaybePlotFile = None
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Table to write (CSV).")] = (
        None
    )
    records: RecordsFile = None
    feature: Feature = None
    sampler: Annotated[
        list[str] | None,
        typer.Option(
            help="What chooses the plants, by name, or "
            f"{OWN}; repeat to compare. Default: {', '.join(COMPARED)}.",
            callback=known_or_own,
        ),
    ] = None
    every: Every = None
    days: SeasonDays = 25
    visit_every: VisitEvery = 1
    seed: Annotated[
        int, typer.Option(help="Seed: the same seed, the same season.", callback=within(SEED))
    ] = 1
    infested: InfestedAtStart = 0.02
    spread: Annotated[
        float | None,
        typer.Option(
            help="Chance per night to infest each neighbour; 0.1 if neither it nor --pest is "
            "given.",
            callback=within(CHANCE),
        ),
    ] = None
    treat_from: Annotated[
        float | None,
        typer.Option(
            help="Treat in the evening from this share of infested plants.",
            callback=within(SHARE),
        ),
    ] = None
    treat: Annotated[
        str, typer.Option(help="What is treated then: zones above it, or the whole plot.")
    ] = "zones"
    on: WorkDate = None
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    pest_options: PestOptions = field(default_factory=PestOptions)
    files: PlotFiles = field(default_factory=PlotFiles)

    def season(self, pest_in_weather: PestInWeather | None) -> SimulationSettings:
        """Return what happens in the season."""
        from fieldmon.infestation.insects.spread import SIMULATED_PER_DAY, Spread
        from fieldmon.simulation.season import SimulationSettings

        self.pest_options.check_alone(spread=self.spread)
        rate = SIMULATED_PER_DAY if self.spread is None else self.spread
        return SimulationSettings(
            n_days=self.days,
            spread=Spread(rate),
            pest=pest_in_weather,
            treating=_treating(self),
            visit_every=self.visit_every,
        )


@with_options
def simulate(options: SimulateOptions) -> None:
    """Simulate a season on a plot: insects spread at night, samplers inspect by day.

    The start is drawn from the chance map of the records; all samplers meet the same insects.
    Detection is all finds so far as a percentage of all infestations so far.

    With --pest and --weather the insects are that pest in that weather, and the chance map knows.
    With --visit-every 7 somebody inspects on days 1, 8, 15 and 22, and insects spread on all.

    Example: fieldmon simulate vines.zip --feature 3 --pest spider-mite --weather station.csv
    Example: fieldmon simulate vines.zip --feature 3 --visit-every 7 --hours 12
    Example: fieldmon simulate vines.zip --feature 3 --sampler naive --sampler dynamic --days 10
    """
    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.simulation.start import season_start

    if options.output is not None:
        refuse_unrecorded(None, [options.output])
    names = options.sampler or COMPARED
    refuse_idle_every(names, options.every)
    robot, told = options.pest_options.seen(options.worker.robot()), day(options.on)
    request = options.files.request(options.plot, options.feature, options.records)
    known = prepared(request)
    begins = day_on(known.plot.field, told)
    pest_in_weather = options.pest_options.in_weather(known.plot.field, begins)
    season, plot = options.season(pest_in_weather), known.plot
    chance = believed(known, begins, prior_of(pest_in_weather, begins))
    streams = RandomStreams(options.seed)
    begin = season_start(plot.grid, chance, options.infested, streams)
    rows = []
    for name in names:
        rows += _season(plot, robot, name, begin, (options, season))
    if options.output is not None:
        from fieldmon.io.atomic_write import write_whole

        header = _HEADER + (_OF_VISITS if season.visit_every > 1 else "")
        write_whole(options.output, "\n".join([header, *rows, ""]).encode())
        typer.echo(f"Table written to {options.output}")


def _season(
    plot: Plot,
    robot: Robot,
    name: str,
    begin: Start,
    told: tuple[SimulateOptions, SimulationSettings],
) -> list[str]:
    """Print the days of a season with a sampler; return them as lines of the table."""
    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.simulation.season import simulated_days

    options, settings = told
    decides, streams = sampler_with(name, options.every), RandomStreams(options.seed)
    walk = simulated_days(plot.aisles, robot, decides, begin, settings, streams)
    rows, plant_days, sprayed, inspected, worked_s = [], 0, [], 0, 0.0
    apart = settings.visit_every > 1
    visit = "  visit" if apart else ""
    typer.echo(f"\n{label_of(name)}\n day{visit}  detection %  visited %  found  infested left")
    for each in walk:
        plant_days, inspected = plant_days + each.left, inspected + len(each.work)
        worked_s += each.worked_s
        sprayed += [] if each.sprayed is None else [each.sprayed.zones]
        typer.echo(_line(each, apart=apart))
        rows.append(
            f"{label_of(name)},{each.number + 1},{_detection(each, '.4f')},{each.visited_pct:.4f},"
            f"{each.ever_visited_pct:.4f},{each.found},{each.left}"
        )
        if apart:
            visit = "" if each.visit is None else f"{each.visit + 1}"
            rows[-1] += f",{visit},{each.worked_s / 3600:.4f}"
    if apart:
        visits = counted(settings.visits, "visit")
        typer.echo(
            f"{visits} in {counted(settings.n_days, 'day')}, {worked_s / 3600:.1f} h worked, "
            f"{inspected / settings.visits:.0f} plants inspected a visit, {plant_days} infested "
            "plant-days"
        )
    if settings.treating is not None:
        typer.echo(_cost(settings.treating.costs, plant_days, sprayed))
    return rows


def _detection(day: SimulatedDay, form: str) -> str:
    """Return how much of all infestations so far was found; "": there were none."""
    return format(day.detection_pct, form) if day.ever_infested else ""


def _line(day: SimulatedDay, *, apart: bool) -> str:
    """Return a day as a line of the table on the screen; with its visit where they are apart."""
    visit, visited, found = "", f"{day.visited_pct:.1f}", str(day.found)
    detection = _detection(day, ".1f") or "-"
    if apart:
        visit = f"  {'-' if day.visit is None else day.visit + 1:>5}"
    if day.visit is None:
        visited = found = "-"
    return f"{day.number + 1:4d}{visit}  {detection:>11}  {visited:>9}  {found:>5}  {day.left:13d}"


def _treating(options: SimulateOptions) -> TreatmentRule | None:
    """Return the rule by which seasons are treated, if they are."""
    if options.treat_from is None:
        return None
    from fieldmon.simulation.treating import TreatmentRule

    return TreatmentRule(options.treat_from, options.treat, seed=options.seed)


def _cost(costs: TreatmentCosts, plant_days: int, sprayed: list[Zones]) -> str:
    """Return what a season came to, in plants, hectares and money."""
    area, spent = (sum(getattr(one, name) for one in sprayed) for name in ("m2", "cost"))
    lost, evenings = plant_days * costs.infested_plant_day, len(sprayed)
    return (
        f"{plant_days} infested plant-days, {area / 10_000:.2f} ha sprayed on {evenings} "
        f"evening{'s' * (evenings != 1)}: {spent:.2f} spent and {lost:.2f} lost, "
        f"{spent + lost:.2f} altogether"
    )
