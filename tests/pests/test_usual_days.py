"""A day without weather is as the days that stand for it, for warmth and for insects alike."""

from datetime import date

import numpy as np
import pytest

from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.pests.degree_days import Thresholds
from fieldmon.pests.development import daily_warmth
from fieldmon.pests.pest import Pest
from fieldmon.pests.usual_days import UsualDays
from fieldmon.pests.weather import DAY_S, weather_of


def stretch(first, last):
    return np.arange(first, last, dtype="datetime64[D]")


def standing_for(known, on):
    """Return which dates stand for a day, and the share of each."""
    which, weight = UsualDays(known).of(np.datetime64(on))
    return {str(known[k]): float(w / weight.sum()) for k, w in zip(which, weight, strict=True)}


def test_a_known_day_stands_for_itself():
    assert standing_for(stretch("2026-03-01", "2026-04-01"), "2026-03-09") == {"2026-03-09": 1.0}


def test_in_a_short_gap_the_nearer_side_counts_more_even_where_other_years_are_known():
    known = np.concatenate(
        [stretch("2025-01-01", "2026-03-01"), stretch("2026-03-05", "2026-03-20")]
    )
    assert standing_for(known, "2026-03-01") == pytest.approx(
        {"2026-02-28": 0.8, "2026-03-05": 0.2}
    )


def test_beyond_the_weather_it_is_the_same_week_of_other_years_over_the_new_year_too():
    known = stretch("2024-06-01", "2026-06-01")
    found = standing_for(known, "2027-01-02")
    assert {day[:4] for day in found} == {"2024", "2025", "2026"}
    assert {"2024-12-27", "2025-01-09", "2025-12-27", "2026-01-09"} <= found.keys()
    assert not {"2024-12-20", "2025-01-12"} & found.keys()


def test_in_a_long_gap_it_is_other_years_and_without_them_both_sides():
    summers = np.concatenate(
        [stretch("2025-05-01", "2025-09-01"), stretch("2026-05-01", "2026-09-01")]
    )
    assert standing_for(summers, "2026-01-01").keys() == {"2025-08-31", "2026-05-01"}
    gap = np.concatenate([stretch("2025-01-01", "2026-03-01"), stretch("2026-08-01", "2026-08-20")])
    assert all(day.startswith("2025-05") for day in standing_for(gap, "2026-05-15"))


@pytest.mark.parametrize(
    ("on", "of"), [("2026-02-20", ("2026-03-01", "2026-03-07")),
                   ("2026-12-01", ("2026-08-25", "2026-08-31"))]
)  # fmt: skip
def test_before_the_first_day_it_is_the_first_week_and_after_the_last_the_last(on, of):
    found = standing_for(stretch("2026-03-01", "2026-09-01"), on)
    assert (min(found), max(found), len(found)) == (*of, 7)


def test_degree_days_and_insects_are_told_the_same_of_days_without_weather():
    days = np.concatenate(
        [stretch("2026-03-01", "2026-05-01"), stretch("2026-05-08", "2026-09-01")]
    )
    mean = np.linspace(8.0, 32.0, len(days))
    weather = weather_of(days.astype("datetime64[s]"), DAY_S, temperature_c=mean)
    for on in (date(2026, 2, 20), date(2026, 5, 3), date(2026, 7, 1), date(2026, 11, 1)):
        warmth = daily_warmth(weather, Thresholds(0.0), on, on).degree_days[0]
        insects = PestInWeather(Pest("mite"), weather, on).day(0).temperature_c.mean()
        assert insects == pytest.approx(warmth)
