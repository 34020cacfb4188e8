"""What was chosen for a season earlier: by what its days were worked, what counted before."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import from_json
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence
    from datetime import date

    from fieldmon.monitoring.season.open_season import OpenSeason
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.local_clock import LocalClock


def settings_on(season: OpenSeason, on: date) -> MonitoringSettings:
    """Return what counts, with who worked on a day, from when, and who chose, as it was then.

    As when the day was planned before its work or, if it never was, first recorded: whatever is
    planned of it later changes nothing, see `logged_days.worked_by`. What is believed is of
    now, for all days (but see `fieldmon.monitoring.estimates.told_detection`).
    """
    with season.store.reading() as db:
        return counted_on(db, [on], local_clock(season.plot.field))


def counted_on(
    db: sqlite3.Connection, days: Sequence[date], clock: LocalClock
) -> MonitoringSettings:
    """Return what counted on the first of some days that was planned or recorded; else now."""
    now, parts = settings_of(db), settings_log.of(db, chosen_on(db, days, clock))
    then = from_json(parts) if parts else now
    return replace(
        now, robot=then.robot, starts=then.starts, sampler=then.sampler,
        sampler_settings=then.sampler_settings, team=then.team, teamwork=then.teamwork,
    )  # fmt: skip


def chosen_on(
    db: sqlite3.Connection, days: Sequence[date], clock: LocalClock
) -> settings_log.Marks:
    """Return by which settings the first of some days was worked; else those of now."""
    worked = (logged_days.worked_by(db, day, clock) for day in days)
    return next((one for one in worked if one is not None), None) or settings_log.marks(db)


def before_change(season: OpenSeason) -> MonitoringSettings | None:
    """Return what counted before the last change of settings; None: nothing was changed."""
    with season.store.reading() as db:
        parts = settings_log.before_now(db)
    return None if parts is None else from_json(parts)


def was_changed(season: OpenSeason) -> bool:
    """Return whether anything else was ever chosen than what the season began with."""
    with season.store.reading() as db:
        return len(settings_log.all_moments(db)) > 1
