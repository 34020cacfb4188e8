"""Who is in a team, as a table says: one line a robot or scout."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.parse.own_table import own_table
from fieldmon.io.parse.values import told_number
from fieldmon.io.writers.csv import said_cell
from fieldmon.plot.robot import SAID_IN, broken_rule

if TYPE_CHECKING:
    from pathlib import Path

#: columns that are settings of `Robot`
SETTINGS = {said.column: name for name, said in SAID_IN.items()}
COLUMNS = ("name", "who", *SETTINGS, "start", "lon", "lat")
#: what is more as thousands is none
MOST = {"lon": 180.0, "lat": 90.0} | {said.column: said.most for said in SAID_IN.values()}


class StatedMember(NamedTuple):
    """A line of a team's table; None where it says nothing.

    Parameters
    ----------
    name
        What the member is called.
    who
        ``"scout"`` (a person on foot) or ``"robot"``; empty: as those of the season are.
    settings
        Settings of `Robot` that were stated.
    start
        Local time of day at which it starts, as ``HH:MM``.
    gate
        ``(lon, lat)`` where its day starts and ends.
    where
        File and line, for sentences.
    """

    name: str
    who: str
    settings: dict[str, float]
    start: str | None
    gate: tuple[float, float] | None
    where: str


def read_team(path: Path) -> tuple[StatedMember, ...]:
    """Return the members of a table in a file, see `team_of_table`.

    Raises
    ------
    FileProblem
        If the file cannot be read, or as `team_of_table` does.
    """
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise FileProblem(
            worded("{path} must be a table (CSV), but there is none. Check the name.", path=path)
        ) from None
    except OSError as error:
        raise _unreadable(str(path)) from error
    return team_of_table(content, str(path))


def team_of_table(content: bytes, name: str) -> tuple[StatedMember, ...]:
    r"""Return the members of a table (CSV with a header, `COLUMNS`; only ``name`` is needed).

    Parameters
    ----------
    content, name
        What the file holds, and its name for sentences.

    Raises
    ------
    FileProblem
        If it is no text, has other columns, or a value that is none.

    Examples
    --------
    >>> ann, robot = team_of_table(b"name,who,hours\nAnn,scout,2\nrobot,,\n", "team.csv")
    >>> ann.who, ann.settings, robot.settings
    ('scout', {'hours': 2.0}, {})
    """
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _unreadable(name) from error
    table = own_table(text, name, comments=False)  # a robot may be #2
    columns = [column.casefold() for column in table.columns]
    unknown = [column for column in columns if column not in COLUMNS]
    if "name" not in columns or unknown:
        raise FileProblem(
            worded(
                "{path} must have a column name, and of others only {names}, but it has {names_2}.",
                path=name,
                names=", ".join(COLUMNS[1:]),
                names_2=", ".join(columns) or "none",
            )
        )
    members = [
        _member(dict(zip(columns, cells.values(), strict=True)), where)
        for where, cells in table.lines
    ]
    if not members:
        raise FileProblem(
            worded(
                "{path} must name a member of the team, but it names none.",
                path=name,
            )
        )
    return tuple(members)


def _unreadable(name: str) -> FileProblem:
    return FileProblem(worded("{path} must be a readable table (CSV), but it is not.", path=name))


def _member(values: dict[str, str], where: str) -> StatedMember:
    who = values.get("who", "").casefold()
    if who not in {"robot", "scout", ""}:
        raise FileProblem(
            worded(
                "{where}: who must be robot or scout, but it is {who!r}.",
                where=where,
                who=values["who"],
            )
        )
    name = said_cell(values["name"])
    if not name:
        raise FileProblem(
            worded(
                "{where}: every member must have a name, but this has none.",
                where=where,
            )
        )
    numbers = {
        column: _number(values[column], column, where)
        for column in (*SETTINGS, "lon", "lat")
        if values.get(column)
    }
    gate, settings = _gate(numbers, where), _settings(numbers, where)
    start = values.get("start") or None
    return StatedMember(name, who, settings, start, gate, where)


def _gate(numbers: dict[str, float], where: str) -> tuple[float, float] | None:
    """Return the gate that a line states, ``(lon, lat)``; None: none."""
    if ("lon" in numbers) != ("lat" in numbers):
        raise FileProblem(
            worded(
                "{where}: a gate must have lon and lat, but it has one of them.",
                where=where,
            )
        )
    return (numbers["lon"], numbers["lat"]) if "lon" in numbers else None


def _settings(numbers: dict[str, float], where: str) -> dict[str, float]:
    """Return what a line states of who works, by the names of `Robot`'s fields."""
    settings = {}
    for column, setting in SETTINGS.items():
        if column not in numbers:
            continue
        value = numbers[column]
        if rule := broken_rule(setting, value):
            raise FileProblem(
                worded(
                    "{where}: {name} must be {rule}, but it is {value:g}.",
                    where=where,
                    name=column,
                    rule=rule,
                    value=value,
                )
            )
        settings[setting] = value / SAID_IN[setting].units
    return settings


def _number(text: str, name: str, where: str) -> float:
    try:
        return told_number(text, name, MOST[name])
    except SettingError as error:
        raise FileProblem(
            worded("{where}: {problem}", where=where, problem=error.args[0])
        ) from error
