"""Who is in a team, as the table that `fieldmon.io.readers.team` reads."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.io.parse.values import could_be_thousands
from fieldmon.io.readers.team import COLUMNS, SETTINGS
from fieldmon.io.writers.csv import safe_cell
from fieldmon.plot.robot import SAID_IN

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.readers.team import StatedMember

# of a number of Python's
_DIGITS = 17


def team_csv(team: Iterable[StatedMember]) -> bytes:
    r"""Return a team's table as CSV with all columns, those empty of which a line says nothing.

    It begins with a byte order mark, without which Excel mangles Hebrew and umlauts. A name that a
    spreadsheet would run as a formula gets an apostrophe before it, which its reader takes off.

    Examples
    --------
    >>> from fieldmon.io.readers.team import team_of_table
    >>> stated = team_of_table(b"name,speed_km_h\n=Ann,2.5\n", "team.csv")
    >>> (again,) = team_of_table(team_csv(stated), "team.csv")
    >>> again.name, again.settings == stated[0].settings
    ('=Ann', True)
    """
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\r\n")
    table.writerow(COLUMNS)
    for one in team:
        stated = {column: _of(name, one) for column, name in SETTINGS.items()}
        lon, lat = ("", "") if one.gate is None else (_written(degrees) for degrees in one.gate)
        table.writerow((safe_cell(one.name), one.who, *stated.values(), one.start or "", lon, lat))
    return text.getvalue().encode("utf-8-sig")


def _of(name: str, one: StatedMember) -> str:
    """Return a setting of `Robot` as a table says it, in the units of `SAID_IN`."""
    if name not in one.settings:
        return ""
    return _written(one.settings[name], SAID_IN[name].units)


def _written(value: float, units: float = 1.0) -> str:
    """Return the shortest number of so many units that is read as the value."""
    said = value * units
    each = (np.format_float_positional(round(said, k), trim="-") for k in range(_DIGITS))
    text = next((one for one in each if float(one) / units == value), repr(said))
    # 31.125 might be thousands, 31.1250 is not
    return f"{text}0" if could_be_thousands(text) else text
