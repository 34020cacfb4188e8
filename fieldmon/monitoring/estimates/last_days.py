"""The last days of a season, and which day is meant where none is named."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.estimates.season_contents import newest_day
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.monitoring.season.open_season import OpenSeason


def last_date(season: OpenSeason) -> date:
    """Return the last day on which anything was planned or recorded; at first the first."""
    with season.store.reading() as db:
        return settings_of(db).date(newest_day(db))


def last_recorded(season: OpenSeason) -> date:
    """Return the last day of which an inspection or a treatment counts; at first the first."""
    history = season.history
    days = [*history.days[-1:].tolist(), *(one.day for one in history.treatments)]
    return season.settings.date(max(days, default=0))


def recorded_ahead(season: OpenSeason) -> date | None:
    """Return the last day of which something counts, if it has not come; None: it has.

    A slip in a date hides what was seen from every day before.
    """
    history, today = season.history, local_clock(season.plot.field).today()
    is_anything = len(history.inspections) or len(history.treatments)
    return last if is_anything and (last := last_recorded(season)) > today else None


def default_date(season: OpenSeason) -> date:
    """Return the day that is meant where none is named: the last date, but today at most.

    Where today is before the season it is the last date.
    """
    last, today = last_date(season), local_clock(season.plot.field).today()
    return last if today < season.settings.begins else min(last, today)
