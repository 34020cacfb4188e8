"""`fieldmon decide`: spray or not, and where. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.options import SeasonFile, TheDate
from fieldmon.cli.times import day

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.decisions.thresholds import Threshold
    from fieldmon.decisions.zones import Sprayer, TreatmentCosts, Zones
    from fieldmon.monitoring import Season

Level = Annotated[
    str, typer.Option(help="Treat from here on: a share of the plants, 5%, or a published name.")
]
Own = Annotated[
    Path | None, typer.Option(help="CSV of thresholds of your own: name,measure,level,source.")
]
Sure = Annotated[float, typer.Option(help="How sure a verdict must be, 0.5 to 1.")]
Leaves = Annotated[int, typer.Option(help="Leaves looked at, for a threshold of leaves.", min=0)]
Counted = Annotated[
    float, typer.Option(help="Of these: leaves infested, or animals counted on them.", min=0)
]
Rate = Annotated[float, typer.Option(help="Litres a hectare in the zones, for the files.")]
Product = Annotated[str, typer.Option(help="What is sprayed, for the files.")]
Outputs = Annotated[
    list[Path] | None,
    typer.Option("-o", "--output", help="Zones to write: .xml.zip, .shp.zip, .gpkg or .kml."),
]
Rows = Annotated[int, typer.Option(help="Rows that a section covers; 0: plant by plant.", min=0)]
LeastOn = Annotated[float, typer.Option(help="Least length of a zone along the rows, metres.")]
LeastOff = Annotated[float, typer.Option(help="Least gap between two, metres.")]
PerHa = Annotated[float, typer.Option(help="Product, water and work for a hectare.")]
PerZone = Annotated[float, typer.Option(help="What switching on and off costs.")]
Loss = Annotated[float, typer.Option(help="Loss by a plant that is infested for a day.")]
Days = Annotated[float, typer.Option(help="Days that an untreated plant stays infested.")]
Works = Annotated[float, typer.Option(help="Chance that treating cleans a plant, 0 to 1.")]


def decide(  # noqa: PLR0913, PLR0917 - the command's options
    season: SeasonFile,
    threshold: Level,
    thresholds: Own = None,
    on: TheDate = None,
    sure: Sure = 0.9,
    leaves: Leaves = 0,
    counted: Counted = 0.0,
    rate: Rate = 300.0,
    product: Product = "",
    output: Outputs = None,
    section_rows: Rows = 2,
    least_on: LeastOn = 6.0,
    least_off: LeastOff = 6.0,
    per_ha: PerHa = 100.0,
    per_zone: PerZone = 0.5,
    loss: Loss = 0.1,
    days: Days = 14.0,
    works: Works = 0.9,
) -> None:
    """Say whether to spray, and where it pays; write the zones for the sprayer.

    Example: fieldmon decide season.gpkg --threshold 5% --per-ha 120 -o zones.xml.zip
    """
    from fieldmon.decisions.thresholds import threshold_of  # noqa: PLC0415
    from fieldmon.decisions.zones import Sprayer, TreatmentCosts  # noqa: PLC0415
    from fieldmon.monitoring import Season  # noqa: PLC0415

    asked = threshold_of(threshold, _own(thresholds))
    kept = Season(season)
    when = day(on) or kept.last_date()
    typer.echo(asked.sentence())
    if asked.measure == "share of plants":
        typer.echo(kept.verdict(when, asked.level, sure).sentence())
    else:
        typer.echo(_of_leaves(asked, leaves, counted))
    sprayer = Sprayer(section_rows, least_on, least_off)
    costs = TreatmentCosts(per_ha, per_zone, loss, days, works)
    zones = _where(kept, when, sprayer, costs)
    if output:
        _write(kept, zones, _Files(tuple(output), rate, product))


def _own(path: Path | None) -> tuple[Threshold, ...] | None:
    from fieldmon.decisions.thresholds import published, read_thresholds  # noqa: PLC0415

    return None if path is None else (*published(), *read_thresholds(path))


def _of_leaves(asked: Threshold, leaves: int, counted: float) -> str:
    """Return what leaves say, which the season knows nothing of."""
    from fieldmon.decisions.sequential import IwaoPlan, after, least_more  # noqa: PLC0415
    from fieldmon.decisions.taylor import TaylorLaw  # noqa: PLC0415

    plan = IwaoPlan(asked.level, None if asked.is_share else TaylorLaw())
    if not leaves:
        return (
            f"The season holds plants, and this threshold is of leaves: look at "
            f"{least_more(plan, 0, 0)} leaves or more, and say --leaves and --counted."
        )
    verdict = after(plan, leaves, counted)
    said = f"{leaves} leaves, {counted:g} counted: {verdict}"
    if verdict == "look on":
        said += f"; after {least_more(plan, leaves, counted)} more you can decide at the earliest"
    return f"{said} (Iwao's plan, 90 % sure)."


def _where(kept: Season, when: date, sprayer: Sprayer, costs: TreatmentCosts) -> Zones:
    from fieldmon.decisions.zones import best_zones  # noqa: PLC0415

    zones = best_zones(kept.plot.grid, kept.evening(when), sprayer, costs)
    typer.echo(zones.sentence())
    typer.echo(
        f"Assumed: {costs.per_ha:g} a hectare and {costs.per_zone:g} a zone to treat, "
        f"{costs.infested_plant_day:g} lost a day by an infested plant over {costs.days:g} days, "
        f"treating cleans {costs.works:.0%}."
    )
    return zones


@dataclass(frozen=True)
class _Files:
    paths: tuple[Path, ...]
    rate_l_ha: float
    product: str


def _write(kept: Season, zones: Zones, files: _Files) -> None:
    from fieldmon.decisions.zones import outlines  # noqa: PLC0415
    from fieldmon.io.writers.treatment_map import (  # noqa: PLC0415
        TreatmentMap,
        write_treatment_map,
    )

    of = TreatmentMap(
        kept.plot.field.name,
        kept.plot.field.boundary,
        outlines(kept.plot.grid, zones),
        files.rate_l_ha,
        files.product,
    )
    for path in files.paths:
        typer.echo(f"Zones written to {write_treatment_map(of, path)}")
