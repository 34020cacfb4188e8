"""What a plan leaves on the disk: route files, and the chance map."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.plot.plot import Plot

ChanceMap = Annotated[
    Path | None, typer.Option(help="Cloud Optimised GeoTIFF to write: chance of each plant.")
]


def write_routes(route: Route, outputs: list[Path] | None) -> None:
    """Write a route in every format asked for, and say where."""
    for output in outputs or [Path("route.geojson")]:
        for path in route.to_file(output):
            typer.echo(f"Route written to {path}")


def write_chance_map(to: Path | None, plot: Plot, chance: NDArray[np.float64]) -> None:
    """Write the chance map, if it was asked for."""
    if to is None:
        return
    from fieldmon.io.writers.chance_raster import write_chance_raster  # noqa: PLC0415

    made = write_chance_raster(plot.grid, chance, to)
    high, wide = made.values.shape
    typer.echo(
        f"Chance map written to {to} ({wide} x {high} pixels of {made.pixel_m:g} m, {made.crs})"
    )


def day_in_words(route: Route) -> str:
    """Return what a planned day comes to, and what no other route can exceed, where it is known."""
    said = (
        f"{len(route)} of {len(route.aisles.grid)} plants in {route.end_s / 3600:.1f} h, "
        f"{route.drive_m / 1000:.2f} km; about {route.expected_finds:.1f} of them infested, "
        f"about {route.expected_found:.1f} of these would be found."
    )
    more = (route.bound_sentence, route.aisles.told_shut())
    return "\n".join([said, *(one for one in more if one)])
