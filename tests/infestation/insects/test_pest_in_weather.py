"""Weather becomes warmth, movement and wind along the rows, hour by hour and night by night."""

from dataclasses import replace
from datetime import date, timedelta

import numpy as np
import pytest

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import (
    PestInWeather,
    along_rows,
    hours_of_movement,
    kernel_of,
)
from fieldmon.pests.pest import Entry, Increase, Movement, Pest, Stage
from fieldmon.pests.weather import weather_of
from fieldmon.plot.projection import Frame

FRAME = Frame(35.0, 31.0, 90.0)
MITE = Pest(
    "mite",
    stages=(Stage("egg", 12.5, 50.0, visible=False, mobile=False),),
    increase=Increase((12.5, 15.0, 30.0), (0.0, 0.08, 0.321)),
    movement=Movement("exponential", 0.5, reach_m=6.0, at_c=30.0, wind="with", hours=(8, 18)),
    entry=Entry(anywhere_per_day=1e-4),
)
BEGINS = date(2026, 6, 1)


def hourly(days=2, zone="", **measured):
    at = np.arange(days * 24) * 3600 + np.datetime64("2026-06-01T00:00:00")
    return weather_of(at, 3600, zone, **{k: np.resize(v, len(at)) for k, v in measured.items()})


def daily(first="2026-06-01", days=3, **measured):
    at = np.datetime64(first, "D") + np.arange(days)
    values = {k: np.resize(np.asarray(v, float), days) for k, v in measured.items()}
    return weather_of(at.astype("datetime64[s]"), 86_400, **values)


def test_weather_without_a_day_on_which_it_begins_is_refused():
    weather = hourly(temperature_c=np.linspace(10.0, 30.0, 24))
    with pytest.raises(SettingError, match="must begin on a day, but none is given"):
        PestInWeather(MITE, weather)
    with pytest.raises(SettingError, match="A pest's weather must be a Weather, but it is 'hot'"):
        PestInWeather(MITE, "hot")
    assert PestInWeather(MITE, weather, date(2026, 1, 1)).begins == PestInWeather(MITE).begins


def test_an_hour_s_degree_days_add_up_to_the_day_s():
    pest_in_weather = PestInWeather(MITE, hourly(temperature_c=np.linspace(10.0, 30.0, 24)), BEGINS)
    day = pest_in_weather.night(0, FRAME)
    hours = pest_in_weather.hours(0, FRAME, starts=0)
    assert sum(hour.warmth[0] for hour in hours) == pytest.approx(day.warmth[0])
    by_hand = np.maximum(np.linspace(10.0, 30.0, 24) - 12.5, 0.0).sum() / 24
    assert day.warmth[0] == pytest.approx(by_hand)
    assert sum(hour.sends for hour in hours) == pytest.approx(day.sends)


def test_a_warm_night_sends_more_than_a_cold_one():
    warm, cold = (
        PestInWeather(MITE, daily(low_c=[t], high_c=[t]), BEGINS).night(0, FRAME).sends
        for t in (30.0, 15.0)
    )
    assert warm == pytest.approx(0.5)
    assert cold == pytest.approx(0.5 * 0.08 / 0.321)


def test_insects_move_in_their_hours_only():
    pest_in_weather = PestInWeather(MITE, None, BEGINS)
    moving = [hour.sends > 0 for hour in pest_in_weather.hours(0, FRAME, starts=6)]
    assert moving == [False] * 2 + [True] * 10 + [False] * 12
    night = hours_of_movement(Movement(hours=(22.5, 2.0)))
    assert night[[22, 23, 0, 1]] == pytest.approx(np.array([0.5, 1.0, 1.0, 1.0]) / 3.5)
    assert hours_of_movement(Movement()) == pytest.approx(np.full(24, 1 / 24))


def test_the_hours_that_follow_are_of_today_until_midnight_then_of_tomorrow():
    """It is as many degrees warm as hours have passed since the first midnight."""
    pest_in_weather = PestInWeather(MITE, hourly(temperature_c=np.arange(48.0)), BEGINS)
    for starts in (0, 6, 23):
        hours = pest_in_weather.hours(0, FRAME, starts=starts)
        by_hand = np.maximum(np.arange(starts, starts + 24.0) - 12.5, 0.0) / 24
        assert [hour.warmth[0] for hour in hours] == pytest.approx(by_hand)


def test_a_wind_from_the_west_goes_along_rows_that_run_east():
    west = daily(temperature_c=[25.0], wind_speed_m_s=[4.0], wind_from_deg=[270.0])
    assert PestInWeather(MITE, west, BEGINS).night(0, FRAME).wind_m_s == (4.0, 0.0)
    assert along_rows(4.0, 0.0, FRAME.turned(0.0)) == (0.0, -4.0)
    assert along_rows(0.0, 3.0, FRAME) == (0.0, 3.0)


def test_rows_of_weather_are_of_local_hours():
    """Ten in the morning in Israel's summer is seven by UTC."""
    wind = np.where(np.arange(24) == 7, 6.0, 0.0)
    weather = hourly(zone="Asia/Jerusalem", temperature_c=[25.0], wind_speed_m_s=wind,
                     wind_from_deg=[270.0])  # fmt: skip
    hours = PestInWeather(MITE, weather, BEGINS).hours(0, FRAME, starts=0)
    assert [k for k, hour in enumerate(hours) if hour.wind_m_s != (0.0, 0.0)] == [10]


def test_without_weather_a_pest_does_what_its_figures_say():
    spell = PestInWeather(MITE).night(3, FRAME)
    assert spell.sends == pytest.approx(0.5)
    assert spell.warmth == pytest.approx((17.5,))
    assert spell.wind_m_s == (0.0, 0.0)


def test_days_beyond_the_file_are_the_usual_of_their_date():
    lastly = PestInWeather(MITE, daily(days=3, temperature_c=[20.0, 22.0, 24.0]), BEGINS)
    assert lastly.day(9).temperature_c == pytest.approx(np.full(24, 22.0))
    assert lastly.known(2)
    assert lastly.measured(2)
    assert not lastly.known(3)
    assert not lastly.measured(3)
    years = daily("2025-06-01", 400, temperature_c=np.arange(400.0) / 20)
    usual = PestInWeather(MITE, years, date(2026, 8, 1)).day(0).temperature_c
    # the first of August of the year before is day 61, and those about it even out
    assert usual == pytest.approx(np.full(24, 61 / 20))


def test_a_disease_of_splashes_moves_in_rain_only_and_unmeasured_rain_holds_nothing_back():
    splash = Pest("splash", movement=Movement("adjacent", 0.3, least_rain_mm=2.0))
    wet = daily(days=2, temperature_c=[20.0], rain_mm=[5.0, 0.0])
    pest_in_weather = PestInWeather(splash, wet, BEGINS)
    assert pest_in_weather.night(0, FRAME).sends == pytest.approx(-np.log(0.7))
    assert pest_in_weather.night(1, FRAME).sends == 0.0
    dry = PestInWeather(splash, daily(temperature_c=[20.0]), BEGINS)
    assert dry.night(0, FRAME).sends > 0.0


@pytest.mark.parametrize(("first", "n"), [("2026-03-26T22:00", 23), ("2026-10-24T21:00", 25)])
def test_no_rain_is_missing_from_a_day_on_which_clocks_change(first, n):
    """Israel's clocks skip the hour from two in March, and repeat the one from one in October."""
    splash = Pest("splash", movement=Movement("adjacent", 0.3, least_rain_mm=2.0))
    at = np.datetime64(first, "s") + 3600 * np.arange(n)
    on = date.fromisoformat(first[:10]) + timedelta(days=1)

    def day_of(**rain):
        warm = np.full(n, 20.0)
        return PestInWeather(
            splash, weather_of(at, 3600, "Asia/Jerusalem", temperature_c=warm, **rain), on
        )

    for rain, moves in ((np.zeros(n), False), (np.where(np.arange(n) == 1, 2.5, 0.0), True),
                        (np.full(n, 2.001 / n), True)):  # fmt: skip
        there = day_of(rain_mm=rain)
        assert there.day(0).rain_mm.sum() == pytest.approx(rain.sum())
        assert (there.night(0, FRAME).sends > 0.0) == moves
    assert day_of().night(0, FRAME).sends > 0.0


def test_hours_of_a_day_that_is_hardly_known_are_those_of_the_days_that_stand_for_it():
    """On the last day the thermometer was read until three at night; on the second it was not."""
    warm = np.tile(np.where(np.arange(24) < 6, 10.0, 25.0), 4)
    warm[24:48] = warm[75:] = np.nan
    in_weather = PestInWeather(MITE, hourly(4, temperature_c=warm), BEGINS)
    for day in range(4):
        assert in_weather.day(day).temperature_c == pytest.approx(warm[:24])
    # where no day is known well, each is as its own hours
    seldom = np.tile(np.where(np.arange(24) < 8, 12.0, np.nan), 4)
    assert (
        PestInWeather(MITE, hourly(4, temperature_c=seldom), BEGINS).day(1).temperature_c[20]
        == 12.0
    )


def test_the_chance_map_is_told_the_same_rate_wind_and_warmth():
    windy = daily(temperature_c=[25.0], wind_speed_m_s=[4.0], wind_from_deg=[270.0])
    pest_in_weather = PestInWeather(MITE, windy, BEGINS)
    spread, spell = pest_in_weather.spread(0, FRAME), pest_in_weather.night(0, FRAME)
    assert (spread.warmth, spread.sends, spread.wind_m_s) == spell[1:]
    assert spread.arrivals_per_day == 1e-4
    beside = Pest("beside", movement=Movement("adjacent", 0.3))
    assert PestInWeather(beside).spread(0, FRAME).rate_per_day == pytest.approx(0.3)


def test_a_movement_s_reach_is_its_mean_or_its_median_jump():
    assert kernel_of(Movement("exponential", 0.1, reach_m=6.0, along_over_across=2.0)).across == 0.5
    assert kernel_of(Movement("cauchy", 0.1, reach_m=np.sqrt(3.0))).scale_m == pytest.approx(1.0)


def test_a_night_is_a_day_long_and_an_hour_a_twenty_fourth_of_it():
    pest_in_weather = PestInWeather(MITE, None, BEGINS)
    assert pest_in_weather.night(0, FRAME).days == 1.0
    assert [hour.days for hour in pest_in_weather.hours(0, FRAME)] == pytest.approx([1 / 24] * 24)


def a_station(seed, days=3):
    """Return hours of a station, some of them not measured, and the columns as they are."""
    rng, n = np.random.default_rng(seed), 24 * days
    columns = {
        "temperature_c": rng.uniform(8.0, 38.0, n), "rain_mm": rng.uniform(0.0, 2.0, n),
        "wind_speed_m_s": rng.uniform(0.0, 6.0, n), "wind_from_deg": rng.uniform(0.0, 360.0, n),
    }  # fmt: skip
    for column in columns.values():
        column[rng.random(n) < 0.15] = np.nan
    return hourly(days, **columns), columns


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("by_hour", [True, False])
@pytest.mark.parametrize("wind", ["with", "none"])
def test_a_night_is_what_its_hours_bring_one_by_one(seed, by_hour, wind):
    """Of a pest that moves in some hours, and in rain: hours that nobody measured hold nothing."""
    weather, columns = a_station(seed)
    moves = replace(MITE.movement, hours=(7.5, 18.25), wind=wind, least_rain_mm=1.0,
                    by_hour=by_hour)  # fmt: skip
    in_weather = PestInWeather(replace(MITE, movement=moves), weather, BEGINS)
    warm = columns["temperature_c"][24:48].copy()
    known = np.flatnonzero(~np.isnan(warm))
    warm = np.interp(np.arange(24), known, warm[known])
    rain = columns["rain_mm"][24:48]
    to = np.deg2rad(columns["wind_from_deg"][24:48] + 180.0)
    east, north = (columns["wind_speed_m_s"][24:48] * turn(to) for turn in (np.sin, np.cos))
    overlap = [max(0.0, min(h + 1.0, 18.25) - max(h, 7.5)) / 10.75 for h in range(24)]
    sends, degree_days, weights = [], [], []
    for h in range(24):
        enough = rain[h] if by_hour else rain.sum()
        share = overlap[h] * (np.isnan(enough) or enough >= 1.0)
        rate = 0.5 * np.interp(warm[h], (12.5, 15.0, 30.0), (0.0, 0.08, 0.321)) / 0.321
        sends.append(share * rate)
        weights.append(share)
        degree_days.append(max(warm[h] - 12.5, 0.0) / 24)
    night = in_weather.night(1, FRAME)
    assert night.sends == pytest.approx(sum(sends))
    assert night.warmth == pytest.approx((sum(degree_days),))
    weights = np.array(weights) / max(sum(weights), 1e-12)
    blows = [float(np.nan_to_num(one) @ weights) for one in (east, north)]
    assert night.wind_m_s == (along_rows(*blows, FRAME) if wind == "with" else (0.0, 0.0))
    spread = in_weather.spread(1, FRAME)
    told = spread.sends, spread.wind_m_s, spread.warmth, spread.days, spread.arrivals_per_day
    assert told == (night.sends, night.wind_m_s, night.warmth, 1.0, 1e-4)


def test_a_day_of_which_some_hours_were_forecast_was_not_measured():
    weather = hourly(days=2, temperature_c=[20.0], forecast=np.arange(48) > 40)
    in_weather = PestInWeather(MITE, weather, BEGINS)
    assert [in_weather.known(k) for k in range(3)] == [True, True, False]
    assert [in_weather.measured(k) for k in range(3)] == [True, False, False]


@pytest.mark.parametrize("day", [-3, 5, 30])
def test_a_day_nobody_measured_is_the_mean_of_the_nearest_days_hour_by_hour(day):
    """Of the first seven before the weather, of the last seven after it; of each what is known."""
    weather, columns = a_station(7, days=20)
    in_weather = PestInWeather(MITE, weather, date(2026, 6, 1))
    assert in_weather.known(day) == (0 <= day < 20)
    for k in (0, 13, 19):
        warm = columns["temperature_c"][24 * k : 24 * k + 24]
        measured = ~np.isnan(warm)
        assert in_weather.day(k).temperature_c[measured].tolist() == warm[measured].tolist()
        rain = columns["rain_mm"][24 * k : 24 * k + 24]
        np.testing.assert_array_equal(in_weather.day(k).rain_mm, rain)
    if day == 5:
        return
    usual = in_weather.day(day)
    rain = (
        columns["rain_mm"].reshape(20, 24)[:7]
        if day < 0
        else columns["rain_mm"].reshape(20, 24)[-7:]
    )
    assert usual.rain_mm == pytest.approx(np.nanmean(rain, axis=0), nan_ok=True)


@pytest.mark.parametrize("bearing", [0.0, 37.0, 90.0, 200.0])
def test_a_wind_is_told_along_and_across_rows_by_half_metres_a_second(bearing):
    rng, frame = np.random.default_rng(1), Frame(35.0, 31.0, bearing)
    for east, north in rng.uniform(-8.0, 8.0, (20, 2)):
        along, across = along_rows(east, north, frame)
        blows = complex(east, north)
        # rows head by their bearing from the north, clockwise
        heads = complex(np.sin(np.deg2rad(bearing)), np.cos(np.deg2rad(bearing)))
        turned = blows * heads.conjugate()
        assert along == round(2.0 * turned.real) / 2.0
        assert across == round(2.0 * turned.imag) / 2.0


@pytest.mark.parametrize("hours", [(0, 24), (8, 18), (20, 4), (7.25, 7.75), (23.5, 0.5), (6, 6)])
def test_the_share_of_an_hour_is_what_of_it_lies_in_the_hours_of_movement(hours):
    """By a thousand moments of each."""
    first, end = hours
    length = (end - first) % 24 or 24
    moments = (np.arange(24_000) + 0.5) / 1000
    moving = ((moments - first) % 24 < length).reshape(24, 1000).sum(axis=1)
    share = hours_of_movement(replace(MITE.movement, hours=hours))
    assert share == pytest.approx(moving / moving.sum(), abs=1e-9)


@pytest.mark.parametrize("by_hour", [True, False])
@pytest.mark.parametrize(("least_mm", "moves"), [(0.0, True), (2.4, True), (2.5, False)])
def test_so_much_rain_as_is_needed_is_enough_and_who_needs_none_moves_when_it_is_dry(
    by_hour, least_mm, moves
):
    rain_mm = 0.0 if least_mm == 0.0 else 2.4 if by_hour else 0.1
    movement = replace(MITE.movement, least_rain_mm=least_mm, by_hour=by_hour)
    weather = hourly(1, temperature_c=30.0, rain_mm=rain_mm)
    sends = PestInWeather(replace(MITE, movement=movement), weather, BEGINS).night(0, FRAME).sends
    assert sends == pytest.approx(0.5 * moves)


def test_its_content_is_the_same_before_and_after_somebody_looks():
    weather = hourly(zone="Asia/Jerusalem", temperature_c=[20.0], rain_mm=[1.0])
    pest_in_weather = PestInWeather(MITE, weather, BEGINS)
    before = digest(*pest_in_weather.content)
    pest_in_weather.night(0, FRAME)
    pest_in_weather.measured(0)
    weather.local_days()
    assert digest(*pest_in_weather.content) == before
