"""Times of weather tables are those that their writers meant, or none."""

import datetime as dt
import io

import numpy as np
import openpyxl
import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem

HOURS = [(18 + k // 24, k % 24) for k in range(48)]
#: local midnight in Jerusalem's winter
FIRST = np.datetime64("2026-11-17T22:00:00")


def said(read):
    return " ".join(str(message) for message in read.messages)


def workbook(clock):
    book = openpyxl.Workbook()
    book.active.append(["Date", "Time", "Temp (C)"])
    for k, (d, h) in enumerate(HOURS):
        book.active.append([dt.datetime(2026, 11, d), clock(h), k])
    book.save(made := io.BytesIO())
    return made.getvalue()


def must_be_the_hours(weather):
    """Hours from the first midnight on, as warm as hours have passed."""
    assert weather.hourly
    assert (weather.at == FIRST + 3600 * np.arange(48)).all()
    assert weather.temperature_c.tolist() == list(range(48))


@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("Date,Hour", "2026-11-{d},{h}"),
        ("Date,HHMM", "2026-11-{d},{h:02d}00"),
        ("Date,Time", "2026-11-{d},{h}00"),
        ("Date,Hr", "2026-11-{d},{h}"),
        ("Fecha;Hora", "{d}/11/2026;{h}.00"),
        ("Year,Month,Day,Hour", "2026,11,{d},{h}"),
        ("Year,Month,Day,Time", "2026,11,{d},{h:02d}:00"),
        ("YYYYMMDDHH,time", "x,202611{d}{h:02d}"),
        ("time", "202611{d}:{h:02d}00"),
        ("time", "2026-11-{d}T{h:02d}"),
        ("time", "{d}.11.2026 {h}h"),
        ("time", "{d} November 2026 {h}"),
        ("time", "{d} de noviembre de 2026 {h}h"),
        ("Date,Hour", "2026-11-{d},{h}:00:00"),
    ],
)
def test_an_hour_beside_a_date_is_that_hour(read_weather, header, row):
    mark = ";" if ";" in header else ","
    lines = [f"{row.format(d=d, h=h)}{mark}{k}" for k, (d, h) in enumerate(HOURS)]
    must_be_the_hours(read_weather(f"{header}{mark}Temp (C)\n" + "\n".join(lines)).value)


@pytest.mark.parametrize("clock", [dt.time, int, lambda hour: hour / 24])
def test_an_hour_of_a_workbook_is_that_hour(read_weather, clock):
    must_be_the_hours(read_weather(workbook(clock), name="w.xlsx").value)


@pytest.mark.parametrize(
    ("header", "row"),
    [
        ("Datetime", "2026-11-{d} {h:02d}:00"),
        ("YEAR,MO,DY,HR", "2026,11,{d},{h}"),
        ("Date,Hour (PST)", "11/{d}/2026,{h:02d}00"),
    ],
)
def test_hours_counted_1_to_24_are_those_that_end_then(read_weather, header, row):
    lines = [f"{row.format(d=d, h=h + 1)},{k}" for k, (d, h) in enumerate(HOURS)]
    imported = read_weather(f"{header},Temp (C)\n" + "\n".join(lines))
    must_be_the_hours(imported.value)
    assert "Hours are counted 1 to 24; each was read as the hour that ends then" in said(imported)


def test_24_00_among_minutes_is_the_midnight_that_follows(read_weather):
    rows = ["23:30,1", "24:00,2"]
    weather = read_weather("time,temp (C)\n" + "\n".join(f"2026-11-18 {row}" for row in rows)).value
    assert weather.at.astype(str).tolist() == ["2026-11-18T21:00:00", "2026-11-18T22:00:00"]


def test_hours_of_part_of_a_day_say_how_they_were_read(read_weather):
    imported = read_weather("Date,Hour,Temp (C)\n2026-11-18,7,1\n2026-11-18,8,2")
    assert imported.value.at[0] == np.datetime64("2026-11-18T05:00:00")
    assert "guessed: Hours were read as 0 to 23, each as the hour that begins then" in said(
        imported
    )


def test_a_humidity_called_hr_is_no_hour(read_weather):
    days = "\n".join(
        f"2026-11-{day},20,{hr}" for day, hr in ((18, 24), (19, 21), (20, 23), (21, 23))
    )
    weather = read_weather(f"Fecha,T (C),HR\n{days}").value
    assert not weather.hourly
    assert weather.humidity_pct.tolist() == [24, 21, 23, 23]


def test_a_time_that_is_none_is_not_midnight(read_weather):
    table = "time,temp (C)\n2026-11-18 00:00,1\n2026-11-18 1 o'clock,2\n2026-11-18 02:00,3\n"
    imported = read_weather(table + "2026-11-18 03:00,4\n2026-11-18 04:00,5\n")
    assert imported.value.temperature_c.tolist() == [1, 3, 4, 5]
    assert """1 time is none ("2026-11-18 1 o'clock")""" in said(imported)
    with pytest.raises(FileProblem, match="holds none"):
        read_weather("Date,Time,temp (C)\n2026-11-18,noon,2\n2026-11-19,noon,3\n")
    # midnight is often written as its date alone
    alone = read_weather("time,temp (C)\n2026-11-18,1\n2026-11-18 01:00,2\n2026-11-18 02:00,3\n")
    assert alone.value.temperature_c.tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("name", "first"),
    [("Time (UTC)", "00"), ("Date Time, GMT+02:00", "22"), ("Time (UTC+3)", "21"),
     ("Date/Time (LST)", "22")],
)  # fmt: skip
def test_a_zone_in_the_name_of_a_column_is_that_of_its_times(read_weather, name, first):
    rows = "".join(f"2026-07-18 {h:02d}:00,{h}\n" for h in range(24))
    weather = read_weather(f'"{name}",temp (C)\n{rows}').value
    assert str(weather.at[0])[11:13] == first


def test_a_station_whose_clock_is_never_put_forward_is_in_standard_time(read_weather):
    """It measured at two in the night of 27 March, when clocks in Israel skip from two to three."""
    local = np.datetime64("2026-03-26T00:00") + np.arange(72).astype("timedelta64[h]")
    imported = read_weather(
        "time,temp (C)\n" + "\n".join(f"{at},{k / 4}" for k, at in enumerate(local))
    )
    assert (imported.value.at == local.astype("datetime64[s]") - np.timedelta64(2, "h")).all()
    assert "Clocks skip 2026-03-27 02:00, but it was measured" in said(imported)


def test_days_and_months_in_both_orders_are_asked_about(read_weather):
    days = "".join(f"{day},20\n" for day in ("13/11/2026", "12/11/2026", "11/14/2026"))
    with pytest.raises(ChoiceNeeded, match=r"1 is day first .* 1 month first .*1 could"):
        read_weather(f"date,temp (C)\n{days}")
