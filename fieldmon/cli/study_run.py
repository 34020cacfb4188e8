"""`fieldmon study run`: samplers x settings x seeds on one's own plots, on any machines."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldmon.cli.files_to_plot import estate
from fieldmon.cli.messages import Terminal, tell_assumed
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import of_robot, within
from fieldmon.cli.options import Bearing, BothFaces, Headland, PlantSpacing, RowSpacing, VisitEvery
from fieldmon.cli.pest_options import PestOptions
from fieldmon.cli.progress import counting
from fieldmon.cli.sampler_names import OWN
from fieldmon.cli.study_output import can_be_folder, going_on
from fieldmon.cli.times import day, day_on
from fieldmon.cli.worker_options import RobotTimesName
from fieldmon.compute.ranges import CHANCE, DAYS, SEASONS, SEED, SHARE
from fieldmon.samplers import COMPARED

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    import pyarrow as pa

    from fieldmon.io.plot_request import PlantingChoices
    from fieldmon.plot.assumed import Assumed
    from fieldmon.plot.field import Field
    from fieldmon.simulation.design import Design
    from fieldmon.simulation.study_plot import StudyPlot


@dataclass(frozen=True)
class StudyOptions:
    """What `fieldmon study run` is told."""

    plot: Annotated[
        Path, typer.Argument(help="Plot file; all its plots unless --feature chooses one.")
    ]
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the Parquet dataset.")
    ] = Path("study")
    feature: Annotated[str | None, typer.Option(help="Only this plot: name or number.")] = None
    records: Annotated[Path | None, typer.Option(help="Dated pest records.")] = None
    sampler: Annotated[
        list[str] | None,
        typer.Option(help=f"Sampler, or {OWN}; repeat for more. Default: {', '.join(COMPARED)}."),
    ] = None
    hours: Annotated[
        list[float] | None,
        typer.Option(help="Working hours; repeat.", callback=of_robot("hours")),
    ] = None
    look: Annotated[
        list[float] | None,
        typer.Option(help="Seconds to inspect a plant; repeat.", callback=of_robot("look_s")),
    ] = None
    infested: Annotated[
        list[float] | None,
        typer.Option(help="Share infested at the start; repeat.", callback=within(SHARE)),
    ] = None
    spread: Annotated[
        list[float] | None,
        typer.Option(help="Chance per night and neighbour; repeat.", callback=within(CHANCE)),
    ] = None
    days: Annotated[int, typer.Option(help="Days of a season.", callback=within(DAYS))] = 25
    visit_every: VisitEvery = 1
    seeds: Annotated[
        int, typer.Option(help="Seasons of each combination.", callback=within(SEASONS))
    ] = 100
    first_seed: Annotated[
        int,
        typer.Option(
            help="First seed; the same seeds give the same seasons.", callback=within(SEED)
        ),
    ] = 1
    on: Annotated[
        str | None,
        typer.Option(
            "--date",
            help="First day, YYYY-MM-DD; default: that of the folder's study, or today.",
        ),
    ] = None
    workers: Annotated[
        int | None,
        typer.Option(help="Processes; default: one per core.", callback=within(1, 1000)),
    ] = None
    scheduler: Annotated[
        str | None, typer.Option(help="Scheduler of a Dask cluster: tcp://host:8786.")
    ] = None
    bearing: Bearing = None
    row_spacing: RowSpacing = None
    plant_spacing: PlantSpacing = None
    headland: Headland = None
    both_faces: BothFaces = False
    robot_times: RobotTimesName = None
    pest_options: PestOptions = field(default_factory=PestOptions)

    def design(self) -> Design:
        """Return what is compared."""
        from fieldmon.simulation.design import Design

        self.pest_options.check_alone(spread=self.spread or None)
        told = {
            "samplers": self.sampler,
            "hours": self.hours,
            "look_s": self.look,
            "infested": self.infested,
            "spread": self.spread,
        }
        chosen: dict[str, Any] = {name: tuple(values) for name, values in told.items() if values}
        if self.robot_times is not None:
            chosen["robot_times"] = self.robot_times
        chosen |= {"n_days": self.days, "visit_every": self.visit_every}
        return Design(**chosen, n_seeds=self.seeds, first_seed=self.first_seed)

    def planting(self) -> PlantingChoices:
        """Return what was said of the rows."""
        from fieldmon.io.plot_request import PlantingChoices

        spacings = self.row_spacing, self.plant_spacing, self.headland
        return PlantingChoices(self.bearing, *spacings, 2 if self.both_faces else None)

    def plots(self) -> tuple[StudyPlot, ...]:
        """Return the plots with their records."""
        import numpy as np

        from fieldmon.io.options import PlotOptions
        from fieldmon.io.plot_request import PlotRequest, PlotSources, RecordSource
        from fieldmon.plot.plot import planting_of
        from fieldmon.simulation.results import first_day
        from fieldmon.simulation.study_plot import StudyPlot

        # the same command goes on tomorrow with the study of today
        told = day(self.on) or first_day(self.output)
        records = None if self.records is None else RecordSource(self.records)
        sources = PlotSources(self.plot, PlotOptions(feature=self.feature))
        choices, terminal = self.planting(), Terminal(flags={})
        known = estate(PlotRequest(sources, choices, records), terminal)
        _tell_laid(known.fields, choices, terminal)
        begins = day_on(known.fields[0], told)
        on = np.datetime64(begins, "D")
        pest_in_weather = self.pest_options.in_weather(known.fields[0], begins)
        return tuple(
            StudyPlot(
                one, planting_of(one, **choices.given()), known.records.on(one), on, pest_in_weather
            )
            for one in known.fields
        )


@with_options
def study_run(options: StudyOptions) -> None:
    """Compare samplers on your own plots, over many seasons, on one machine or many.

    Every combination of the options' values meets the same insects, seed by seed. Seasons are
    added to the folder as they are finished (Parquet, one row per season). A study that was stopped
    or killed continues with the same command. The outcome does not depend on the number of workers.

    With --pest and --weather the insects are that pest in that weather, and the table's column
    spread is empty.

    Example: fieldmon study run vines.zip --feature 3 --hours 6 --hours 12 --seeds 200 -o study
    """
    from fieldmon.samplers.own import is_own
    from fieldmon.simulation import executor, results
    from fieldmon.simulation.design import study_of
    from fieldmon.simulation.experiment import run
    from fieldmon.simulation.worker import simulate_chunk

    can_be_folder(options.output)
    design, plots, output = options.design(), options.plots(), options.output
    for levels in design.combinations:
        if is_own(levels.sampler):  # what it answers wrongly is said before many work on it
            simulate_chunk((plots[0], levels), range(design.first_seed, design.first_seed + 1), 1)
    _tell_charged(design.robot_times)
    folder = results.StudyFolder(output, plots, design)
    with going_on(output), executor.cluster(options.scheduler, options.workers) as workers:
        typer.echo(f"Dashboard: {workers.dashboard}", err=True)
        with counting("Simulating") as count:
            run(study_of(plots, design), workers, folder, count)
    for name, sentence in folder.refused.items():
        typer.echo(f"refused: {name}: {sentence}", err=True)
    if len(folder.refused) < len(plots):
        _tell(results.seasons(output))
        typer.echo(f"Seasons are in {output}")


def _tell_laid(fields: Sequence[Field], choices: PlantingChoices, terminal: Terminal) -> None:
    """Print how a plot is planted; of several, what had to be assumed of which."""
    from fieldmon.compute.wording import first_few
    from fieldmon.io.plot_records import MOST_NAMED
    from fieldmon.io.prepare import assumed_of, lay

    if len(fields) == 1:
        terminal.laid(lay(fields[0], choices))
        return
    names: dict[Assumed, list[str]] = {}
    for one in fields:
        for assumed in assumed_of(one, choices):
            if assumed.setting == "row_bearing_deg":
                continue  # each plot has one of its own
            names.setdefault(assumed, []).append(one.name)
    terminal.assumed(
        one if len(whose) == len(fields) else replace(one, of=first_few(whose, MOST_NAMED))
        for one, whose in names.items()
    )


def _tell_charged(robot_times: str) -> None:
    """Print what the robot's time rests on though nobody said it."""
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.planning.assumptions import assumed_by
    from fieldmon.plot.robot import Robot

    assumed = assumed_by((), PriorSettings(), Robot().with_times(robot_times))
    tell_assumed(one for one in assumed if one.setting in _CHARGED)


# of what is assumed of a robot: the rest are a study's levels
_CHARGED = ("speed_m_s", "row_change_s", "stop_s")
# of one season there is no interval
_FEW = 2
#: what seasons have in common whose samplers meet the same insects
_ALIKE = ["hours", "look_s", "infested", "spread"]


def _tell(seasons: pa.Table) -> None:
    """Print the mean of each combination, and how much more it loses than the best sampler."""
    import numpy as np

    measures = ["detection_pct", "infested_plant_days"]
    table = seasons.select(["sampler", *_ALIKE, "plot", "seed", *measures]).to_pandas()
    typer.echo(
        "sampler           hours  look s  infested  spread  seasons  detection %  plant-days  "
        "more than the best"
    )
    for alike, of_alike in table.groupby(_ALIKE, dropna=False):
        hours, look_s, infested, spread = alike
        rate = "" if np.isnan(spread) else f"{spread:g}"
        lost = of_alike.pivot_table("infested_plant_days", ["plot", "seed"], "sampler")
        best = lost.mean().idxmin()
        for name, one in of_alike.groupby("sampler"):
            typer.echo(
                f"{name:16s} {hours:6g} {look_s:7g} {infested:9g} {rate:>7s} {len(one):8d} "
                f"{one['detection_pct'].mean():12.1f} {one['infested_plant_days'].mean():11.0f}  "
                f"{_more(lost[name] - lost[best], is_best=name == best)}".rstrip()
            )
    typer.echo(
        "Plant-days: infested plants, summed over the evenings. More than the best: season by "
        "season, with 95 % intervals; one that holds 0 is no sure difference."
    )


def _more(difference: pd.Series[float], *, is_best: bool) -> str:
    """Return how many plant-days more a sampler loses than the best, season by season."""
    import numpy as np

    from fieldmon.compute.wording import digits_of_estimate
    from fieldmon.simulation.statistics import summary_statistics

    if is_best:
        return "(best)"
    more = summary_statistics(np.asarray(difference, np.float64))
    form = f"+.{digits_of_estimate(more.mean)}f"
    if more.replicates < _FEW:
        return format(more.mean, form)
    return f"{more.mean:{form}} ({more.low:{form}} to {more.high:{form}})"
