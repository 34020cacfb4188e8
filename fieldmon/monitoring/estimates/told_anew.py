"""What a change of a season's settings makes of days past, told beside the change."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from fieldmon.compute.wording import estimate, worded
from fieldmon.monitoring.estimates.figures_of_day import still_infested
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.settings.settings import as_json

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from datetime import date

    from fieldmon.monitoring.season.open_season import OpenSeason
    from fieldmon.monitoring.settings.settings import MonitoringSettings

# from which all mornings follow, those of days past, too
_OF_ALL_DAYS = ("prior", "beliefs", "pest", "weather")


@contextmanager
def telling_anew(
    season: OpenSeason, before: MonitoringSettings, after: MonitoringSettings,
    tell: Callable[[str], object],
) -> Iterator[None]:  # fmt: skip
    """Tell what a change makes of the last day, where it makes of days past something else."""
    was, now = as_json(before), as_json(after)
    if all(was.get(name) == now.get(name) for name in _OF_ALL_DAYS):
        yield
        return
    on = default_date(season)
    told = _still_there(season, on)
    yield
    if (still := _still_there(season, on)) != told:
        said = worded(
            "Days past are worked out anew, too: after {on} {still} plants are expected to be "
            "still infested; before this change it was {told}.",
            on=on,
            still=still,
            told=told,
        )
        tell(said)


def _still_there(season: OpenSeason, on: date) -> str:
    # with those found and only flagged: else a change of them would seem to find or lose plants
    left = still_infested(season, on)
    return worded(
        "{expected} ({low:,} to {high:,})",
        expected=estimate(left.expected), low=left.low, high=left.high,
    )  # fmt: skip
