"""`fieldmon study samplers`: Adaptive against Dynamic and the others, on the same insects."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import VisitEvery
from fieldmon.cli.pest_options import PestName, pest_in_weather_of
from fieldmon.cli.progress import counting
from fieldmon.cli.sampler_names import OWN
from fieldmon.cli.scenario_names import beginning_so
from fieldmon.cli.study_output import can_be_folder, going_on, tell_not_read, write_all
from fieldmon.compute.ranges import PAIRED
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.studies.samplers.contenders import Added
    from fieldmon.studies.samplers.scenarios import Scenario
    from fieldmon.studies.samplers.seasons import SeasonOutcome


_SEEDS = 10


@dataclass(frozen=True)
class SamplersOptions:
    """What `fieldmon study samplers` is told."""

    seeds: Annotated[
        int | None,
        typer.Option(
            help="Simulated seasons per scenario.",
            callback=within(PAIRED),
            show_default=str(_SEEDS),
        ),
    ] = None
    full: Annotated[
        bool,
        typer.Option(
            "--full", help="Run every combination of plot, spread, start and prior (takes hours)."
        ),
    ] = False
    scenario: Annotated[
        list[str] | None,
        typer.Option(
            "--scenario",
            "--cell",
            help="Only scenarios whose name begins like this; repeat for more.",
        ),
    ] = None
    maps: Annotated[
        Path | None,
        typer.Option(
            help="Folder with maps of plants, public ones or NAME.map.csv (docs: strategies): "
            "compare finds on these."
        ),
    ] = None
    sampler: Annotated[
        list[str] | None,
        typer.Option(help=f"Sampler to add to those compared, or {OWN}; repeat for more."),
    ] = None
    tune: Annotated[
        bool, typer.Option("--tune", help="Search Dynamic's open choices instead (ten minutes).")
    ] = False
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the table (CSV) and report (HTML).")
    ] = Path()
    pest: PestName = None
    visit_every: VisitEvery = 1


@with_options
def samplers(options: SamplersOptions) -> None:
    """Compare samplers in scenarios A, B and C: infested plant-days, days to 50 and 80 %.

    A study that was stopped continues where its table ends. With 10 seeds it takes about five
    minutes.

    Scenarios named "world" run only if chosen. There the insects do what no chance map expects.
    --scenario "world, B, 12 h" --seeds 200 gives most ratios to five hundredths, in a quarter of
    an hour.

    With --pest that pest lives in all scenarios, at the temperature of its figures, and every
    sampler knows it: "B, whitefly, clusters, prior none" is such a scenario.

    With --maps the plots are maps of real plants, on which nothing spreads. One of your own is a
    table NAME.map.csv with the columns row, plant, infested, row_m and plant_m.

    With --visit-every 7 somebody inspects on days 1, 8, 15 and 22, and insects spread on all.

    A sampler that is added by --sampler, as NAME or my_sampler.py:Mine, meets the same insects and
    is given the map of chances of adaptive. A table of before is only completed.

    Example: fieldmon study samplers --scenario "B, spread 30% to one" --seeds 20 -o study
    """
    from fieldmon.studies.samplers.contenders import added
    from fieldmon.studies.samplers.report import report_html
    from fieldmon.studies.samplers.summary import ratio_lines, sentences

    can_be_folder(options.output)
    if options.pest is not None and (options.tune or options.maps is not None):
        raise SettingError(
            "--pest goes without --maps, where nothing spreads, and without --tune, which searches "
            "for the study's own insects."
        )
    if options.visit_every > 1 and (options.tune or options.maps is not None):
        raise SettingError("--visit-every goes without --maps and --tune: both know daily visits.")
    if options.sampler and options.tune:
        raise SettingError("--sampler goes without --tune, which tries Dynamic alone.")
    if options.maps is not None and (
        options.seeds is not None or options.scenario or options.full or options.tune
    ):
        raise SettingError(
            "--maps goes without --seeds, --scenario, --full and --tune: a map is inspected once "
            "from each corner, and nothing is drawn."
        )
    if options.maps is not None:
        _on_maps(options.maps, options.output, options.sampler or ())
        return
    if options.tune:
        _tune()
        return
    table = options.output / "samplers.csv"
    meant = _scenarios(options.scenario, pest_in_weather_of(options.pest), full=options.full)
    meant = [replace(each, visit_every=options.visit_every) for each in meant]
    more = added(options.sampler or ())
    shown = _outcomes(meant, options.seeds or _SEEDS, more, table)
    for sentence in (*ratio_lines(shown), *sentences(shown)):
        typer.echo(sentence)
    typer.echo(f"Written: {table}")
    about = {one.label: one.about for one in more}
    write_all(options.output, {"samplers.html": report_html(shown, about)})


def _scenarios(
    beginnings: list[str] | None, pest_in_weather: PestInWeather | None, *, full: bool
) -> list[Scenario]:
    """Return the scenarios that are meant."""
    from fieldmon.studies.samplers.scenarios import (
        all_scenarios,
        in_worlds,
        usual_scenarios,
        with_pest,
    )

    scenarios = all_scenarios() if full else usual_scenarios()
    if pest_in_weather is not None:
        scenarios = with_pest(scenarios, pest_in_weather)
    if not beginnings:
        return scenarios
    if pest_in_weather is None:
        scenarios = [*scenarios, *in_worlds()]
    return beginning_so(beginnings, scenarios, "" if full else ", and more with --full")


def _outcomes(
    scenarios: list[Scenario], seeds: int, more: Sequence[Added], file: Path
) -> list[SeasonOutcome]:
    """Simulate what the table lacks, and keep it there; return the outcomes asked for."""
    from fieldmon.simulation import executor
    from fieldmon.simulation.experiment import run
    from fieldmon.studies.outcome_table import OutcomeTable
    from fieldmon.studies.samplers.contenders import CONTENDERS, NAMES, OF_PESTS
    from fieldmon.studies.samplers.seasons import SeasonOutcome, study_of

    pest = scenarios[0].pest_in_weather is not None
    always = {one.name for one in (OF_PESTS if pest else CONTENDERS) if one.every == 1}

    def whole(rows: list[SeasonOutcome]) -> bool:
        who = {row.contender for row in rows}
        return always <= who or who.isdisjoint(NAMES)

    study = study_of(scenarios, range(seeds), more)
    table = OutcomeTable(file, [chunk.key for chunk in study.chunks()], SeasonOutcome, whole)
    with going_on(file), counting("Seasons") as count, table, executor.threads() as workers:
        run(study, workers, table, count)
    labels = {one.called: one.label for one in more}
    return [
        replace(each, contender=labels.get(each.contender, each.contender))
        for each in table.asked()
    ]


def _tune() -> None:
    """Print what each of Dynamic's open choices loses."""
    from fieldmon.studies.samplers.tuning import (
        SEEDS,
        losses,
        tuning_scenarios,
    )

    with counting("Choices") as count:
        made = losses(tuning_scenarios(), SEEDS, count)
    for loss, suspicious, at_once in sorted((loss, *choice) for choice, loss in made.items()):
        typer.echo(f"{loss:8.1f} infested plant-days: {suspicious = }, {at_once = }")


def _on_maps(folder: Path, output: Path, samplers: Sequence[str]) -> None:
    """Print and write how many infested plants an inspection finds on mapped plots."""
    from fieldmon.compute.wording import counted
    from fieldmon.studies.samplers.contenders import added
    from fieldmon.studies.samplers.mapped_plots import (
        FILES,
        SHARES,
        WHO,
        plots_in,
        sentences,
        table,
        table_csv,
    )

    plots, rows, more = plots_in(folder), [], added(samplers, to=WHO)
    tell_not_read(folder, FILES)
    after = _columns(SHARES, "{:6.0%}")
    typer.echo(f"{'Infested plants found after':44} {'':9} {after}  {after}")
    typer.echo(f"{'':44} {'':9} {'per inspection':27}  per hour")
    for plot in plots:
        of_plot = table([plot], more)
        for row in of_plot:
            named = f"{row.name} (neighbours {row.correlation:.2f})".replace("nan", "-")
            found = _columns(row.per_inspection, "{:6.2f}")
            typer.echo(f"{named:44} {row.who:9} {found}  {_columns(row.per_hour, '{:6.1f}')}")
        rows += of_plot
        if plot.unknown:
            typer.echo(f"{plot.name}: {counted(plot.unknown, 'plant')} of unknown state left out")
    for sentence in sentences(rows):
        typer.echo(sentence)
    write_all(output, {"maps.csv": table_csv(rows)})


def _columns(values: Iterable[float], form: str) -> str:
    """Return numbers side by side; those that there are none of are a hyphen."""
    return " ".join(form.format(value).replace("nan", "  -") for value in values)
