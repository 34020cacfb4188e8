"""A season and other files: whether they are copies of it, of its plot, or stand in its place."""

from __future__ import annotations

import shlex
from collections import Counter
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring.changes import copy_corrections, season_log
from fieldmon.monitoring.changes.transactions import Store, get_meta
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.rows_that_count import COUNTS, TAKEN_BACK
from fieldmon.monitoring.merging import same_season
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from shapely import MultiPolygon

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.changes.outside_changes import OutsideChange
    from fieldmon.monitoring.season.open_season import OpenSeason

# of the smaller of two boundaries, in the other: they are of one plot
_MOST_OF_PLOT = 0.5
# of the seasons that are open
_KNOWN: WeakKeyDictionary[OpenSeason, SeasonGround] = WeakKeyDictionary()


def is_another_now(season: OpenSeason) -> bool:
    """Return whether another season's file, or one of an earlier version, took its place."""
    with season.store.reading() as db:
        is_ours = get_meta(db, "version") == str(schema.VERSION)
        return not is_ours or f"{season.path} {season_log.first(db)}" != season.key


class BroughtSeason(NamedTuple):
    """What is in another season's file beside its findings, held to a season.

    Parameters
    ----------
    is_copy
        Whether it is a copy of this season.
    corrections
        What another program changed of inspections in such a copy.
    taken_back
        How many inspections that count here were taken back in such a copy.
    treatments
        Product and day of the treatments that count there alone.
    """

    is_copy: bool
    corrections: tuple[OutsideChange, ...]
    taken_back: int
    treatments: list[tuple[str, str]]


def brought_season(season: OpenSeason, file: Path, name: str) -> BroughtSeason:
    """Return what is in another season's file of that name, beside its findings.

    Raise `FileProblem` where it looks for another pest, or where a copy has taken corrections that
    this season has not: recorded from there, what was corrected would count twice, and what was
    deleted would still count.
    """
    with season.store.reading() as db, Store(file).reading() as theirs:
        same_season.refuse_another_pest(db, theirs)
        alone = treatments.counting_alone(db, theirs)
        if not same_season.are_copies(db, theirs):
            return BroughtSeason(is_copy=False, corrections=(), taken_back=0, treatments=alone)
        if n := copy_corrections.n_alone(db, theirs):
            raise FileProblem(
                worded(
                    "A copy of a season whose findings are recorded must have no corrections of "
                    "its own, but {n} {n:inspection of this one was|inspections of this one were} "
                    "corrected or deleted there. {remedy}",
                    n=n,
                    remedy=take_all(season, name),
                )
            )
        return BroughtSeason(
            is_copy=True,
            corrections=copy_corrections.waiting(theirs),
            taken_back=_n_taken_back(db, theirs),
            treatments=alone,
        )


def _n_taken_back(db: sqlite3.Connection, theirs: sqlite3.Connection) -> int:
    """Return how many inspections that count here were taken back in a copy."""
    wanted = "SELECT DISTINCT digest FROM inspections WHERE undone = ?"
    here, there = ({*one.execute(wanted, (COUNTS,))} for one in (db, theirs))
    return len(({*theirs.execute(wanted, (TAKEN_BACK,))} & here) - there)


def is_copy(season: OpenSeason, file: Path) -> bool:
    """Return whether a file is this season or a copy of it, however far they went apart.

    Seasons begun apart are no copies, even of one plot and one day. Nor is a copy any more that
    looks for another pest, once nothing that counts stands in both.
    """
    if file.resolve() == season.path.resolve():
        return True
    with season.store.reading() as db, Store(file).reading() as theirs:
        return same_season.are_copies(db, theirs)


def take_all(season: OpenSeason, name: str) -> Worded:
    """Return how all that a copy of this name holds is taken in, not its findings alone."""
    merge = f"fieldmon merge {shlex.quote(season.path.name)} {shlex.quote(name)}"
    return worded("Take all that it holds with Merge in the app, or with: {merge}", merge=merge)


def is_of_another_pest(season: OpenSeason, file: Path) -> bool:
    """Return whether this and the season in a file name pests that differ."""
    with season.store.reading() as db, Store(file).reading() as theirs:
        return same_season.are_of_two_pests(db, theirs)


class SeasonGround(NamedTuple):
    """The ground of a season's plot.

    Parameters
    ----------
    planting
        What stands for the rows and plants: other seasons of the plot have the same.
    boundary
        Its outline, lon/lat.
    """

    planting: str
    boundary: MultiPolygon

    @classmethod
    def of(cls, season: OpenSeason) -> SeasonGround:
        """Return that of a season; it never changes, and takes long to read."""
        if (known := _KNOWN.get(season)) is None:
            with season.store.reading() as db:
                known = cls(same_season.planting(db), season.plot.field.boundary)
            _KNOWN[season] = known
        return known

    def is_that_of(self, other: SeasonGround) -> bool:
        """Return whether another season has the same plants, or stands on the same ground.

        Then more than half of the smaller boundary lies in the other, however rows were laid.
        """
        if self.planting == other.planting:
            return True
        smaller = min(self.boundary.area, other.boundary.area)
        shared = self.boundary.intersection(other.boundary).area
        return bool(shared > _MOST_OF_PLOT * smaller)


def called_apart(seasons: Sequence[OpenSeason]) -> tuple[str, ...]:
    """Return what the plot of each season is called, with its file where two are called alike."""
    named = [own_names(season) for season in seasons]
    often = Counter(name for name, *_ in named)
    twice = Counter((name, file) for name, file, *_ in named)
    return tuple(
        by_folder if twice[name, file] > 1 else by_file if often[name] > 1 else name
        for name, file, by_file, by_folder in named
    )


def own_names(season: OpenSeason) -> tuple[str, str, str, str]:
    """Return what tables may call a season's plot: its name, its file, and as `called_apart`."""
    name, file = season.plot.field.name, season.path.stem
    folder = season.path.absolute().parent.name
    return name, file, f"{name} ({file})", f"{name} ({folder}/{file})"


def by_plot(seasons: Iterable[OpenSeason]) -> list[list[OpenSeason]]:
    """Return the seasons of each plot together: as many lists as there are plots."""
    plots: list[list[tuple[OpenSeason, SeasonGround]]] = []
    for season in seasons:
        here = SeasonGround.of(season)
        same = [plot for plot in plots if any(here.is_that_of(ground) for _, ground in plot)]
        plots = [plot for plot in plots if plot not in same]
        plots.append([*chain.from_iterable(same), (season, here)])
    return [[season for season, _ in plot] for plot in plots]


def of_one_plot(
    seasons: Iterable[OpenSeason], named: Callable[[str], str] = str
) -> tuple[Worded, ...]:
    """Return a sentence on each plot of which there are several seasons; `named` writes a name."""
    return tuple(
        worded(
            "{names} and {last} are {n} seasons of one plot: each counts. If somebody began one of "
            "them a second time, leave it away.",
            names=joined(", ", names), last=last, n=len(same),
        )
        for same in by_plot(seasons)
        if len(same) > 1
        for *names, last in [[_with_pest(season, named) for season in same]]
    )  # fmt: skip


def _with_pest(season: OpenSeason, named: Callable[[str], str]) -> str:
    name, pest = named(season.path.stem), season.settings.pest
    return name if pest is None else f"{name} ({pest.name})"
