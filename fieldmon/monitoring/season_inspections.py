"""What was found in a season: recorded, corrected, merged and taken back."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, time
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import (
    batches,
    cautions,
    copy_corrections,
    corrections,
    drafts,
    inspection_lots,
    inspection_table,
    label_table,
    merging,
    numbered_inspections,
    outside_changes,
    phone_tables,
    repeated_recordings,
    scouts,
    season_log,
    tables,
    treatments,
)
from fieldmon.monitoring.batches import Recorded, Undone, more_in_words
from fieldmon.monitoring.contradictions import (
    Contradictions,
    contradicting,
    contradictions,
    known_before,
    said_before,
    said_otherwise,
)
from fieldmon.monitoring.merging import Merged
from fieldmon.monitoring.open_season import OpenSeason, settings_of
from fieldmon.monitoring.people import as_written, names_written, written_in
from fieldmon.monitoring.settings import seconds
from fieldmon.monitoring.told_detection import said_now
from fieldmon.monitoring.transactions import Store
from fieldmon.pests.weather import DAY_S
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Sequence
    from datetime import date
    from pathlib import Path

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.batches import Batch, BatchContents
    from fieldmon.monitoring.merging import MergedCopy
    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.monitoring.tables import KeptMessage
    from fieldmon.monitoring.treatments import KeptTreatment


#: why treatments do not count any more after merging, as `MergedCopy` has them
_GONE = (
    "counted here, but was undone there",
    "counted there, but was undone here",
    "counted in both, but each undid another recording of it",
)


@checked
class SeasonInspections(OpenSeason):
    """The inspections of a season, whoever brings them; each batch can be undone."""

    def contradictions(self, inspections: Inspections) -> Contradictions:
        """Return which `inspections` say otherwise than what is recorded of their plant and day."""
        return contradictions(inspections, self.history.inspections)

    def new_of(self, inspections: Inspections) -> int:
        """Return how many `inspections` say more than what is recorded."""
        return int(np.count_nonzero(~known_before(inspections, self.history.inspections)))

    def unrecorded(self, inspections: Inspections) -> int:
        """Return how many `inspections` are of a plant, day and result that were never recorded.

        What was recorded and taken back since was recorded.
        """
        with self.store.reading() as db:
            known = inspection_table.ever_recorded(db)
        dates = inspections.date.astype(str).tolist()
        told = zip(inspections.plant.tolist(), dates, inspections.result.tolist(), strict=True)
        return sum(one not in known for one in told)

    def contradicting(self, on: date) -> Inspections:
        """Return a day's inspections of plants that were both clean and found on it."""
        return contradicting(self.history.inspections.on(on))

    def said_otherwise(self, on: date, named: Callable[[str], str] = str) -> tuple[Worded, ...]:
        """Return a line for each such plant `on` a day: who says what; `named` writes a name."""
        return said_otherwise(self.history.inspections.on(on), self.plot.grid, named)

    def record(
        self,
        inspections: Inspections,
        source: str = "",
        who: str = "",
        *,
        confirmed: bool = False,
        into: int | None = None,
    ) -> Recorded:
        """Add inspections; those that the season holds already change nothing.

        Parameters
        ----------
        inspections
            What was found where and when.
        source, who
            File or screen it comes from; the person, where the inspections name none.
        confirmed
            Whether results count that contradict what is recorded of the same plant and day.
        into
            Batch to add them to, as `Recorded` numbers it; None: a new one.

        Raises
        ------
        ContradictionError
            If there are such results and nobody confirmed them.
        ObservationError
            If a plant is not on this plot, or a result has no date or an impossible one.
        SettingError
            If a date is not of this season.
        """
        (done,) = self.record_all([(inspections, source)], who, confirmed=confirmed, into=into)
        return done

    def record_all(
        self,
        brought: Sequence[tuple[Inspections, str]],
        who: str = "",
        *,
        confirmed: bool = False,
        into: int | None = None,
        copies: Sequence[Path | None] = (),
    ) -> tuple[Recorded, ...]:
        """Add inspections of several sources, a batch each: all of them, or none.

        Parameters
        ----------
        brought
            Inspections, each with the name of the file or screen it comes from.
        who
            The person, where the inspections name none.
        confirmed
            Whether results and corrections count that contradict what is recorded, or one another.
        into
            Batch to add all of them to; None: new ones.
        copies
            Of each source, the copy of this season whose corrections, by `who`, are taken before
            anything is added or held to what is recorded; None: it is none.

        Raises
        ------
        ContradictionError
            If there are such results and nobody confirmed them.
        ObservationError
            If a plant is not on this plot, or a result has no date or an impossible one.
        SettingError
            If a date is not of this season, or nobody is named who corrected.
        FileProblem
            If a corrected row makes no sense or is not here.
        """
        done = []
        with self._writing() as db:
            taken = [
                0
                if copy is None
                else self._take_corrections(db, copy, (source, who), confirmed=confirmed)
                for copy, (_, source) in zip(copies or [None] * len(brought), brought, strict=True)
            ]
            before = self._read(db)
            if any(taken):
                self._last = None  # the transaction may yet fail
            held, first = before.history.inspections, []
            known = names_written(db)
            who = as_written(known, who)
            if not confirmed and brought:
                every = reduce(Inspections.and_those, [told for told, _ in brought])
                contradictions(every, held).refuse(self.plot.grid)
            for (told, source), n in zip(brought, taken, strict=True):
                inspections = _by_those_known(known, told)
                one, news = self._add(db, inspections, held, (source, who, into))
                done.append(replace(one, corrected=n))
                if one.new:
                    held = held.and_those(news)
                if one.more:  # the next source is held to that, too
                    held = inspection_lots.load(db, settings_of(db).begins)
                if one.batch is not None:
                    first.append(settings_of(db).day(inspections.date.min().item()))
            if first:
                self._refresh(db, min(first), before)
        return tuple(done)

    def record_instead(self, inspections: Inspections, source: str = "", who: str = "") -> Recorded:
        """Add inspections; where they contradict what is recorded, they hold in its place.

        Those are a batch of corrections, the others one of inspections. Undoing the corrections
        brings back what stood there before. Of results that contradict each other the later one
        holds.

        Parameters
        ----------
        inspections
            What was found where and when.
        source, who
            File or screen it comes from; the person, where the inspections name none.

        Raises
        ------
        ObservationError
            If a plant is not on this plot, or a result has no date or an impossible one.
        SettingError
            If a date is not of this season.
        """
        with self._writing() as db:
            before = self._read(db)
            held, known = before.history.inspections, names_written(db)
            who = as_written(known, who)
            inspections = _by_those_known(known, inspections)
            against = contradictions(inspections, held).which
            others = inspections.take(np.setdiff1d(np.arange(len(inspections)), against))
            done, news = self._add(db, others, held, (source, who, None))
            holding, plot = inspections.take(against), (self.plot.grid, self.plant_numbers)
            taken: tuple[str, ...] = ()
            if len(holding):
                said = settings_of(db), (source, who)
                taken = corrections.take(db, holding, plot, *said)
                self._corrected(db, taken, who, here=True)
            elif done.batch is not None:
                day = settings_of(db).day((others if done.more else news).date.min().item())
                self._refresh(db, day, before)
        return replace(done, corrected=len(holding))

    def _add(
        self,
        db: sqlite3.Connection,
        inspections: Inspections,
        held: Inspections,
        said: tuple[str, str, int | None],
    ) -> tuple[Recorded, Inspections]:
        """Write inspections of one source, besides what is held, and what they say beside it.

        Return what that did, and the new ones.
        """
        source, who, into = said
        if into is not None:
            batches.must_count(db, into)
        batch = batches.begin(db, "findings", source, "") if into is None else into
        how = self.plot.grid, self.plant_numbers, settings_of(db), (batch, who)
        named = np.where(inspections.who == "", who, inspections.who).astype(object)
        inspections = replace(inspections, who=named)
        known = said_before(inspections, held)
        told = inspections.take(~known)
        new = inspection_table.store(db, inspection_table.rows(told, *how))
        news, told = told.take(new), inspections.take(known).and_those(told.take(~new))
        held = held.and_those(news)
        more = repeated_recordings.additions(told, held)
        told = told.take(np.array([one.brought for one in more], np.intp))
        made = inspection_table.rows(told, *how)
        repeated_recordings.keep(db, held, zip([one.held for one in more], made, strict=True))
        by = ", ".join(sorted({*map(str, news.who), *map(str, told.who)} - {""}))
        if into is None:
            batches.name(db, batch, by)
        batches.end(db, batch, len(news) + len(more), grows=into is not None)
        n_notes = sum(one.is_note for one in more)
        done = Recorded(
            batch if len(news) or more else None, len(news), len(inspections) - len(news),
            noted=n_notes, filled=len(more) - n_notes,
        )  # fmt: skip
        self._log_seen(db, news, (source, by), done, who)
        return done, news

    def _log_seen(
        self, db: sqlite3.Connection, news: Inspections, said: tuple[str, str], done: Recorded,
        who: str = "",
    ) -> None:  # fmt: skip
        """Log what is new of a batch, and what was added to what was known."""
        if done.batch is None:
            return
        source, by = said
        what: dict[str, object] = {"more": str(done.more)} if done.more else {}
        if len(news):
            what |= inspection_table.in_words(news, said_now(db, news, who))
        season_log.append(
            db, "seen" if len(news) else "noted", by,
            states=season_log.states(db, [done.batch]), batch=done.batch, source=source, **what,
        )  # fmt: skip

    def undo(self, batch: int | None = None, inspection: int | None = None, who: str = "") -> str:
        """Take a `batch` back (None: the last one), or one `inspection`; nothing is deleted.

        Both are numbers; `who` takes it back, for the log. `redo` lets a batch count again, but no
        inspection alone: that is recorded anew. Return a sentence that says what was undone. Raise
        `SettingError` if there is nothing, or both are given.
        """
        return self.take_back(batch, inspection, who).said

    def take_back(
        self, batch: int | None = None, inspection: int | None = None, who: str = ""
    ) -> Undone:
        """Do what `undo` does; return also which batches `redo` then lets count again.

        Parameters
        ----------
        batch, inspection, who
            As `undo` has them.

        Raises
        ------
        SettingError
            As `undo` has it.
        """
        if batch is not None and inspection is not None:
            raise SettingError(
                worded(
                    "A batch or one inspection must be taken back, but both are given: batch "
                    "{batch} and inspection {inspection}. Give one of them.",
                    batch=batch,
                    inspection=inspection,
                )
            )
        signs = self.plot.grid.line_signs
        with self._lock, self.store.writing() as db:
            if inspection is None:
                number, before = batches.to_undo(db, batch)
                changed, said = batches.undo(db, number, signs)
                what = {"batch": number, **({"but": before} if before else {})}
            else:
                changed, said = batches.undo_one(db, inspection, signs)
                what = {}
            self._note_undone(db, who, changed, said, **what)
            again = batches.to_redo(db, changed)
            if again is None:
                return Undone(said, None)
            but = season_log.left_out_of(db, again)
            return Undone(said, again, batches.to_redo_first(db, again, but))

    def redo(self, batch: int, who: str = "") -> str:
        """Let a `batch` that was undone count again; `who` does so, for the log.

        What was taken back of it before, one by one or on a phone, stays so. Return a sentence that
        says what counts again. Raise `SettingError` if the batch was not undone, or what it
        corrected is not as it was before.
        """
        with self._lock, self.store.writing() as db:
            but = season_log.left_out_of(db, batch)
            changed, said = batches.redo(db, batch, but, self.plot.grid.line_signs)
            told = phone_tables.undo_as_told(db)
            changed |= {number for number, _ in told}
            for one in changed:
                batches.close_if_empty(db, one)
            if all(one.undone for one in batches.all_of(db) if one.number == batch):
                raise SettingError(
                    worded(
                        "Batch {batch} must have something that can count again, but all of it was "
                        "taken back on the phone. Record it anew.",
                        batch=batch,
                    )
                )
            self._note_undone(db, who, changed, said, batch=batch)
        return said

    def _note_undone(
        self, db: sqlite3.Connection, who: str, changed: set[int], said: str,
        **what: object,
    ) -> None:  # fmt: skip
        states = season_log.states(db, changed)
        season_log.append(db, "undone", written_in(db, who), states=states, said=said, **what)
        self._refresh(db, min(batches.first_day(db, one) for one in changed))

    def correct(self, who: str, *, confirmed: bool = False) -> int:
        """Take what another program changed of inspections as corrections; return how many.

        They are a batch of their own, of `who` corrects; undoing it brings back what was before.
        What says nothing else than before is put back as it was, and is none. Raise `FileProblem`
        if more than inspections was changed, or what makes no sense;
        `ContradictionError` if they contradict what else is recorded and are not `confirmed`.
        """
        with self._lock, self.store.writing() as db:
            outside_changes.refuse_more(db)
            settings, plot = settings_of(db), (self.plot.grid, self.plant_numbers)
            who = written_in(db, who)
            taken = outside_changes.correct(db, plot, settings, who)
            self._may_be_taken(db, taken, confirmed=confirmed)
            self._corrected(db, taken, who)
        return len(taken)

    def correct_time(
        self,
        inspection: int,
        at: time | None,
        who: str,
        on: date | None = None,
        *,
        confirmed: bool = False,
    ) -> str:
        """Give one inspection another day, or another time of its day; return what was done.

        That is a batch of its own; undoing it brings back the time before.

        Parameters
        ----------
        inspection
            Its number (fid) in the season's file.
        at
            The local time that is right, none to come; None: as it is.
        who
            Who corrects.
        on
            The day that is right, of the season and not to come; None: as it is.
        confirmed
            Whether it counts though it contradicts what else is recorded of the plant and day.

        Raises
        ------
        ContradictionError
            If it does and nobody confirmed it.
        SettingError
            If there is no such inspection that counts, no such day or time (yet), or nothing
            to correct.
        """
        with self._writing() as db:
            plot, settings = (self.plot.grid, self.plant_numbers), settings_of(db)
            if on is not None:
                settings.day(on)
            day, held_at = corrections.made(db, inspection)
            self._must_have_come(on or day, at or held_at)
            if on in {None, day} and at in {None, held_at}:
                raise SettingError(
                    worded(
                        "A correction must say something else than what is recorded, but "
                        "inspection {inspection} is of {when} already: there is nothing to "
                        "correct.",
                        inspection=inspection,
                        when=str(day) if held_at is None else f"{day} {held_at:%H:%M}",
                    )
                )
            who, when = written_in(db, who), (on, None if at is None else seconds(at))
            said = corrections.retime(db, inspection, when, plot, settings, who)
            self._may_be_taken(db, said, confirmed=confirmed)
            self._corrected(db, said, who, here=True)
        return said[0]

    def _must_have_come(self, on: date, at: time | None) -> None:
        """Raise `SettingError` if a moment, or a whole day, lies ahead of the plot's clock.

        So it does if that clock never showed it.
        """
        clock = local_clock(self.plot.field)
        now = clock.now()
        told = datetime.combine(on, at or time())
        if at is not None and clock.at(clock.moment(on, at).astimezone(UTC)) != told:
            raise SettingError(
                worded(
                    "An inspection must be of a time that the plot's clock showed, but {day} is "
                    "none: clocks were put forward over it.",
                    day=f"{told:%Y-%m-%d %H:%M}",
                )
            )
        if (on, at or now.time()) > (now.date(), now.time()):
            raise SettingError(
                worded(
                    "An inspection must be of a moment that has come, but {day} has not: on the "
                    "plot it is {now}.",
                    day=str(on) if at is None or on > now.date() else f"{on} {at:%H:%M}",
                    now=f"{now:%Y-%m-%d %H:%M}",
                )
            )

    def inspections_of(self, plant: int) -> tuple[numbered_inspections.NumberedInspection, ...]:
        """Return the inspections of a plant that count, in their order, with their numbers."""
        with self.store.reading() as db:
            return numbered_inspections.of_plant(db, plant)

    def inspections_on(self, on: date) -> tuple[int, ...]:
        """Return the numbers (fid) in the file of a day's inspections that count, in order."""
        with self.store.reading() as db:
            return numbered_inspections.of_day(db, on)

    def number_of(self, inspections: Inspections) -> int:
        """Return the number (fid) in the file of the last of some inspections with times."""
        last = inspections.take(slice(len(inspections) - 1, len(inspections)))
        at = inspection_table.time_text(float(last.second[0]) % DAY_S)
        said = int(last.plant[0]), str(last.date[0]), at
        with self.store.reading() as db:
            (number,) = db.execute(
                "SELECT fid FROM inspections WHERE plant = ? AND date >= ? AND undone = 0 "
                "ORDER BY time = ? DESC, date, fid DESC",
                said,
            ).fetchone()
        return int(number)

    def take_drafts(self) -> tuple[str, ...]:
        """Let inspections count that another program added to the file itself.

        They are a batch of their own. Return a sentence for each that does not count, and why; it
        stays as it is. Where more was changed, nothing is taken before that is settled.
        """
        plot = self.plot.grid, self.plant_numbers
        with self._lock, self.store.reading() as db:
            if not drafts.any_waiting(db) or outside_changes.waiting(db):
                return ()
            known = self._read(db)
            found = drafts.read(db, plot, known.settings, known.history.inspections)
        if any(one.inspection is not None for one in found):
            try:
                with self._writing() as db:
                    before = self._read(db)
                    found = drafts.read(db, plot, before.settings, before.history.inspections)
                    good = [one for one in found if one.inspection is not None]
                    self._take_drafts(db, good, before.settings)
            except FileProblem as error:  # who may only read it reads it without them
                return (str(error),)
        return tuple(one.sentence for one in found if one.inspection is None)

    def _take_drafts(
        self, db: sqlite3.Connection, taken: list[drafts.Draft], settings: MonitoringSettings
    ) -> None:
        batch = batches.begin(db, "findings", drafts.SOURCE, "")
        said = (self.plot.grid, self.plant_numbers), settings, batch
        news = drafts.keep(db, taken, *said)
        batches.end(db, batch, len(taken))
        known = [one for one in taken if one.known is not None]
        n_notes = sum(one.is_note for one in known)
        done = Recorded(batch, len(news), len(known), noted=n_notes, filled=len(known) - n_notes)
        self._log_seen(db, news, (drafts.SOURCE, ""), done)
        # there are as many rows as before: all is read again
        days = [one.inspection.date[0].item() for one in taken if one.inspection is not None]
        self._refresh(db, settings.day(min(days)))

    def is_copy(self, file: Path) -> bool:
        """Return whether a file is this season or a copy of it, however far they went apart.

        Seasons begun apart are no copies, even of one plot and one day. Nor is a copy any more that
        looks for another pest, once nothing that counts stands in both.
        """
        if file.resolve() == self.path.resolve():
            return True
        with self.store.reading() as db, Store(file).reading() as theirs:
            try:
                merging.refuse_strangers(db, theirs)
            except FileProblem:
                return False
            apart = merging.are_of_two_pests(db, theirs)
            return not apart or merging.hold_in_common(db, theirs)

    def is_of_another_pest(self, file: Path) -> bool:
        """Return whether this and the season in a file name pests that differ."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            return merging.are_of_two_pests(db, theirs)

    def refuse_another_pest(self, file: Path) -> None:
        """Raise `FileProblem` where the season in a file looks for another pest than this one."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            merging.refuse_another_pest(db, theirs)

    def is_of_one_plot(self, file: Path) -> bool:
        """Return whether the season in a file has the same rows and plants as this one."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            return merging.are_of_one_plot(db, theirs)

    def treatments_alone_in(self, file: Path) -> list[tuple[str, str]]:
        """Return product and day of the treatments that count in another season's file alone."""
        with self.store.reading() as db, Store(file).reading() as theirs:
            return treatments.counting_alone(db, theirs)

    def corrections_in(self, copy: Path) -> tuple[outside_changes.OutsideChange, ...]:
        """Return what another program changed of inspections in a copy of this season.

        A file that is no copy of it has none.
        """
        if not self.is_copy(copy):
            return ()
        with Store(copy).reading() as theirs:
            return copy_corrections.waiting(theirs)

    def take_corrections(self, copy: Path, name: str, who: str, *, confirmed: bool = False) -> int:
        """Take what was corrected or deleted in a `copy` of this season; return how many were new.

        They are a batch of their own, of `who`; `name` is what the copy is called.
        Raise `FileProblem` if a changed row makes no sense or is not here, `SettingError` if
        nobody is named, and `ContradictionError` if they contradict what else is recorded and are
        not `confirmed`.
        """
        with self._writing() as db:
            return self._take_corrections(db, copy, (name, who), confirmed=confirmed)

    def _take_corrections(
        self, db: sqlite3.Connection, copy: Path, said: tuple[str, str], *, confirmed: bool
    ) -> int:
        name, who = said
        if not who.strip():
            raise SettingError(
                worded(
                    "Corrections must have an author, but {name} was changed by another program "
                    "and nobody says who did. Give --who NAME.",
                    name=name,
                )
            )
        with Store(copy).reading() as theirs:
            plot, who = (self.plot.grid, self.plant_numbers), written_in(db, who)
            taken = copy_corrections.take(db, theirs, plot, settings_of(db), (name, who))
        self._may_be_taken(db, taken, confirmed=confirmed)
        self._corrected(db, taken, who)
        return len(taken)

    def _may_be_taken(
        self, db: sqlite3.Connection, taken: tuple[str, ...], *, confirmed: bool
    ) -> None:
        """Raise `ContradictionError` if the last corrections contradict what else is recorded."""
        if taken and not confirmed:
            corrections.contradicting(db).refuse(self.plot.grid, corrected=True)

    def _corrected(
        self, db: sqlite3.Connection, taken: tuple[str, ...], who: str, *, here: bool = False
    ) -> None:
        """Log what was corrected; `here`: with fieldmon itself, not by another program."""
        if taken:
            what = {"rows": len(taken), "said": taken, **({"here": True} if here else {})}
            season_log.append(db, "corrected", who, states=season_log.states(db), **what)
            self._refresh(db)

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
                taken = merging.merge(db, theirs)
            self._refresh(db)
            # what either copy took back or corrected contradicts nothing
            contradict = contradict.still(self._inspections(db))
            ended = _ended(here, there, taken)
            states, labels = season_log.states(db), label_table.read(db)
            if states != was:
                _log_merged(db, states, told, taken, ended)
            twice = _recorded_twice(treatments.kept(db, self._inside, clock), taken)
            overlaps = scouts.overlaps(db, int(self.plant_numbers.line.max()))
        no_more = (
            cautions.counts_no_more(one, cautions.label_of(one, labels), why) for one, why in ended
        )
        return Merged(
            new=taken.new,
            contradictions=(
                *contradict.sentences(self.plot.grid),
                *taken.differing,
                *twice,
                *no_more,
            ),
            taken_back=taken.taken_back,
            moved=bool(taken.numbers),
            treatments=taken.treatments,
            codes=taken.codes,
            overlaps=overlaps,
            chosen=taken.chosen,
            noted=taken.noted,
        )

    def batches(self) -> tuple[Batch, ...]:
        """Return everything recorded, the last one first."""
        with self.store.reading() as db:
            return batches.all_of(db)

    def contents(self, numbers: Sequence[int]) -> dict[int, BatchContents]:
        """Return what batches of inspections and treatments say, by their numbers."""
        with self.store.reading() as db:
            return batches.contents(db, numbers)

    def corrected_by(self) -> dict[tuple[object, ...], str]:
        """Return who corrected inspections that count, by plant, day (ISO), result and count."""
        with self.store.reading() as db:
            return batches.corrected_by(db)

    def messages(self) -> tuple[KeptMessage, ...]:
        """Return what the imports had to say."""
        with self.store.reading() as db:
            return tables.read_messages(db)


def _by_those_known(known: dict[str, str], told: Inspections) -> Inspections:
    """Return inspections whose people are written as they are known."""
    names = [as_written(known, str(name)) for name in told.who]
    return replace(told, who=np.array(names, object))


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
        new=taken.new,
        entries=len(told),
        theirs=told,
        moved=bool(taken.numbers),
        numbers=taken.numbers,
        undone=undone,
        chosen=taken.chosen,
        more=str(more_in_words(taken.noted)),
    )


def _recorded_twice(counting: Sequence[KeptTreatment], taken: MergedCopy) -> list[str]:
    """Return a sentence for each two treatments that may be one, recorded in either copy."""
    by_number = {one.number: one for one in counting}
    said = (
        cautions.same_plants_twice(by_number[one], by_number[other]) for one, other in taken.alike
    )
    return [one for one in said if one]
