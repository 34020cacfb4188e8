"""`fieldmon treat`: a plot or a part of it was sprayed. Heavy imports wait."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.options import SeasonFile, TheDate
from fieldmon.cli.times import day, day_on

if TYPE_CHECKING:
    from shapely import MultiPolygon


def treat(
    season: SeasonFile,
    efficacy: Annotated[
        float, typer.Option(help="Chance that an infested plant is clean afterwards, 0 to 1.")
    ],
    area: Annotated[
        Path | None, typer.Option(help="File with the area treated; the whole plot if none.")
    ] = None,
    product: Annotated[str, typer.Option(help="What was used.")] = "",
    on: TheDate = None,
) -> None:
    """Note that the plot or an area of it was sprayed; the chance falls there.

    Example: fieldmon treat season.gpkg --efficacy 0.8 --area corner.geojson --product soap
    """
    from fieldmon.monitoring import Season  # noqa: PLC0415

    told = day(on)
    kept = Season(season)
    treated = None if area is None else _area(area)
    on_day = day_on(kept.plot.field, told)
    done = kept.treat(on_day, efficacy, treated, product)
    if not done.new:
        typer.echo("This treatment was noted already; nothing changed.")
        return
    ahead = kept.status(on_day).estimate
    typer.echo(
        f"Treatment noted as batch {done.batch}; about {ahead.expected:.1f} plants are believed "
        f"infested now ({ahead.low} to {ahead.high})."
    )


def _area(file: Path) -> MultiPolygon:
    """Return all areas of a file as one."""
    import shapely  # noqa: PLC0415
    from shapely import MultiPolygon  # noqa: PLC0415

    from fieldmon.io.read import read_plots  # noqa: PLC0415

    read = read_plots(file)
    for message in read.messages:
        typer.echo(str(message), err=True)
    whole = shapely.union_all([field.boundary for field in read.value])
    return MultiPolygon(list(shapely.get_parts(whole)))
