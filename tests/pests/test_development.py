"""A pest comes as far as its weather lets it, and what is filled in is marked."""

from datetime import date

import numpy as np
import pytest

from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.pests.degree_days import Thresholds
from fieldmon.pests.development import daily_warmth, development, whole_generation
from fieldmon.pests.pest import Pest, Stage
from fieldmon.pests.weather import DAY_S, HOUR_S, weather_of

MITE = shipped_pest("spider-mite")


def days(first, lows, highs):
    at = np.arange(np.datetime64(first, "D"), np.datetime64(first, "D") + len(lows))
    return weather_of(
        at.astype("datetime64[s]"), DAY_S,
        low_c=np.asarray(lows, float), high_c=np.asarray(highs, float),
    )  # fmt: skip


def test_a_generation_is_complete_when_its_degree_days_are():
    """22.5 °C all day is 10 degree-days above 12.5 °C: 146.48 take 15 days."""
    warm = days("2026-11-01", [22.5] * 30, [22.5] * 30)
    there = development(MITE, warm, date(2026, 11, 1), date(2026, 11, 10))
    assert there.so_far == pytest.approx(100)
    assert there.next_generation == date(2026, 11, 15)
    assert there.generations == pytest.approx(100 / 146.48)
    assert str(there.sentence()) == (
        "100 degree-days above 12.5 °C since 2026-11-01 of 146.48 a generation: the next around "
        "2026-11-15."
    )
    later = development(MITE, warm, date(2026, 11, 1), date(2026, 11, 20))
    assert later.next_generation == date(2026, 11, 30)


def test_stages_pass_each_above_its_own_threshold():
    """Egg 63.35 above 12.87 °C, larva 26.81 above 12.92: at 22.5 °C 6.6 and 2.8 days."""
    warm = days("2026-11-01", [22.5] * 30, [22.5] * 30)
    seen = [
        development(MITE, warm, date(2026, 11, 1), date(2026, 11, day)).stage
        for day in (6, 7, 9, 10, 12, 13, 15, 16)
    ]
    assert seen == ["egg", "larva", "larva", "protonymph", "deutonymph", "deutonymph", "egg",
                    "egg"]  # fmt: skip


def test_where_it_stays_cold_no_generation_is_promised():
    cold = days("2026-11-01", [1] * 10, [9] * 10)
    there = development(MITE, cold, date(2026, 11, 1), date(2026, 11, 5))
    assert there.next_generation is None
    assert "more than a year away" in there.sentence()


def test_weather_goes_on_as_in_its_last_week_and_gaps_as_about_them():
    gap = days("2026-11-01", [20, np.nan, 20], [20, np.nan, 26])
    made = daily_warmth(gap, Thresholds(10), date(2026, 11, 1), date(2026, 11, 5))
    assert made.degree_days.tolist() == pytest.approx([10, 11.5, 13, 11.5, 11.5])
    assert made.guessed.tolist() == [False, True, False, True, True]


def test_hours_count_as_they_are_and_a_day_of_few_is_not_known():
    at = np.datetime64("2026-11-01", "s") + 3600 * np.arange(30)
    hours = weather_of(at, HOUR_S, temperature_c=np.full(30, 22.0))
    made = daily_warmth(hours, Thresholds(10), date(2026, 11, 1), date(2026, 11, 2))
    assert made.degree_days[0] == pytest.approx(12)
    assert made.guessed.tolist() == [False, True]


def test_without_any_weather_nothing_is_gathered():
    nothing = days("2026-11-01", [np.nan], [np.nan])
    there = development(MITE, nothing, date(2026, 11, 1), date(2026, 11, 5))
    assert (there.so_far, there.next_generation) == (0, None)


def test_a_disease_without_stages_has_no_development():
    weather = days("2026-11-01", [20], [20])
    disease = shipped_pest("plum-pox-virus")
    assert development(disease, weather, date(2026, 11, 1), date(2026, 11, 2)) is None


def test_a_generation_is_the_published_one_or_the_sum_of_its_stages():
    assert whole_generation(MITE).degree_days == 146.48
    aphid = whole_generation(shipped_pest("green-peach-aphid"))
    # Whalon & Smilowitz publish 135.7 themselves
    assert (aphid.threshold_c, aphid.degree_days) == (4, pytest.approx(134.3))
    mixed = Pest("a", stages=(Stage("egg", 10, 30), Stage("adult", 14, 10)))
    assert whole_generation(mixed).threshold_c == 11
    # (11.5 * 90 + 9 * 150 + 10 * 40) / 280 is 9.946...
    egg, larva, adult = Stage("egg", 11.5, 90), Stage("larva", 9, 150), Stage("adult", 10, 40)
    assert whole_generation(Pest("a", stages=(egg, larva, adult))).threshold_c == 9.9


@pytest.mark.parametrize(("uppers", "of_all"), [((30, 38), 32), ((30, None), None), ((30, 30), 30)])
def test_a_generation_stops_where_its_stages_do_and_not_where_the_first_does(uppers, of_all):
    egg, adult = Stage("egg", 10, 30, upper_c=uppers[0]), Stage("adult", 14, 10, upper_c=uppers[1])
    assert whole_generation(Pest("a", stages=(egg, adult))).upper_c == of_all
