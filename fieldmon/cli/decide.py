"""`fieldmon decide`: spray or not, and where. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.numbers import within
from fieldmon.cli.options import LastDate, SeasonFile
from fieldmon.cli.times import day
from fieldmon.compute.arguments import RATE_L_HA
from fieldmon.compute.ranges import MOST_COUNTED, SURE
from fieldmon.decisions.sprayer import COSTS, SWITCHED
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.decisions.thresholds import Threshold
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.advice import Advice

Level = Annotated[
    str, typer.Option(help="Threshold: a share of the plants (5%), or the name of a published one.")
]
Own = Annotated[
    Path | None, typer.Option(help="CSV of thresholds of your own: name,measure,level,source.")
]
Sure = Annotated[
    float, typer.Option(help="How sure a verdict must be, 0.5 to 1.", callback=within(SURE))
]
Leaves = Annotated[
    int,
    typer.Option(
        help="Leaves inspected, for a threshold of leaves.", callback=within(0, MOST_COUNTED)
    ),
]
Counted = Annotated[
    float,
    typer.Option(
        help="Of these leaves: how many are infested, or animals counted on them.",
        callback=within(0, MOST_COUNTED),
    ),
]
Rate = Annotated[
    float,
    typer.Option(
        help="Litres per hectare in the zones, for the files.", callback=within(RATE_L_HA)
    ),
]
Product = Annotated[str, typer.Option(help="What is sprayed, for the files.")]
Outputs = Annotated[
    list[Path] | None,
    typer.Option(
        "-o", "--output",
        help="Zones to write: .xml.zip, .grid1.xml.zip, .shp.zip, .gpkg, .geojson, .kml, .tif; "
        "or .pdf.",
    ),
]  # fmt: skip
Presence = Annotated[
    bool, typer.Option("--presence", help="For a mean: --counted is the number of infested leaves.")
]
Boom = Annotated[
    float,
    typer.Option(help="Width of the boom, metres; with --sections.", callback=within(0, 1000)),
]
Sections = Annotated[int, typer.Option(help="Sections of the boom.", callback=within(1, 10_000))]
Ring = Annotated[
    int,
    typer.Option(
        help="Knapsack: how many plants around each are sprayed with it.",
        callback=within(SWITCHED["ring"]),
    ),
]
Reserve = Annotated[
    float,
    typer.Option(
        help="Share of the plot that is never sprayed, for predators, 0 to 1.",
        callback=within(COSTS["reserve"]),
    ),
]
Rows = Annotated[
    int,
    typer.Option(
        help="Rows that a section covers; 0: a knapsack sprayer.", callback=within(SWITCHED["rows"])
    ),
]
LeastOn = Annotated[
    float,
    typer.Option(
        help="Least length of a zone along the rows, metres.",
        callback=within(SWITCHED["least_on_m"]),
    ),
]
LeastOff = Annotated[
    float,
    typer.Option(
        help="Least gap between two zones, metres.", callback=within(SWITCHED["least_off_m"])
    ),
]
PerHa = Annotated[
    float,
    typer.Option(
        help="Cost of product, water and work per hectare.", callback=within(COSTS["per_ha"])
    ),
]
PerZone = Annotated[
    float,
    typer.Option(
        help="Cost of switching on and off, per zone.", callback=within(COSTS["per_zone"])
    ),
]
Loss = Annotated[
    float,
    typer.Option(
        help="Loss per plant that is infested for a day.",
        callback=within(COSTS["infested_plant_day"]),
    ),
]
Days = Annotated[
    float,
    typer.Option(
        help="Days that an untreated plant stays infested.", callback=within(COSTS["days"])
    ),
]
Works = Annotated[
    float,
    typer.Option(
        help="Chance that treating cleans a plant, 0 to 1.", callback=within(COSTS["works"])
    ),
]

_LEAVES_OF_PLANTS = (
    "--leaves, --counted and --presence answer a threshold of leaves, but {} is a share of the "
    "plants, which the season itself knows. Leave them out, or name a threshold of leaves."
)

#: endings of the advice to print
_PAPER = (".pdf", ".html")


def decide(  # noqa: PLR0913, PLR0917 - the command's options
    season: SeasonFile,
    threshold: Level,
    thresholds: Own = None,
    on: LastDate = None,
    sure: Sure = 0.9,
    leaves: Leaves = 0,
    counted: Counted = 0.0,
    presence: Presence = False,  # noqa: FBT002 - a flag of the command
    rate: Rate = 300.0,
    product: Product = "",
    output: Outputs = None,
    section_rows: Rows = 2,
    least_on: LeastOn = 6.0,
    least_off: LeastOff = 6.0,
    boom: Boom = 0.0,
    sections: Sections = 1,
    ring: Ring = 0,
    per_ha: PerHa = 100.0,
    per_zone: PerZone = 0.5,
    loss: Loss = 0.1,
    days: Days = 14.0,
    works: Works = 0.9,
    reserve: Reserve = 0.0,
) -> None:
    """Say whether to spray, and where it pays; write the zones for the sprayer.

    Example: fieldmon decide season.gpkg --threshold 5% --per-ha 120 -o zones.xml.zip
    """
    from fieldmon.decisions.leaves import of_leaves
    from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
    from fieldmon.decisions.thresholds import threshold_of
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.advice import AdviceSettings

    asked = threshold_of(threshold, _own(thresholds))
    for path in output or []:
        _check_name(path)
    of_plants = asked.measure == "share of plants"
    _refuse_idle(
        (of_plants and (leaves or counted or presence), _LEAVES_OF_PLANTS.format(threshold)),
        (counted and not leaves, "--counted says what was found on leaves: give --leaves N too."),
        (sections > 1 and not boom, "--sections are those of a boom: give --boom METRES too."),
        (ring and (boom or section_rows), "--ring is of a knapsack: give --section-rows 0 too."),
    )
    kept = Season(season)
    when = day(on) or kept.last_date()
    rows_m = kept.plot.grid.row_spacing_m
    rows = Sprayer.of_boom(boom, sections, rows_m).rows if boom else section_rows
    level = {"level": asked.level} if of_plants else {}
    advice = kept.advice(
        when,
        AdviceSettings(
            sure=sure,
            sprayer=Sprayer(rows, least_on, least_off, ring),
            costs=TreatmentCosts(per_ha, per_zone, loss, days, works, reserve),
            rate_l_ha=rate,
            **level,
        ),
    )
    if level:
        said, short = [advice.headline(), *advice.reasons()], advice.in_short()
    else:
        named = "" if leaves else " (--leaves, --counted)"
        said = [of_leaves(asked, leaves, counted, presence=presence) + named]
        short = " ".join([*said, advice.zones.sentence()])
    where = advice.said_of_zones(above=bool(level))
    typer.echo("\n".join([f"{when}, after the day's work.", asked.sentence(), *said, *where]))
    kept.advise(when, short)
    if output:
        _write(_AdviceAsked(kept, when, advice, product), output)


def _refuse_idle(*each: tuple[object, str]) -> None:
    """Refuse what would be passed over without a word: the first sentence that holds."""
    for idle, says in each:
        if idle:
            raise SettingError(says)


def _own(path: Path | None) -> tuple[Threshold, ...] | None:
    from fieldmon.decisions.thresholds import published, read_thresholds

    return None if path is None else (*published(), *read_thresholds(path))


@dataclass(frozen=True, eq=False)
class _AdviceAsked:
    kept: Season
    when: date
    advice: Advice
    product: str


def _check_name(path: Path) -> None:
    """Refuse a file that could not be written, before the first of them is."""
    from fieldmon.io.atomic_write import require_place
    from fieldmon.io.writers.treatment_map import checked_ending

    if path.suffix.lower() not in _PAPER:
        try:
            checked_ending(path.name)
        except SettingError as error:
            raise SettingError(f"{error} The advice to print ends in .pdf or .html.") from error
    require_place(path)


def _write(asked: _AdviceAsked, paths: list[Path]) -> None:
    from fieldmon.compute.units import Units
    from fieldmon.io.writers.treatment_map import write_treatment_map
    from fieldmon.reports.advice import advice_report
    from fieldmon.reports.write import write_report

    for path in paths:
        if path.suffix.lower() in _PAPER:
            made = advice_report(asked.kept, asked.when, asked.advice, Units(), asked.product)
            typer.echo(f"Advice written to {write_report(made, path)}")
            continue
        of = asked.advice.treatment_map(asked.kept.plot.field, asked.product)
        typer.echo(f"Zones written to {write_treatment_map(of, path)}")
