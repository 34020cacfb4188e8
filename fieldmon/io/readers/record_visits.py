"""Which records tell of one visit, and so count once; and which of one visit disagree."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.io.import_report import ImportMessage, doubtful, guessed
from fieldmon.io.parse.columns import is_position
from fieldmon.io.readers.visits import VISIT_S, first_of_visits, same_places, telling
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.records import Records
    from fieldmon.io.readers.record_columns import RecordColumns


# roles of columns that say where a record lies
_LIES = frozenset({"lon", "lat", "position", "x", "y", "crs", "accuracy"})


class RecordVisits(NamedTuple):
    """Which records can be of one visit with others, ``(k,)``; where and when each is, ``(n,)``."""

    known: NDArray[np.intp]
    place: NDArray[np.intp]
    at_s: NDArray[np.float64]


def places_of(records: Records) -> NDArray[np.intp]:
    """Return a number for the place of each record ``(n,)``; of those with none their own."""
    place = np.arange(len(records))
    there = np.flatnonzero(np.isfinite(records.lonlat).all(axis=1))
    if len(there):
        lonlat = records.lonlat[there]
        east = np.cos(np.radians(np.median(lonlat[:, 1])))
        xy_m = (lonlat - lonlat[0]) * M_PER_DEGREE * [east, 1.0]
        place[there] = there[same_places(xy_m, records.accuracy_m[there])]
    return place


def each_visit_once(
    records: Records, table: RecordColumns, visits: RecordVisits
) -> tuple[NDArray[np.intp], list[ImportMessage]]:
    """Return the first record of each visit, and what there is to say of the others.

    A robot tells of a plant each time that it sees it, and that is one look. Records without a day,
    and of positions that tell no plants apart, stay as they are; so do those of which any other
    column tells that they are of something else.
    """
    some = records.take(visits.known)
    columns = (visits.place[visits.known], some.day.astype(np.int64), some.present, some.count)
    read = [np.nan_to_num(column.astype(np.float64), nan=-1.0).tolist() for column in columns]
    alike = list(zip(*read, some.species.tolist(), some.stage.tolist(), strict=True))
    often = Counter(alike)
    again = np.flatnonzero([often[one] > 1 for one in alike])
    if not len(again):
        return np.arange(len(records)), []
    alike, which = [alike[k] for k in again.tolist()], visits.known[again]
    at_s = visits.at_s[which]
    lies = {name for name in table.layer.columns if is_position(name)}
    rest = telling(table.layer, which, lies | {table.named(role) for role in _LIES})
    says = list(zip(alike, *rest.values(), strict=True))
    first = first_of_visits(says, at_s)
    messages: list[ImportMessage] = []
    if n_again := len(which) - len(first):
        said = worded(
            "{n} {n:record repeats|records repeat} what another says of the same place and day, "
            "within {minutes} minutes or with no time: one visit, which counts once.",
            n=n_again,
            minutes=round(VISIT_S / 60),
        )
        messages.append(guessed(said))
    if n_more := len(first) - len({says[k] for k in first.tolist()}):
        said = worded(
            "{n} {n:record tells|records tell} the same of a place and day as another at another "
            "time: each visit counts.",
            n=n_more,
        )
        messages.append(doubtful(said))
    if n_other := len(first) - len(first_of_visits(alike, at_s)):
        said = worded(
            "{n} {n:record differs|records differ} from another of the same place and time only "
            "in {columns}: each counts.",
            n=n_other,
            columns=first_few(_differing(alike, rest), 3),
        )
        messages.append(guessed(said))
    later = np.delete(which, first)
    return np.delete(np.arange(len(records)), later), messages


def _differing(alike: list[tuple[object, ...]], rest: dict[str, list[str]]) -> list[str]:
    """Return the columns in which records differ that are alike."""
    n = len(set(alike))
    return [
        repr(name) for name, cells in rest.items() if len(set(zip(alike, cells, strict=True))) > n
    ]


def disagreeing(records: Records, place: NDArray[np.intp]) -> list[ImportMessage]:
    """Return a doubt about records of one place ``(k,)`` and day that disagree."""
    if len(records) < 2:
        return []
    day = records.day.astype(np.int64).astype(np.float64)
    kinds = [np.unique(v, return_inverse=True)[1] for v in (records.species, records.stage)]
    visit: list[NDArray[np.generic]] = [place, day, *kinds]
    count = np.nan_to_num(records.count, nan=-1)
    n_visits, n_stated = _n_distinct(visit), _n_distinct([*visit, count, records.present])
    if n_stated == n_visits:
        return []
    return [
        doubtful(
            worded(
                "{n} {n:record gives|records give} another count for a place and day that "
                "another record "
                "already has.",
                n=n_stated - n_visits,
            )
        )
    ]


def _n_distinct(columns: list[NDArray[np.generic]]) -> int:
    """Return how many different rows columns ``(n,)`` make."""
    order = np.lexsort(columns)
    new = np.zeros(len(order) - 1, dtype=bool)
    for column in columns:
        new |= np.diff(column[order]) != 0
    return int(new.sum()) + 1
