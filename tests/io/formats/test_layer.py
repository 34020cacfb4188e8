"""A layer is what a file holds: some of it, one column, cells as people see them."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import Severity, seen
from tests.io.tables_of_cells import column, table

ROWS = table(name=["north", "south", "north"], n=[1, 2.0, None])


@pytest.mark.parametrize(
    ("cell", "seen_as"),
    [(None, ""), (float("nan"), ""), (3.0, "3"), (3.5, "3.5"), (" x ", "x"), (1e20, "1e+20")],
)
def test_a_cell_is_read_as_a_person_sees_it(cell, seen_as):
    assert text(cell) == seen_as


@given(st.lists(st.integers(0, 2)))
def test_taking_some_takes_them_of_every_column_and_of_the_shapes(which):
    points = column([Point(i, i) for i in range(3)])
    layer = Layer("x", ROWS.columns, points, "EPSG:2039", (seen("Here."),))
    some = layer.take(np.array(which, np.intp))
    assert len(some) == len(which)
    assert [shapely.get_x(p) for p in some.geometry] == which
    assert some.columns["name"].tolist() == [ROWS.columns["name"][i] for i in which]
    assert (some.crs, some.messages) == (layer.crs, layer.messages)


def test_features_are_chosen_by_what_a_column_holds():
    assert ROWS.where("name=north").columns["n"].tolist() == [1, None]
    assert ROWS.where("NAME = south").columns["n"].tolist() == [2.0]
    assert ROWS.where("n=2").columns["name"].tolist() == ["south"]
    assert ROWS.where(None) is ROWS
    pests = Layer("x", {"pest": column(["Mite", "mite ", "thrips"])})
    assert len(pests.where("pest=mite")) == 2
    assert len(Layer("x", {"n": pests.columns["pest"]}).where("n=mite", ["n"])) == 2


def test_a_choice_that_fits_nothing_is_a_question_with_what_there_is():
    with pytest.raises(ChoiceNeeded, match="fits none") as asked:
        ROWS.where("name=east")
    assert (asked.value.option, asked.value.choices) == ("where", ("name=north", "name=south"))


def test_a_column_is_found_without_its_capitals_or_asked_for():
    assert ROWS.column("Name").tolist() == ["north", "south", "north"]
    with pytest.raises(ChoiceNeeded, match="must be a column 'count'") as asked:
        ROWS.column("count")
    assert asked.value.choices == ("name", "n")


def test_heights_and_coordinates_that_are_no_numbers_are_left_out_and_said():
    with np.errstate(invalid="ignore"):
        nowhere = shapely.from_wkt("LINESTRING (0 0, NaN 1)")
    checked = Layer("x", {}, column([Point(1, 2, 3), nowhere, None, Point(4, 5)])).checked()
    assert [g is None for g in checked.geometry] == [False, True, True, False]
    assert shapely.to_wkt(checked.geometry[0]) == "POINT (1 2)"
    severities = [(m.severity, m.feature) for m in checked.messages]
    assert severities == [(Severity.SEEN, None), (Severity.DROPPED, "feature 2")]


def test_a_table_is_as_long_as_its_columns_and_has_nothing_to_check():
    assert len(ROWS) == 3
    assert len(Layer("x", {})) == 0
    assert ROWS.checked() is ROWS
    assert ROWS.saying(seen("Here.")).messages == (seen("Here."),)


FOUND = Layer("x", {name: column([1]) for name in ("lon", "date", "row", "A", "B", "Milben")})


def test_what_is_offered_for_a_column_is_known_as_nothing_else():
    with pytest.raises(ChoiceNeeded) as asked:
        FOUND.with_roles((("count", "C"), ("present", "B")))
    assert asked.value.choices == ("count=A", "count=Milben")
    with pytest.raises(ChoiceNeeded) as asked:
        FOUND.with_roles((("date", "C"),))
    assert asked.value.choices == ("date=date", "date=A", "date=B")
    only = Layer("x", {"lon": column([1])})
    with pytest.raises(ChoiceNeeded) as asked:
        only.with_roles((("count", "C"),))
    assert asked.value.choices == ("count=lon",)


@pytest.mark.parametrize("written", ["A,present=B", "a, present=B"])
def test_two_columns_named_at_once_are_to_be_named_one_by_one(written):
    with pytest.raises(ChoiceNeeded, match=r"columns=count=[aA], columns=present=B") as asked:
        FOUND.with_roles((("count", written),))
    assert asked.value.choices == ("count=A",)
