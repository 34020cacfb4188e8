"""What a program hands over: refused in a sentence where it is something else."""

from datetime import date, datetime
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from fieldmon.compute.arguments import (
    array_of,
    chances_of,
    day_of,
    days_of,
    entries_of,
    must_be,
    must_be_in,
    must_be_known,
    must_be_name_of_file,
    must_be_shaped,
    must_be_zone,
    must_hold_shapes,
    plants_marked,
    shown,
)
from fieldmon.compute.ranges import AllowedRange
from fieldmon.errors import SettingError


def test_what_is_of_its_kind_passes_and_anything_else_is_said_with_what_to_do():
    must_be("A name must be text", "Gate", str, "Put it in quotes.")
    with pytest.raises(SettingError, match=r"^A name must be text, but it is 3\. Put it in qu"):
        must_be("A name must be text", 3, str, "Put it in quotes.")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (None, "None"),
        ("4h", "'4h'"),
        (np.float64(2.5), "2.5"),
        ([1], "a list"),
        (np.zeros(2), "an array of float64"),
        (object(), "an object"),
    ],
)
def test_a_short_value_is_said_itself_and_anything_else_by_its_kind(given, said):
    assert shown(given) == said


def test_a_long_text_is_cut():
    assert shown("x" * 1000) == "'" + "x" * 39 + "..."


def test_an_array_holds_numbers_or_is_refused():
    assert array_of(np.float64, "A risk map", [1, 0.5]).tolist() == [1.0, 0.5]
    days = np.zeros(2, "datetime64[D]")
    for bad in (["a", "b"], "x", b"12", [[1], [1, 2]], [object()], 1j, 10**400, days):
        with pytest.raises(SettingError, match=r"^A risk map must hold numbers, but"):
            array_of(np.float64, "A risk map", bad)


def test_entries_are_picked_by_numbers_a_mask_or_a_slice():
    mask = np.array([True, False, True])
    for which, kept in (([0, -1], [0, 2]), ([], []), (mask, [0, 2]), (slice(1, None), [1, 2])):
        assert np.arange(3)[entries_of("Records", which, 3)].tolist() == kept
    for bad in ([3], [-4], 1, None, "a", [0.0], [True], np.zeros((3, 1), int), [[0], [1, 2]]):
        with pytest.raises(SettingError, match=r"^Records must be picked by .* 'which' is"):
            entries_of("Records", bad, 3)


def test_days_are_dates_texts_or_numpys_and_no_numbers():
    for good in ("2026-11-18", date(2026, 11, 18), datetime(2026, 11, 18, 5), np.datetime64("NaT")):
        assert days_of(good) is not None
    assert days_of([date(2026, 11, 18), None]).astype(str).tolist() == ["2026-11-18", "NaT"]
    for bad in (
        None,
        "",
        "soon",
        20_000,
        1e30,
        10**30,
        [10**30],
        [1, 2],
        pd.NaT,
        [[1], [1, 2]],
        True,
    ):
        assert days_of(bad) is None


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


def test_a_number_is_in_its_range():
    must_be_in("A seed", AllowedRange(0, 9), 9)
    with pytest.raises(SettingError, match=r"^A seed must be 0 or more, but it is -1\.$"):
        must_be_in("A seed", AllowedRange(0, 9), -1)


def test_a_file_has_a_name_and_a_zone_too():
    must_be_name_of_file("A file", "a.zip")
    must_be_zone("A zone", "Asia/Jerusalem")
    must_be_zone("A zone", "")
    for bad in ("", "a\0b"):
        with pytest.raises(SettingError, match=r"^A file must be given by its path, but it is '"):
            must_be_name_of_file("A file", bad)
    for bad in ("soon", "../UTC", "a\0b"):
        with pytest.raises(SettingError, match=r"^A zone must be a time zone as Asia/Jerusalem"):
            must_be_zone("A zone", bad)


def test_an_array_of_true_and_false_takes_no_numbers():
    assert array_of(np.bool_, "A mask", [True, False]).tolist() == [True, False]
    for bad in ([1, 0], ["a"], [[True], [True, False]], 3):
        with pytest.raises(SettingError, match=r"^A mask must hold True or False, but .* Do\.$"):
            array_of(np.bool_, "A mask", bad, "Do.")


def test_a_name_that_nobody_knows_is_said_with_those_that_are_known():
    must_be_known("Settings", ["hours"], ["hours", "seed"])
    with pytest.raises(SettingError, match="Settings are hours, seed, but one is called 'hour'"):
        must_be_known("Settings", {"hours": 4, "hour": 4}, ["hours", "seed"])


@pytest.mark.parametrize(
    ("given", "day"),
    [
        ("2026-11-18", date(2026, 11, 18)),
        (datetime(2026, 11, 18, 5), date(2026, 11, 18)),
        (np.datetime64("2026-11-18T05"), date(2026, 11, 18)),
        (np.datetime64(10**9, "D"), np.datetime64(10**9, "D")),
        (3, 3),
    ],
)
def test_a_day_is_taken_from_a_text_or_a_time_and_the_rest_is_left(given, day):
    assert day_of("A harvest", given) == day


def test_a_text_that_is_no_day_is_refused():
    with pytest.raises(SettingError, match="A harvest must be a day as 2026-11-18, but it is 'soo"):
        day_of("A harvest", "soon")


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
