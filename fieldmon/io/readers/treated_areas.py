"""Where was treated, as a file says: areas, and where there are rates only those above 0."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import Imported, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers
from fieldmon.io.readers.plot_areas import shapes_of
from fieldmon.io.readers.plots import plots_of

if TYPE_CHECKING:
    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import PlotOptions

_RATES = frozenset({"rate", "rateapplied", "dose", "appliedrate", "vrarate", "targetrate"})


def treated_of(layer: Layer, options: PlotOptions) -> Imported[MultiPolygon]:
    """Return all areas of a layer as one, degrees WGS84; those of which the rate is 0 left out."""
    if any(plain(name) == "kind" and "partfield" in layer.column(name) for name in layer.columns):
        raise FileProblem(
            worded(
                "{file} is task data for a terminal: it names the plot, and not what was treated. "
                "Give the zones as .gpkg, .shp.zip or .kml.",
                file=layer.name,
            )
        )
    kinds = shapely.get_dimensions(shapes_of(layer)) if len(layer) else np.empty(0)
    if len(kinds) and not (kinds == 2).any():
        raise FileProblem(
            worded(
                "{file} must hold the areas that were treated, but it holds only points or lines. "
                "Give areas as .gpkg, .shp.zip, .kml or .geojson, as fieldmon decide writes them.",
                file=layer.name,
            )
        )
    named = next((name for name in layer.columns if plain(name) in _RATES), None)
    said = []
    if named is not None:
        sprayed = np.nan_to_num(numbers(layer.column(named)), nan=1.0) > 0.0
        if not sprayed.any():
            raise FileProblem(
                worded(
                    "{file} must hold an area that was treated, but every {column} is 0.",
                    file=layer.name, column=named,
                )
            )  # fmt: skip
        left = int(np.count_nonzero(~sprayed))
        if left:
            said.append(
                seen(worded("{n} {n:area|areas} of rate 0 {n:was|were} not treated.", n=left))
            )
        layer = layer.take(sprayed)
    read = plots_of(layer, options)
    whole = shapely.union_all([field.boundary for field in read.value])
    return read.having(MultiPolygon(list(shapely.get_parts(whole))), said)
