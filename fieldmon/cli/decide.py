"""`fieldmon decide`: spray or not, and where. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import tell_found_again
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import LastDate, SeasonFile
from fieldmon.cli.season_files import default_date, refuse_unrecorded, season_of
from fieldmon.cli.times import day
from fieldmon.compute.ranges import MOST_COUNTED, SURE, USUAL_SURE
from fieldmon.decisions.sprayer import COSTS, SWITCHED, Sprayer, TreatmentCosts
from fieldmon.errors import SettingError
from fieldmon.io.spray_rate import RATE_L_HA, USUAL_RATE_L_HA

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    from fieldmon.decisions.thresholds import Threshold
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.advice.advice import Advice

_OF_PLANTS = "share of plants"
_LEAVES_OF_PLANTS = (
    "--leaves, --counted and --presence answer a threshold of leaves, but {} is a share of the "
    "plants, which the season itself knows. Leave them out, or name a threshold of leaves."
)

#: endings of the advice to print
_PAPER = (".pdf", ".html")


@dataclass(frozen=True)
class DecideOptions:
    """What is asked of the season."""

    season: SeasonFile
    threshold: Annotated[
        str,
        typer.Option(
            help="Action threshold: a share of the plants (5%), or the name of a published one."
        ),
    ]
    thresholds: Annotated[
        Path | None,
        typer.Option(help="CSV of action thresholds of your own: name,measure,level,source."),
    ] = None
    on: LastDate = None
    sure: Annotated[
        float, typer.Option(help="How sure a verdict must be, 0.5 to 1.", callback=within(SURE))
    ] = USUAL_SURE


@dataclass(frozen=True)
class LeafOptions:
    """What was seen on leaves, for a threshold of those."""

    leaves: Annotated[
        int,
        typer.Option(
            help="Leaves inspected, for a threshold of leaves.", callback=within(0, MOST_COUNTED)
        ),
    ] = 0
    counted: Annotated[
        float,
        typer.Option(
            help="Of these leaves: how many are infested, or animals counted on them.",
            callback=within(0, MOST_COUNTED),
        ),
    ] = 0.0
    presence: Annotated[
        bool,
        typer.Option("--presence", help="For a mean: --counted is the number of infested leaves."),
    ] = False

    def given(self) -> bool:
        """Return whether any of it was told."""
        return bool(self.leaves or self.counted or self.presence)

    def idle(self) -> Iterator[tuple[object, str]]:
        """Yield whether a part of it would be passed over, and what to say then."""
        says = "--counted says what was found on leaves: give --leaves N too."
        yield self.counted and not self.leaves, says


@dataclass(frozen=True)
class ZoneFileOptions:
    """What is written, and what it says of the product."""

    rate: Annotated[
        float,
        typer.Option(
            help="Litres per hectare in the zones, for the files.", callback=within(RATE_L_HA)
        ),
    ] = USUAL_RATE_L_HA
    product: Annotated[
        str, typer.Option(help="What is sprayed, for the files; it is held to its label.")
    ] = ""
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o", "--output",
            help="Zones to write: .xml.zip, .grid1.xml.zip, .shp.zip, .gpkg, .geojson, .kml, .tif; "
            "or .pdf.",
        ),
    ] = None  # fmt: skip


@dataclass(frozen=True)
class SprayerOptions:
    """What the sprayer can switch."""

    section_rows: Annotated[
        int,
        typer.Option(
            help="Rows that a section covers; 0: a knapsack sprayer.",
            callback=within(SWITCHED["rows"]),
        ),
    ] = Sprayer.rows
    least_on: Annotated[
        float,
        typer.Option(
            help="Least length of a zone along the rows, metres.",
            callback=within(SWITCHED["least_on_m"]),
        ),
    ] = Sprayer.least_on_m
    least_off: Annotated[
        float,
        typer.Option(
            help="Least gap between two zones, metres.", callback=within(SWITCHED["least_off_m"])
        ),
    ] = Sprayer.least_off_m
    boom: Annotated[
        float,
        typer.Option(help="Width of the boom, metres; with --sections.", callback=within(0, 1000)),
    ] = 0.0
    sections: Annotated[
        int, typer.Option(help="Sections of the boom.", callback=within(1, 10_000))
    ] = 1
    ring: Annotated[
        int,
        typer.Option(
            help="Knapsack: how many plants around each are sprayed with it.",
            callback=within(SWITCHED["ring"]),
        ),
    ] = Sprayer.ring

    def idle(self) -> Iterator[tuple[object, str]]:
        """Yield whether a part of it would be passed over, and what to say then."""
        says = "--sections are those of a boom: give --boom METRES too."
        yield self.sections > 1 and not self.boom, says
        says = "--ring is of a knapsack: give --section-rows 0 too."
        yield self.ring and (self.boom or self.section_rows), says

    def sprayer(self, row_spacing_m: float) -> Sprayer:
        """Return what it can switch on rows so far apart."""
        rows = self.section_rows
        if self.boom:
            rows = Sprayer.of_boom(self.boom, self.sections, row_spacing_m).rows
        return Sprayer(rows, self.least_on, self.least_off, self.ring)


@dataclass(frozen=True)
class CostOptions:
    """What treating costs and saves."""

    per_ha: Annotated[
        float,
        typer.Option(
            help="Cost of product, water and work per hectare.", callback=within(COSTS["per_ha"])
        ),
    ] = TreatmentCosts.per_ha
    per_zone: Annotated[
        float,
        typer.Option(
            help="Cost of switching on and off, per zone.", callback=within(COSTS["per_zone"])
        ),
    ] = TreatmentCosts.per_zone
    loss: Annotated[
        float,
        typer.Option(
            help="Loss per plant that is infested for a day; with --both-faces, per face.",
            callback=within(COSTS["infested_plant_day"]),
        ),
    ] = TreatmentCosts.infested_plant_day
    days: Annotated[
        float,
        typer.Option(
            help="Days that an untreated plant stays infested.", callback=within(COSTS["days"])
        ),
    ] = TreatmentCosts.days
    works: Annotated[
        float | None,
        typer.Option(
            help="Chance that treating cleans a plant, 0 to 1; else as the season learnt it of the "
            f"product, or of the last one used; {TreatmentCosts.works:g} if it learnt nothing.",
            callback=within(COSTS["works"]),
        ),
    ] = None
    reserve: Annotated[
        float,
        typer.Option(
            help="Share of the plot that is never sprayed, for predators, 0 to 1.",
            callback=within(COSTS["reserve"]),
        ),
    ] = TreatmentCosts.reserve

    def costs(self, learnt: float | None) -> TreatmentCosts:
        """Return them as decisions take them; how well treating works may be `learnt`."""
        told = TreatmentCosts(
            self.per_ha, self.per_zone, self.loss, self.days, reserve=self.reserve
        )
        works = learnt if self.works is None else self.works
        return told if works is None else replace(told, works=works)


@with_options
def decide(
    asked: DecideOptions,
    leaves: LeafOptions,
    files: ZoneFileOptions,
    sprayer: SprayerOptions,
    costs: CostOptions,
) -> None:
    """Say whether to spray, and where it pays; write the zones for the sprayer.

    Example: fieldmon decide season.gpkg --threshold 5% --per-ha 120 -o zones.xml.zip
    """
    from fieldmon.decisions.thresholds import threshold_of
    from fieldmon.monitoring.days.advised import advise
    from fieldmon.monitoring.estimates.treatment_effect import learnt_efficacy
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings

    threshold = threshold_of(asked.threshold, _own(asked.thresholds))
    for path in files.output or []:
        _check_name(path)
    of_plants = threshold.measure == _OF_PLANTS
    _refuse_idle(
        (of_plants and leaves.given(), _LEAVES_OF_PLANTS.format(asked.threshold)),
        *leaves.idle(),
        *sprayer.idle(),
    )
    kept = season_of(asked.season)
    refuse_unrecorded(kept, files.output or [])
    when = default_date(kept, day(asked.on))
    learnt = learnt_efficacy(kept.effects(when), files.product) if costs.works is None else None
    settings = AdviceSettings(
        sure=asked.sure,
        sprayer=sprayer.sprayer(kept.plot.grid.row_spacing_m),
        costs=costs.costs(None if learnt is None else learnt.efficacy),
        rate_l_ha=files.rate,
        learnt_of="" if learnt is None else learnt.product,
    )
    if of_plants:
        settings = replace(settings, level=threshold.level)
    advice = kept.advice(when, settings)
    said, short = _in_words(advice, threshold, leaves)
    where = advice.said_of_zones(above=of_plants)
    typer.echo("\n".join([f"{when}, after the day's work.", threshold.sentence(), *said, *where]))
    tell_found_again(kept, when)
    pest = kept.settings.pest
    if doubt := threshold.doubt("" if pest is None else pest.name):
        typer.echo(f"warning: {doubt}", err=True)
    for caution in kept.cautions_if_treated(when, files.product, advice.sprayed):
        typer.echo(f"warning: {caution.sentence}", err=True)
    refused = _write(_AdviceAsked(kept, when, advice, files.product), files.output or [])
    advise(kept, when, short)
    if refused is not None:
        raise refused


def _in_words(advice: Advice, threshold: Threshold, leaves: LeafOptions) -> tuple[list[str], str]:
    """Return the answer to a threshold of plants or of leaves, line by line and in short."""
    from fieldmon.decisions.leaves import of_leaves

    if threshold.measure == _OF_PLANTS:
        return [advice.headline(), *advice.reasons()], advice.in_short()
    said = of_leaves(threshold, leaves.leaves, leaves.counted, presence=leaves.presence)
    said += "" if leaves.leaves else " (--leaves, --counted)"
    return [said], f"{said} {advice.zones.sentence()}"


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


def _write(asked: _AdviceAsked, paths: list[Path]) -> SettingError | None:
    """Write the pages, then the zones; return why there are none, where spraying pays nowhere."""
    if not paths:
        return None
    from fieldmon.compute.units import Units
    from fieldmon.io.writers.treatment_map import said_of_cells, write_treatment_map
    from fieldmon.reports.advice import advice_report
    from fieldmon.reports.write import write_report

    zones = [path for path in paths if path.suffix.lower() not in _PAPER]
    for path in paths:
        if path not in zones:
            made = advice_report(asked.kept, asked.when, asked.advice, Units(), asked.product)
            typer.echo(f"Advice written to {write_report(made, path)}")
    if not zones:
        return None
    try:
        of = asked.advice.treatment_map(asked.kept.plot.field, asked.product)
    except SettingError as none:
        return none
    for path in zones:
        typer.echo(f"Zones written to {write_treatment_map(of, path)}")
        if said := said_of_cells(of, path.name):
            typer.echo(said)
    return None
