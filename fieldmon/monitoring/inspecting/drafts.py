"""Inspections that another program (QGIS, QField) added to the season: drafts, and who counts.

A draft has no digest. It counts from the season's next opening on, if it says what was seen at
which plant and when; what does not stays a draft, and is told of.
"""

from __future__ import annotations

from contextlib import suppress
from datetime import date
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, COUNT
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.parse.result_words import GONE, gone_note
from fieldmon.monitoring.file.geopackage import beside_plot, geometry, touch
from fieldmon.monitoring.file.schema import INSPECTIONS
from fieldmon.monitoring.inspecting import inspection_lots, inspection_table, repeated_recordings
from fieldmon.monitoring.inspecting.contradictions import contradictions, said_before

if TYPE_CHECKING:
    import sqlite3

    from numpy.typing import NDArray

    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.grid import PlantGrid, PlantNumbers

SOURCE = "added by another program"
# by the index of digests that count, which is small where nothing waits
_DRAFTS = "digest IS NULL AND undone = 0"
_SAID = {"found": PRESENT, "clean": ABSENT, "skipped": UNKNOWN, GONE: UNKNOWN}


class Draft(NamedTuple):
    """An inspection that another program added.

    Parameters
    ----------
    row
        Its number in the layer of inspections.
    inspection
        What it says, or None.
    why
        Why it does not count; "" where it does.
    known
        The inspection that is held already, beside which it says more; None: it is new.
    is_note
        Whether that is a note.
    """

    row: int
    inspection: Inspections | None
    why: str = ""
    known: Inspections | None = None
    is_note: bool = False
    fills: bool = False

    @property
    def sentence(self) -> str:
        """Return for people why it does not count."""
        return worded(
            "Finding {row} (fid, in the layer Findings), which another program added, does not "
            "count: {why} Correct it there, or delete it.",
            row=self.row,
            why=self.why if self.why.endswith(".") else worded("{why}.", why=self.why),
        )


def any_waiting(db: sqlite3.Connection) -> bool:
    """Tell whether there are drafts."""
    found = db.execute(f"SELECT 1 FROM inspections WHERE {_DRAFTS} LIMIT 1")  # noqa: S608 - ours
    return found.fetchone() is not None


def read(
    db: sqlite3.Connection,
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    held: Inspections,
    today: date,
) -> list[Draft]:
    """Return the drafts of a season, besides those that say no more than it holds already.

    `held` are the inspections that count. Of two drafts that contradict, the first counts. One of
    a day after `today` does not, where others are of days that have come.
    """
    names = ("geom", *(column.kept for column in COLUMNS))
    wanted = f"SELECT fid, {', '.join(names)} FROM inspections WHERE {_DRAFTS} ORDER BY fid"  # noqa: S608 - ours
    # as in `_looked_up`
    from fieldmon.io.readers.date_doubts import amid_past  # noqa: PLC0415

    rows = db.execute(wanted).fetchall()
    drafts, first = [], _first_day(held, [dict(zip(names, one[1:], strict=True)) for one in rows])
    for row, *values in rows:
        try:
            one = _inspection(dict(zip(names, values, strict=True)), plot[0])
            if ahead := amid_past(np.append(first, one.date), today):
                drafts.append(Draft(row, None, next(iter(ahead.values()))))
                continue
            inspection_table.rows(one, *plot, settings, (0, ""))  # whether it fits the season
            if said_before(one, held).any():
                for more in repeated_recordings.additions(db, one, held):
                    known = held.take(np.array([more.held]))
                    drafts.append(Draft(row, one, "", known, more.is_note, more.fills))
                continue
            contradictions(one, held).refuse(plot[0])
        except (FieldmonError, ValueError, TypeError) as error:
            why = error.args[0] if isinstance(error, FieldmonError) else str(error)
            drafts.append(Draft(row, None, why))
        else:
            held = held.and_those(one)
            drafts.append(Draft(row, one))
    return drafts


def _first_day(held: Inspections, said: list[dict[str, Any]]) -> NDArray[np.datetime64]:
    """Return the first day of what is held and of what drafts say, ``(k,)``: one, or none."""
    days = [*held.date[:1]]
    for one in said:
        with suppress(ValueError):
            days.append(np.datetime64(str(one["date"])[:10], "D"))
    known = np.array(days, "datetime64[D]")
    return np.sort(known[~np.isnat(known)])[:1]


def keep(
    db: sqlite3.Connection,
    taken: list[Draft],
    plot: tuple[PlantGrid, PlantNumbers],
    settings: MonitoringSettings,
    batch: int,
) -> Inspections:
    """Let drafts count, each in its own row; return what is new of them."""
    news = Inspections.none()
    # first those beside which others may say more
    for draft in sorted(taken, key=lambda one: one.known is not None):
        assert draft.inspection is not None  # noqa: S101 - these count
        (made,) = inspection_table.rows(draft.inspection, *plot, settings, (batch, ""))
        values = dict(zip(INSPECTIONS.names, made, strict=True))
        if draft.known is None:
            news = news.and_those(draft.inspection)
        else:
            values = repeated_recordings.standing_back(db, draft.known, 0, made)
        values["geom"] = beside_plot(db, values["geom"])
        names = ", ".join(f"{name} = ?" for name in values)
        db.execute(
            f"UPDATE inspections SET {names} WHERE fid = ?",  # noqa: S608 - names of ours
            (*values.values(), draft.row),
        )
    touch(db, INSPECTIONS.name)
    return news


def plant_at(place: bytes, named: object, grid: PlantGrid) -> int:
    """Return the plant at a point, which may name it too; raise with the reason if there is none.

    `named` is its number in the grid; None: it names none.
    """
    when = {"when": np.array(["NaT"], "datetime64[s]"), "day": np.array(["NaT"], "datetime64[D]")}
    said = {one.name: np.array([one.from_file(None)]) for one in (COUNT, *BESIDE)}
    return int(_looked_up(_one_row(place, named, PRESENT) | when | said, grid).plant[0])


def _inspection(said: dict[str, Any], grid: PlantGrid) -> Inspections:
    """Return what a draft says; raise with the reason where it makes no sense."""
    on, at, result = said["date"], said["time"], said["result"]
    if on in {None, ""}:
        raise ValueError("it has no date")
    if result not in _SAID:
        raise ValueError(f"its result is none of {', '.join(_SAID)}")
    if result == GONE:
        said = {**said, "notes": gone_note(str(said["notes"] or ""))}
    try:
        day = np.datetime64(date.fromisoformat(str(on)[:10]), "D")
    except ValueError as error:
        raise ValueError(worded("its date {on!r} is not written as 2026-04-06", on=on)) from error
    second = np.nan if at in {None, ""} else inspection_lots.second_of(str(at))
    when = np.datetime64("NaT", "s")
    if not np.isnan(second):
        when = day.astype("datetime64[s]") + np.timedelta64(round(second), "s")
    rows = _one_row(said["geom"], said["plant"], _SAID[str(result)])
    rows |= {"when": np.array([when]), "day": np.array([day])}
    rows |= {one.name: np.array([one.from_file(said[one.kept])]) for one in (COUNT, *BESIDE)}
    return _looked_up(rows, grid)


def _looked_up(rows: dict[str, Any], grid: PlantGrid) -> Inspections:
    """Return what one row says of its plant; raise with the reason where it has none."""
    # readers take a tenth of a second to import, and drafts are few
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows  # noqa: PLC0415
    from fieldmon.io.readers.inspection_options import InspectionOptions  # noqa: PLC0415
    from fieldmon.io.readers.inspections import look_up  # noqa: PLC0415

    found, messages = look_up(InspectionRows(**rows), grid, InspectionOptions())
    if not len(found):
        raise ValueError(messages[0].sentence if messages else "it names no plant")
    return found


def _one_row(place: object, plant: object, result: int) -> dict[str, np.ndarray]:
    from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID  # noqa: PLC0415 - late

    point = geometry(place) if isinstance(place, bytes) else None
    lonlat = (point.x, point.y) if point is not None and not point.is_empty else (np.nan, np.nan)
    return {
        "plant": np.array([-1 if plant is None else int(str(plant))]),
        "line": np.array([UNSAID]),
        "number": np.array([UNSAID]),
        "face": np.zeros(1, np.int8),
        "lonlat": np.array([lonlat], float),
        "accuracy_m": np.array([np.nan]),
        "unread": np.array([""]),
        "result": np.array([result], np.int8),
        "doubt": np.array([""]),
        "source_row": np.ones(1, np.int64),
        "block": np.array([""]),
    }
