"""What is said of the shapes of plots."""

import pytest
import shapely
from shapely import MultiPolygon, Polygon, box

from fieldmon.io.import_report import Severity
from fieldmon.io.readers.plots import plots_of
from tests.io.readers.plot_layers import ANY, ONE, TWO, layer_of
from tests.io.tables_of_cells import sentences


def test_parts_and_holes_are_kept_and_said():
    parts = MultiPolygon([ONE, TWO])
    holed = Polygon(box(5, 46, 5.01, 46.01).exterior, [box(5.004, 46.004, 5.006, 46.006).exterior])
    imported = plots_of(layer_of([parts, holed], name=["two", "ring"]), ANY)
    assert [len(field.boundary.geoms) for field in imported.value] == [2, 1]
    assert shapely.area(imported.value[1].boundary) == pytest.approx(shapely.area(holed))
    assert "several parts, which were kept: two." in sentences(imported)
    assert "holes, kept as places without plants: ring." in sentences(imported)
    (own,) = (said for one in imported.messages if one.each for said in one.about("ring"))
    assert str(own) == "seen: ring: It has holes, kept as places without plants."


def test_an_island_in_a_hole_is_doubted_as_routes_lead_across_the_hole():
    hole, island = box(5.004, 46.004, 5.006, 46.006), box(5.0045, 46.0045, 5.0055, 46.0055)
    ring = Polygon(box(5, 46, 5.01, 46.01).exterior, [hole.exterior])
    beside = MultiPolygon([ring, box(5.02, 46, 5.03, 46.01)])
    imported = plots_of(layer_of([MultiPolygon([ring, island]), beside], name=["a", "b"]), ANY)
    assert (
        "doubtful: 1 plot has a part in a hole of another, and routes lead straight across that "
        "hole: a."
    ) in sentences(imported)


def test_the_same_outline_twice_is_doubted_however_it_is_drawn():
    backwards = Polygon(list(ONE.exterior.coords)[::-1])
    imported = plots_of(layer_of([ONE, backwards, TWO], name=["a", "b", "c"]), ANY)
    (doubt,) = imported.of(Severity.DOUBTFUL)
    assert (doubt.feature, doubt.sentence) == ("b", "It has the same outline as a.")
