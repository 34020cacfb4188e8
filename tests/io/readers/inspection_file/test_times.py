"""When plants were inspected: from one column or two, from the plan, or as told."""

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import Severity, UnreadDates, UnsureCells
from fieldmon.io.readers.inspection_file.columns import columns_of
from fieldmon.io.readers.inspection_file.times import times_in
from fieldmon.io.readers.inspection_options import InspectionOptions
from tests.io.tables_of_cells import table


def read(options=None, **columns):
    chosen = options or InspectionOptions()
    n = len(next(iter(columns.values())))
    layer = table(plant=list(range(n)), found=["x"] * n, **columns)
    return times_in(layer, columns_of(layer, chosen), chosen)


@pytest.mark.parametrize(
    ("columns", "noted"),
    [
        ({"time": "2026-11-18T08:30:05"}, "2026-11-18T08:30:05"),
        ({"time": "2026-11-18 08:30"}, "2026-11-18T08:30:00"),
        ({"date": "18.11.2026", "time": "08:30"}, "2026-11-18T08:30:00"),
        ({"date": "18/11/2026 8:30 PM", "hour": None}, "2026-11-18T20:30:00"),
        ({"when": "45979.5"}, "2025-11-18T12:00:00"),
        ({"time": "2026-11-18T08:30:05+02:00"}, "2026-11-18T08:30:05"),
        ({"תאריך": "18.11.2026", "שעה": "7:05"}, "2026-11-18T07:05:00"),
    ],
)
def test_times_are_read_as_people_write_them(columns, noted):
    times = read(**{name: [cell] for name, cell in columns.items()})
    assert (str(times.when[0]), str(times.day[0])) == (noted, noted[:10])


def test_times_in_utc_become_local_where_the_zone_is_told_and_else_the_guess_is():
    kept = read(time=["2026-11-18T22:30:00Z"])
    assert str(kept.when[0]) == "2026-11-18T22:30:00"
    assert [(m.severity, m.remedy.option) for m in kept.messages] == [(Severity.GUESSED, "zone")]
    moved = read(InspectionOptions(zone="Asia/Jerusalem"), time=["2026-11-18T22:30:00Z"])
    assert (str(moved.when[0]), str(moved.day[0])) == ("2026-11-19T00:30:00", "2026-11-19")
    assert moved.messages == []


@pytest.mark.parametrize("midnight", ["2026-11-18 00:00:00", "2026-11-18T00:00:00Z", "45979.0"])
@pytest.mark.parametrize("zone", [None, "America/Los_Angeles"])
def test_a_day_that_a_program_stored_as_its_midnight_has_no_time(midnight, zone):
    day = midnight[:10] if "-" in midnight else "2025-11-18"
    for column in ("date", "time"):
        times = read(InspectionOptions(zone=zone), **{column: [midnight, midnight]})
        assert np.isnat(times.when).all()
        assert times.day.astype(str).tolist() == [day, day]
    # an empty time beside such a day, and a time beside it
    times = read(date=[midnight, midnight], time=["", "08:30"])
    assert np.isnat(times.when).tolist() == [True, False]
    assert str(times.when[1]) == f"{day}T08:30:00"


def test_midnights_of_here_written_in_utc_are_days_too():
    jerusalem = InspectionOptions(zone="Asia/Jerusalem")
    times = read(jerusalem, date=["2026-11-17T22:00:00Z", "2026-06-17T21:00:00Z"])
    assert np.isnat(times.when).all()
    assert times.day.astype(str).tolist() == ["2026-11-18", "2026-06-18"]


def test_midnight_among_other_times_is_a_time():
    times = read(time=["2026-11-18 00:00", "2026-11-18 00:10"])
    assert times.when.astype(str).tolist() == ["2026-11-18T00:00:00", "2026-11-18T00:10:00"]


@pytest.mark.parametrize(
    ("zone", "cells", "timed"),
    [
        (None, ["2026-11-18 00:00:00", "2026-11-19 00:00:00", "2026-11-18 09:30:00"], "001"),
        (None, ["2026-11-18T00:00", "2026-11-19T00:00", *["2026-11-18T09:30"] * 2], "0011"),
        ("Asia/Jerusalem", [*["2026-11-17T22:00:00Z"] * 2, "2026-11-18T07:30Z"], "001"),
        # fewer of them are times, and so are clocks that somebody wrote beside their day
        (None, ["2026-11-18 00:00", "2026-11-19 00:00", *["2026-11-18 09:30"] * 3], "11111"),
        (None, ["2026-11-18 00:00", "2026-11-18 09:30", "", "2026-11-18"], "1100"),
        (None, ["00:00", "00:00", "00:10"], "111"),
    ],
)  # fmt: skip
def test_midnights_are_days_where_they_are_half_of_the_times_and_that_is_told(zone, cells, timed):
    days = {"date": ["2026-11-18"] * 3} if cells[0] == "00:00" else {}
    times = read(InspectionOptions(zone=zone), **days, time=cells)
    assert (~np.isnat(times.when)).astype(int).astype(str).tolist() == list(timed)
    assert times.day.astype(str)[0] == "2026-11-18"
    said = [m.sentence for m in times.messages if m.severity is Severity.GUESSED]
    told = ["2 dates with the time 00:00 among others were read as days without a time."]
    assert [one for one in said if "00:00" in one] == (told if timed[0] == "0" else [])


def test_without_a_time_the_day_is_the_planned_one_or_the_one_told():
    told = InspectionOptions(day=np.datetime64("2026-11-20"))
    times = read(told, arrive=["2026-11-18T08:30:00", None])
    assert np.isnat(times.when).all()
    assert times.day.astype(str).tolist() == ["2026-11-18", "2026-11-20"]
    assert read(told, date=["17.11.2026"]).day.astype(str).tolist() == ["2026-11-17"]
    assert np.isnat(read(colour=["red"]).day).all()


def test_a_day_that_was_told_of_lines_that_all_have_their_own_is_said_to_count_for_none():
    told = InspectionOptions(day=np.datetime64("2026-11-20"))
    dated = read(told, date=["17.11.2026", "20.11.2026"])
    (said,) = (one.sentence for one in dated.messages if "told" in one.sentence)
    assert said.startswith("The day that was told, 2026-11-20, counts for no line")
    for quiet in (read(told, date=["20.11.2026"]), read(told, date=["17.11.2026", ""])):
        assert not [one for one in quiet.messages if "told" in one.sentence]


def test_what_a_shift_past_midnight_finds_is_of_the_day_on_which_it_began():
    plan = {"arrive": ["2026-11-18T23:59:00", "2026-11-19T00:31:00"], "arrive_s": ["60", "1980"]}
    assert read(**plan).day.astype(str).tolist() == ["2026-11-18", "2026-11-18"]
    timed = read(time=["", "00:32"], **plan)
    assert timed.day.astype(str).tolist() == ["2026-11-18", "2026-11-19"]


@pytest.mark.parametrize("clock", ["8.31", "0831", "8h31", "noon", "25:00", "8:31:99", "8:30 EST"])
def test_a_time_that_is_none_leaves_the_day_beside_it_and_is_shown(clock):
    times = read(date=["2026-11-18"], time=[clock])
    assert np.isnat(times.when).all()
    assert str(times.day[0]) == "2026-11-18"
    (said,) = times.messages
    assert repr(clock) in said.sentence


def test_a_time_alone_is_of_the_planned_day_or_of_the_day_told():
    told = InspectionOptions(day=np.datetime64("2026-11-20"))
    times = read(told, time=["8:30", "9:00"], arrive=["2026-11-18T08:30:00", None])
    assert times.when.astype(str).tolist() == ["2026-11-18T08:30:00", "2026-11-20T09:00:00"]
    assert times.day.astype(str).tolist() == ["2026-11-18", "2026-11-20"]
    assert not times.messages


@pytest.mark.parametrize(
    "columns",
    [
        {"date": ["2026-02-30"]},
        {"date": ["31.11.2026"], "time": ["8:30"]},
        {"time": ["2026-02-30 8:30"]},
        {"date": ["next week"]},
    ],
)
def test_a_day_that_is_none_is_not_taken_for_the_planned_day_or_the_day_told(columns):
    told = InspectionOptions(day=np.datetime64("2026-11-20"))
    times = read(told, arrive=["2026-11-18T08:30:00"], **columns)
    assert np.isnat(times.day).all()
    assert np.isnat(times.when).all()
    (said,) = times.messages
    assert isinstance(said, UnreadDates)
    assert "1 record has a date that is none (record 1: '" in said.sentence
    assert "Write dates as 2026-11-18, 18/11/2026 or" in said.sentence


def test_times_that_are_none_are_left_open_and_shown():
    times = read(time=["soon", "2026-11-18 8:30"])
    assert np.isnat(times.when).tolist() == [True, False]
    assert "1 time is none ('soon')" in times.messages[0].sentence


def test_days_that_could_be_months_are_told():
    times = read(date=["03/04/2026"])
    assert times.day[0] == np.datetime64("2026-04-03")
    assert [m.remedy.option for m in times.messages] == ["date_order"]
    read_as_told = read(InspectionOptions(date_order="mdy"), date=["03/04/2026"])
    assert read_as_told.day[0] == np.datetime64("2026-03-04")


@pytest.mark.parametrize(
    ("columns", "day"),
    [
        ({"INSP_DATE": "2026-09-28", "CreationDate": "2026-10-05 11:00"}, "2026-09-28"),
        ({"CreationDate": "2026-10-05", "Inspection_Date": "2026-09-28"}, "2026-09-28"),
        ({"Date received": "2026-10-05", "Date sampled": "2026-09-28"}, "2026-09-28"),
        ({"Scouting date (2026)": "2026-09-28", "EditDate": "2026-10-05"}, "2026-09-28"),
        ({"date": "2026-09-28", "survey date": ""}, "2026-09-28"),
        ({"date": "2026-09-28", "planting_date": "2019-03-01", "end_time": "46294"}, "2026-09-28"),
        ({"date": "2026-09-28", "survey date": "28.9.2026"}, "2026-09-28"),
    ],
)
def test_the_day_of_the_work_goes_before_the_day_on_which_a_record_was_written(columns, day):
    times = read(**{name: [cell] for name, cell in columns.items()})
    assert (str(times.day[0]), times.messages) == (day, [])


def test_a_day_known_only_from_when_a_record_was_written_is_a_guess():
    times = read(CreationDate=["2026-10-05 11:00"], EditDate=["2026-10-06 11:00"])
    assert str(times.when[0]) == "2026-10-05T11:00:00"
    (said,) = times.messages
    assert (said.severity, "column 'CreationDate'" in said.sentence) == (Severity.GUESSED, True)
    beside_a_clock = read(time=["08:30"], CreationDate=["2026-10-05"])
    assert str(beside_a_clock.when[0]) == "2026-10-05T08:30:00"
    assert len(beside_a_clock.messages) == 1
    told = InspectionOptions().naming(date="EditDate")
    assert read(told, CreationDate=["2026-10-05"], EditDate=["2026-10-06"]).messages == []


def test_no_other_day_is_taken_for_that_of_the_work():
    assert np.isnat(read(planting_date=["2019-03-01"]).day[0])


def test_two_columns_that_say_different_days_are_a_question():
    cells = {"Date": ["2026-10-12", "2026-10-12"], "Sampling date": ["2026-09-28", "2026-10-12"]}
    with pytest.raises(ChoiceNeeded, match="different days of 1 of 2 records") as asked:
        read(**cells)
    assert set(asked.value.choices) == {"date=Date", "date=Sampling date"}
    chosen = InspectionOptions().choose(asked.value.option, "date=Sampling date")
    assert str(read(chosen, **cells).day[0]) == "2026-09-28"
    months_first = InspectionOptions(date_order="mdy")
    same = read(months_first, date=["04/03/2026"], sampling_date=["2026-04-03"])
    assert str(same.day[0]) == "2026-04-03"


def test_24_00_is_the_next_days_midnight_with_its_time_and_said():
    for times in (["24:00"], ["24:00", "08:30"]):
        noted = read(date=["2026-11-18"] * len(times), time=times)
        assert noted.when[0] == np.datetime64("2026-11-19T00:00:00")
        assert noted.day[0] == np.datetime64("2026-11-19")
        (said,) = (one for one in noted.messages if isinstance(one, UnsureCells))
        assert "1 time is 24:00, taken as 00:00 of the next day" in said.sentence


def test_a_time_in_the_hour_that_clocks_skip_is_doubted():
    here = InspectionOptions(zone="Asia/Jerusalem")
    noted = read(here, time=["2025-03-28T02:30:00", "2025-03-28T03:30:00"])
    assert noted.when[0] == np.datetime64("2025-03-28T02:30:00")
    (said,) = (one for one in noted.messages if "clocks skip" in one.sentence)
    assert said.severity is Severity.DOUBTFUL
    assert said.sentence.startswith("1 time is in an hour that clocks skip at the plot (2025-03-28")
    for zone, time in (("Asia/Jerusalem", "2025-10-26T01:30:00"), ("+02:00", "2025-03-28T02:30:00"),
                       ("Asia/Jerusalem", "2025-03-28T02:30:00+02:00")):  # fmt: skip
        quiet = read(InspectionOptions(zone=zone), time=[time])
        assert not any("clocks skip" in one.sentence for one in quiet.messages)
