"""Other files that may be copies of a season, and what they hold taken in."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import label_table
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.inspecting.contradictions import contradictions
from fieldmon.monitoring.merging import merged_corrections
from fieldmon.monitoring.merging.merge import merge_copies
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.season.open_season import OpenSeason
from fieldmon.monitoring.treating import cautions, treatments
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence

    from fieldmon.monitoring.merging.merge import Merged, MergedCopy
    from fieldmon.monitoring.treating.treatments import KeptTreatment

#: why treatments do not count any more after merging, as `MergedCopy` has them
_GONE = (
    worded("counted here, but was undone there"),
    worded("counted there, but was undone here"),
    worded("counted in both, but each undid another recording of it"),
)


@checked
class SeasonCopies(OpenSeason):
    """A season beside other files: whether they are copies of it, and what merging them brings."""

    @kept_open()
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
            corrected = tuple(merged_corrections.sentences(db, taken.twice, self.plot.grid))
            states, labels = season_log.states(db), label_table.read(db)
            if changed := states != was:
                _log_merged(db, states, told, taken, (ended, corrected))
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
                *corrected,
                *taken.merged.contradictions,
                *twice,
                *no_more,
            ),
            overlaps=overlaps,
            entries=len(told),
            changed=changed,
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
    came: tuple[list[tuple[KeptTreatment, str]], tuple[str, ...]],
) -> None:
    """Note that another copy was taken in, with the entries that its log `told` beside ours.

    `came` is which treatments do not count any more, and what both corrected, in words.
    """
    ended, corrected = came
    both: dict[str, Any] = {"corrected": corrected} if corrected else {}
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
        treatments=taken.merged.treatments,
        taken_back=taken.merged.taken_back,
        entries=len(told),
        theirs=told,
        moved=taken.merged.moved,
        numbers=taken.numbers,
        undone=undone,
        chosen=taken.merged.chosen,
        more=str(taken.merged.more),
        **both,
    )


def _recorded_twice(counting: Sequence[KeptTreatment], taken: MergedCopy) -> list[str]:
    """Return a sentence for each two treatments that may be one, recorded in either copy."""
    by_number = {one.number: one for one in counting}
    said = (
        cautions.same_plants_twice(by_number[one], by_number[other]) for one, other in taken.alike
    )
    return [one for one in said if one]
