"""What people want of a day besides, kept with the season: whoever is out goes by it, too."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring.changes.transactions import get_meta, set_meta
from fieldmon.planning.wishes import Wishes

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from fieldmon.monitoring.season.open_season import OpenSeason


class KeptWishes(NamedTuple):
    """Wishes that are kept of a day, and the number of the last route that was kept before."""

    wishes: Wishes = Wishes()
    since: int = 0


NO_WISHES = KeptWishes()


def kept_in(db: sqlite3.Connection, on: date, n: int) -> KeptWishes:
    """Return what is kept as wanted of a day, of `n` plants.

    Raise `FileProblem` where the file says what cannot be.
    """
    said = get_meta(db, _key(on))
    if said is None:
        return NO_WISHES
    try:
        wanted, unwanted, since = json.loads(said)
        return KeptWishes(Wishes(_plants(wanted, n), _plants(unwanted, n)), int(since))
    except (ValueError, TypeError, OverflowError, RecursionError):
        raise FileProblem(
            worded(
                "What is wanted of {day} must be two lists of plants of this plot and a number, "
                "but the season says: {said}. Another program changed it: take an earlier copy of "
                "the file.",
                day=on, said=said[:80],
            )
        ) from None  # fmt: skip


def wishes_kept(season: OpenSeason, on: date) -> Wishes:
    """Return what is kept as wanted of a day besides.

    Examples
    --------
    >>> from datetime import date
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> season = fm.Season.create(Path(mkdtemp()) / "gate.gpkg", plot)
    >>> keep_wishes(season, date(2026, 11, 18), fm.Wishes(unwanted=(7,)))
    >>> wishes_kept(season, date(2026, 11, 18))
    Wishes(wanted=(), unwanted=(7,))
    """
    with season.store.reading() as db:
        return kept_in(db, on, len(season.plant_numbers.line)).wishes


def keep_wishes(season: OpenSeason, on: date, wishes: Wishes) -> None:
    """Keep what is wanted of a day, instead of what was; plans of the day go by it from now on."""
    if wishes_kept(season, on) == wishes:
        return
    with season.store.writing() as db:
        (last,) = db.execute("SELECT coalesce(max(fid), 0) FROM routes").fetchone()
        said = json.dumps([wishes.wanted, wishes.unwanted, last], separators=(",", ":"))
        set_meta(db, _key(on), said)


def _key(on: date) -> str:
    return f"wishes {on}"


def _plants(said: object, n: int) -> tuple[int, ...]:
    if not isinstance(said, list) or any(type(k) is not int or not 0 <= k < n for k in said):
        raise TypeError
    return tuple(said)
