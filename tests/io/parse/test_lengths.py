"""Distances are read in the unit they are written in; what is none is doubted."""

import numpy as np
import pytest

from fieldmon.io.parse.lengths import accuracies, metres, unit_m, units_said


def cells(*values):
    return np.array(values, dtype=object)


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        *[("25 m", 25.0), ("25m.", 25.0), ("± 3 m", 3.0), ("~5", 5.0), ("3,5 m", 3.5)],
        *[("11'", 3.3528), ("10 FT", 3.048), ("0.5 km", 500.0), ("25 מטר", 25.0)],
        *[("4 metros", 4.0), ("25", 25.0), (25, 25.0), ("3 yd", np.nan), ("good", np.nan)],
    ],
)  # fmt: skip
def test_a_distance_is_in_the_unit_it_is_written_in(said, expected):
    assert metres(cells(said, "4 m")) == pytest.approx([expected, 4.0], nan_ok=True)


def test_a_column_may_say_the_unit_of_plain_numbers():
    known, said = accuracies(cells("10", 20, "3 m", None), "accuracy (ft)")
    assert known == pytest.approx([3.048, 6.096, 3.0, np.nan], nan_ok=True)
    assert said == []
    assert accuracies(cells(10), "accuracy (ft) (1 sigma)")[0] == pytest.approx([3.048])
    assert accuracies(cells(10, 20), "accuracy [m]")[0] == pytest.approx([10.0, 20.0])
    assert accuracies(cells(10, 20), "accuracy (1 sigma)")[0] == pytest.approx([10.0, 20.0])


@pytest.mark.parametrize(
    ("name", "units"),
    [
        *[("accuracy (ft)", ["ft"]), ("Row spacing [ Metres. ]", ["metres"]), ("spacing", [])],
        *[("spacing (mean) (cm)", ["mean", "cm"]), ("spacing ()", [""]), ("spacing (m", [])],
    ],
)
def test_what_a_column_has_in_brackets_is_read_as_units_are_written(name, units):
    assert units_said(name) == units
    assert units_said(name, at_end=True) == units[-1:]
    assert units_said(f"{name} of it", at_end=True) == []


def test_a_unit_is_known_however_it_is_written_and_none_is_none():
    assert [unit_m(one) for one in (" FT. ", "m", "מטר")] == [0.3048, 1.0, 1.0]
    assert unit_m("1 sigma") is None


def test_accuracies_that_are_none_are_doubted():
    known, (said,) = accuracies(cells("good", "good", "3 yd", "bad", "odd", "3 m", -1, 0), "hacc")
    assert known == pytest.approx([np.nan] * 5 + [3.0] + [np.nan] * 2, nan_ok=True)
    assert str(said) == (
        "doubtful: hacc: Accuracies must be distances such as 3, 3 m or 10 ft, but 5 are not: "
        "'good', '3 yd', 'bad', .... Their records count as if no accuracy was stated."
    )
