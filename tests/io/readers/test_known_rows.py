"""What a plot file says of its rows goes to the plot it is said of."""

import pytest

from fieldmon.io.readers.known_rows import KnownRows, known_rows
from tests.io.tables_of_cells import table

NAMES = ["a", "b"]


def test_each_plot_gets_what_its_own_line_says():
    layer = table(row_bearing_deg=[10, None], row_spacing=["3,5", "4"], plant_spacing_m=[None, 1.5])
    known, (said,) = known_rows(layer, NAMES)
    assert known == {"a": KnownRows(10.0, 3.5, None), "b": KnownRows(None, 4.0, 1.5)}
    for column in layer.columns:
        assert repr(column) in said.sentence


@pytest.mark.parametrize(
    ("value", "said"),
    [(0, 0), (None, 0), ("-999", 0), (-3, 1), ("none", 1), ("3 yd", 1), ("3 m x 2", 1)],
)
def test_a_spacing_that_is_none_is_not_taken_and_said_if_it_was_meant(value, said):
    known, (_, *doubts) = known_rows(table(row_spacing_m=[value, 4]), NAMES)
    assert known["a"].row_spacing_m is None
    assert len(doubts) == said
    assert all(f"a ({str(value)!r})" in one.sentence for one in doubts)


@pytest.mark.parametrize(
    ("said", "metres"),
    [
        ("11'", 3.3528),
        ("11 ft", 3.3528),
        ("11ft.", 3.3528),
        ("1.2 m", 1.2),
        ("3,5 m", 3.5),
        ("350 cm", 3.5),
        ('60"', 1.524),
        ("3.5", 3.5),
    ],
)
def test_a_spacing_is_in_the_unit_it_is_written_in(said, metres):
    known, _ = known_rows(table(row_spacing=[said, "4"]), NAMES)
    assert known["a"].row_spacing_m == pytest.approx(metres)
    assert known["b"].row_spacing_m == 4.0


def test_rows_may_run_north_and_west_of_it():
    known, _ = known_rows(table(azimuth=[0, -20]), NAMES)
    assert [known[name].row_bearing_deg for name in NAMES] == [0.0, -20.0]


@pytest.mark.parametrize("column", ["Row spacing (m)", "ROW_SPAC_M", "rowSpace", "row dist"])
def test_columns_are_known_however_they_are_written(column):
    known, _ = known_rows(table(**{column: [3, 4]}), NAMES)
    assert known["a"].row_spacing_m == 3.0


def test_a_file_that_says_nothing_of_rows_says_nothing():
    assert known_rows(table(crop=["vine", "vine"]), NAMES) == ({}, [])


def test_what_no_rows_are_is_doubted_with_its_column_and_its_value():
    layer = table(row_dist=[5000, 4], azimuth=[10, -1000], plant_m=[0, 0.01])
    known, (_, *doubts) = known_rows(layer, NAMES)
    assert [(one.severity.value, one.feature, one.sentence) for one in doubts] == [
        ("doubtful", "b", "Column 'azimuth' must be -360 to 360 degrees, but it is -1000."),
        ("doubtful", "a", "Column 'row_dist' must be 0.05 to 1000 metres, but it is 5000."),
        ("doubtful", "b", "Column 'plant_m' must be 0.05 to 1000 metres, but it is 0.01."),
    ]
    assert known["a"].row_spacing_m == 5000


@pytest.mark.parametrize(
    ("column", "said", "metres"),
    [
        ("row_spacing_cm", 250, 2.5),
        ("Row spacing (cm)", 250, 2.5),
        ("row spacing [ft]", "10", 3.048),
        ("row spacing (mean) (cm)", 250, 2.5),
        ("row_dist_ft", "3 m", 3.0),
        ("row_spacing_metres", 3, 3.0),
    ],
)
def test_a_column_may_say_the_unit_of_its_spacings(column, said, metres):
    known, messages = known_rows(table(**{column: [said, said]}), NAMES)
    assert known["a"].row_spacing_m == pytest.approx(metres)
    assert [one.severity.value for one in messages] == ["seen"]


@pytest.mark.parametrize(
    "column",
    ["row spacing (yd)", "Reihenabstand", "vine_distance", "row_direction", "InterRow", "spacing"],
)
def test_what_seems_to_be_said_of_rows_and_is_not_read_is_named(column):
    known, (doubt,) = known_rows(table(crop=["vine"] * 2, **{column: ["3", "4"]}), NAMES)
    assert known == {}
    assert f"is not read: {column!r}. Call such columns row_bearing_deg" in doubt.sentence


@pytest.mark.parametrize("column", ["row_spacin", "plant_spac", "row_bearin"])
def test_a_name_that_a_shapefile_cut_is_doubted_with_names_that_fit(column):
    known, (doubt,) = known_rows(table(**{column: ["3", "4"]}), NAMES)
    assert known == {}
    assert "Call such columns bearing, row_m and plant_m, since a shapefile" in doubt.sentence
    fitting = known_rows(table(bearing=[68, 68], row_m=[4, 4], plant_m=[3, 3]), NAMES)[0]
    assert fitting["a"] == (68.0, 4.0, 3.0)


def test_spacings_that_may_be_in_another_unit_are_doubted():
    known, (_, doubt) = known_rows(table(row_spacing=[250, 4]), NAMES)
    assert known["a"].row_spacing_m == 250.0
    assert "Column 'row_spacing' says 250 m" in doubt.sentence
    assert doubt.feature == "a"


def test_a_direction_may_have_a_remark_behind_its_name():
    known, (said,) = known_rows(table(**{"bearing (from north)": [10, 20]}), NAMES)
    assert known["b"].row_bearing_deg == 20.0
    assert said.severity.value == "seen"
