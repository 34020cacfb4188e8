"""`fieldmon plots`: what a file holds."""

from __future__ import annotations

import typer

from fieldmon.cli.options import Crs, Layer, PlotChoices, PlotFile, plot_options
from fieldmon.cli.preparing import estate


def plots(
    plot: PlotFile, crs: Crs = None, layer: Layer = None, plot_option: PlotChoices = None
) -> None:
    """List the plots of a file, with their areas."""
    from fieldmon.io.sources import PlotRequest, PlotSources  # noqa: PLC0415

    options = plot_options(None, crs, layer, plot_option)
    listed = estate(PlotRequest(PlotSources(plot, options))).fields
    for number, field in enumerate(listed, 1):
        area = field.frame().geometry_m(field.boundary).area
        typer.echo(f"{number:4d}  {area / 1e4:9.2f} ha  {field.name}")
