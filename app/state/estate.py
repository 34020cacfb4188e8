"""All plots that can be opened, with their state: of the seasons, and of the files at hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.errors import FieldmonError
from fieldmon.io.options import PlotOptions
from fieldmon.monitoring.days.estate_day import days_since, not_begun
from fieldmon.plot.local_clock import local_clock

from ..words.language import of_error
from . import (
    cached,
    cached_files,
    plot_files,
    plot_source,
    sample_estate,
    season_held,
    seasons_folder,
)
from .brought_files import settled

if TYPE_CHECKING:
    from shapely import MultiPolygon

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring import Season

# the other plots do not wait for one that another program holds
_GLANCE_S = 0.5
#: how often is looked whether a season that was held is free
LOOK_AGAIN_S = 2.0


@dataclass(frozen=True, eq=False)
class PlotState:
    """A plot on the map of all plots.

    Parameters
    ----------
    name
        The plot's, or the season's.
    source
        What is opened for it: see `plot_source.chosen`.
    outline
        Its boundary, lon/lat.
    number
        Which plot of its file it is; None: a season has one only.
    days_since
        Days since it was seen, half of its plan at least; None: never.
    expected
        Plants still infested, as expected, with those found and only flagged; None: nobody asked
        yet.
    is_begun
        Whether a plant of it was inspected.
    waits
        Why it has no part in today: its season begins on another day; None: it has.
    """

    name: str
    source: str
    outline: MultiPolygon
    number: int | None = None
    days_since: int | None = None
    expected: float | None = None
    is_begun: bool = False
    waits: Worded | None = None


@dataclass(frozen=True)
class NotAmong:
    """A plot that cannot be shown among the others: why; the season's name if another holds it.

    And its name; empty: that of a file, which the sentence says.
    """

    said: str
    held: str = ""
    name: str = ""


def plots() -> tuple[list[PlotState], list[NotAmong]]:
    """Return the plots, seasons first, and why those that cannot be opened are not among them."""
    found: list[PlotState] = []
    problems: list[NotAmong] = []
    for name in seasons_folder.names():
        try:
            path = seasons_folder.path_of(name)
            season_held.wait(path, patience_s=_GLANCE_S)
            found.append(_of_season(name, cached.season(path)))
        except FieldmonError as error:
            said = of_error(error)
            said = said if name in said else f"{name}: {said}"
            problems.append(
                NotAmong(said, name if isinstance(error, season_held.SeasonHeld) else "", name)
            )
    files = plot_files.of_session()
    if files is not None and files.plot is not None:
        try:
            read = cached_files.plots(
                files.plot.key, settled(files.plot, PlotOptions()), files.plot.source
            )
            found += [
                PlotState(field.name, plot_source.FILES, field.boundary, number)
                for number, field in enumerate(read.value)
            ]
        except FieldmonError as error:
            problems.append(NotAmong(of_error(error)))
    if not found:
        found = [
            PlotState(field.name, plot_source.SAMPLE, field.boundary, number)
            for number, field in enumerate(sample_estate.plots())
        ]
    return found, problems


def is_one_free(names: list[str]) -> bool:
    """Tell whether another program holds one of these seasons no more; nobody waits for that."""
    for name in names:
        try:
            season_held.wait(seasons_folder.path_of(name), patience_s=0.0)
        except season_held.SeasonHeld:
            continue
        except FieldmonError:
            pass  # what is wrong with it is said when it is opened
        return True
    return False


def _of_season(name: str, season: Season) -> PlotState:
    today = local_clock(season.plot.field).today()
    # nothing is known of a season before its first day
    on = max(today, season.settings.begins)
    of = season.key, season.revision, str(on), season
    expected = cached.still_infested(*of).expected
    seen = days_since(season, today)
    begun = bool(len(season.inspections))
    waits = not_begun(season.settings.begins, today)
    return PlotState(name, name, season.plot.field.boundary, None, seen, expected, begun, waits)


def open_plot(plot: PlotState) -> None:
    """Let this plot be the one that is open from the next run on (for callbacks)."""
    plot_source.open_season(plot.source)
    if plot.number is None:
        return
    files = plot_files.of_sample() if plot.source == plot_source.SAMPLE else plot_files.of_session()
    if files is not None and files.plot is not None:
        plot_source.choose_feature(files.plot.key, plot.number)
