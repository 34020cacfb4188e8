"""`fieldmon study run`: samplers x settings x seeds on one's own plots, on any machines."""

from __future__ import annotations

from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldmon.cli.waiting import progress, shown
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    import pyarrow as pa

    from fieldmon.simulation.design import StudyPlot


def register(app: typer.Typer) -> None:
    """Add the command to `fieldmon study`."""
    app.command("run")(study_run)


def study_run(  # noqa: PLR0913, PLR0917 - a command's options are its arguments
    plot: Annotated[Path, typer.Argument(help="Plot file; all its plots unless one is chosen.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder of the Parquet dataset.")
    ] = Path("study"),
    feature: Annotated[str | None, typer.Option(help="Only this plot: name or number.")] = None,
    observations: Annotated[Path | None, typer.Option(help="Dated pest records.")] = None,
    sampler: Annotated[
        list[str] | None, typer.Option(help="Who chooses; repeat. Naive, bouncy, dynamic if none.")
    ] = None,
    hours: Annotated[list[float] | None, typer.Option(help="Working hours; repeat.")] = None,
    look: Annotated[list[float] | None, typer.Option(help="Seconds a plant; repeat.")] = None,
    infested: Annotated[
        list[float] | None, typer.Option(help="Share infested at the start; repeat.")
    ] = None,
    spread: Annotated[
        list[float] | None, typer.Option(help="Chance a night per neighbour; repeat.")
    ] = None,
    days: Annotated[int, typer.Option(help="Working days of a season.")] = 25,
    seeds: Annotated[int, typer.Option(help="Seasons of each combination.")] = 100,
    first_seed: Annotated[int, typer.Option(help="The same seeds, the same seasons.")] = 1,
    on: Annotated[str | None, typer.Option("--date", help="First day, YYYY-MM-DD; today.")] = None,
    workers: Annotated[int | None, typer.Option(help="Processes; one a core.", min=1)] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="A Dask cluster's scheduler: tcp://host:8786.")
    ] = None,
) -> None:
    """Compare samplers on plots of one's own, over many seasons, on as many machines as there are.

    Every combination of the options' values meets the same insects, seed by seed. Seasons are
    added to the folder as they come (Parquet, one row a season). Stopped or killed, the same
    command goes on; the outcome does not depend on the number of workers.

    Example: fieldmon study run vines.zip --feature 3 --hours 6 --hours 12 --seeds 200 -o study
    """
    from fieldmon.simulation import executor, results  # noqa: PLC0415
    from fieldmon.simulation.design import Design, study_of  # noqa: PLC0415
    from fieldmon.simulation.experiment import run  # noqa: PLC0415

    values = {"hours": hours, "look_s": look, "infested": infested, "spread": spread}
    chosen: dict[str, Any] = {
        name: tuple(each)
        for name, each in (values | {"samplers": sampler}).items()
        if each is not None
    }
    design = Design(**chosen, n_days=days, n_seeds=seeds, first_seed=first_seed)
    plots = _plots(plot, feature, observations, on)
    with executor.cluster(scheduler, workers) as ready:
        typer.echo(f"Dashboard: {ready.dashboard}", err=True)
        folder = results.StudyFolder(output, plots, design)
        with progress("Simulating") as bar:
            run(study_of(plots, design), ready, folder, shown(bar))
    for name, sentence in folder.refused.items():
        typer.echo(f"refused: {name}: {sentence}", err=True)
    if len(folder.refused) < len(plots):
        _tell(results.seasons(output))
        typer.echo(f"Seasons are in {output}")


def _plots(
    plot: Path, feature: str | None, observations: Path | None, on: str | None
) -> tuple[StudyPlot, ...]:
    import numpy as np  # noqa: PLC0415

    from fieldmon.infestation.observations import Observations  # noqa: PLC0415
    from fieldmon.io.options import PlotOptions  # noqa: PLC0415
    from fieldmon.io.read import read_plots, read_records  # noqa: PLC0415
    from fieldmon.io.readers.nearby import apart  # noqa: PLC0415
    from fieldmon.plot.plot import planting_of  # noqa: PLC0415
    from fieldmon.simulation.design import StudyPlot  # noqa: PLC0415

    try:
        day = np.datetime64(date.fromisoformat(on) if on else date.today(), "D")  # noqa: DTZ011 - local day
    except ValueError as error:
        raise SettingError(f"--date must be a day as YYYY-MM-DD, but it is {on!r}.") from error
    fields = read_plots(plot, PlotOptions(feature=feature)).value
    records = Observations.none() if observations is None else read_records(observations).value
    return tuple(
        StudyPlot(field, planting_of(field), apart(records, field).inside, day) for field in fields
    )


def _tell(seasons: pa.Table) -> None:
    """Print the mean of each combination."""
    settings = ["sampler", "hours", "look_s", "infested", "spread"]
    measures = ["detection_pct", "infested_plant_days"]
    means = seasons.group_by(settings).aggregate(
        [("seed", "count"), *((measure, "mean") for measure in measures)]
    )
    typer.echo(
        "sampler           hours  look s  infested  spread  seasons  detection %  plant-days"
    )
    order = [(name, "ascending") for name in settings]
    for row in means.sort_by(order).to_pylist():
        typer.echo(
            f"{row['sampler']:16s} {row['hours']:6g} {row['look_s']:7g} {row['infested']:9g} "
            f"{row['spread']:7g} {row['seed_count']:8d} {row['detection_pct_mean']:12.1f} "
            f"{row['infested_plant_days_mean']:11.0f}"
        )
