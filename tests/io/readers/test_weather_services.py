"""Whole files as weather services give them out, made up here, become the same weather."""

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.readers.weather_options import WeatherOptions

HOURS = [(18 + k // 24, k % 24) for k in range(48)]
UTC_HOURS = np.datetime64("2026-11-18T00:00:00") + 3600 * np.arange(48)
NASA = """-BEGIN HEADER-
NASA/POWER Source Native Resolution Hourly Data
Dates (month/day/year): 11/18/2026 through 11/19/2026 in {zone}
Location: Latitude  30.36   Longitude {lon}
Elevation from MERRA-2: Average for 0.5 x 0.625 degree lat/lon region = 228.15 meters
The value for missing source data that cannot be computed or is outside of its range: -999
Parameter(s):
T2M             MERRA-2 Temperature at 2 Meters (C)
RH2M            MERRA-2 Relative Humidity at 2 Meters (%)
PRECTOTCORR     MERRA-2 Precipitation Corrected (mm/hour)
WS2M            MERRA-2 Wind Speed at 2 Meters (m/s)
WD2M            MERRA-2 Wind Direction at 2 Meters (Degrees)
-END HEADER-
YEAR,MO,DY,HR,T2M,RH2M,PRECTOTCORR,WS2M,WD2M
"""
NASA_ROWS = "".join(
    f"2026,11,{d},{h},{-999 if (d, h) == (18, 5) else h / 2},50.5,0.25,2.5,270.5\n"
    for d, h in HOURS
)
KNMI = """# BRON: KONINKLIJK NEDERLANDS METEOROLOGISCH INSTITUUT (KNMI)
# Opmerking: door stationsverplaatsingen zijn deze reeksen niet homogeen;
# STN         LON(east)   LAT(north)  ALT(m)      NAME
# 260         5.180       52.100      1.90        De Bilt
# YYYYMMDD  : datum (YYYY=jaar, MM=maand, DD=dag);
# HH        : tijd (HH=uur, UT. 12 UT=13 MET, 14 MEZT. Uurvak 05 loopt van 04.00 UT tot 5.00 UT);
# FH        : Uurgemiddelde windsnelheid (in {tenth} m/s);
# T         : Temperatuur (in {tenth} graden Celsius) op 1.50 m hoogte;
# RH        : Uursom van de neerslag (in {tenth} mm) (-1 voor <0.05 mm);
# STN,YYYYMMDD,   HH,   DD,   FH,    T,   RH,    U
#
"""
KNMI_ROWS = "".join(
    f"  260,202611{d},{h + 1:5d},{990 if h == 7 else 270:5d},   31,{10 * h - 20:5d},"
    f"{-1 if h < 12 else 12:5d},   80\n"
    for d, h in HOURS
)


def said(read):
    return " ".join(str(message) for message in read.messages)


@pytest.mark.parametrize(
    ("zone", "lon", "ahead"), [("UTC", 35.15, 0), ("LST", 35.15, 2), ("LST", -78.2, -5)]
)
def test_nasa_power_s_hours_are_utc_or_solar_as_its_header_says(read_weather, zone, lon, ahead):
    imported = read_weather(NASA.format(zone=zone, lon=lon) + NASA_ROWS)
    weather = imported.value
    assert weather.hourly
    assert (weather.at == UTC_HOURS - np.timedelta64(ahead, "h")).all()
    assert np.isnan(weather.temperature_c).nonzero()[0].tolist() == [5]
    assert weather.temperature_c[[4, 47]].tolist() == [2.0, 11.5]
    assert weather.humidity_pct[0] == 50.5
    assert weather.rain_mm.sum() == pytest.approx(12)
    assert (weather.wind_speed_m_s[0], weather.wind_from_deg[0]) == (2.5, 270.5)
    assert ("UTC," if zone == "UTC" else f"(LST), read as UTC{ahead:+03d}:00") in said(imported)


def test_nasa_power_without_its_header_is_without_summer_time(read_weather):
    table = "YEAR,MO,DY,HR,T2M\n" + "".join(f"2026,7,{d},{h},{h}\n" for d, h in HOURS)
    imported = read_weather(table)
    assert imported.value.at[0] == np.datetime64("2026-07-17T22:00:00")
    assert imported.value.temperature_c[13] == 13
    assert "guessed: Times are local time without summer time (LST), read as UTC+02:00" in said(
        imported
    )


def test_nasa_power_s_days_may_be_counted_through_the_year(read_weather):
    weather = read_weather("YEAR,DOY,T2M_MIN,T2M_MAX\n2026,59,1,9\n2026,60,2,10\n").value
    assert weather.local_days().astype(str).tolist() == ["2026-02-28", "2026-03-01"]


def test_dwd_s_hours_are_utc(read_weather):
    table = "STATIONS_ID;MESS_DATUM;QN_9;TT_TU;RF_TU;eor\n" + "".join(
        f"       44;202611{d}{h:02d};    3;{-999.0 if h == 5 else h + 0.5:6.1f};  {50 + h}.0;eor\n"
        for d, h in HOURS
    )
    imported = read_weather(table)
    weather = imported.value
    assert (weather.at == UTC_HOURS).all()
    assert weather.temperature_c[[0, 47]].tolist() == [0.5, 23.5]
    assert weather.gaps == 2
    assert weather.humidity_pct[1] == 51
    assert "Times are in UTC, as DWD gives them" in said(imported)
    assert "has no unit" not in said(imported)


def test_dwd_s_wind_of_letters_and_its_ten_minutes_are_read(read_weather):
    table = "STATIONS_ID;MESS_DATUM;QN;F;D;TT_10;eor\n" + "".join(
        f"44;2026111800{m:02d};3;{m / 10};90;20;eor\n" for m in range(0, 60, 10)
    )
    weather = read_weather(table).value
    assert weather.at.tolist() == [UTC_HOURS[0].item()]
    assert (weather.wind_speed_m_s[0], weather.wind_from_deg[0]) == (pytest.approx(2.5), 90)


def test_knmi_s_hours_end_when_they_are_counted_and_its_values_are_tenths(read_weather):
    imported = read_weather(KNMI.format(tenth="0.1") + KNMI_ROWS)
    weather = imported.value
    assert (weather.at == UTC_HOURS).all()
    assert weather.temperature_c[[0, 1, 47]] == pytest.approx([-2, -1, 21])
    assert weather.wind_speed_m_s[0] == pytest.approx(3.1)
    assert weather.rain_mm.reshape(2, 24).sum(axis=1) == pytest.approx([14.4, 14.4])
    assert weather.humidity_pct[0] == 80
    assert np.isnan(weather.wind_from_deg).nonzero()[0].tolist() == [7, 31]
    assert "Hours are counted 1 to 24; each was read as the hour that ends then" in said(imported)


def test_knmi_s_days_are_tenths_too(read_weather):
    head = (
        "# TG : Etmaalgemiddelde temperatuur (in 0.1 graden Celsius)\n# STN,YYYYMMDD,   FG,   TG,"
    )
    rows = "".join(f"  260,202611{d},   31,  115,   80,  150,   -1,   85\n" for d in (18, 19))
    weather = read_weather(f"{head}   TN,   TX,   RH,   UG\n{rows}").value
    assert not weather.hourly
    days = weather.temperature_c[0], weather.low_c[0], weather.high_c[0], weather.rain_mm[0]
    assert days == pytest.approx((11.5, 8, 15, 0))
    assert weather.humidity_pct[0] == 85


@pytest.mark.parametrize(("warmest", "made"), [("215", 21.5), ("21.5", 21.5), ("21", None)])
def test_knmi_without_its_header_is_in_tenths_if_nothing_else_can_be(read_weather, warmest, made):
    table = f"STN,YYYYMMDD,HH,T,U\n260,20261118,1,{warmest},50\n260,20261118,2,10,50\n"
    if made is not None:
        assert read_weather(table).value.temperature_c[0] == pytest.approx(made)
        return
    with pytest.raises(ChoiceNeeded, match="in tenths or degrees") as asked:
        read_weather(table)
    for choice, wanted in zip(asked.value.choices, (2.1, 21), strict=True):
        told = read_weather(table, WeatherOptions(temperature_unit=choice)).value
        assert told.temperature_c[0] == pytest.approx(wanted)


def test_open_meteo_s_times_are_as_far_ahead_as_its_first_lines_say(read_weather):
    table = (
        "latitude,longitude,elevation,utc_offset_seconds,timezone,timezone_abbreviation\n"
        "30.36,35.15,120.0,10800,Asia/Jerusalem,GMT+3\n\n"
        "time,temperature_2m (°C),relative_humidity_2m (%),rain (mm),wind_speed_10m (km/h),"
        "wind_direction_10m (°),soil_temperature_0cm (°C)\n"
    ) + "".join(f"2026-11-{d}T{h:02d}:00,{h / 2},50,0.25,7.2,270,{40 + h}\n" for d, h in HOURS)
    imported = read_weather(table)
    weather = imported.value
    assert (weather.at == UTC_HOURS - np.timedelta64(3, "h")).all()
    assert weather.temperature_c[47] == 11.5
    assert weather.wind_speed_m_s[0] == pytest.approx(2)
    assert weather.rain_mm.sum() == pytest.approx(12)
    assert "Times are in UTC+03:00, as the lines above the table say" in said(imported)


@pytest.mark.parametrize("facts", ["99999", "-1e3", ""])
def test_facts_that_are_none_leave_the_plot_s_zone(read_weather, facts):
    table = f"latitude,utc_offset_seconds\n30,{facts}\n\ntime,temp (C)\n"
    rows = "".join(f"2026-11-{d}T{h:02d}:00,{h}\n" for d, h in HOURS)
    assert read_weather(table + rows).value.at[0] == np.datetime64("2026-11-17T22:00:00")
    nasa = NASA.format(zone="LST", lon=9999) + NASA_ROWS
    assert read_weather(nasa).value.at[0] == np.datetime64("2026-11-17T22:00:00")
