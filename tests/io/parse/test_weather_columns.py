"""A column of weather is known by its name and its unit."""

import pytest

from fieldmon.io.parse.weather_columns import half_days, weather_column, weather_columns


@pytest.mark.parametrize(
    ("name", "measure", "unit"),
    [
        ("Temp (°C)", "temperature_c", "°c"),
        ("temp_f", "temperature_c", "f"),
        ("T2M", "temperature_c", ""),
        ("AirTC_Avg", "temperature_c", ""),
        ("Tmin", "low_c", ""),
        ("High Temp - °F", "high_c", "°f"),
        ("TXK", "high_c", ""),
        ("Hi Temp high", "high_c", ""),
        ("Hi Temp (F)", "high_c", "f"),
        ("tempHi", "high_c", ""),
        ("temp_lo_f", "low_c", "f"),
        ("Température la plus haute", "high_c", ""),
        ("Température basse (°C)", "low_c", "°c"),
        ("Température à hauteur de 2 m", "temperature_c", ""),
        ("Temperatura máxima [°C]", "high_c", "°c"),
        ("Höchsttemperatur", "high_c", ""),
        ("טמפרטורה (°C)", "temperature_c", "°c"),
        ("טמפרטורת מינימום", "low_c", ""),
        ("טמפ מקס", "high_c", ""),
        ("טמפ' מינ'", "low_c", ""),
        ("Day temperature (°C)", "temperature_c", "°c"),
        ("درجة الحرارة العظمى", "high_c", ""),
        ("Wind Speed (km/h)", "wind_speed_m_s", "km/h"),
        ("wind_speed_m_s", "wind_speed_m_s", "m/s"),
        ("windSpeedKmh", "wind_speed_m_s", "kmh"),
        ("velocidad del viento (m/s)", "wind_speed_m_s", "m/s"),
        ("WS10M", "wind_speed_m_s", ""),
        ("מהירות רוח (מ/ש)", "wind_speed_m_s", "מ/ש"),
        ("سرعة الرياح", "wind_speed_m_s", ""),
        ("Windrichtung", "wind_from_deg", ""),
        ("wind_dir_deg", "wind_from_deg", "deg"),
        ("כיוון רוח", "wind_from_deg", ""),
        ("WD10M", "wind_from_deg", ""),
        ("Precipitation (in)", "rain_mm", "in"),
        ("RSK", "rain_mm", ""),
        ("Niederschlag mm", "rain_mm", "mm"),
        ("משקעים (מ״מ)", "rain_mm", "מ״מ"),
        ("هطول الأمطار", "rain_mm", ""),
        ("RH (%)", "humidity_pct", "%"),
        ("Humedad relativa", "humidity_pct", ""),
        ("Luftfeuchte", "humidity_pct", ""),
        ("לחות יחסית", "humidity_pct", ""),
    ],
)
def test_names_of_stations_are_known(name, measure, unit):
    column = weather_column(name)
    assert column is not None
    assert (column.measure, column.unit) == (measure, unit)


@pytest.mark.parametrize(
    "name",
    ["Soil temp 10cm", "Dew Point (C)", "Wind gust", "Rain rate (mm/h)", "Inside temp", "Battery",
     "Heat index", "Station", "Barometer (hPa)", "wind max (m/s)", "RH min", "Event", "Bodentemp"],
)  # fmt: skip
def test_what_looks_like_weather_and_is_none_is_passed_over(name):
    assert weather_column(name) is None


def test_of_two_columns_for_one_measure_the_first_counts_and_a_line_of_units_goes_first():
    found = weather_columns(["Temp", "Temp 2 (C)", "Rain (mm)"], {"Temp": "°F"})
    assert [(one.name, one.unit) for one in found] == [("Temp", "°f"), ("Rain (mm)", "mm")]


@pytest.mark.parametrize(
    ("day", "night"),
    [("Day temperature (°C)", "Night temperature (°C)"), ("day_temp", "night_temp"),
     ("Temperatura día", "Temperatura noche"), ("Tagestemperatur", "Nachttemperatur"),
     ("טמפ יום", "טמפ לילה"), ("dayTemp", "nightTemp")],
)  # fmt: skip
def test_means_of_the_day_and_of_the_night_are_none_of_both(day, night):
    assert half_days([day, night, "Temperatura media", "Night min temp"]) == (day, night)
    assert [one.name for one in weather_columns([day, night, "Temp"], {})] == ["Temp"]
    assert half_days([day, "Daily mean temp"]) == ()
