"""Weather is read as stations write it, and refused where it makes no sense."""

from datetime import UTC, datetime

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.options import Upload
from fieldmon.io.readers.weather import weather_in
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.io.sandbox.workroom import Workroom

JERUSALEM = WeatherOptions(zone="Asia/Jerusalem")


@pytest.fixture
def read(read_weather):
    return read_weather


def said(read):
    return " ".join(str(message) for message in read.messages)


HOURS = "\n".join(
    f"2026-11-18 {hour:02d}:00;{hour}.5;{18 + hour / 10};{hour * 10};0,2;{50 + hour}"
    for hour in range(24)
)


def test_hours_with_units_in_the_names_become_ours(read):
    table = f"Time;Temp (°C);Wind (km/h);Wind direction (deg);Rain (mm);Hum (%)\n{HOURS}"
    weather = read(table.replace(",", ".")).value
    assert weather.hourly
    assert len(weather) == 24
    # local midnight in winter is two hours before that of UTC
    assert weather.at[0] == np.datetime64("2026-11-17T22:00:00")
    assert weather.temperature_c[3] == 3.5
    assert weather.wind_speed_m_s[0] == pytest.approx(5.0)
    assert weather.wind_from_deg[9] == 90
    assert weather.rain_mm.sum() == pytest.approx(4.8)
    assert weather.humidity_pct[1] == 51
    assert weather.gaps == 0
    assert not weather.forecast.any()


@pytest.mark.parametrize(
    ("header", "row", "wanted"),
    [
        ("Date,Tmin (F),Tmax (F),Rain (in)", "2026-11-{},50,68,0.5", (10, 20, 12.7)),
        ("Datum;Temperatur Min;Temperatur Max;Niederschlag (mm)", "{}.11.2026;10;20;12,7",
         (10, 20, 12.7)),
        ("Fecha,Temperatura mínima (°C),Temperatura máxima (°C),Lluvia mm",
         "2026-11-{},10,20,12.7", (10, 20, 12.7)),
        ("תאריך,טמפרטורת מינימום,טמפרטורת מקסימום,גשם (מ״מ)", "{}/11/2026,10,20,12.7",
         (10, 20, 12.7)),
        ("التاريخ,درجة الحرارة الصغرى,درجة الحرارة العظمى,أمطار (مم)", "2026-11-{},10,20,12.7",
         (10, 20, 12.7)),
        ("Date,Température minimale,Température maximale,Pluie (mm)", "2026-11-{},10,20,12.7",
         (10, 20, 12.7)),
        ("YEAR,MO,DY,T2M_MIN,T2M_MAX,PRECTOTCORR", "2026,11,{},10,20,12.7", (10, 20, 12.7)),
        ("date,tmin_k,tmax_k,rain_cm", "2026-11-{},283.15,293.15,1.27", (10, 20, 12.7)),
    ],
)  # fmt: skip
def test_days_are_read_in_large_languages_and_units(read, header, row, wanted):
    weather = read("\n".join([header, *(row.format(day) for day in (18, 19, 20))])).value
    assert not weather.hourly
    assert weather.local_days().astype(str).tolist() == ["2026-11-18", "2026-11-19", "2026-11-20"]
    made = weather.low_c[1], weather.high_c[1], weather.rain_mm[1]
    assert made == pytest.approx(wanted)
    assert weather.temperature_c[0] == pytest.approx(15)


@pytest.mark.parametrize(
    ("header", "cell", "wanted"),
    [("wind_m_s", "5", 5), ("Wind Speed mph", "10", 4.4704), ("wind (kn)", "10", 5.144444),
     ("windSpeedKmh", "36", 10), ("Windgeschwindigkeit (km/h)", "36", 10)],
)  # fmt: skip
def test_winds_come_in_any_unit_that_is_named(read, header, cell, wanted):
    weather = read(f"date,temp_c,{header}\n2026-11-18,20,{cell}\n2026-11-19,20,{cell}").value
    assert weather.wind_speed_m_s[0] == pytest.approx(wanted, rel=1e-5)


def test_a_line_of_units_below_the_names_is_read(read):
    table = "TIMESTAMP,AirTC_Avg,WS_ms,Rain_Tot\n,Deg F,m/s,in\n2026-11-18 00:00,68,2,1\n"
    weather = read(table + "2026-11-18 01:00,50,2,0\n").value
    assert weather.temperature_c.tolist() == pytest.approx([20, 10])
    assert weather.rain_mm[0] == pytest.approx(25.4)


def test_no_file_is_refused_for_its_humidity_for_nothing_needs_it(read):
    unit = read("date,temp (C),RH (g/m3)\n2026-11-18,20,12\n2026-11-19,20,11")
    assert "The unit of RH (g/m3) is 'g/m3' and not %. It was left out" in said(unit)
    values = read("date,temp (C),RH\n2026-11-18,20,612\n2026-11-19,20,611")
    assert "2 values of humidity_pct are impossible; left out" in said(values)
    for imported in (unit, values):
        assert np.isnan(imported.value.humidity_pct).all()


def test_values_of_no_weather_are_left_out_or_refuse_the_file(read):
    days = "\n".join(f"2026-10-{day:02d},20" for day in range(1, 31))
    imported = read(f"date,temp (C)\n{days}\n2026-10-31,888")
    assert "1 value of temperature_c is impossible" in said(imported)
    assert imported.value.gaps == 0  # after the last known nothing is missing
    with pytest.raises(FileProblem, match=r"3 of 3 values are beyond it \(the first is 201\)"):
        read("date,temp (C)\n2026-11-18,201\n2026-11-19,205\n2026-11-20,199")
    with pytest.raises(FileProblem, match="record 2 they are 21 and 20"):
        read("date,tmin (C),tmax (C)\n2026-11-18,10,20\n2026-11-19,21,20")


def test_a_file_without_temperatures_or_times_says_what_it_lacks(read):
    with pytest.raises(FileProblem, match="must hold temperatures"):
        read("date,rain (mm)\n2026-11-18,1\n2026-11-19,2")
    with pytest.raises(FileProblem, match="column of dates or times, but has station, temp"):
        read("station,temp (C)\nA,20\nB,21")


def test_days_that_could_be_months_are_asked_for(read):
    with pytest.raises(ChoiceNeeded, match="day or month first") as asked:
        read("date,temp (C)\n03/04/2026,20\n04/04/2026,21")
    assert asked.value.option == "date_order"


@pytest.mark.parametrize("clock", ["", " 00:00"])
def test_days_with_points_are_read_day_first_and_that_is_said(read, clock):
    june = read(f"date,temp (C)\n01.06.2026{clock},20\n02.06.2026{clock},21")
    assert june.value.at[0].astype("datetime64[M]") >= np.datetime64("2026-05")
    assert june.value.at[-1] - june.value.at[0] < np.timedelta64(3, "D")
    said = " ".join(map(str, june.messages))
    assert "Dates could be day or month first; read day first." in said
    assert "date_order=mdy" in said
    shown = read("date,temp (C)\n05.12.2026,20\n05.13.2026,21")
    assert "could be day or month first" not in " ".join(map(str, shown.messages))


def test_times_that_name_a_zone_are_taken_at_their_word(read):
    weather = read("time,temp (C)\n2026-11-18T00:00Z,1\n2026-11-18T01:00Z,2").value
    assert weather.at[0] == np.datetime64("2026-11-18T00:00:00")
    utc = read("Time (UTC),temp (C)\n2026-11-18 00:00,1\n2026-11-18 01:00,2").value
    assert utc.at[0] == np.datetime64("2026-11-18T00:00:00")


def test_the_hour_that_comes_twice_in_autumn_stands_twice(read):
    table = "time,temp (C)\n" + "\n".join(
        f"2026-10-25 {clock},{i}" for i, clock in enumerate(("00:00", "01:00", "01:00", "02:00"))
    )
    weather = read(table).value
    assert np.diff(weather.at).astype(int).tolist() == [3600] * 3
    assert weather.temperature_c.tolist() == [0, 1, 2, 3]


def test_a_date_and_a_clock_in_two_columns_are_one_time(read):
    weather = read("Date,Hour,temp (C)\n2026-11-18,13:00,20\n2026-11-18,14:00,21").value
    assert weather.at[0] == np.datetime64("2026-11-18T11:00:00")


def test_ten_minutes_are_gathered_into_hours(read):
    rows = [f"2026-11-18 {h:02d}:{m:02d},{10 + m / 10},{m},{2 * (m == 0)}" for h in range(3)
            for m in range(0, 60, 10)]  # fmt: skip
    imported = read("time,temp (C),wind dir (deg),rain (mm)\n" + "\n".join(rows))
    weather = imported.value
    assert len(weather) == 3
    assert weather.temperature_c[0] == pytest.approx(12.5)
    assert (weather.low_c[0], weather.high_c[0]) == (10, 15)
    assert weather.rain_mm.tolist() == [2, 2, 2]
    assert weather.wind_from_deg[0] == pytest.approx(25, abs=0.1)
    assert "every 10 minutes" in said(imported)


def test_winds_are_averaged_as_vectors(read):
    rows = ["2026-11-18 00:00,1,350", "2026-11-18 00:30,1,10"]
    weather = read("time,temp (C),wind dir (deg)\n" + "\n".join(rows)).value
    assert weather.wind_from_deg[0] == pytest.approx(0, abs=1e-6)


def test_compass_points_are_directions(read):
    rows = ["2026-11-18,20,SW", "2026-11-19,20,calm", "2026-11-20,20,N"]
    weather = read("date,temp (C),wind dir\n" + "\n".join(rows)).value
    assert weather.wind_from_deg[[0, 2]].tolist() == [225, 0]
    assert np.isnan(weather.wind_from_deg[1])


def test_gaps_are_stated_with_the_longest(read):
    rows = [f"2026-11-{day},20" for day in (1, 2, 6, 8, 9)]
    imported = read("date,temp (C)\n" + "\n".join(rows))
    assert imported.value.gaps == 4
    assert "4 days without a temperature; the longest gap, 3 days" in said(imported)


def test_temperatures_of_the_day_and_the_night_alone_are_refused(read):
    half = "date,Day temperature (C),Night temperature (C){}\n2026-11-18,20,10{}"
    with pytest.raises(FileProblem, match=r"the night alone \(Day temperature .*Night"):
        read(half.format("", ""))
    assert read(half.format(",Temp (C)", ",14")).value.temperature_c.tolist() == [14]


def test_what_lies_ahead_is_forecast(read):
    now = datetime(2026, 11, 18, 12, tzinfo=UTC)
    options = WeatherOptions(zone="UTC", now=now)
    weather = read("date,temp (C)\n2026-11-18,20\n2026-11-19,21", options).value
    assert weather.forecast.tolist() == [False, True]
    flagged = read("date,temp (C),forecast\n2026-11-18,20,no\n2026-11-19,21,yes").value
    assert flagged.forecast.tolist() == [False, True]


@pytest.mark.parametrize("rows", [("20,no", "31,yes"), ("31,yes", "20,no")])
def test_of_one_time_the_measured_line_holds(read, rows):
    both = "\n".join(f"2026-11-18,{row}" for row in rows)
    weather = read(f"date,temp (C),forecast\n{both}\n2026-11-19,21,yes").value
    assert (weather.temperature_c.tolist(), weather.forecast.tolist()) == ([20, 21], [False, True])


def test_soil_dew_and_gusts_are_not_taken_for_the_weather(read):
    table = "date,soil temp (C),dew point (C),gust (m/s),air temp (C)\n2026-11-18,1,2,3,20\n"
    weather = read(table + "2026-11-19,1,2,3,21").value
    assert weather.temperature_c.tolist() == [20, 21]
    assert np.isnan(weather.wind_speed_m_s).all()


def test_fuzzed_tables_are_read_or_refused_with_a_sentence(tmp_path):
    table = "Time,Temp (C),Wind (m/s)\n2026-11-18 00:00,1,2\n2026-11-18 01:00,2,3\n"
    rng, sentences = np.random.default_rng(7), []
    for number in range(40):
        data = bytearray(table.encode())
        for at in rng.integers(0, len(data), 4):
            data[at] = rng.integers(32, 127)
        room = tmp_path / str(number)
        room.mkdir()
        try:
            weather_in(Upload("w.csv", bytes(data)), JERUSALEM, Workroom(room))
        except (FileProblem, ChoiceNeeded) as refused:
            sentences.append(str(refused))
    assert 5 < len(sentences) < 40
    assert all(sentence.endswith((".", "?")) for sentence in sentences)


def test_numbers_that_mark_what_is_missing_are_no_weather(read):
    """A rain of 999.9 mm was one, and -99.9 made a file without units one in Fahrenheit."""
    rows = "\n".join(
        f"2026-11-18 {hour:02d}:00,{-99.9 if hour < 6 else 20},{999.9 if hour == 3 else 0.5},"
        f"{990 if hour == 1 else 90},{-999 if hour == 9 else 50}"
        for hour in range(24)
    )
    imported = read(f"time,temp,rain (mm),wind dir,RH\n{rows}")
    weather = imported.value
    assert np.isnan(weather.temperature_c).tolist() == [True] * 6 + [False] * 18
    assert np.nansum(weather.rain_mm) == pytest.approx(11.5)
    assert np.isnan(weather.wind_from_deg).nonzero()[0].tolist() == [1]
    assert np.nanmean(weather.humidity_pct) == 50
    assert "6 values of temp are missing, marked by -99.9" in said(imported)


@pytest.mark.parametrize(
    ("unit", "cell"), [("mm/h", 6), ("mm/10min", 1), ("mm", 1), ("mm/day", 144)]
)
def test_rain_that_is_told_as_a_rate_is_summed_over_its_time(read, unit, cell):
    rows = "\n".join(f"2026-11-18 {h:02d}:{m:02d},20,{cell}" for h in range(3)
                     for m in range(0, 60, 10))  # fmt: skip
    assert read(f"time,temp (C),rain ({unit})\n{rows}").value.rain_mm.tolist() == [6.0] * 3


def test_a_low_and_a_mean_without_a_high_are_doubted(read):
    days = "\n2026-11-18,27,10\n2026-11-19,26,9"
    assert "Tmin (C) was read as the low and Temp (C) as the mean" in said(
        read(f"Date,Temp (C),Tmin (C){days}")
    )
    assert "doubtful" not in said(read(f"Date,Tmax (C),Tmin (C){days}"))
    davis = read("Date,Hi Temp (F),Low Temp (F)\n2026-11-18,80,50\n2026-11-19,80,50")
    assert davis.value.temperature_c[0] == pytest.approx((80 + 50 - 64) / 2 / 1.8)


def test_tens_of_degrees_are_degrees(read):
    table = "date,temp (C),Wind Dir (10s deg)\n2026-11-18,20,27\n2026-11-19,20,9\n"
    assert read(table).value.wind_from_deg.tolist() == [270, 90]


def test_a_logger_s_number_behind_a_unit_is_no_unit(read):
    table = 'date,"Temp, °F (LGR S/N: 12, SEN S/N: 13)"\n2026-11-18,50\n2026-11-19,50\n'
    assert read(table).value.temperature_c[0] == pytest.approx(10)


def test_names_that_stand_again_are_passed_over_and_another_table_is_left_out(read):
    one = "time,temp (C)\n2026-11-18 00:00,1\n2026-11-18 01:00,2\n"
    again = read(one + one.replace("11-18", "11-19"))
    assert again.value.temperature_c.tolist() == [1, 2, 1, 2]
    other = read(one + "time,temp max (C)\n2026-11-18,20\n2026-11-19,21\n")
    assert other.value.temperature_c.tolist() == [1, 2]
    assert "Another table begins after record 2" in said(other)


def test_dates_of_no_station_are_no_times(read):
    imported = read("date,temp (C)\n0001-01-01,20\n2026-11-18,20\n9999-12-31,21\n2026-11-19,22")
    assert len(imported.value) == 2
    assert "2 lines without a time" in said(imported)
