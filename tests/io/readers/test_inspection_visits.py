"""Leaves of a plant, and what is said again, are one inspection; another visit is another one."""

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.import_report import Severity
from tests.io.readers.test_inspections import read


@pytest.mark.parametrize(
    "other",
    [
        "8,x,3,Noa,2026-11-18T08:30",
        "7,no,,Noa,2026-11-18T08:30",
        "7,x,4,Noa,2026-11-18T08:30",
        "7,x,,Noa,2026-11-18T08:30",
        "7,x,3,Amir,2026-11-18T08:30",
        "7,x,3,Noa,2026-11-18T08:41",
        "7,x,3,Noa,",
    ],
)
def test_any_other_inspection_is_another_one(other):
    head = "plant,found,count,who,time\n"
    assert len(read(f"{head}7,x,3,Noa,2026-11-18T08:30\n{other}\n").value) == 2


def test_notes_and_blanks_make_no_other_inspection():
    head = "plant,found,count,who,time,notes\n"
    rows = "7,x,3,Noa,2026-11-18T08:30,leaf\n7,x,3.0, Noa ,2026-11-18T08:30:00,thorns\n"
    rows += "7,x,3,Noa,2026-11-18,\n"
    assert read(head + rows).value.notes.tolist() == ["leaf; thorns"]


def test_what_a_file_says_twice_is_taken_once():
    imported = read("plant,found\n7,x\n8,no\n7,yes\n")
    assert imported.value.plant.tolist() == [7, 8]
    assert any("says again" in f.sentence for f in imported.messages)


def test_leaves_of_a_plant_are_one_inspection_found_if_any_leaf_is():
    head = "plant,date,leaf,count\n"
    told = read(f"{head}7,2026-11-18,1,0\n7,2026-11-18,2,3\n7,2026-11-18,3,2\n8,2026-11-18,1,0\n")
    assert told.value.plant.tolist() == [7, 8]
    assert told.value.result.tolist() == [FOUND, CLEAN]
    np.testing.assert_array_equal(told.value.count, [5, np.nan])
    (said,) = (m.sentence for m in told.of(Severity.GUESSED) if "single leaves" in m.sentence)
    assert said.startswith("3 records of single leaves became 1 inspection of whole plants")
    twice = read(f"{head}7,2026-11-18,1,0\n7,2026-11-18,1,3\n")
    assert twice.value.result.tolist() == [CLEAN, FOUND]
    assert any("both found and clean" in m.sentence for m in twice.messages)


@pytest.mark.parametrize(
    ("times", "n"), [(("8", "17"), 2), (("early", "late"), 2), (("early", "early"), 1)]
)
def test_hours_tell_visits_apart_and_so_do_times_that_nobody_can_read(times, n):
    first, second = times
    text = f"plant,date,hour,found\n7,2026-11-18,{first},x\n7,2026-11-18,{second},x\n"
    told = read(text)
    assert len(told.value) == n
    unread = any("times are none ('early'" in m.sentence for m in told.messages)
    assert unread is (first == "early")
