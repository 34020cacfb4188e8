"""What `fieldmon plan` is told: of a plot, of a team, of a season."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import typer

from fieldmon.cli.options import (
    Background,
    Bounded,
    Every,
    Feature,
    MaybePlotFile,
    Outputs,
    PlotFiles,
    RecordsFile,
    StartTime,
    WorkDate,
)
from fieldmon.cli.outputs import ChanceMap
from fieldmon.cli.pest_options import PestOptions
from fieldmon.cli.sampler_names import OneSamplerOrOwn
from fieldmon.cli.times import WorkStart, clock, day
from fieldmon.cli.worker_options import Passing, Robots, WorkerOptions
from fieldmon.samplers import USUAL_SAMPLER

Now = Annotated[
    str | None,
    typer.Option(help="In a season: plan the rest of the day from this local time, HH:MM."),
]


AsNow = Annotated[
    bool,
    typer.Option(
        "--as-now", help="In a season: plan a past day by the settings of now, not of then."
    ),
]
EnterTreated = Annotated[
    bool,
    typer.Option(
        "--enter-treated",
        help="In a season: also plan plants where people may not be yet after a treatment, as for "
        "robots.",
    ),
]
EveryPlot = Annotated[
    bool,
    typer.Option(
        "--all", help="Plan every plot of the file; --output is then the folder of routes."
    ),
]


@dataclass(frozen=True)
class PlanOptions:
    """What `fieldmon plan` is told."""

    plot: MaybePlotFile = None
    output: Outputs = None
    records: RecordsFile = None
    feature: Feature = None
    sampler: OneSamplerOrOwn = USUAL_SAMPLER
    every: Every = None
    on: WorkDate = None
    start: StartTime = "06:00"
    now: Now = None
    as_now: AsNow = False
    enter_treated: EnterTreated = False
    worker: WorkerOptions = field(default_factory=WorkerOptions)
    background: Background = None
    pest_options: PestOptions = field(default_factory=PestOptions)
    files: PlotFiles = field(default_factory=PlotFiles)
    chance_map: ChanceMap = None
    every_plot: EveryPlot = False
    bound: Bounded = True
    robots: Robots = None
    passing: Passing = None

    def starts(self) -> WorkStart:
        """Return when the work starts, as it was told."""
        return WorkStart(day(self.on), clock(self.start))
