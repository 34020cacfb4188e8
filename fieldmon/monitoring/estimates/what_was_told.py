"""What a season is told: what inspections detect, and what an earlier season knew."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.estimates.told_detection import read_now, told_at_first

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.season.open_season import OpenSeason


def detection_of(season: OpenSeason, on: date, who: str = "") -> float:
    """Return what inspections of `who` on `on` find, where nothing else is said with them.

    That is by the day's last plan, or else by what counts when it is recorded first. Nobody named:
    whoever is in no team.
    """
    with season.store.reading() as db:
        return read_now(db, on, who)


def earlier_season_note(season: OpenSeason) -> Worded | None:
    """Return what of an earlier season counts in this one; None: it began without one."""
    settings = season.settings
    belief = settings.belief
    if belief.earlier is None or not belief.traces:
        return None
    with season.store.reading() as db:
        told = told_at_first(db)
    return belief.earlier.sentence(belief.believed(season.plot.grid, settings.pest, told))
