"""What was applied: what a record asks, and what a label adds where nobody said it."""

import math
from datetime import time

import pytest

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import SettingError
from fieldmon.monitoring.treating.applications import Application

LABEL = ProductLabel("Acarol", waiting_days=7, reentry_hours=12.0, irac_groups=("6",))


def test_the_label_says_what_nobody_said_and_nothing_else():
    said = Application("Acarol").by_label(LABEL)
    assert (said.waiting_days, said.reentry_hours, said.irac_groups) == (7, 12.0, ("6",))
    own = Application("Acarol", waiting_days=0, reentry_hours=0.0, irac_groups=("10A",))
    assert own.by_label(LABEL) == own
    assert own.by_label(None) == own


def test_only_what_was_said_is_told():
    assert Application("soap").said() == {"product": "soap"}
    told = Application("soap", Dose(2, "%"), began=time(7), irac_groups=("4A", "28")).said()
    assert told == {"product": "soap", "dose": "2 %", "began": "07:00", "irac_groups": "4A+28"}


@pytest.mark.parametrize(
    "wrong",
    [{"waiting_days": -1}, {"reentry_hours": -1.0}, {"water_l_ha": 0.0}, {"reason": "x" * 2001}],
)
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(SettingError):
        Application("soap", **wrong)


@pytest.mark.parametrize(
    "said",
    [{"product": 3}, {"operator": None}, {"reason": 10**30}, {"began": "eight"}, {"ended": 8.5}],
)
def test_what_is_said_of_a_treatment_is_of_its_kind(said):
    (name,) = said
    with pytest.raises(SettingError, match=f"A treatment's {name} must be (text|a time)"):
        Application(**said)


@pytest.mark.parametrize(
    ("times", "over_s"),
    [
        ({}, math.inf), ({"began": time(6)}, 21_600.0),
        ({"began": time(6), "ended": time(6, 30)}, 23_400.0),
        ({"began": time(23), "ended": time(1)}, 90_000.0),
    ],
)  # fmt: skip
def test_it_is_over_once_it_ended_or_began_where_no_end_was_said(times, over_s):
    assert Application("soap", **times).over_s == over_s
