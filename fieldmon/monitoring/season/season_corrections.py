"""What was recorded wrong in a season: corrected here, or taken from another program or a copy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.monitoring.changes import copy_corrections, corrections, outside_changes, season_log
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.phones.people import written_in
from fieldmon.monitoring.season.season_copies import SeasonCopies
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from pathlib import Path

    from fieldmon.compute.day_arguments import Day, TimeOfDay


@checked
class SeasonCorrections(SeasonCopies):
    """The corrections of a season; each time they are a batch, which can be undone."""

    def correct(self, who: str, *, confirmed: bool = False) -> int:
        """Take what another program changed of inspections as corrections; return how many.

        They are a batch of their own, of `who` corrects; undoing it brings back what was before.
        What says nothing else than before is put back as it was, and is none.

        Parameters
        ----------
        who
            Who corrects, for the log.
        confirmed
            Whether they count where they contradict what else is recorded.

        Raises
        ------
        FileProblem
            If more than inspections was changed, or what makes no sense, as a day to come.
        ContradictionError
            If they contradict what else is recorded and are not confirmed.
        """
        with self._lock, self.store.writing() as db:
            outside_changes.refuse_more(db)
            outside_changes.refuse_days_to_come(db, local_clock(self.plot.field).today())
            settings, plot = settings_of(db), (self.plot.grid, self.plant_numbers)
            who = written_in(db, who)
            taken = outside_changes.correct(db, plot, settings, who)
            self._may_be_taken(db, taken, confirmed=confirmed)
            self._corrected(db, taken, who)
        return len(taken)

    def correct_time(
        self,
        inspection: int,
        at: TimeOfDay | None,
        who: str,
        on: Day | None = None,
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
            corrections.must_have_come(self.plot.field, on or day, at or held_at)
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

    def take_corrections(self, copy: Path, name: str, who: str, *, confirmed: bool = False) -> int:
        """Take what was corrected or deleted in a `copy` of this season; return how many were new.

        They are a batch of their own.

        Parameters
        ----------
        copy
            The file.
        name
            What the copy is called.
        who
            Who takes them over.
        confirmed
            Whether they count where they contradict what else is recorded.

        Raises
        ------
        FileProblem
            If a changed row makes no sense or is not here.
        SettingError
            If nobody is named.
        ContradictionError
            If they contradict what else is recorded and are not confirmed.
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
            outside_changes.refuse_days_to_come(theirs, local_clock(self.plot.field).today())
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
