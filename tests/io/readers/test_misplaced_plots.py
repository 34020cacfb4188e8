"""Plots with a mistyped corner, or of another UTM zone."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from pyproj import Transformer
from shapely import Polygon, box

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions
from fieldmon.io.readers.plots import plots_of
from tests.io.readers.plot_layers import ANY, TWO, corners, layer_of, names_of
from tests.io.tables_of_cells import column, sentences, table

MISTYPED = [(5, 45), (5.001, 45), (5.001, 450.01), (5, 45.001)]


def test_a_mistyped_corner_is_refused_and_named_as_without_it_the_plot_is_another():
    said = r"corner 3, 5.001 / 450.01, does not"
    for wrong in (corners(*MISTYPED), layer_of([Polygon(MISTYPED)], name=["X"])):
        with pytest.raises(FileProblem, match=said):
            plots_of(wrong, ANY)
    with pytest.raises(FileProblem, match=r"corner 2, 5.001 / east, does not"):
        plots_of(table(lon=[5, 5.001, 5.001, 5], lat=["45", "east", "45.001", "45.001"]), ANY)
    blocks = layer_of([Polygon(MISTYPED), TWO], name=["X", "X"], part=["a", "b"])
    with pytest.raises(FileProblem, match=f"corner of X / a must.*{said}"):
        plots_of(blocks, ANY.naming(block="part"))


def test_a_plot_with_a_mistyped_corner_is_left_out_and_the_others_stay():
    # as the first corner, it ends the outline too
    for turned in (MISTYPED, [*MISTYPED[2:], *MISTYPED[:2]]):
        read = plots_of(layer_of([Polygon(turned), TWO], name=["X", "Y"]), ANY)
        assert names_of(read) == ["Y"]
        (left_out,) = read.of(Severity.DROPPED)
        number = turned.index(MISTYPED[2]) + 1
        assert (left_out.feature, left_out.remedy) == ("X", None)
        assert left_out.sentence.startswith(f"Corner {number}, 5.001 / 450.01, lies nowhere")


def test_plots_of_a_file_that_are_written_in_two_utm_zones_are_doubted_and_named():
    def metres(west, zone):
        to = Transformer.from_crs("OGC:CRS84", f"EPSG:326{zone}", always_xy=True).transform
        area = box(west, 31.5, west + 0.002, 31.502)
        return shapely.transform(area, lambda xy: np.stack(to(*xy.T), axis=1))

    shapes, names = [metres(35.9, 36), metres(35.95, 36), metres(36.1, 37)], ["A", "B", "C"]
    layer = Layer("estate", {"name": column(names)}, column(shapes), "EPSG:32636")
    for options, doubted in ((ANY, True), (PlotOptions(feature="C"), True),
                             (PlotOptions(feature="A"), False)):  # fmt: skip
        said = sentences(plots_of(layer, options))
        told = "1 plot lies 551 km from the others (C), but as UTM zone 37 it would lie 14 km from"
        assert (told in said) is doubted
    right = replace(layer, geometry=column([*shapes[:2], metres(36.1, 36)]))
    assert "UTM zone 37" not in sentences(plots_of(right, ANY))
    columns = {"name": column(names), "utm_zone": column([36, 36, 37])}
    with pytest.raises(ChoiceNeeded, match="'utm_zone' names 2: 36, 37") as asked:
        plots_of(replace(layer, columns=columns), ANY)
    assert asked.value.option == "where"
    unstated = replace(layer.take(np.array([0, 1])), crs=None, columns={"huso": column([36, 36])})
    assert len(plots_of(unstated, ANY).value) == 2
