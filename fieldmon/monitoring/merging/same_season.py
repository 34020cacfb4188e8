"""Whether two files are copies of one season: of one plot, begun at one moment, for one pest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import FileProblem
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.merging.merged_inspections import counting
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.treating import treatments

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.file.geopackage import GeoPackageTable

_NAMED_PLOTS = 3


#: what makes a season this one, and must be the same in both
SAME = (schema.ARRAYS, schema.PLOTS, schema.PLACES, schema.ROWS, schema.PLANTS, schema.RECORDS)

# and a plot this one
_PLANTING = (schema.ROWS, schema.PLANTS)


def refuse_strangers(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    """Raise `FileProblem` unless both are copies of one season."""
    _refuse_two_plots(db, other)
    _refuse_begun_apart(*(settings_log.begun(one) for one in (db, other)))
    for table in SAME:
        if not _is_same(db, other, table):
            why = worded(
                "they differ in the layer {name}: they are two seasons, or another program changed "
                "one of them",
                name=table.name,
            )
            raise _strangers(why)
    at, other_at = (settings_log.begun_at(one) for one in (db, other))
    if at and other_at:
        _refuse_begun_apart(_moment(at), _moment(other_at))
    else:  # too old to say it
        refuse_another_pest(db, other)


def _refuse_two_plots(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    if _is_same(db, other, schema.PLOTS) or are_of_one_plot(db, other):
        return
    here, there = (
        first_few([name or "" for (name,) in one.execute("SELECT name FROM plots")], _NAMED_PLOTS)
        for one in (db, other)
    )
    if here == there:
        raise _strangers(worded("one is of another plot than the other, or of another planting"))
    raise _strangers(
        worded("one is of the plot {here} and the other of {there}", here=here, there=there)
    )


def _refuse_begun_apart(here: str, there: str) -> None:
    if here != there:
        raise _strangers(
            worded(
                "one was begun on {here} and the other on {there}: they are two seasons",
                here=here,
                there=there,
            )
        )


def _strangers(why: Worded) -> FileProblem:
    return FileProblem(
        worded(
            "Two copies of one season can be merged, but {why}. Leave each in its file. If both "
            "are of one plot and look for the same, record what was found in the one into the "
            "other with Record in the app, or with: fieldmon record",
            why=why,
        )
    )


def _moment(at: str) -> str:
    """Return a moment as people read it."""
    return f"{at.replace('T', ' ').removesuffix('Z')} UTC"


def refuse_another_pest(db: sqlite3.Connection, other: sqlite3.Connection) -> None:
    """Raise `FileProblem` where the two are of different pests: finds would be of the wrong one."""
    here, there = _pests(db, other)
    if are_of_two_pests(db, other):
        raise FileProblem(
            worded(
                "What was found can come from one season into another if both look for one pest, "
                "but one looks for {here} and the other for {there}: finds would become those of "
                "another pest. Leave each in its file; where one of them names the wrong pest, "
                "name the right one there first with: fieldmon change --pest",
                here=here,
                there=there,
            )
        )


def of_no_pest(db: sqlite3.Connection, other: sqlite3.Connection) -> Iterator[str]:
    """Yield a sentence where `db` names a pest, and another names none but found something."""
    pest, named = _pests(db, other)
    if pest and not named and counting(other) - counting(db):
        yield worded(
            "Only one copy names a pest, {pest}: what the other found counts as found of it, too. "
            "If that one looked for another pest, undo its batches.",
            pest=pest,
        )


def are_of_two_pests(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether two seasons name pests by now that differ."""
    here, there = _pests(db, other)
    return bool(here and there and here != there)


def _pests(db: sqlite3.Connection, other: sqlite3.Connection) -> tuple[str, str]:
    return settings_log.pest(db), settings_log.pest(other)


def are_copies(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether two files are copies of one season, however far they went apart."""
    try:
        refuse_strangers(db, other)
    except FileProblem:
        return False
    return not are_of_two_pests(db, other) or hold_in_common(db, other)


def hold_in_common(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether an inspection or a treatment that counts stands in both."""
    held = []
    for one in (db, other):
        treated = frozenset[str]().union(*treatments.counting(one))
        held.append(counting(one) | treated)
    return not held[0].isdisjoint(held[1])


def are_of_one_plot(db: sqlite3.Connection, other: sqlite3.Connection) -> bool:
    """Return whether two seasons have the same rows and plants."""
    return all(_is_same(db, other, table) for table in _PLANTING)


def planting(db: sqlite3.Connection) -> str:
    """Return what stands for the rows and plants of a season: others of the plot have the same."""
    return digest(*(_all_of(db, table) for table in _PLANTING))


def _is_same(db: sqlite3.Connection, other: sqlite3.Connection, table: GeoPackageTable) -> bool:
    return _all_of(db, table) == _all_of(other, table)


def _all_of(db: sqlite3.Connection, table: GeoPackageTable) -> list[object]:
    names = ", ".join(table.names)
    wanted = f"SELECT {names} FROM {table.name} ORDER BY fid"  # noqa: S608 - names of ours
    return db.execute(wanted).fetchall()
