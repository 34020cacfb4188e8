"""Dates in both orders or of days to come are doubted, in records and in findings; no others."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.parse.dates import dates
from fieldmon.io.readers.date_doubts import in_future, mixed_dates
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.plot.layout import rectangle

BOTH = ["18/11/2026", "11/15/2026", "11/06/2026"]


@pytest.mark.parametrize(("column", "doubts"), [(BOTH, 1), (BOTH[:1], 0), (BOTH[1:], 0), ([], 0)])
def test_it_is_said_with_how_many_could_be_either(column, doubts):
    said = mixed_dates(dates(np.array(column, object)), "date")
    assert len(said) == doubts
    for one in said:
        assert one.severity == Severity.DOUBTFUL
        assert "1 that could be either were read day first" in one.sentence


def test_findings_say_so_too():
    lines = "".join(f"{k + 1},yes,{day}\n" for k, day in enumerate(BOTH))
    file = Upload("found.csv", f"plant,found,date\n{lines}".encode())
    read = read_inspections(file, rectangle(2, 5), None)
    assert any("could be either" in message.sentence for message in read.messages)


def days_from_now(n):
    return np.datetime64((datetime.now(UTC) + timedelta(days=n)).date(), "D")


def test_a_day_to_come_is_doubted_but_not_tomorrow_which_is_today_elsewhere():
    (said,) = in_future(np.array([days_from_now(3), days_from_now(0), days_from_now(9)]))
    assert said.severity == Severity.DOUBTFUL
    assert f"2 records lie in the future, the last on {days_from_now(9)}" in said.sentence
    assert in_future(np.array([days_from_now(0), np.datetime64("NaT")])) == []


def test_findings_of_a_day_to_come_are_doubted():
    file = Upload("found.csv", f"plant,found,date\n1,yes,{days_from_now(40)}\n".encode())
    read = read_inspections(file, rectangle(2, 5), None)
    assert any("1 record lies in the future" in message.sentence for message in read.messages)
    assert len(read.value) == 1


def test_a_day_to_come_amid_days_that_have_come_is_left_out_unless_it_is_taken():
    days = [days_from_now(-2), days_from_now(363), days_from_now(0), days_from_now(1)]
    lines = "".join(f"{k},yes,{day}\n" for k, day in enumerate(days))
    file = Upload("found.csv", f"plant,found,date\n{lines}".encode())
    read = read_inspections(file, rectangle(2, 5), None)
    assert read.value.plant.tolist() == [0, 2, 3]
    (said,) = (one for one in read.messages if one.feature == "record 2")
    assert said.severity == Severity.DOUBTFUL
    assert said.sentence == (
        f"It is doubtful: its day, {days[1]}, has not come, but others of the file have."
    )
    assert said.remedy.setting == "take_doubtful=yes"
    taken = read_inspections(file, rectangle(2, 5), InspectionOptions(take_doubtful=True))
    assert taken.value.date.tolist() == [day.item() for day in days]
