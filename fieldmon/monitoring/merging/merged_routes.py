"""Routes of two copies with their stops, in the order in which they were given out."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merged_rows import key_of
from fieldmon.planning.members import person_key

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Hashable, Iterable

    from fieldmon.monitoring.merging.merged_rows import TableRows
    from fieldmon.monitoring.treating.treatments import Row


#: what a route is known by in every copy: also how often it had been given out by then
_KNOWN_BY = ("day", "person", "digest", "again")


class _KeptRoute(NamedTuple):
    """A route and the rows of its stops."""

    row: Row
    stops: list[Row]


def merge(both: tuple[sqlite3.Connection, sqlite3.Connection], copies: list[TableRows]) -> None:
    """Let the first have the routes of both, numbered in the order in which they were given out.

    One that was given out again after another counts as often as it was.
    """
    given_out = _given_out(both)
    for copied in copies:
        _tell_apart(copied["routes"])
        _say_when(copied["routes"], given_out)
    revisions: Counter[Hashable] = Counter()
    stops: list[Row] = []
    ordered = _in_order(copies, _once(copies))
    for number, route in enumerate(ordered, 1):
        of = route.row["day"], route.row["person"]
        revisions[of] += 1
        route.row["revision"] = revisions[of]
        stops += [{**stop, "route": number} for stop in route.stops]
    merged_rows.write(both[0], schema.ROUTES, [route.row for route in ordered])
    merged_rows.write(both[0], schema.STOPS, stops)


def _given_out(both: Iterable[sqlite3.Connection]) -> dict[Hashable, list[str]]:
    """Return when each route was kept, by day, person and digest, as the logs of both say."""
    told: dict[Hashable, set[str]] = {}
    for db in both:
        for one in logged_days.given_out(db):
            told.setdefault((one.date, person_key(one.who), one.digest), set()).add(one.at)
    return {key: sorted(at) for key, at in told.items()}


def _tell_apart(routes: list[Row]) -> None:
    """Note of a copy's routes whose each is, and the how manieth of all that are like it."""
    given: Counter[Hashable] = Counter()
    for route in routes:
        route["person"] = person_key(route["who"])
        key = key_of(route, _KNOWN_BY[:-1])
        given[key] += 1
        route["again"] = given[key]


def _say_when(routes: list[Row], given_out: dict[Hashable, list[str]]) -> None:
    """Note of a copy's routes, which are told apart, when each was given out; "": never."""
    given = Counter(key_of(route, _KNOWN_BY[:-1]) for route in routes)
    before = ""
    for route in routes:
        at = given_out.get(key_of(route, ("date", "person", "digest")), [])
        later = given[key_of(route, _KNOWN_BY[:-1])] - route["again"]
        # a clock may be set back: what stands below is later
        before = route["at"] = max(before, at[-1 - later] if later < len(at) else "")


def _once(copies: list[TableRows]) -> dict[tuple[Any, ...], _KeptRoute]:
    """Return the routes of both by what they are known by, with the stops of the first copy."""
    found: dict[tuple[Any, ...], _KeptRoute] = {}
    for copied in copies:
        stops: dict[int, list[Row]] = {}
        for stop in copied["stops"]:
            stops.setdefault(stop["route"], []).append(stop)
        for row in copied["routes"]:
            route = _KeptRoute(row, stops.get(row["fid"], []))
            kept = found.setdefault(key_of(row, _KNOWN_BY), route).row
            kept["revision"] = min(kept["revision"], row["revision"])
            kept["at"] = max(kept["at"], row["at"])
    return found


def _in_order(
    copies: list[TableRows], found: dict[tuple[Any, ...], _KeptRoute]
) -> list[_KeptRoute]:
    """Return routes as they were given out; those that both copies begin with stay first."""
    begin = merged_rows.alike_at_first(copies, "routes", _KNOWN_BY)
    order = ("at", "day", "person", "revision", "digest", "again")
    rest = sorted(
        (key for key in found if key not in begin), key=lambda key: key_of(found[key].row, order)
    )
    return [found[key] for key in (*begin, *rest)]
