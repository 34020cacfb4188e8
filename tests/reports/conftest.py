"""A season that was worked on, made once."""

from datetime import timedelta

import pytest

from fieldmon.compute.units import Units
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.reports.day import DayFacts, day_report
from fieldmon.reports.season import season_report
from tests.monitoring.seasons import BEGINS, Insects, a_season


@pytest.fixture(scope="session")
def worked(tmp_path_factory):
    """Return a season of six days, one of them idle and one ended by a treatment."""
    season = a_season(tmp_path_factory.mktemp("reports") / "season.gpkg")
    insects = Insects(season)
    for day in (0, 1, 2, 4, 5):
        on = BEGINS + timedelta(days=day)
        plants = season.plan(on).route.plant
        season.record(insects.look(day, plants), f"day_{day}.csv", "נועה")
        if day == 2:
            season.treat(on, 0.7, product="Oil")
    return Season(season.path)


@pytest.fixture(scope="session")
def last(worked):
    return last_date(worked)


@pytest.fixture(scope="session")
def of_season(worked, last):
    return season_report(worked, last, Units())


@pytest.fixture(scope="session")
def of_day(worked, last):
    """Return the report of a day that lies ahead."""
    return day_report(DayFacts.of_season(worked, last + timedelta(days=1)), Units())


@pytest.fixture(scope="session")
def of_worked_day(worked, last):
    return day_report(DayFacts.of_season(worked, last), Units())
