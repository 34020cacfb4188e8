"""What a program hands over: refused in a sentence where it is something else."""

import numpy as np
import pytest

from fieldmon.compute.arguments import (
    must_be,
    must_be_in,
    must_be_known,
    must_be_name_of_file,
    must_be_zone,
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


def test_a_name_that_nobody_knows_is_said_with_those_that_are_known():
    must_be_known("Settings", ["hours"], ["hours", "seed"])
    with pytest.raises(SettingError, match="Settings are hours, seed, but one is called 'hour'"):
        must_be_known("Settings", {"hours": 4, "hour": 4}, ["hours", "seed"])
