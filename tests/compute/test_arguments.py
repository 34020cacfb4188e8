"""What a program hands over: refused in a sentence where it is something else."""

from dataclasses import dataclass
from datetime import date, datetime
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from shapely import MultiPolygon

from fieldmon.compute.arguments import (
    array_of,
    day_of,
    must_be,
    must_be_known,
    must_hold_numbers,
    shown,
)
from fieldmon.errors import SettingError
from fieldmon.io.writers.treatment_map import TreatmentMap
from fieldmon.monitoring.advice import AdviceSettings


@dataclass(frozen=True)
class _Settings:
    hours: "float" = 4.0
    rows: "int | None" = None
    name: "str" = ""

    def __post_init__(self):
        must_hold_numbers(self, "The robot's")


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
        (np.zeros(2), "a ndarray"),
        (object(), "an object"),
    ],
)
def test_a_short_value_is_said_itself_and_anything_else_by_its_kind(given, said):
    assert shown(given) == said


def test_a_long_text_is_cut():
    assert shown("x" * 1000) == "'" + "x" * 39 + "..."


@pytest.mark.parametrize("good", [4, 4.5, np.float32(4), np.int16(3), Fraction(7, 2)])
def test_numbers_of_any_make_are_numbers(good):
    assert _Settings(hours=good, rows=3).hours == good


@pytest.mark.parametrize(
    ("bad", "said"),
    [({"hours": "4"}, "hours must be a number, but it is '4'"),
     ({"hours": None}, "hours must be a number, but it is None"),
     ({"rows": [1]}, "rows must be a number, but it is a list")],
)  # fmt: skip
def test_a_setting_that_is_no_number_is_named(bad, said):
    with pytest.raises(SettingError, match=f"The robot's {said}"):
        _Settings(**bad)


def test_other_settings_are_left_to_their_own_checks():
    assert _Settings(name=3).name == 3


def test_an_array_holds_numbers_or_is_refused():
    assert array_of(np.float64, "A risk map", [1, 0.5]).tolist() == [1.0, 0.5]
    for bad in (["a", "b"], "x", [[1], [1, 2]], [object()]):
        with pytest.raises(SettingError, match=r"^A risk map must hold numbers, but"):
            array_of(np.float64, "A risk map", bad)


def test_an_array_of_true_and_false_takes_no_numbers():
    assert array_of(np.bool_, "A mask", [True, False]).tolist() == [True, False]
    for bad in ([1, 0], ["a"], [[True], [True, False]], 3):
        with pytest.raises(SettingError, match=r"^A mask must hold True or False, but .* Do\.$"):
            array_of(np.bool_, "A mask", bad, "Do.")


@pytest.mark.parametrize("rate", [0.0, -1.0, 100_000.0, np.nan, np.inf, "300", None])
def test_a_rate_that_nobody_sprays_is_refused_alike_in_a_map_and_in_advice(rate):
    said = []
    for make in (AdviceSettings, partial(TreatmentMap, "plot", MultiPolygon(), [])):
        with pytest.raises(SettingError, match="The rate in the zones must") as refused:
            make(rate_l_ha=rate)
        said.append(str(refused.value))
    assert said[0] == said[1]


def test_a_name_that_nobody_knows_is_said_with_those_that_are_known():
    must_be_known("Settings", ["hours"], ["hours", "seed"])
    with pytest.raises(SettingError, match="Settings are hours, seed, but one is called 'hour'"):
        must_be_known("Settings", {"hours": 4, "hour": 4}, ["hours", "seed"])


@pytest.mark.parametrize(
    ("given", "day"),
    [("2026-11-18", date(2026, 11, 18)), (datetime(2026, 11, 18, 5), date(2026, 11, 18)), (3, 3)],
)
def test_a_day_is_taken_from_a_text_or_a_time_and_the_rest_is_left(given, day):
    assert day_of("A harvest", given) == day


def test_a_text_that_is_no_day_is_refused():
    with pytest.raises(SettingError, match="A harvest must be a day as 2026-11-18, but it is 'soo"):
        day_of("A harvest", "soon")
