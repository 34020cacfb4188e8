"""`fieldmon study routes`: the exact walk beside published heuristics. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fieldmon.cli.waiting import progress
from fieldmon.errors import FileProblem, SettingError

_ALWAYS = ("GR", "GPR", "GFR", "OFR", "HPR")


def routes(  # noqa: PLR0913 - one a command-line option
    files: Annotated[
        list[Path] | None, typer.Argument(help="Reward matrices (CSV, one line a row).")
    ] = None,
    budget: Annotated[
        list[float] | None, typer.Option(help="Share of the full budget; repeat for more.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Draw the published families from this seed, too.")
    ] = None,
    *,
    maps: Annotated[
        bool, typer.Option(help="With the families, maps of 240 x 500 and 274 x 214 plants.")
    ] = True,
    pyvrp: Annotated[
        bool, typer.Option("--pyvrp", help="PyVRP, too, where few plants have a reward.")
    ] = False,
    milp: Annotated[
        bool, typer.Option("--milp", help="A mixed-integer program with its proof, if small.")
    ] = False,
    solver_seconds: Annotated[
        float, typer.Option(help="Seconds for PyVRP and for the mixed-integer program.")
    ] = 10.0,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (routes.csv).")
    ] = Path(),
) -> None:
    """Compare walks along rows by the published model: unit steps, back to the corner.

    Example: fieldmon study routes rewards.csv --budget 0.1 --budget 0.5 -o study
    """
    from fieldmon.io.atomic_write import write_whole  # noqa: PLC0415
    from fieldmon.studies.routes.instances import families, read_matrix  # noqa: PLC0415
    from fieldmon.studies.routes.study import (  # noqa: PLC0415
        MILP,
        PYVRP,
        csv_text,
        run,
        sentences,
    )

    if not output.is_dir():
        raise FileProblem(f"The folder {output} must exist, but it does not. Make it first.")
    shares = budget or [0.1, 0.5]
    if not all(0.0 < share <= 1.0 for share in shares):
        raise SettingError(f"A budget must be a share above 0 and up to 1, but it is {shares}.")
    instances = [read_matrix(_text(file), file.name) for file in files or []]
    if seed is not None:
        instances += families(seed, maps=maps)
    if not instances:
        raise SettingError("A reward matrix or a seed must be given, but neither is.")
    methods = [*_ALWAYS, *([PYVRP] if pyvrp else []), *([MILP] if milp else [])]
    made = []
    with progress("Instances", len(instances)) as bar:
        for instance in instances:
            made += list(run(instance, shares, methods, solver_seconds))
            bar.update(1)
    for sentence in sentences(made):
        typer.echo(sentence)
    table = output / "routes.csv"
    write_whole(table, csv_text(made).encode())
    typer.echo(f"Written: {table}")


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise FileProblem(
            f"{file} must be a readable text file (CSV), but it is not ({error})."
        ) from error
