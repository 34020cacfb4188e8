"""`fieldmon study samplers`: Adaptive against Dynamic and the others, on the same insects."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.waiting import progress, shown
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable


def samplers(
    seeds: Annotated[int, typer.Option(min=2, help="Simulated seasons a cell.")] = 10,
    *,
    full: Annotated[
        bool,
        typer.Option("--full", help="Every combination of plot, spread, start and prior (hours)."),
    ] = False,
    cell: Annotated[
        list[str] | None, typer.Option(help="Only cells whose name begins so; repeat for more.")
    ] = None,
    maps: Annotated[
        Path | None,
        typer.Option(help="Folder with the public plant maps: finds a look on these instead."),
    ] = None,
    tune: Annotated[
        bool, typer.Option("--tune", help="Search Dynamic's open choices instead (ten minutes).")
    ] = False,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV) and report (HTML).")
    ] = Path(),
) -> None:
    """Compare samplers in scenarios A, B and C: infested plant-days, days to 50 and 80 %, looks.

    A study that was stopped goes on where its table ends. With 10 seeds it takes about half an
    hour on two free cores.

    On mapped plots (`--maps`) no plant infects another: the share of looks that find something.

    Example: fieldmon study samplers --cell "B, spread 30% to one" --seeds 20 -o study
    """
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.simulation import executor  # noqa: PLC0415
    from fieldmon.simulation.experiment import run  # noqa: PLC0415
    from fieldmon.studies.samplers.outcome_table import OutcomeTable  # noqa: PLC0415
    from fieldmon.studies.samplers.report import report_html  # noqa: PLC0415
    from fieldmon.studies.samplers.scenarios import all_scenarios, usual_scenarios  # noqa: PLC0415
    from fieldmon.studies.samplers.seasons import study_of  # noqa: PLC0415
    from fieldmon.studies.samplers.summary import sentences  # noqa: PLC0415

    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")
    if maps is not None:
        _on_maps(maps, output)
        return
    if tune:
        _tune()
        return
    scenarios = all_scenarios() if full else usual_scenarios()
    if cell:
        scenarios = [each for each in scenarios if any(map(each.name.startswith, cell))]
    if not scenarios:
        raise SettingError(f"A cell must begin with {' or '.join(cell or [])}, but none does.")
    study, file = study_of(scenarios, range(seeds)), output / "samplers.csv"
    table = OutcomeTable(file, [chunk.key for chunk in study.chunks()])
    with progress("Seasons") as bar, table, executor.threads() as workers:
        run(study, workers, table, shown(bar))
    for sentence in sentences(table.asked()):
        typer.echo(sentence)
    page = output / "samplers.html"
    write_whole(page, report_html(table.asked()).encode())
    typer.echo(f"Written: {file}\nWritten: {page}")


def beliefs(
    seeds: Annotated[int, typer.Option(min=1, help="Simulated seasons a belief.")] = 10,
    cell: Annotated[
        str, typer.Option(help="How the name of the situation begins (see `study samplers`).")
    ] = "B, spread 30% to one, clusters, prior none",
    sampler: Annotated[str, typer.Option(help="Who inspects meanwhile.")] = "adaptive",
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the report (HTML).")
    ] = Path(),
) -> None:
    """Compare chance maps by what came true: reliability, scores, intervals, cost.

    Example: fieldmon study beliefs --seeds 20 --sampler naive -o study
    """
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.samplers import sampler as named  # noqa: PLC0415
    from fieldmon.studies.samplers.calibration import (  # noqa: PLC0415
        BELIEFS,
        calibration,
        report_html,
    )
    from fieldmon.studies.samplers.scenarios import all_scenarios  # noqa: PLC0415

    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")
    chosen = next((each for each in all_scenarios() if each.name.startswith(cell)), None)
    if chosen is None:
        raise SettingError(f"A cell must begin with {cell!r}, but none does.")
    made = {}
    for name, believe in BELIEFS.items():
        made[name] = c = calibration([chosen], named(sampler), believe, seeds)
        typer.echo(
            f"{name:24} Brier {c.brier:.5f}, log score {c.log_score:.4f} "
            f"(as suspicious or not {c.suspicious_log_score:.4f}), 90 % interval holds "
            f"{c.covered:.0%}, {1000 * c.seconds_a_day:.0f} ms a day"
        )
    about = f"{chosen.name}; {seeds} seasons of 12 days inspected by {sampler}."
    page = output / "beliefs.html"
    write_whole(page, report_html(made, about).encode())
    typer.echo(f"Written: {page}")


def _tune() -> None:
    """Print what each of Dynamic's open choices loses."""
    from fieldmon.studies.samplers.tuning import (  # noqa: PLC0415
        SEEDS,
        losses,
        tuning_scenarios,
    )

    with progress("Choices") as bar:
        made = losses(tuning_scenarios(), SEEDS, shown(bar))
    for loss, suspicious, at_once in sorted((loss, *choice) for choice, loss in made.items()):
        typer.echo(f"{loss:8.1f} infested plant-days: {suspicious = }, {at_once = }")


def _on_maps(folder: Path, output: Path) -> None:
    """Print and write how many infested plants a look finds on mapped plots."""
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.studies.samplers.mapped_plots import (  # noqa: PLC0415
        SHARES,
        plots_in,
        table,
        table_csv,
    )

    rows = table(plots_in(folder))
    typer.echo(f"{'Infested plants found per look, after':38} " + _columns(SHARES, "{:6.0%}"))
    for name, who, values in rows:
        typer.echo(f"{name:28} {who:9} " + _columns(values, "{:6.2f}"))
    write_whole(output / "maps.csv", table_csv(rows).encode())
    typer.echo(f"Written: {output / 'maps.csv'}")


def _columns(values: Iterable[float], form: str) -> str:
    return " ".join(form.format(value) for value in values)
