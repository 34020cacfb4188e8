"""`fieldmon treat`: a plot or a part of it was sprayed. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import how_to_say_wait, tell_not_come
from fieldmon.cli.option_groups import with_options
from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import SeasonFile, TheDate
from fieldmon.cli.season_files import season_of
from fieldmon.cli.times import clock, day, day_on
from fieldmon.compute.ranges import CHANCE
from fieldmon.compute.wording import estimate
from fieldmon.decisions.doses import WATER_L_HA
from fieldmon.decisions.labels import WAITS_DAYS, WAITS_HOURS
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.monitoring import Application, Season

Area = Annotated[
    Path | None,
    typer.Option(help="File with the area treated, as fieldmon decide writes it; else the plot."),
]
RowsTreated = Annotated[
    str | None, typer.Option("--rows", help="Rows treated instead of an area: 3-5,8.")
]
DoseSaid = Annotated[
    str | None, typer.Option(help="Dose of the product with its unit: '0.5 l/ha', '20 ml/dunam'.")
]
Groups = Annotated[str, typer.Option("--irac", help="Mode-of-action group: 6, or 4A+28.")]
Waiting = Annotated[
    int | None,
    typer.Option(
        "--waiting-days",
        help="Whole days until harvest; else the label's.",
        callback=within(WAITS_DAYS),
    ),
]
ReEntry = Annotated[
    float | None,
    typer.Option(
        "--reentry-hours",
        help="Hours until people may enter; else the label's.",
        callback=within(WAITS_HOURS),
    ),
]
Began = Annotated[str | None, typer.Option("--began", help="Local time at which it began, HH:MM.")]
Ended = Annotated[
    str | None,
    typer.Option(
        "--ended",
        help="Local time at which it ended: what was inspected later counts after it; else the end "
        "of the day.",
    ),
]


@dataclass(frozen=True)
class TreatOptions:
    """What `fieldmon treat` is told."""

    season: SeasonFile
    efficacy: Annotated[
        float | None,
        typer.Option(
            help="Chance that an infested plant is clean afterwards, 0 to 1; else as the season "
            "learnt it of the product.",
            callback=within(CHANCE),
        ),
    ] = None
    area: Area = None
    rows: RowsTreated = None
    on: TheDate = None
    product: Annotated[str, typer.Option(help="What was used.")] = ""
    active_ingredient: Annotated[str, typer.Option(help="Its active ingredient.")] = ""
    dose: DoseSaid = None
    water: Annotated[
        float | None,
        typer.Option(help="Litres of water per hectare.", callback=within(WATER_L_HA)),
    ] = None
    operator: Annotated[str, typer.Option(help="Who did it.")] = ""
    reason: Annotated[str, typer.Option(help="Why: the pest, and what was seen.")] = ""
    waiting_days: Waiting = None
    reentry_hours: ReEntry = None
    irac: Groups = ""
    began: Began = None
    ended: Ended = None
    machinery: Annotated[str, typer.Option(help="Sprayer, knapsack, by hand.")] = ""
    crop: Annotated[str, typer.Option(help="Crop it was for.")] = ""
    pest: Annotated[str, typer.Option(help="Pest it was for.")] = ""
    authorised_by: Annotated[str, typer.Option(help="Who authorised it.")] = ""
    weather: Annotated[str, typer.Option(help="Weather then: '18 °C, wind 2 m/s, dry'.")] = ""

    def application(self) -> Application:
        """Return what was applied."""
        from fieldmon.decisions.doses import Dose
        from fieldmon.decisions.labels import irac_groups
        from fieldmon.monitoring import Application

        return Application(
            product=self.product,
            dose=None if self.dose is None else Dose.of(self.dose, "--dose"),
            water_l_ha=self.water,
            operator=self.operator,
            reason=self.reason,
            waiting_days=self.waiting_days,
            reentry_hours=self.reentry_hours,
            irac_groups=irac_groups(self.irac),
            began=None if self.began is None else clock(self.began, "--began"),
            ended=None if self.ended is None else clock(self.ended, "--ended"),
            machinery=self.machinery,
            crop=self.crop,
            pest=self.pest,
            authorised_by=self.authorised_by,
            active_ingredient=self.active_ingredient,
            weather=self.weather,
        )


@with_options
def treat(options: TreatOptions) -> None:
    """Record that the plot or a part of it was sprayed; the chances fall there.

    Waiting periods, dose and mode-of-action group are checked against the label table, see
    fieldmon labels, and warnings are printed.

    Example: fieldmon treat season.gpkg --efficacy 0.8 --area zones.gpkg --product soap
    """
    from fieldmon.io.read import read_treated
    from fieldmon.monitoring.estimates.day_figures import flagged_said
    from fieldmon.plot.named_rows import plants_in_rows

    if options.area is not None and options.rows is not None:
        raise SettingError("Give --area or --rows, not both.")
    told, said = day(options.on), options.application()
    kept = season_of(options.season)
    treated = None
    if options.area is not None:
        read = read_treated(options.area)
        treated = read.value
        for message in read.messages:
            typer.echo(str(message), err=True)
    plants = None if options.rows is None else plants_in_rows(kept.plot.grid, options.rows)
    on_day = day_on(kept.plot.field, told)
    done = kept.treat(on_day, options.efficacy, treated, application=said, plants=plants)
    if not done.new:
        typer.echo("This treatment was noted already; nothing changed.")
        return
    tell_not_come(on_day, kept.plot.field, "the day of the treatment")
    now = kept.status(on_day)
    still = now.infested
    typer.echo(
        f"Treatment noted as batch {done.batch}; about {estimate(still.expected)} plants are "
        f"believed infested now ({still.low:,} to {still.high:,})."
    )
    for sentence in flagged_said(now.estimate, now.flagged):
        typer.echo(sentence)
    _say_what_follows(kept, done.batch, learnt=options.efficacy is None)


def _say_what_follows(kept: Season, batch: int | None, *, learnt: bool) -> None:
    """Print what a treatment asks for: waiting periods and warnings."""
    from fieldmon.monitoring.treating.cautions import harvest_unsaid, label_of, waits

    (one,) = (treatment for treatment in kept.treatments() if treatment.batch == batch)
    if learnt:
        typer.echo(
            f"Assumed: it cleans {100 * one.efficacy:.0f} % of infested plants, as learnt before."
        )
    if one.application.ends_next_day:
        typer.echo(
            f"Taken as over midnight: it ended on {one.on + timedelta(days=1)} at "
            f"{one.application.ended:%H:%M}. If that is wrong: fieldmon undo"
        )
    period = waits(one, label_of(one, kept.labels()))
    if period.entry_from is not None:
        typer.echo(f"Enter there from {period.entry_from:%Y-%m-%d %H:%M} on ({one.clock.zone}).")
    first = kept.harvest_from(one.on)
    if first is not None and first[0] is None and first[1].batch != batch:
        typer.echo(f"{harvest_unsaid(first[1])} {how_to_say_wait(kept.path, first[1])}")
    elif period.harvest_from is not None:
        typer.echo(f"Harvest there from {period.harvest_from} on.")
    for caution in kept.cautions(one.on, because_of=one.batch):
        typer.echo(f"warning: {caution.sentence}", err=True)
    if period.harvest_from is None:
        typer.echo(how_to_say_wait(kept.path, one), err=True)
