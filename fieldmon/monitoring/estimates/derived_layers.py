"""Layers that follow from the causes: rebuilt with every change, held to their digests."""

from __future__ import annotations

from functools import lru_cache
from itertools import zip_longest
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.digest import digest
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring.estimates import day_figures
from fieldmon.monitoring.estimates.mornings import causes_of, rules
from fieldmon.monitoring.estimates.plant_states import TREATED_SINCE, hot_spots_on, latest_states
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import blob, insert, touch

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.monitoring.estimates.history import History
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

#: of this season: what records from before say is in the layer `observations`
STATES = {
    -1: "never inspected",
    0: "looked clean",
    1: "found infested",
    TREATED_SINCE: "found, treated since",
}
_DIGITS = 9  # of a chance; a digest must not hang on the last bit of another processor


def map_digest(chance: NDArray[np.float64]) -> str:
    """Return a short name for a chance map ``(n,)``: the same for the same map only."""
    return digest(np.round(chance, _DIGITS).astype("<f8"), length=24, end=b"")


def refresh(
    db: sqlite3.Connection,
    plot: Plot,
    history: History,
    morning: Callable[[int], Belief],
    since: int = 0,
) -> int:
    """Write the layers anew, as of the last day on which anything happened; return that day.

    What is known of days before `since` did not change.
    """
    worked = np.unique(history.days).tolist()
    planned = [day for (day,) in db.execute("SELECT DISTINCT day FROM routes")]
    treated = [treatment.day for treatment in history.treatments]
    days: list[int] = sorted({0, *worked, *planned, *treated})
    kept = {day for (day,) in db.execute("SELECT day FROM days WHERE day < ?", (since,))}
    gone = [(day,) for day in kept.difference(days)]
    db.executemany("DELETE FROM days WHERE day = ?", gone)
    db.execute("DELETE FROM days WHERE day >= ?", (since,))
    rows = [_day_row(history, morning(day), day) for day in days if day not in kept]
    insert(db, schema.DAYS, rows)
    day_figures.note_rules(db, rules(), since)
    _name_causes(db, history, morning(days[-1]), days[-1])
    spots = _write_spots(db, plot, history, days[-1])
    _write_states(db, history, spots, (days[-1], morning(days[-1])))
    db.execute(f"DELETE FROM {schema.LEARNT.name}")  # noqa: S608 - ours
    learnt = history.learnt(morning(days[-1]), days[-1])
    insert(db, schema.LEARNT, [(one.name, one.value, one.low, one.high) for one in learnt])
    return days[-1]


def _day_row(history: History, morning: Belief, day: int) -> tuple[object, ...]:
    today = history.on(day).inspected
    estimate = history.estimate(morning, day)
    plants = today.plant, today.plant[today.result == FOUND]
    inspected, found = (len(np.unique(which)) for which in plants)
    return (
        *(day, str(history.date_of(day)), inspected, found),
        *(estimate.expected, estimate.low, estimate.high, estimate.chance_clean),
        map_digest(morning.chance),
        None,
    )


def _name_causes(db: sqlite3.Connection, history: History, morning: Belief, day: int) -> None:
    """Note of the last day from what its figures follow: so they need not be worked out again."""
    causes = causes_of(history, day, history.estimate(morning, day))
    db.execute("UPDATE days SET causes = NULL WHERE causes IS NOT NULL")
    db.execute("UPDATE days SET causes = ? WHERE day = ?", (causes, day))


def _write_spots(db: sqlite3.Connection, plot: Plot, history: History, day: int) -> HotSpots:
    spots = hot_spots_on(history, day)
    db.execute("DELETE FROM hot_spots")
    rows = []
    for h in range(len(spots)):
        area = spot_area(plot, spots, h)
        counts = (int(each[h]) for each in (spots.found, spots.inspected, spots.plants))
        chances = (float(each[h]) for each in (spots.expected, spots.p, spots.q))
        rows.append((blob(area), h + 1, *counts, *chances))
    insert(db, schema.HOT_SPOTS, rows)
    touch(db, schema.HOT_SPOTS.name, plot.field.boundary.bounds)
    return spots


def spot_area(plot: Plot, spots: HotSpots, h: int) -> MultiPolygon:
    """Return the ground of a hot spot, lon/lat: its plants and half a row around them."""
    grid = plot.grid
    plants = np.flatnonzero(spots.of_plant == h)
    starts = np.concatenate([[0], np.flatnonzero(~_adjacent_to_next(grid, plants)) + 1])
    stretch = tuple(starts.tolist())
    around = _ground_around(grid.xy_m[plants].tobytes(), stretch, grid.row_spacing_m)
    parts = shapely.get_parts(grid.frame.geometry_lonlat(around))
    return MultiPolygon(list(parts))


def _adjacent_to_next(grid: PlantGrid, plants: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return whether each plant but the last stands in a row just before the next one given."""
    far_m = np.hypot(*np.diff(grid.xy_m[plants], axis=0).T)
    same_row = np.diff(grid.row[plants]) == 0
    beside: NDArray[np.bool_] = (np.diff(plants) == 1) & same_row & (far_m <= grid.row_spacing_m)
    return beside


@lru_cache(maxsize=64)  # a tap changes one spot of many
def _ground_around(xy_m: bytes, starts: tuple[int, ...], row_m: float) -> shapely.Geometry:
    """Return the ground around plants; from each of `starts` on they stand in one line.

    Around lines it takes a tenth of what it takes around each plant: circles overlap many times.
    """
    stretches = np.split(np.frombuffer(xy_m).reshape(-1, 2), starts[1:])
    # a line of one plant begins and ends there
    lines = [np.repeat(m, 2, axis=0) if len(m) == 1 else m for m in stretches]
    plants = shapely.MultiLineString(lines)
    around = shapely.buffer(plants, 1.5 * row_m, quad_segs=4)
    return shapely.buffer(around, -row_m, quad_segs=4)


def _write_states(
    db: sqlite3.Connection,
    history: History,
    spots: HotSpots,
    latest: tuple[int, Belief],
) -> None:
    day, morning = latest
    name = {day: str(history.date_of(day)) for day in np.unique(history.days).tolist()}
    rows = zip(
        range(1, len(history.grid) + 1),
        [STATES[state] for state in latest_states(history, day, own=True).tolist()],
        [name.get(last) for last in history.last_inspected(day).tolist()],
        [None if h < 0 else h + 1 for h in spots.of_plant.tolist()],
        strict=True,
    )
    # a tap changes what is known of a few plants: only these are written
    before = db.execute(
        "SELECT fid, state, last_inspected, hot_spot FROM plant_state ORDER BY fid"
    ).fetchall()
    changed = [row for row, old in zip_longest(rows, before) if row != old and row is not None]
    db.executemany(
        "INSERT INTO plant_state (fid, state, last_inspected, hot_spot) VALUES (?, ?, ?, ?) "
        "ON CONFLICT (fid) DO UPDATE SET state = excluded.state, "
        "last_inspected = excluded.last_inspected, hot_spot = excluded.hot_spot",
        changed,
    )
    _write_chances(db, np.round(history.in_hindsight(morning, day).chance, 6).tolist())
    for table in (schema.PLANT_STATE, schema.CHANCE, schema.DAYS):
        touch(db, table.name)


def _write_chances(db: sqlite3.Connection, chances: list[float]) -> None:
    """Let plants have these chances, in one statement: a night changes those of all of them."""
    db.create_function("chance_of", 1, [None, *chances].__getitem__)
    db.execute(
        "UPDATE plant_state SET chance = chance_of(fid) "
        "WHERE fid BETWEEN 1 AND ? AND chance IS NOT chance_of(fid)",
        (len(chances),),
    )
    db.create_function("chance_of", 1, None)
