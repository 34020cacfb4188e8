"""Single figures of a day of a season, each without the others of its status."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.monitoring.estimates import day_figures as kept_figures
from fieldmon.monitoring.estimates.day_figures import DayFigures, Progress
from fieldmon.monitoring.estimates.found_again import found_again as found_again_by
from fieldmon.monitoring.estimates.mornings import rules
from fieldmon.monitoring.estimates.season_contents import MorningAsked

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.monitoring.estimates.found_again import FoundAgain
    from fieldmon.monitoring.estimates.season_contents import SeasonContents
    from fieldmon.monitoring.season.open_season import OpenSeason


def believed(season: OpenSeason, on: date) -> MorningAsked:
    """Return from what the figures of a day are worked out."""
    return MorningAsked.of(_contents(season), on)


def _contents(season: OpenSeason) -> SeasonContents:
    with season.reading() as now:
        return now.contents


def progress(season: OpenSeason, on: date) -> Progress:
    """Return how far the inspections are after the work of `on`; nothing is estimated."""
    contents = _contents(season)
    return Progress.of(contents.history, contents.settings.day(on))


def day_figures(season: OpenSeason, on: date) -> DayFigures:
    """Return the day `on` in figures: those kept with it, or worked out in seconds.

    What another version of fieldmon kept is worked out anew.
    """
    day = season.settings.day(on)
    with season.store.reading() as db:
        days = kept_figures.kept(db) if kept_figures.holds(db, rules(), day) else ()
    for kept in days:
        if kept.on == on:
            return kept
    contents, morning, day = believed(season, on)
    estimate = contents.history.estimate(morning, day)
    return DayFigures.of(on, Progress.of(contents.history, day), estimate)


def still_infested(season: OpenSeason, on: date) -> PlotEstimate:
    """Return how many plants are still infested after a day: not found yet, and flagged."""
    if season.settings.belief.treated:
        return day_figures(season, on).estimate  # it stands in the file
    contents, morning, day = believed(season, on)
    return contents.history.infested(morning, day)


def flagged(season: OpenSeason, on: date) -> float:
    """Return how many of the plants found up to `on` are only flagged and still infested."""
    if season.settings.belief.treated:
        return 0.0  # no morning is needed for it
    contents, morning, day = believed(season, on)
    return contents.history.flagged(morning, day)


def found_again(season: OpenSeason, on: date) -> FoundAgain | None:
    """Return how many plants that are taken as treated were found again up to `on`.

    None: none, or no more than may be chance.
    """
    contents = _contents(season)
    return found_again_by(contents.history, contents.settings.day(on))
