"""What was found in a season: recorded, taken back and told again."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, ImportDoubt, ObservationError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.io.readers.date_doubts import to_come
from fieldmon.monitoring.changes import corrections, outside_changes, season_log
from fieldmon.monitoring.estimates.told_detection import said_now
from fieldmon.monitoring.file import tables
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.inspecting import (
    batches,
    drafts,
    inspection_lots,
    inspection_table,
    repeated_recordings,
)
from fieldmon.monitoring.inspecting.batches import Recorded
from fieldmon.monitoring.inspecting.contradictions import (
    contradictions,
    said_before,
)
from fieldmon.monitoring.inspecting.numbered_inspections import (
    NumberedInspection,
    numbered_inspections,
)
from fieldmon.monitoring.phones.people import as_written, names_written
from fieldmon.monitoring.season.season_corrections import SeasonCorrections
from fieldmon.monitoring.season.undoing import redo_batch, undo_with_batches
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.monitoring.treating import treatments
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence
    from datetime import date
    from pathlib import Path

    from fieldmon.compute.day_arguments import Day
    from fieldmon.monitoring.file.tables import KeptMessage
    from fieldmon.monitoring.inspecting.batches import Batch, BatchContents
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.local_clock import LocalClock


@checked
class SeasonInspections(SeasonCorrections):
    """The inspections of a season, whoever brings them; each batch can be undone."""

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
            If a plant is not on this plot, a result has no date or an impossible one, or a find
            counts 0.
        SettingError
            If a date is not of this season.

        Warns
        -----
        ImportDoubt
            If a date has not come on the plot, in a season that has begun: a slip in a date.
        """
        done = recorded(self, inspections, source, who, confirmed=confirmed, into=into)
        if done.batch is not None:
            _doubt_days_to_come(inspections, self.settings.begins, local_clock(self.plot.field))
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
            If a plant is not on this plot, a result has no date or an impossible one, or a find
            counts 0.
        SettingError
            If a date is not of this season.

        Warns
        -----
        ImportDoubt
            As `record` does.
        """
        _must_count_finds(inspections)
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
            begins = settings_of(db).begins
        if done.batch is not None or taken:
            _doubt_days_to_come(inspections, begins, local_clock(self.plot.field))
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
        more = repeated_recordings.additions(db, told, held)
        told = told.take(np.array([one.brought for one in more], np.intp))
        made = inspection_table.rows(told, *how)
        repeated_recordings.keep(db, held, zip([one.held for one in more], made, strict=True))
        by = ", ".join(sorted({*map(str, news.who), *map(str, told.who)} - {""}))
        batches.name(db, batch, by)
        batches.end(db, batch, len(news) + len(more), grows=into is not None)
        done = Recorded(
            batch if len(news) or more else None, len(news), len(inspections) - len(news),
            **batches.n_more(more),
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

    @kept_open()
    def undo(self, batch: int | None = None, inspection: int | None = None, who: str = "") -> str:
        """Take a `batch` back (None: the last one), or one `inspection`; nothing is deleted.

        `redo` lets a batch count again, but no inspection alone: that is recorded anew.

        Parameters
        ----------
        batch, inspection
            Number of the one or of the other.
        who
            Who takes it back, for the log.

        Returns
        -------
        str
            A sentence that says what was undone.

        Raises
        ------
        SettingError
            If there is nothing to take back, or both are given.
        """
        return undo_with_batches(self, batch, inspection, who).said

    @kept_open()
    def redo(self, batch: int, who: str = "") -> str:
        """Let a `batch` that was undone count again; `who` does so, for the log.

        What was taken back of it before, one by one or on a phone, stays so.

        Parameters
        ----------
        batch
            Its number.
        who
            Who lets it count, for the log.

        Returns
        -------
        str
            A sentence that says what counts again.

        Raises
        ------
        SettingError
            If the batch was not undone, or what it corrected is not as it was before.
        """
        return redo_batch(self, batch, who)

    def numbered(
        self, on: Day | None = None, plant: int | None = None
    ) -> tuple[NumberedInspection, ...]:
        """Return the inspections that count with their numbers, by which `undo` knows them.

        So does `correct_time`.

        Parameters
        ----------
        on
            Their day; None: all days.
        plant
            Their plant, by its number in the grid; None: all plants, in the order of the numbers.

        Raises
        ------
        ObservationError
            If there is no such plant.
        """
        last = len(self.plot.grid) - 1
        if plant is not None and not 0 <= plant <= last:
            raise ObservationError(
                worded("A plant must be 0 to {last}, but it is {plant}.", last=last, plant=plant)
            )
        with self.store.reading() as db:
            return numbered_inspections(db, on, plant)

    def take_drafts(self) -> tuple[str, ...]:
        """Let inspections count that another program added to the file itself.

        They are a batch of their own. Return a sentence for each that does not count, and why; it
        stays as it is. Where more was changed, nothing is taken before that is settled.
        """
        plot, today = (self.plot.grid, self.plant_numbers), local_clock(self.plot.field).today()
        with self._lock, self.store.reading() as db:
            if not drafts.any_waiting(db) or outside_changes.waiting(db):
                return ()
            known = self._read(db)
            found = drafts.read(db, plot, known.settings, known.history.inspections, today)
        if any(one.inspection is not None for one in found):
            try:
                with self._writing() as db:
                    before = self._read(db)
                    held = before.history.inspections
                    found = drafts.read(db, plot, before.settings, held, today)
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
        done = Recorded(batch, len(news), len(known), **batches.n_more(known))
        self._log_seen(db, news, (drafts.SOURCE, ""), done)
        # there are as many rows as before: all is read again
        days = [one.inspection.date[0].item() for one in taken if one.inspection is not None]
        self._refresh(db, settings.day(min(days)))

    def batches(self) -> tuple[Batch, ...]:
        """Return everything recorded, the last one first."""
        with self.store.reading() as db:
            return batches.all_of(db)

    def contents(self, numbers: Sequence[int]) -> dict[int, BatchContents]:
        """Return what batches of inspections and treatments say, by their numbers."""
        grid = self.plot.grid
        with self.store.reading() as db:
            said = batches.contents(db, numbers)
            if not grid.has_faces:
                return said
            vines = treatments.n_vines(db, numbers, self._inside, grid)
        return {number: replace(one, n=vines.get(number, one.n)) for number, one in said.items()}

    def messages(self) -> tuple[KeptMessage, ...]:
        """Return what the imports had to say."""
        with self.store.reading() as db:
            return tables.read_messages(db)


def recorded(
    season: SeasonInspections, inspections: Inspections, source: str, who: str = "", *,
    confirmed: bool = False, into: int | None = None,
) -> Recorded:  # fmt: skip
    """Add inspections as `Season.record` does, without a warning of days that have not come.

    For robots and pages: the ones drive days to come, the others say themselves what has not come.
    """
    _must_count_finds(inspections)
    (done,) = season.record_all([(inspections, source)], who, confirmed=confirmed, into=into)
    return done


def _must_count_finds(inspections: Inspections) -> None:
    """Raise `ObservationError` where a find counts 0; seasons of old hold such ones."""
    nothing = (inspections.result == FOUND) & (inspections.count == 0)
    if nothing.any():
        raise ObservationError(
            worded(
                "A find must count above 0, but result {value} counts 0. Say clean, or give no "
                "count (NaN).",
                value=int(nothing.argmax()) + 1,
            )
        )


def _doubt_days_to_come(inspections: Inspections, begins: date, clock: LocalClock) -> None:
    """Warn whoever called a checked method of a season of what was inspected after today.

    In a season that has not begun either it is a rehearsal.
    """
    today = clock.today()
    ahead = inspections.date[to_come(inspections.date, today)]
    if begins <= today and len(ahead):
        warnings.warn(
            f"Inspections must be of days that have come, but {ahead.max()} has not: it is {today} "
            "on the plot. If it is a slip, take them back with season.undo(), and record them with "
            "their day.",
            ImportDoubt,
            stacklevel=4,
        )


def _by_those_known(known: dict[str, str], told: Inspections) -> Inspections:
    """Return inspections whose people are written as they are known."""
    names = [as_written(known, str(name)) for name in told.who]
    return replace(told, who=np.array(names, object))
