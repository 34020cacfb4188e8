"""What can be chosen when inspections are read, and what cannot."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.io.readers.inspection_options import InspectionOptions


@pytest.mark.parametrize("written", ["2026-11-18", "18.11.2026", "18 November 2026"])
def test_a_day_is_chosen_as_people_write_it(written):
    assert InspectionOptions().choose("day", written).day == np.datetime64("2026-11-18")


def test_an_order_of_dates_chosen_before_is_kept_to():
    options = InspectionOptions(date_order="mdy").choose("day", "03/04/2026")
    assert options.day == np.datetime64("2026-03-04")


def test_other_options_are_chosen_as_for_any_file():
    options = InspectionOptions().choose("accuracy_m", "3.5").choose("take_doubtful", "yes")
    assert (options.accuracy_m, options.take_doubtful) == (3.5, True)
    assert InspectionOptions().choose("columns", "count=Milben").column("count") == "Milben"
    assert InspectionOptions().choose("zone", "+02:00").zone == "+02:00"


@pytest.mark.parametrize(
    ("option", "value", "says"),
    [
        ("zone", "Paran", "time zone"),
        ("accuracy_m", "good", "number of metres"),
        ("accuracy_m", "-1", "0 to 1000 m"),
        ("accuracy_m", "5000", "0 to 1000 m"),
        ("day", "soon", "must be a date"),
        ("colour", "red", "no option 'colour'"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(option, value, says):
    with pytest.raises(SettingError, match=says):
        InspectionOptions().choose(option, value)
