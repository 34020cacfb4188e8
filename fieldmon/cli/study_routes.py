"""`fieldmon study routes`: the exact walk beside published heuristics. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.progress import progress
from fieldmon.cli.study_output import can_be_folder, write_all
from fieldmon.compute.ranges import SEED
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from fieldmon.studies.routes.instances import Instance
    from fieldmon.studies.routes.study import MethodOutcome

_ALWAYS = ("GR", "GPR", "GFR", "OFR", "HPR")
# steps of the bar for each walk or team
_PARTS = 100


@dataclass(frozen=True)
class RoutesOptions:
    """What `fieldmon study routes` is told."""

    files: Annotated[
        list[Path] | None, typer.Argument(help="Reward matrices (CSV, one line per row).")
    ] = None
    budget: Annotated[
        list[float] | None,
        typer.Option(
            help="Share of the full budget; repeat for more.",
            callback=within(0, 1, above=True, said="above 0 and 1 at most"),
        ),
    ] = None
    seed: Annotated[
        int | None,
        typer.Option(
            help="Draw the published families from this seed, too.", callback=within(SEED)
        ),
    ] = None
    team: Annotated[
        list[int] | None,
        typer.Option(
            help="Size of a team, each with the budget; repeat for more.", callback=within(1, 1000)
        ),
    ] = None
    maps: Annotated[
        bool, typer.Option(help="With the families, maps of 240 x 500 and 274 x 214 plants.")
    ] = True
    pyvrp: Annotated[
        bool, typer.Option("--pyvrp", help="Run PyVRP too, on instances with few rewards.")
    ] = False
    milp: Annotated[
        bool,
        typer.Option(
            "--milp", help="Run a mixed-integer program too, with its proof, on small instances."
        ),
    ] = False
    solver_seconds: Annotated[
        float,
        typer.Option(
            help="Seconds for PyVRP and for the mixed-integer program.",
            callback=within(0, 86_400, above=True, unit=" s"),
        ),
    ] = 10.0
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the tables (routes.csv, routes.md).")
    ] = Path()

    def instances(self) -> list[Instance]:
        """Return the reward matrices of files, and the families drawn from a seed."""
        from fieldmon.studies.routes.instances import families, read_matrix

        instances = [read_matrix(_text(file), file.name) for file in self.files or []]
        if self.seed is not None:
            instances += families(self.seed, maps=self.maps)
        if not instances:
            raise SettingError("A reward matrix or a seed must be given, but neither is.")
        return instances


@with_options
def routes(options: RoutesOptions) -> None:
    """Compare walks along rows in the published model: unit steps, back to the corner.

    A team takes up to a minute for each budget and matrix. Ctrl-C keeps what is done by then.

    Example: fieldmon study routes rewards.csv --budget 0.1 --budget 0.5 -o study
    """
    from fieldmon.studies.routes.study import (
        MILP,
        PYVRP,
        csv_text,
        run,
        run_teams,
        sentences,
        table,
        team_sentences,
    )

    can_be_folder(options.output)
    shares, sizes = options.budget or [0.1, 0.5], options.team or []
    instances = options.instances()
    methods = [*_ALWAYS, *([PYVRP] if options.pyvrp else []), *([MILP] if options.milp else [])]
    made: list[MethodOutcome] = []
    teams: list[MethodOutcome] = []
    each = len(shares) * (1 + len(methods) + len(sizes))
    with progress("Walks", _PARTS * each * len(instances)) as bar:

        def partly(share: float) -> None:
            """Show how much of a team's search is done: it takes longer than all others."""
            bar.update(int((_PARTS - 1) * share) - bar.pos % _PARTS)

        try:
            for done, instance in enumerate(instances, start=1):
                walks = run(instance, shares, methods, options.solver_seconds)
                for kept, outcomes in (
                    (made, walks),
                    (teams, run_teams(instance, shares, sizes, partly)),
                ):
                    for one in outcomes:
                        kept.append(one)
                        bar.update(_PARTS - bar.pos % _PARTS)
                # not every method plays every matrix
                bar.update(_PARTS * done * each - bar.pos)
        except KeyboardInterrupt:
            if not made:
                raise
            typer.echo("Stopped: this is what was done.")
    for sentence in (*sentences(made), *team_sentences(teams)):
        typer.echo(sentence)
    write_all(options.output, {"routes.csv": csv_text([*made, *teams]), "routes.md": table(made)})


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise FileProblem(
            f"{file} must be a readable text file (CSV), but it is not ({error})."
        ) from error
