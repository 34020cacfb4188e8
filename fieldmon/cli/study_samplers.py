"""`fieldmon study samplers`: Adaptive against Dynamic and the others, on the same insects."""

from __future__ import annotations

from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.study_output import must_be_folder, write_all
from fieldmon.cli.waiting import progress
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.studies.samplers.scenarios import Cell
    from fieldmon.studies.samplers.seasons import Outcome

_SAVED_EVERY_S = 15.0


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
    from fieldmon.studies.samplers.report import report_html  # noqa: PLC0415
    from fieldmon.studies.samplers.summary import sentences  # noqa: PLC0415

    must_be_folder(output)
    if maps is not None:
        _on_maps(maps, output)
        return
    if tune:
        _tune()
        return
    table = output / "samplers.csv"
    shown = _seasons(_cells(cell, full=full), seeds, table)
    for sentence in sentences(shown):
        typer.echo(sentence)
    typer.echo(f"Written: {table}")
    write_all(output, {"samplers.html": report_html(shown)})


def _cells(beginnings: list[str] | None, *, full: bool) -> list[Cell]:
    """Return the cells that are meant."""
    from fieldmon.studies.samplers.scenarios import all_cells, usual_cells  # noqa: PLC0415

    cells = all_cells() if full else usual_cells()
    if not beginnings:
        return cells
    meant = [each for each in cells if each.name.startswith(tuple(beginnings))]
    if not meant:
        raise SettingError(f"A cell must begin with {' or '.join(beginnings)}, but none does.")
    return meant


def _seasons(cells: list[Cell], seeds: int, table: Path) -> list[Outcome]:
    """Simulate what the table lacks, and keep it there; return the outcomes of cells and seeds."""
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.studies.samplers.seasons import run  # noqa: PLC0415
    from fieldmon.studies.samplers.summary import csv_text, outcomes_from  # noqa: PLC0415

    made = outcomes_from(table.read_text(encoding="utf-8"), table.name) if table.exists() else []
    done = frozenset((outcome.cell, outcome.seed) for outcome in made)
    wanted = {(each.name, seed) for each in cells for seed in range(seeds)}
    with progress("Seasons", len(wanted)) as bar:
        bar.update(len(done & wanted))
        saved = monotonic()
        try:
            for outcomes in run(cells, range(seeds), done):
                made += outcomes
                bar.update(1)
                if monotonic() > saved + _SAVED_EVERY_S:
                    write_whole(table, csv_text(made).encode())
                    saved = monotonic()
        finally:
            write_whole(table, csv_text(made).encode())
    return [outcome for outcome in made if (outcome.cell, outcome.seed) in wanted]


def _tune() -> None:
    """Print what each of Dynamic's open choices loses."""
    from fieldmon.studies.samplers.tuning import (  # noqa: PLC0415
        CHOICES,
        SEEDS,
        losses,
        tuning_cells,
    )

    made = []
    with progress("Choices", len(CHOICES)) as bar:
        for choice, loss in losses(tuning_cells(), SEEDS):
            made.append((loss, *choice))
            bar.update(1)
    for loss, suspicious, at_once in sorted(made):
        typer.echo(f"{loss:8.1f} infested plant-days: {suspicious = }, {at_once = }")


def _on_maps(folder: Path, output: Path) -> None:
    """Print and write how many infested plants a look finds on mapped plots."""
    from fieldmon.studies.samplers.mapped_plots import (  # noqa: PLC0415
        LAYOUTS,
        SHARES,
        maps_from,
        table,
        table_csv,
    )

    files = [folder / name for name in LAYOUTS if (folder / name).is_file()]
    if not files:
        raise FileProblem(f"{folder} must hold one of {', '.join(LAYOUTS)}, but it does not.")
    rows = table([m for file in files for m in maps_from(file.name, file.read_text("utf-8"))])
    typer.echo(f"{'Infested plants found per look, after':38} " + _columns(SHARES, "{:6.0%}"))
    for name, who, values in rows:
        typer.echo(f"{name:28} {who:9} " + _columns(values, "{:6.2f}"))
    write_all(output, {"maps.csv": table_csv(rows)})


def _columns(values: Iterable[float], form: str) -> str:
    return " ".join(form.format(value) for value in values)
