"""Settings and tables of labels of two copies: what was chosen last counts, and is said."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, joined, worded
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.merging import merged_rows
from fieldmon.monitoring.merging.merged_rows import key_of
from fieldmon.monitoring.settings import settings_log, settings_words

if TYPE_CHECKING:
    import sqlite3

    from fieldmon.monitoring.merging.merged_rows import TableRows
    from fieldmon.monitoring.treating.treatments import Row

_KNOWN_BY = ("changed", "name", "value")
# parts of what is chosen, as a season's file calls them
_NAMES = {
    "robot": worded("robot"), "prior": worded("prior"), "beliefs": worded("beliefs"),
    "season": worded("season"), "team": worded("team"), "sampler": worded("sampler"),
    "pest": worded("pest"), "weather": worded("weather"),
}  # fmt: skip


def merge_settings(
    db: sqlite3.Connection, copies: list[TableRows]
) -> tuple[tuple[str, ...], list[str]]:
    """Let `db` have the choices of both; return which both chose differently, and what changed."""
    chosen = merged_rows.once(copies, "settings", _KNOWN_BY, "changed")
    before = settings_log.as_written_now(settings_log.now(db))
    merged_rows.write(db, schema.SETTINGS, chosen)
    after = settings_log.as_written_now(settings_log.now(db))
    return _differing(copies, chosen), settings_words.differences(before, after)


def _differing(copies: list[TableRows], merged: list[Row]) -> tuple[str, ...]:
    """Return a sentence for each setting that both chose, unknown to each other, differently."""
    known = [{key_of(row, _KNOWN_BY) for row in copied["settings"]} for copied in copies]
    chosen = [
        {row["name"] for row in copied["settings"] if key_of(row, _KNOWN_BY) not in others}
        for copied, others in zip(copies, reversed(known), strict=True)
    ]
    ours, theirs, now = (
        {row["name"]: str(row["value"]) for row in rows}
        for rows in (*(copied["settings"] for copied in copies), merged)
    )
    said = []
    for name in sorted(chosen[0] & chosen[1]):
        values = ours[name], theirs[name]
        if values[0] != values[1]:
            here, there = _chosen(name, *values)
            said.append(
                worded(
                    "The setting {name} differs: {here} here, {there} there. What was chosen last "
                    "counts: {now}.",
                    name=_NAMES.get(name, name),
                    here=here,
                    there=there,
                    now=here if now[name] == values[0] else there,
                )
            )
    return tuple(said)


def _chosen(name: str, ours: str, theirs: str) -> tuple[str, str]:
    """Return two values of the setting called `name`, short enough to be read."""
    if name == "team":
        return _members(ours), _members(theirs)
    if name not in ("pest", "weather"):
        return _apart(ours, theirs)
    short = settings_log.pest_in if name == "pest" else _weather
    here, there = (short(one) or worded("none") for one in (ours, theirs))
    if here != there:
        return here, there
    return (
        worded("{name} (this copy's figures)", name=here),
        worded("{name} (the other copy's figures)", name=there),
    )


def _members(team: str) -> str:
    """Return who is in a team as it is kept, each with the hours: all else is in the log."""
    members = (json.loads(team) or {}).get("members", ())
    each = [
        worded("{name} {hours:g} h", name=one["name"], hours=one["robot"]["hours"])
        for one in members
    ]
    return joined(", ", each) or worded("none")


def _weather(weather: str) -> str:
    """Return until when weather is, in UTC; "" where there is none."""
    at = (json.loads(weather) or {}).get("at", ())
    return worded("until {day}", day=datetime.fromtimestamp(max(at), UTC).date()) if at else ""


def _apart(ours: str, theirs: str) -> tuple[str, str]:
    """Return two values of a setting; of parts with names only those that differ."""
    one, other = json.loads(ours), json.loads(theirs)
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return ours, theirs
    names = [name for name in {**one, **other} if one.get(name) != other.get(name)]
    here, there = (
        joined(", ", [_with_unit(name, told.get(name)) for name in names]) for told in (one, other)
    )
    return here, there


def _with_unit(name: str, value: object) -> str:
    """Return what a part of a setting says; other names end in their unit."""
    if name == "hours" and isinstance(value, int | float):
        return worded("{n:g} h", n=value)
    return f"{name} {json.dumps(value, ensure_ascii=False)}"


def merge_labels(
    both: tuple[sqlite3.Connection, sqlite3.Connection], copies: list[TableRows]
) -> tuple[tuple[str, ...], list[str]]:
    """Let the first have the table of labels kept last; say if both kept one, and if it changed."""
    labels, replaced_twice = _kept_last(copies, [season_log.labels_kept(one) for one in both])
    merged_rows.write(both[0], schema.LABELS, labels)
    return replaced_twice, _other_labels(copies[0]["labels"], labels)


def _kept_last(
    copies: list[TableRows], kept: list[dict[str, str]]
) -> tuple[list[Row], tuple[str, ...]]:
    """Return the table of labels that was kept last, as a whole; say so where both kept one.

    `kept` says when, of all that the log of each copy knows. A copy whose tables the other one
    knows has nothing to add to it.
    """
    tables = [copied["labels"] for copied in copies]
    lines = [[key_of(row, schema.LABELS.names) for row in table] for table in tables]
    if lines[0] == lines[1]:
        return tables[0], ()
    own = [
        sorted(at for mark, at in one.items() if mark not in other)
        for one, other in zip(kept, reversed(kept), strict=True)
    ]
    # a clock may be set back: a copy's table is no older than those that it replaced
    last = [(max(kept[k].values(), default=""), own[k][-1:], repr(lines[k])) for k in (0, 1)]
    if bool(own[0]) != bool(own[1]):
        return tables[int(bool(own[1]))], ()
    products = _products_apart(*tables)
    if last[0] > last[1]:
        said = worded(
            "The table of labels differs ({products}): each copy replaced it. What was kept last "
            "counts, as a whole: the one here.",
            products=products,
        )
    else:
        said = worded(
            "The table of labels differs ({products}): each copy replaced it. What was kept last "
            "counts, as a whole: the one there.",
            products=products,
        )
    return tables[int(last[1] > last[0])], (said,)


def _products_apart(one: list[Row], other: list[Row]) -> str:
    """Return the first products of which two tables of labels say something else."""
    lines = [{key_of(row, schema.LABELS.names) for row in table} for table in (one, other)]
    return first_few(sorted({line[0] for line in lines[0] ^ lines[1]}), 3)


def _other_labels(before: list[Row], after: list[Row]) -> list[str]:
    """Return that the table of labels is another one now, if it is."""
    apart = _products_apart(before, after)
    return [worded("table of labels ({products})", products=apart)] if apart else []
