"""Rain that is counted up is told from rain that was measured hour by hour."""

import numpy as np
import pytest

from fieldmon.io.readers.running_rain import EACH, RUNNING, what_fell
from fieldmon.io.readers.weather_options import WeatherOptions

MIDNIGHT = np.datetime64("2026-01-04T22:00:00")
#: two wet days and a dry one, by hours: 6 mm in the morning, 3 mm after noon
FELL = np.zeros(72)
FELL[[6, 7, 8, 37, 38]] = [1, 3, 2, 2, 1]
BY_DAY = np.concatenate([np.cumsum(day) for day in np.split(FELL, 3)])


def read(values, name="Rain (mm)", step_s=3600, told=None):
    at = MIDNIGHT + np.arange(len(values)) * np.timedelta64(step_s, "s")
    rain, said = what_fell(name, np.array(values, float), at, told)
    return rain, " ".join(map(str, said))


@pytest.mark.parametrize("name", ["Rain (mm)", "Daily Rain (mm)", "Precip. Accum. (mm)"])
@pytest.mark.parametrize("counted", [BY_DAY, np.cumsum(FELL)])
def test_what_is_counted_up_is_read_as_the_difference_and_said(name, counted):
    rain, said = read(counted, name)
    assert rain.tolist() == FELL.tolist()
    assert f"{name} counts up" in said
    assert "rain_is=each" in said


def test_a_counter_that_never_began_anew_does_not_say_what_fell_before_its_first_value():
    rain, _ = read(512.0 + np.cumsum(FELL))
    assert np.isnan(rain[0])
    assert rain[1:].tolist() == FELL[1:].tolist()


def test_a_counter_in_four_dry_days_is_no_rain_of_half_a_metre_each_hour():
    assert np.nansum(read([512.3] * 96)[0]) == 0.0


def test_a_logger_that_starts_anew_within_a_day_is_one_that_counts_up():
    counted = BY_DAY.copy()
    counted[12:24] = [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1]
    assert np.nansum(read(counted)[0]) == FELL.sum() + 1


def test_gaps_and_rows_out_of_order_do_not_change_what_fell():
    counted = BY_DAY.copy()
    counted[7] = np.nan
    at = MIDNIGHT + np.arange(72) * np.timedelta64(3600, "s")
    rain, _ = what_fell("Rain", counted[::-1], at[::-1], None)
    assert np.isnan(rain[::-1][7])
    assert rain[::-1][8] == 5.0
    assert np.nansum(rain) == FELL.sum()


def test_a_line_that_stands_twice_loses_no_rain(read_weather):
    rows = [f"2026-01-{5 + h // 24:02d} {h % 24:02d}:00,20,{BY_DAY[h]}" for h in range(72)]
    table = "\n".join(["time,temp (C),Daily Rain (mm)", *rows[:8], rows[7], *rows[8:]])
    assert read_weather(table).value.rain_mm.sum() == FELL.sum()


def drawn(rng, step_s):
    """Return a few days of rain that comes and goes, in a gauge that tips."""
    # by the day, over months that begin
    n = int(rng.choice([1, 2, 5, 14])) * max(86_400 // step_s, 10 * (step_s == 86_400))
    ends = 1.0 - np.exp(-step_s / (3600 * rng.choice([0.5, 2.0, 6.0])))
    begins = 1.0 - np.exp(-step_s / 3600 * rng.choice([0.01, 0.03, 0.1]))
    wet, is_wet = np.zeros(n, bool), False
    for i, chance in enumerate(rng.random(n)):
        is_wet = chance > ends if is_wet else chance < begins
        wet[i] = is_wet
    mm = wet * rng.gamma(0.7, rng.choice([0.3, 1.0, 4.0]), n) * step_s / 3600
    return 0.2 * np.rint(mm / 0.2)


@pytest.mark.parametrize("step_s", [300, 900, 3600, 10_800, 21_600, 86_400])
def test_rain_measured_each_time_is_read_as_it_stands(step_s):
    """Also that of a few dry days, and of hardly a shower."""
    rng = np.random.default_rng(step_s)
    for _ in range(200):
        values = drawn(rng, step_s)
        rain, said = read(values, step_s=step_s)
        assert (rain.tolist(), said) == (values.tolist(), "")


@pytest.mark.parametrize("hours", [3, 6, 12, 24])
def test_amounts_that_were_shared_out_to_hours_are_read_as_they_stand(hours):
    rng = np.random.default_rng(hours)
    for days in (1, 2, 3, 10) * 25:
        n = days * 24 // hours
        values = np.repeat(np.where(rng.random(n) < 0.3, rng.gamma(0.7, 3.0, n), 0.0), hours)
        assert read(values)[0].tolist() == values.tolist()


@pytest.mark.parametrize("name", ["Rain (mm)", "Daily Rain (mm)", "Precip. Accum. (mm)"])
def test_rain_by_the_day_is_what_fell_on_each_whatever_its_name(name):
    days = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 5.0, 12.0, 3.0]
    assert read(days, name, 86_400) == (pytest.approx(days), "")
    season = np.cumsum([0.0, 5, 0, 0, 0, 2, 1, 0, 0, 0])
    assert read(season, name, 86_400)[0].tolist() == [0, 5, 0, 0, 0, 2, 1, 0, 0, 0]


def test_rain_of_the_month_by_the_day_is_counted_up_where_it_falls_on_the_first_only(read_weather):
    fell = np.where(np.arange(61) % 4 == 1, 5.0, 0.0)
    counted = np.concatenate([np.cumsum(fell[:31]), np.cumsum(fell[31:])])
    days = np.datetime64("2026-03-01") + np.arange(61)

    def read_days(values):
        rows = "\n".join(f"{day},20,{mm}" for day, mm in zip(days, values, strict=True))
        return read_weather(f"date,temp (C),Rain MTD (mm)\n{rows}")

    assert read_days(counted).value.rain_mm.tolist() == fell.tolist()
    assert "Rain MTD (mm) counts up" in " ".join(map(str, read_days(counted).messages))
    # a fall on another day, or a month's mean on each of its days
    for each in (np.roll(counted, 1), np.where(days < np.datetime64("2026-04-01"), 3.2, 1.1)):
        assert read_days(each).value.rain_mm.tolist() == each.tolist()


def test_a_name_that_says_counted_up_of_what_falls_all_day_is_said():
    values = np.zeros(48)
    values[[3, 4, 5, 20, 21, 30, 31]] = [0.2, 1.4, 0.6, 2.0, 0.4, 1.0, 0.2]
    rain, said = read(values, "Precipitación acumulada (mm)")
    assert rain.tolist() == values.tolist()
    assert "falls during the day; each value was read as what fell" in said
    assert "rain_is=running" in said
    assert read(np.zeros(48), "Daily Rain")[1] == ""


def test_what_rises_each_hour_and_falls_at_midnight_only_is_doubted():
    values = np.tile(np.arange(24) / 2, 3)
    rain, said = read(values)
    assert rain.tolist() == values.tolist()
    assert "Rain (mm) rises all day and falls at one time of day only" in said
    assert "rain_is=running" in said
    assert read(values, told=RUNNING)[0].sum() == 3 * 11.5
    assert read(values[:24])[1] == "", "one day tells nothing"
    assert read(np.tile([0, 1, 0, 2, 3, 0, 0, 0], 9))[1] == "", "it falls within days"


def test_whoever_says_what_it_is_is_believed():
    assert read(BY_DAY, told=EACH) == (pytest.approx(BY_DAY), "")
    rain, said = read([0, 2, 1, 3], told=RUNNING)
    assert (rain.tolist(), said) == ([0, 2, 1, 2], "")


def test_a_table_s_counted_rain_comes_by_the_hour_and_a_service_s_never_counts_up(read_weather):
    rows = "\n".join(f"2026-01-05 {h:02d}:{m:02d},20,{min(h + m / 60, 12):.2f}"
                     for h in range(24) for m in (0, 30))  # fmt: skip
    table = f"time,temp (C),Precip. Accum. (mm)\n{rows}"
    assert read_weather(table).value.rain_mm.sum() == pytest.approx(12)
    each = WeatherOptions(zone="Asia/Jerusalem", rain_is="each")
    assert read_weather(table, each).value.rain_mm.sum() > 400
    rate = read_weather(table.replace("(mm)", "(mm/h)")).value
    assert rate.rain_mm.sum() == pytest.approx(213)
    power = "YEAR,MO,DY,HR,T2M,PRECTOTCORR\n" + "\n".join(
        f"2026,1,{5 + h // 24},{h % 24},20,{BY_DAY[h]}" for h in range(72)
    )
    assert read_weather(power).value.rain_mm.sum() == pytest.approx(BY_DAY.sum())
