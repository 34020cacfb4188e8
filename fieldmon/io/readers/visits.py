"""Which records of a file are of one visit: a robot that passes a plant tells of it each time."""

from __future__ import annotations

from math import dist
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.io.formats.layer import text
from fieldmon.io.parse.clock import as_clocks, clock_time
from fieldmon.io.parse.columns import is_record_id, is_score, is_time
from fieldmon.io.parse.dates import dates
from fieldmon.io.readers.inspection_file.columns import is_own

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer

    Floats = NDArray[np.float64]

#: records no farther apart than this are of one visit
VISIT_S = 600.0
# places are the same within a position's accuracy, which must tell plants apart, and within this
_SAME_M = 0.5
_TELLS_PLANTS_M = 1.0
_EXACT_M = 0.01


def visits_of(alike: Iterable[Hashable], at_s: Floats) -> NDArray[np.intp]:
    """Return the first record of the visit of each, ``(k,)``.

    Parameters
    ----------
    alike
        What each says of what; only those that say the same can be of one visit.
    at_s
        ``(k,)`` seconds from anywhere; NaN where no time is known: of any visit that there is.
    """
    keys, first = list(alike), np.arange(len(at_s))
    began: dict[Hashable, int] = {}
    for k in np.argsort(at_s, kind="stable").tolist():  # those of no time come last
        key = keys[k]
        if key not in began or at_s[k] - at_s[began[key]] > VISIT_S:
            began[key] = k
        first[k] = began[key]
    return first


def first_of_visits(alike: Iterable[Hashable], at_s: Floats) -> NDArray[np.intp]:
    """Return the first record of each visit, in the file's order; see `visits_of`."""
    return np.unique(visits_of(alike, at_s))


def telling(
    layer: Layer, records: NDArray[np.intp], silent: Iterable[str | None]
) -> dict[str, list[str]]:
    """Return the cells of some records by each column that tells one thing looked at from another.

    Parameters
    ----------
    layer
        All records.
    records
        ``(k,)`` numbers of those that are asked for.
    silent
        Columns that tell nothing of it. Nor do numbers of records, confidences, notes, and times
        and days that can be read.
    """
    passed, told = set(silent), dict[str, list[str]]()
    for name, values in layer.columns.items():
        if name in passed or is_score(name) or is_own("notes", name):
            continue
        if is_record_id(name, (text(v) for v in values)):
            continue
        cells = [text(v) for v in values[records]]
        distinct = list(set(cells))
        says = distinct
        if is_time(name) or is_own("time", name):
            says = _without_times(as_clocks(name, distinct))
        known = {c: " ".join(s.casefold().split()) for c, s in zip(distinct, says, strict=True)}
        told[name] = [known[cell] for cell in cells]
    return told


def _without_times(cells: list[str]) -> list[str]:
    """Return cells, empty where they hold a time or a day."""
    days = dates(np.array(cells, dtype=object)).day
    none = np.isnat(days).tolist()
    return [c if no and not clock_time(c) else "" for c, no in zip(cells, none, strict=True)]


def same_places(xy_m: Floats, accuracy_m: Floats) -> NDArray[np.intp]:
    """Return the number of the first record at the place of each, ``(k,)``.

    Parameters
    ----------
    xy_m
        ``(k, 2)`` positions in metres.
    accuracy_m
        ``(k,)`` of them; NaN where it is not known: they are the same within a centimetre.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 - not all tables have positions

    _, first, same = np.unique(np.round(xy_m, 3), axis=0, return_index=True, return_inverse=True)
    place = first[same.ravel()]
    told = ~(accuracy_m > _TELLS_PLANTS_M)
    reach = np.clip(np.nan_to_num(accuracy_m), _EXACT_M, _SAME_M)
    some = np.flatnonzero(told & (place == np.arange(len(place))))
    if len(some) < 2:
        return place
    # most stand alone
    next_m = cKDTree(xy_m[some]).query(xy_m[some], k=2, distance_upper_bound=_SAME_M)[0][:, 1]
    reach_m = reach.tolist()
    at_m: list[tuple[float, float]] = [(x, y) for x, y in xy_m.tolist()]
    cells: dict[tuple[int, int], list[int]] = {}
    for k in some[next_m <= reach[some]].tolist():
        column, row = (int(c // _SAME_M) for c in at_m[k])
        around = ((column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        others = (one for cell in around for one in cells.get(cell, ()))
        apart = ((dist(at_m[one], at_m[k]), one) for one in others)
        near = min(
            (one for one in apart if one[0] <= min(reach_m[one[1]], reach_m[k])), default=None
        )
        if near is None:
            cells.setdefault((column, row), []).append(k)
        else:
            place[k] = near[1]
    return place[place]
