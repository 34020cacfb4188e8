"""`fieldmon labels`: what the labels of products allow. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.option_ranges import within
from fieldmon.cli.options import SeasonFile
from fieldmon.cli.season_files import season_of
from fieldmon.decisions.labels import WAITS_DAYS
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.decisions.labels import ProductLabel

Table = Annotated[
    Path | None,
    typer.Argument(
        help="CSV to read: product, crop, pest, max dose, unit, waiting days, re-entry hours, "
        "IRAC group, max uses, source. None: what the season has is listed."
    ),
]
Who = Annotated[str, typer.Option(help="Who provides it.")]
Product = Annotated[
    str, typer.Option(help="Say one product's wait without a table: its name, as it was used.")
]
Waiting = Annotated[
    int | None,
    typer.Option(
        "--waiting-days",
        help="Whole days until harvest on its label; 0 only where the label says so.",
        callback=within(WAITS_DAYS),
    ),
]


def labels(
    season: SeasonFile,
    table: Table = None,
    product: Product = "",
    waiting_days: Waiting = None,
    who: Who = "",
) -> None:
    """Read a table of what product labels allow; treatments are checked against it.

    The table is yours: fieldmon knows no label and no law. It replaces the one before, with what
    was said by --product. What is not known stays empty there: it is never taken as 0.

    Example: fieldmon labels season.gpkg labels.csv
    Example: fieldmon labels season.gpkg --product Acarol --waiting-days 7
    """
    from fieldmon.compute.wording import written
    from fieldmon.decisions.label_file import read_labels

    if bool(product) != (waiting_days is not None):
        raise SettingError("Give --product and --waiting-days together, or neither.")
    kept = season_of(season)
    if table is not None:
        read = read_labels(table)
        for message in read.messages:
            typer.echo(f"{table.name}: {message}", err=True)
        n = kept.keep_labels(read.value, table.name, who)
        typer.echo(f"{table.name}: {n} {written(n, 'label|labels')} kept")
    if waiting_days is not None:
        kept.say_wait(product, waiting_days, who)
    for one in kept.labels():
        typer.echo(f"  {_line(one)}")


def _line(one: ProductLabel) -> str:
    from fieldmon.compute.wording import counted, written

    uses = written(one.max_uses, "use|uses")
    said = [
        f"on {one.crop}" if one.crop else "",
        f"against {one.pest}" if one.pest else "",
        f"at most {one.max_dose}" if one.max_dose else "",
        "" if one.waiting_days is None else f"{counted(one.waiting_days, 'day')} until harvest",
        "" if one.reentry_hours is None else f"{one.reentry_hours:g} h until re-entry",
        f"group {'+'.join(one.irac_groups)}" if one.irac_groups else "",
        "" if one.max_uses is None else f"{one.max_uses} {uses} a season",
        f"({one.source})" if one.source else "",
    ]
    return f"{one.product}: " + ", ".join(part for part in said if part)
