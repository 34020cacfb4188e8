"""What a plan leaves on the disk: route files, and the chance map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.compute.wording import estimate
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.plot.plot import Plot

ROUTE = Path("route.geojson")
_RASTERS = (".tif", ".tiff")
_PRINTED = (".html", ".htm")
# what commands call the files that they write; all other files are read
_WRITTEN = ("output", "chance_map", "bag")

ChanceMap = Annotated[
    Path | None, typer.Option(help="Cloud Optimised GeoTIFF to write: chance of each plant.")
]


def refuse_what_is_read(told: Mapping[str, object]) -> None:
    """Refuse to write over a file that the same command reads, by whichever name."""
    to = [file for name in _WRITTEN for file in _files(told.get(name))]
    if not any(one.is_file() for one in to):
        return
    read = [file for name in told if name not in _WRITTEN for file in _files(told[name])]
    for one in to:
        for other in read:
            if one.is_file() and other.is_file() and one.samefile(other):
                raise SettingError(
                    f"{one} must be another file than those that are read, for it would be "
                    "written over. Choose another name to write to."
                )


def _files(told: object) -> list[Path]:
    """Return the files in what an option or argument was told."""
    return [file for file in (told if isinstance(told, list) else [told]) if isinstance(file, Path)]


def check_outputs(outputs: list[Path] | None, chance_map: Path | None) -> None:
    """Refuse files that could not be written, before anything is planned or written."""
    from fieldmon.io.atomic_write import require_place
    from fieldmon.io.writers.handoff import format_of

    for path in outputs or []:
        format_of(path)
        require_place(path)
    if chance_map is not None:
        if chance_map.suffix.lower() not in _RASTERS:
            raise SettingError(
                f"--chance-map writes a GeoTIFF: its name must end in .tif, but it is "
                f"{chance_map.name!r}."
            )
        require_place(chance_map)


def write_routes(route: Route, outputs: list[Path] | None, language: str = "") -> None:
    """Write a route in every format asked for, and say where; `language` as a season keeps it."""
    for output in outputs or [ROUTE]:
        for path in write_route(route, output, language):
            typer.echo(f"Route written to {path}")


def write_route(route: Route, output: Path, language: str = "") -> tuple[Path, ...]:
    """Write a route as its file's name says: a sheet to print in a language that a season keeps."""
    if language and output.name.lower().endswith(_PRINTED):
        from fieldmon.cli.report_languages import spoken
        from fieldmon.io.writers.day_file import RouteNotes

        notes = replace(route.notes or RouteNotes("", ""), language=spoken(None, language)[0])
        route = replace(route, notes=notes)
    return route.to_file(output)


def write_chance_map(to: Path | None, plot: Plot, chance: NDArray[np.float64]) -> None:
    """Write the chance map, if it was asked for."""
    if to is None:
        return
    from fieldmon.io.writers.chance_raster import write_chance_raster

    made = write_chance_raster(plot.grid, chance, to)
    high, wide = made.values.shape
    typer.echo(
        f"Chance map written to {to} ({wide} x {high} pixels of {made.pixel_m:g} m, {made.crs})"
    )


def day_in_words(route: Route, infested: float | None = None) -> str:
    """Return what a planned day comes to, and what no other route can exceed, where it is known.

    A route goes by what can be seen: `infested` is how many of its plants are believed infested,
    those where it hides among them; None: nothing is known to hide.
    """
    grid, seen = route.aisles.grid, estimate(route.expected_visible)
    among = f"about {seen} of them infested"
    if infested is not None and (all_of_them := estimate(infested)) != seen:
        among = f"about {all_of_them} of them infested, about {seen} so that it can be seen"
    said = (
        f"{len(route):,} of {grid.counted(len(grid))} in {route.end_s / 3600:.1f} h, "
        f"{route.drive_m / 1000:.2f} km; {among}, "
        f"about {estimate(route.expected_finds)} of these would be found."
    )
    more = (route.bound_sentence, *route.ways_said)
    return "\n".join([said, *(one for one in more if one)])
