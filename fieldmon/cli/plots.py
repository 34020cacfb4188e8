"""`fieldmon plots`: what a file holds."""

from __future__ import annotations

import typer

from fieldmon.cli.files_to_plot import estate
from fieldmon.cli.options import Crs, Layer, PlotChoices, PlotFile, plot_options


def plots(
    plot: PlotFile, crs: Crs = None, layer: Layer = None, plot_option: PlotChoices = None
) -> None:
    """List the plots of a file, with their areas and the numbers that --feature takes."""
    import numpy as np

    from fieldmon.io.parse.geometry import areas_m2
    from fieldmon.io.plot_request import PlotRequest, PlotSources

    options = plot_options(None, crs, layer, plot_option)
    listed = estate(PlotRequest(PlotSources(plot, options))).fields
    areas = areas_m2(np.array([field.boundary for field in listed], dtype=object))
    lines = (
        f"{number:4d}  {area / 1e4:9.2f} ha  {field.name}"
        for number, (area, field) in enumerate(zip(areas, listed, strict=True), 1)
    )
    typer.echo("\n".join(lines))
