"""What is held to what when a season's file is verified, and how much of it at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.monitoring.changes import outside_changes
from fieldmon.monitoring.estimates import derived_layers
from fieldmon.monitoring.estimates.season_contents import newest_day

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.monitoring.season.open_season import OpenSeason

#: plants times days of which all mornings are worked out again within some two seconds
SHORT = 2_000_000


def check_against_log(season: OpenSeason) -> tuple[str, ...]:
    """Return a sentence for each thing that the file says otherwise than its log."""
    with season.store.reading() as db:
        return outside_changes.not_as_logged(db)


def changed_maps(
    season: OpenSeason,
    *,
    whole: bool = True,
    tell: Callable[[int, int], object] | None = None,
) -> tuple[str, ...]:
    """Return a sentence for each day whose chance map is not the one that was used then.

    `whole` as in `Season.verify`; `tell` hears how many days are done, and of how many.
    """
    with season.reading() as now:  # both at one moment: others may write between
        contents = now.contents
        kept = now.db.execute("SELECT day, date, digest FROM days ORDER BY day").fetchall()
    since = 0 if whole else contents.mornings.last_until(kept[-1][0])
    days = [row for row in kept if row[0] >= since]
    said = []
    for done, (day, on, then) in enumerate(days, 1):
        if derived_layers.map_digest(contents.morning(day).chance) != then:
            said.append(_otherwise(on))
        if tell is not None:
            tell(done, len(days))
    return tuple(said)


def is_short(season: OpenSeason) -> bool:
    """Return whether all mornings can be worked out again whenever its state is asked for."""
    with season.store.reading() as db:
        days = newest_day(db) + 1
    return len(season.plot.grid) * days <= SHORT


def _otherwise(on: str) -> str:
    return worded(
        "The chance map of {on} comes out differently from the one used then: it was "
        "made by another version of fieldmon, or the file was changed by other hands.",
        on=on,
    )
