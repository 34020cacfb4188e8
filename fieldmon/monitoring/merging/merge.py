"""Put all that another copy of a season holds into this one, each table as its module says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.monitoring.file import phone_tables, schema
from fieldmon.monitoring.inspecting import repeated_recordings
from fieldmon.monitoring.inspecting.batches import close_if_empty, more_in_words
from fieldmon.monitoring.merging import (
    merged_batches,
    merged_choices,
    merged_corrections,
    merged_inspections,
    merged_routes,
    merged_rows,
    merged_treatments,
    same_season,
)
from fieldmon.monitoring.merging.merged_inspections import NOTHING_NEW, NewInspections
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.merging.merged_corrections import CorrectedTwice
    from fieldmon.monitoring.merging.merged_rows import Numbers


@dataclass(frozen=True)
class Merged:
    """What came of merging.

    Parameters
    ----------
    new
        Inspections that count now and did not before.
    contradictions
        A sentence for each result that the copies tell differently, for each inspection that both
        corrected otherwise, for each setting, for the table of labels, for treatments that are
        alike but for what a label may add, and for each treatment that counted in one copy and was
        undone in the other.
    taken_back
        Inspections that counted before and do not now: the other copy undid or corrected them.
    moved
        Whether batches have other numbers now than they had.
    treatments
        Treatments that count now and did not before.
    codes
        Names of those whose keys hold and were not there, one for each key.
    overlaps
        A sentence for each two codes whose rows overlap.
    chosen
        Settings that were otherwise before, each from what to what, and the table of labels.
    noted
        Inspections known before that have more notes now.
    of_new
        Who made the new inspections, of which plants and days, and how many found pests.
    treated
        Each new treatment, in words.
    entries
        Entries of the other copy's log that were not known.
    changed
        Whether anything was taken in.
    """

    new: int
    contradictions: tuple[str, ...]
    taken_back: int = 0
    moved: bool = False
    treatments: int = 0
    codes: tuple[str, ...] = ()
    overlaps: tuple[str, ...] = ()
    chosen: tuple[str, ...] = ()
    noted: int = 0
    of_new: NewInspections = NOTHING_NEW
    treated: tuple[str, ...] = ()
    entries: int = 0
    changed: bool = True

    @property
    def more(self) -> str:
        """What was added to inspections known before, in words; empty: nothing."""
        return more_in_words(self.noted)


class MergedCopy(NamedTuple):
    """What came of another copy, before its results and codes are held to those of this one.

    Parameters
    ----------
    merged
        What the rows of both tell: its `contradictions` are of settings, the table of labels,
        treatments that are alike but for what a label may add, and of a pest that only one names.
    numbers
        What batches are numbered now, by their numbers of before, where that is another one.
    gone
        Numbers of treatments that do not count any more: those that counted here alone, there
        alone, and (by their numbers here) in both.
    alike
        Numbers of each two treatments that count, one of each copy alone, of one day and product.
    twice
        Inspections that both copies corrected otherwise.
    """

    merged: Merged
    numbers: Numbers
    gone: tuple[set[int], set[int], set[int]]
    alike: tuple[tuple[int, int], ...]
    twice: tuple[CorrectedTwice, ...]


def merge_copies(db: sqlite3.Connection, other: sqlite3.Connection) -> MergedCopy:
    """Put all that another copy holds into `db`.

    Raise `FileProblem` if it is no copy of the same season, or is of another pest by now.
    """
    same_season.refuse_strangers(db, other)
    same_season.refuse_another_pest(db, other)
    both = db, other
    copies = [merged_rows.read(one) for one in both]
    phones = [phone_tables.brought(one) for one in both]
    batches = merged_batches.of_both(copies)
    numbers = [merged_batches.numbers_now(copied, batches) for copied in copies]
    stay = merged_inspections.n_staying(both, numbers)
    before = _Standing.of(db, stay)
    unnamed = (*same_season.of_no_pest(db, other), *same_season.of_no_pest(other, db))
    applied = [treatments.counting_of(copied["treatments"]) for copied in copies]
    gone = merged_batches.merge_changes(both, copies, numbers)
    twice = merged_corrections.corrected_twice(copies, gone)
    merged_inspections.merge(both, numbers, gone, stay)
    treated, held = merged_treatments.merge(db, copies, numbers)
    merged_batches.write(db, batches)
    merged_routes.merge(both, copies)
    differing, chosen = merged_choices.merge_settings(db, copies)
    messages = merged_rows.once(copies, "import_findings", schema.IMPORTS.names, "at")
    merged_rows.write(db, schema.IMPORTS, messages)
    replaced_twice, other_labels = merged_choices.merge_labels(both, copies)
    for batch, _ in phone_tables.bring_together(db, phones):
        close_if_empty(db, batch)
    after = _Standing.of(db, stay)
    new_treatments, undone = merged_treatments.changed(db, applied)
    renumbered = {old: number for old, number in numbers[0].items() if old != number}
    merged = Merged(
        new=len(new := after.counting - before.counting),
        of_new=merged_inspections.told_of(db, new, stay),
        contradictions=(
            *differing,
            *unnamed,
            *replaced_twice,
            *merged_treatments.alike_but_for_labels(treated, held),
        ),
        taken_back=len(before.counting - after.counting),
        moved=bool(renumbered),
        treatments=len(new_treatments),
        treated=new_treatments,
        codes=tuple(sorted(name for key, name in after.keys.items() if key not in before.keys)),
        chosen=(*chosen, *other_labels),
        noted=repeated_recordings.n_noted(
            before.notes, after.notes, {*after.notes} - after.counting
        ),
    )
    alike = tuple(merged_treatments.of_one_product(treated, held))
    return MergedCopy(merged, renumbered, undone, alike, twice)


class _Standing(NamedTuple):
    """What holds in a season file at a moment of merging, to tell what merging changed.

    Parameters
    ----------
    counting
        Inspections that count, by their digests.
    keys
        Whose keys hold, by the digests of these.
    notes
        What is noted of each inspection, by its digest.
    """

    counting: set[str]
    keys: dict[str, str]
    notes: dict[str, repeated_recordings.Notes]

    @classmethod
    def of(cls, db: sqlite3.Connection, stay: int) -> _Standing:
        """Return what holds in a season; inspections that `stay` are left out."""
        counting = merged_inspections.counting(db, stay)
        return cls(counting, _keys(db), repeated_recordings.notes(db, stay))


def _keys(db: sqlite3.Connection) -> dict[str, str]:
    """Return whose keys hold, by the digests of these."""
    return dict(db.execute("SELECT key_digest, name FROM scouts WHERE ended IS NULL"))
