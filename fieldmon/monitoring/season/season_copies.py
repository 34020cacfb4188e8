"""Other files that may be copies of a season, and what they hold taken in."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.file import label_table
from fieldmon.monitoring.inspecting.contradictions import contradictions
from fieldmon.monitoring.merging import same_season
from fieldmon.monitoring.merging.merge import merge_copies
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.season.open_season import OpenSeason
from fieldmon.monitoring.treating import cautions, treatments
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.merging.merge import Merged, MergedCopy
    from fieldmon.monitoring.treating.treatments import KeptTreatment

# of the smaller of two boundaries, in the other: they are of one plot
_MOST_OF_PLOT = 0.5
#: why treatments do not count any more after merging, as `MergedCopy` has them
_GONE = (
    "counted here, but was undone there",
    "counted there, but was undone here",
    "counted in both, but each undid another recording of it",
)


@checked
class SeasonCopies(OpenSeason):
    """A season beside other files: whether they are copies of it, and what merging them brings."""

    def is_copy(self, file: Path) -> bool:
        """Return whether a file is this season or a copy of it, however far they went apart.

        Seasons begun apart are no copies, even of one plot and one day. Nor is a copy any more that
        looks for another pest, once nothing that counts stands in both.
        """
        if file.resolve() == self.path.resolve():
            return True
        with self.store.reading() as db, Store(file).reading() as theirs:
            try:
                same_season.refuse_strangers(db, theirs)
            except FileProblem:
                return False
            apart = same_season.are_of_two_pests(db, theirs)
            return not apart or same_season.hold_in_common(db, theirs)

    @cached_property
    def planting(self) -> str:
        """What stands for the rows and plants: other seasons of the plot have the same."""
        with self.store.reading() as db:
            return same_season.planting(db)

    def is_on_plot_of(self, other: SeasonCopies) -> bool:
        """Return whether another season has the same plants, or stands on the same ground.

        Then more than half of the smaller boundary lies in the other, however rows were laid.
        """
        if self.planting == other.planting:
            return True
        one, another = (season.plot.field.boundary for season in (self, other))
        smaller = min(one.area, another.area)
        return bool(one.intersection(another).area > _MOST_OF_PLOT * smaller)

    def is_of_another_pest(self, file: Path) -> bool:
        """Return whether this and the season in a file name pests that differ."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            return same_season.are_of_two_pests(db, theirs)

    def refuse_another_pest(self, file: Path) -> None:
        """Raise `FileProblem` where the season in a file looks for another pest than this one."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            same_season.refuse_another_pest(db, theirs)

    def treatments_alone_in(self, file: Path) -> list[tuple[str, str]]:
        """Return product and day of the treatments that count in another season's file alone."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            return treatments.counting_alone(db, theirs)

    def merge(self, other: OpenSeason) -> Merged:
        """Take in what another copy of this season holds: all that is in either, once each.

        The other one stays as it is. Raise `FileProblem` if it is no copy of this season.
        """
        with self._lock, self.store.writing() as db:
            held = self._inspections(db)
            with other.store.reading(self.path) as theirs:
                told = season_log.taken_in(db, theirs)
                # what is told is noted in any case
                was = None if told else season_log.states(db)
                # nobody writes there from here on
                contradict = contradictions(other.inspections, held)
                clock = local_clock(self.plot.field)
                here, there = (treatments.kept(one, self._inside, clock) for one in (db, theirs))
                taken = merge_copies(db, theirs)
            self._refresh(db)
            # what either copy took back or corrected contradicts nothing
            contradict = contradict.still(self._inspections(db))
            ended = _ended(here, there, taken)
            states, labels = season_log.states(db), label_table.read(db)
            if states != was:
                _log_merged(db, states, told, taken, ended)
            kept = treatments.by_vine(treatments.kept(db, self._inside, clock), self.plot.grid)
            twice = _recorded_twice(kept, taken)
            overlaps = scouts.overlaps(db, int(self.plant_numbers.line.max()))
        no_more = (
            cautions.counts_no_more(one, cautions.label_of(one, labels), why) for one, why in ended
        )
        return replace(
            taken.merged,
            contradictions=(
                *contradict.sentences(self.plot.grid),
                *taken.merged.contradictions,
                *twice,
                *no_more,
            ),
            overlaps=overlaps,
        )


def _ended(
    here: Sequence[KeptTreatment], there: Sequence[KeptTreatment], taken: MergedCopy
) -> list[tuple[KeptTreatment, str]]:
    """Return the treatments of two copies that do not count any more, each with why."""
    return [
        (one, why)
        for why, counted, gone in zip(_GONE, (here, there, here), taken.gone, strict=True)
        for one in counted
        if one.number in gone
    ]


def _log_merged(
    db: sqlite3.Connection,
    states: dict[str, str],
    told: list[dict[str, str]],
    taken: MergedCopy,
    ended: list[tuple[KeptTreatment, str]],
) -> None:
    """Note that another copy was taken in, with the entries that its log `told` beside ours."""
    undone = [
        f"{one.application.product or 'a product that nobody named'} on {one.on}"
        for one, why in ended
        if why != _GONE[1]
    ]
    season_log.append(
        db,
        "merged",
        states=states,
        new=taken.merged.new,
        entries=len(told),
        theirs=told,
        moved=taken.merged.moved,
        numbers=taken.numbers,
        undone=undone,
        chosen=taken.merged.chosen,
        more=str(taken.merged.more),
    )


def _recorded_twice(counting: Sequence[KeptTreatment], taken: MergedCopy) -> list[str]:
    """Return a sentence for each two treatments that may be one, recorded in either copy."""
    by_number = {one.number: one for one in counting}
    said = (
        cautions.same_plants_twice(by_number[one], by_number[other]) for one, other in taken.alike
    )
    return [one for one in said if one]


def called_apart(seasons: Sequence[SeasonCopies]) -> tuple[str, ...]:
    """Return what the plot of each season is called, with its file where two are called alike."""
    named = [own_names(season) for season in seasons]
    often = Counter(name for name, *_ in named)
    twice = Counter((name, file) for name, file, *_ in named)
    return tuple(
        by_folder if twice[name, file] > 1 else by_file if often[name] > 1 else name
        for name, file, by_file, by_folder in named
    )


def own_names(season: SeasonCopies) -> tuple[str, str, str, str]:
    """Return what tables may call a season's plot: its name, its file, and as `called_apart`."""
    name, file = season.plot.field.name, season.path.stem
    folder = season.path.absolute().parent.name
    return name, file, f"{name} ({file})", f"{name} ({folder}/{file})"


def of_one_plot(
    seasons: Iterable[SeasonCopies], named: Callable[[str], str] = str
) -> tuple[Worded, ...]:
    """Return a sentence on each plot of which there are several seasons; `named` writes a name."""
    plots: list[list[SeasonCopies]] = []
    for season in seasons:
        same = [plot for plot in plots if any(map(season.is_on_plot_of, plot))]
        plots = [plot for plot in plots if plot not in same]
        plots.append([*chain.from_iterable(same), season])
    return tuple(
        worded(
            "{names} and {last} are {n} seasons of one plot: each counts. If somebody began one of "
            "them a second time, leave it away.",
            names=joined(", ", names), last=last, n=len(same),
        )
        for same in plots
        if len(same) > 1
        for *names, last in [[_with_pest(season, named) for season in same]]
    )  # fmt: skip


def _with_pest(season: SeasonCopies, named: Callable[[str], str]) -> str:
    name, pest = named(season.path.stem), season.settings.pest
    return name if pest is None else f"{name} ({pest.name})"
