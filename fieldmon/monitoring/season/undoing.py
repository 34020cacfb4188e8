"""Batches and inspections of a season taken back, and batches that count again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import phone_tables
from fieldmon.monitoring.inspecting import batches, undone_batches
from fieldmon.monitoring.inspecting.undone_batches import Undone
from fieldmon.monitoring.phones.people import written_in

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.monitoring.estimates.season_contents import SeasonChange
    from fieldmon.monitoring.season.open_season import OpenSeason


def undo_with_batches(
    season: OpenSeason, batch: int | None = None, inspection: int | None = None, who: str = ""
) -> Undone:
    """Do what `Season.undo` does; return also which batches `redo` then lets count again.

    Raise `SettingError` as it does.
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
    signs = season.plot.grid.line_signs
    with season.changing() as change:
        db = change.db
        if inspection is None:
            number, before = undone_batches.to_undo(db, batch)
            changed, said = undone_batches.undo(db, number, signs)
            what = {"batch": number, **({"but": before} if before else {})}
        else:
            changed, said = undone_batches.undo_one(db, inspection, signs)
            what = {}
        _note(change, who, changed, said, **what)
        again = undone_batches.to_redo(db, changed)
        if again is None:
            return Undone(said, None)
        but = season_log.left_out_of(db, again)
        return Undone(said, again, undone_batches.to_redo_first(db, again, but))


def let_hold(season: OpenSeason, plant: int, on: date, result: int, who: str = "") -> int:
    """Take back what else was found at a plant on a day than `result`; return how many that were.

    `result` is `CLEAN` or `FOUND`. Where it is not recorded by now, or nothing else is, nothing is
    taken back.
    """
    counts = "SELECT fid, result FROM inspections WHERE undone = 0 AND plant = ? AND date = ?"
    with season.store.reading() as db:
        told = [*db.execute(counts, (plant, str(on)))]
    wrong = RESULT_NAMES[CLEAN if result == FOUND else FOUND]
    if RESULT_NAMES[result] not in {said for _, said in told}:
        return 0
    others = [fid for fid, said in told if said == wrong]
    for fid in others:
        undo_with_batches(season, inspection=fid, who=who)
    return len(others)


def redo_batch(season: OpenSeason, batch: int, who: str = "") -> str:
    """Do what `Season.redo` does; raise `SettingError` as it does."""
    with season.changing() as change:
        db = change.db
        but = season_log.left_out_of(db, batch)
        changed, said = undone_batches.redo(db, batch, but, season.plot.grid.line_signs)
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
        _note(change, who, changed, said, batch=batch)
    return said


def _note(change: SeasonChange, who: str, changed: set[int], said: str, **what: object) -> None:
    """Log what was taken back, or counts again, and say from which day on."""
    db = change.db
    states = season_log.states(db, changed)
    season_log.append(db, "undone", written_in(db, who), states=states, said=said, **what)
    change.reaches(min(batches.first_day(db, one) for one in changed))
