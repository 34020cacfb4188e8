"""What of a layer can be plots, and what is said of the rest."""

import pytest
from shapely import LinearRing, LineString, MultiPolygon, Point, Polygon

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.import_report import Severity
from fieldmon.io.readers.plots import plots_of
from tests.io.readers.plot_layers import ANY, ONE, TWO, layer_of, names_of
from tests.io.tables_of_cells import sentences


def test_what_is_no_area_is_left_out_and_counted():
    shapes = [ONE, LineString([(5, 45), (6, 45)]), Point(5, 45), Point(5, 46), None, TWO]
    imported = plots_of(layer_of(shapes, name=list("abcdef")), ANY)
    assert names_of(imported) == ["a", "f"]
    said = [message.sentence for message in imported.of(Severity.DROPPED)]
    assert [sentence.partition(" ")[0] for sentence in said] == ["1", "1", "2"]


def test_lines_that_close_are_the_outlines_of_plots_and_that_is_a_guess():
    ring = LineString(LinearRing([(5, 45), (5.001, 45), (5.001, 45.001)]))
    imported = plots_of(layer_of([ring]), ANY)
    assert imported.value[0].boundary.equals(MultiPolygon([Polygon(ring.coords)]))
    assert "taken as the outlines" in sentences(imported.of(Severity.GUESSED))


def test_lines_and_points_alone_are_offered_as_what_they_can_be():
    with pytest.raises(ChoiceNeeded) as asked:
        plots_of(layer_of([LineString([(5, 45), (6, 45)]), Point(5, 45)]), ANY)
    assert (asked.value.option, asked.value.choices) == ("kind", ("lines", "plants"))
    with pytest.raises(FileProblem, match="without any geometry"):
        plots_of(layer_of([None, None]), ANY)
    with pytest.raises(FileProblem, match="but it is empty"):
        plots_of(layer_of([]), ANY)
