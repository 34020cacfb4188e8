"""Dates in both orders are asked about, of days to come doubted, in records and in findings."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import Severity
from fieldmon.io.options import RecordOptions, Upload
from fieldmon.io.parse.dates import dates
from fieldmon.io.readers.date_doubts import come, in_future, refuse_mixed
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.readers.records import records_of
from fieldmon.plot.layout import rectangle
from tests.io.tables_of_cells import table

BOTH = ["18/11/2026", "11/15/2026", "11/06/2026"]


@pytest.mark.parametrize("column", [BOTH[:1], BOTH[1:], [], ["13/13/2026", *BOTH[1:]]])
def test_dates_of_one_order_are_not_asked_for(column):
    refuse_mixed(dates(np.array(column, object)), "date")


def test_where_dates_stand_in_both_orders_for_sure_it_is_asked_in_which_and_an_answer_holds():
    said = (
        r"1 is day first \(18/11/2026\), 1 month first \(11/15/2026\), and 1 could be either\. "
        "Write them all as 2026-11-18"
    )
    lines = "".join(f"{k + 1},yes,{day}\n" for k, day in enumerate(BOTH))
    file = Upload("found.csv", f"plant,found,date\n{lines}".encode())
    with pytest.raises(ChoiceNeeded, match=said) as asked:
        read_inspections(file, rectangle(2, 5), None)
    assert (asked.value.option, asked.value.choices) == ("date_order", ("dmy", "mdy"))
    read = read_inspections(file, rectangle(2, 5), InspectionOptions(date_order="dmy"))
    assert len(read.value) == 3
    records = table(date=BOTH, lon=[35.1] * 3, lat=[30.3] * 3)
    with pytest.raises(ChoiceNeeded, match=said):
        records_of(records, RecordOptions())


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
    assert not any("in the future" in one.sentence for one in read.messages), "it is said once"
    taken = read_inspections(file, rectangle(2, 5), InspectionOptions(take_doubtful=True))
    assert taken.value.date.tolist() == [day.item() for day in days]
    assert any("in the future" in one.sentence for one in taken.messages)


def test_a_file_of_days_to_come_alone_is_left_out_of_a_season_in_one_sentence():
    file = Upload("found.csv", f"plant,found,date\n1,yes,{days_from_now(40)}\n".encode())
    read = read_inspections(file, rectangle(2, 5), None)
    left = come(read, InspectionOptions(), days_from_now(0).item())
    assert len(left.value) == 0
    (said,) = (one.sentence for one in left.messages if "have not come" in one.sentence)
    assert said.startswith("1 result of days that have not come")
    assert not any("in the future" in one.sentence for one in left.messages)
