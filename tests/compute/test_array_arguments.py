"""Arrays that a program hands over: refused in a sentence where they hold something else."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from fieldmon.compute.array_arguments import (
    array_of,
    array_of_plants,
    chances_of,
    entries_of,
    must_be_shaped,
    must_hold_shapes,
    must_share_index,
    plants_marked,
)
from fieldmon.errors import SettingError


def test_an_array_holds_numbers_or_is_refused():
    assert array_of(np.float64, "A risk map", [1, 0.5]).tolist() == [1.0, 0.5]
    days = np.zeros(2, "datetime64[D]")
    for bad in (["a", "b"], "x", b"12", [[1], [1, 2]], [object()], 1j, 10**400, days):
        with pytest.raises(SettingError, match=r"^A risk map must hold numbers, but"):
            array_of(np.float64, "A risk map", bad)


def test_an_array_of_true_and_false_takes_no_numbers():
    assert array_of(np.bool_, "A mask", [True, False]).tolist() == [True, False]
    for bad in ([1, 0], ["a"], [[True], [True, False]], 3):
        with pytest.raises(SettingError, match=r"^A mask must hold True or False, but .* Do\.$"):
            array_of(np.bool_, "A mask", bad, "Do.")


def test_a_series_of_plants_is_taken_in_their_order_alone():
    chance = pd.Series([0.3, 0.1, 0.2])
    assert array_of_plants(np.float64, "A map", chance).tolist() == [0.3, 0.1, 0.2]
    for other in (chance.sort_values(), chance[1:], chance.set_axis(["a", "b", "c"])):
        with pytest.raises(SettingError, match=r"A map must be in the plants' order, .* another"):
            array_of_plants(np.float64, "A map", other)
    with pytest.raises(SettingError, match="mask must be in the plants' order"):
        plants_marked("A mask", (chance > 0.1).sort_values(), 3, str)


def test_columns_of_one_frame_are_put_together_and_those_of_other_orders_are_not():
    frame = pd.DataFrame({"plant": [7, 8], "result": [0, 1]}, index=[9, 3])
    one = {"plant": frame["plant"], "result": frame["result"], "on": "2026-11-18", "who": ["A"] * 2}
    must_share_index("inspections", one)
    with pytest.raises(SettingError, match="that of result is another than that of plant"):
        must_share_index("inspections", one | {"result": frame["result"].sort_index()})


def test_entries_are_picked_by_numbers_a_mask_or_a_slice():
    mask = np.array([True, False, True])
    for which, kept in (([0, -1], [0, 2]), ([], []), (mask, [0, 2]), (slice(1, None), [1, 2])):
        assert np.arange(3)[entries_of("Records", which, 3)].tolist() == kept
    for bad in ([3], [-4], 1, None, "a", [0.0], [True], np.zeros((3, 1), int), [[0], [1, 2]]):
        with pytest.raises(SettingError, match=r"^Records must be picked by .* 'which' is"):
            entries_of("Records", bad, 3)


def test_arrays_have_their_shapes():
    must_be_shaped(
        "A route's", {"plant": (np.zeros(3), (3,)), "line_m": (np.zeros((4, 2)), (4, 2))}
    )
    with pytest.raises(SettingError, match=r"A route's line_m must have the shape \(4, 2\), but"):
        must_be_shaped("A route's", {"line_m": (np.zeros(4), (4, 2))})


def test_what_holds_arrays_is_held_to_their_shapes_by_name():
    holder = SimpleNamespace(plant=np.zeros(3), line_m=np.zeros(4))
    must_hold_shapes(holder, "A route's", {"plant": (3,)})
    with pytest.raises(SettingError, match=r"A route's line_m must have the shape \(4, 2\), but"):
        must_hold_shapes(holder, "A route's", {"plant": (3,), "line_m": (4, 2)})


def test_chances_are_taken_as_a_list_and_refused_unless_they_are_one_for_each_plant():
    np.testing.assert_array_equal(chances_of([0.1, 0.2, 1], 3), [0.1, 0.2, 1.0])
    for wrong, said in (([0.1], "shape"), ([0.1, 0.3, 2.0], "0..1"), ("soon", "numbers")):
        with pytest.raises(SettingError, match=said):
            chances_of(wrong, 3)


def test_plants_are_marked_each_or_it_is_said_how_many_were():
    assert plants_marked("The mask", [True, False], 2, str).tolist() == [True, False]
    with pytest.raises(SettingError, match=r"^Not 2 but 3$"):
        plants_marked("The mask", [True] * 3, 2, lambda size: f"Not 2 but {size}")
    with pytest.raises(SettingError, match=r"The mask must hold True .* np.isin\(np.arange\(2\), "):
        plants_marked("The mask", [0, 1], 2, str)
