"""What was forecast is told from what was measured, in the languages of stations."""

import pytest

from tests.io.readers.test_weather import said


@pytest.fixture
def read(read_weather):
    return read_weather


@pytest.mark.parametrize(
    ("column", "measured", "forecast"),
    [("Vorhersage", "nein", "ja"), ("Pronóstico", "no", "sí"), ("Prévision", "non", "oui"),
     ("Tipo pronóstico", "medido", "pronóstico"), ("Forecast", "obs", "F"), ("Previsão", "0", "1"),
     ("Forecast", "F", "T"), ("תחזית", "לא", "כן"), ("توقعات", "لا", "نعم")],
)  # fmt: skip
def test_what_a_column_calls_forecast_is_read_in_its_language(read, column, measured, forecast):
    imported = read(f"date,temp (C),{column}\n2026-11-18,20,{measured}\n2026-11-19,21,{forecast}")
    assert imported.value.forecast.tolist() == [False, True]
    assert "doubtful" not in said(imported)


@pytest.mark.parametrize(
    ("column", "measured", "forecast"),
    [("type", "observed", "forecast"), ("Tipo de dato", "observado", "pronóstico"),
     ("סוג", "נמדד", "תחזית")],
)  # fmt: skip
def test_a_column_of_any_name_whose_each_cell_says_forecast_or_measured_is_read(
    read, column, measured, forecast
):
    table = f"date,temp (C),{column}\n2026-11-18,20,{measured}\n2026-11-19,21,{{}}\n"
    assert read(table.format(forecast)).value.forecast.tolist() == [False, True]
    for other in ("", "rain", measured):
        assert not read(table.format(other)).value.forecast.any()
    # of one time, both
    both = read(f"{table.format(forecast)}2026-11-19,22,{measured}").value
    assert (both.temperature_c.tolist(), both.forecast.tolist()) == ([20, 22], [False, False])


def test_words_that_say_neither_forecast_nor_measured_are_doubted(read):
    imported = read("date,temp (C),forecast\n2026-11-18,20,\n2026-11-19,21,GFS\n2026-11-20,21,yes")
    assert imported.value.forecast.tolist() == [False, False, True]
    assert "forecast says of 1 line neither" in said(imported)
    assert "'GFS'" in said(imported)
