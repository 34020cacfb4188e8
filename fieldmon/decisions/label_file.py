"""The user's own table of labels: read as it stands, or refused with the line that cannot be."""

from __future__ import annotations

from dataclasses import fields
from math import ceil
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel, irac_groups, plain_name
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.import_report import Imported, seen
from fieldmon.io.options import Upload, source_name
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.own_table import own_table
from fieldmon.io.parse.text import decode
from fieldmon.io.parse.values import told_number

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

#: columns of a label table, with the words that explain them
COLUMNS = {
    "product": "trade name; needed",
    "crop": "crop the line holds for; empty: every crop",
    "pest": "pest it holds for; empty: every pest",
    "max_dose": "most that the label allows",
    "unit": "unit of that dose: l/ha, ml/dunam, kg/ha, g/100 l, %",
    "waiting_days": "whole days until harvest",
    "reentry_hours": "hours until people may enter",
    "irac_group": "mode-of-action group of IRAC: 6, or 4A+28",
    "max_uses": "uses that the label allows in a season",
    "source": "where that stands: label, page, date",
}
_CALLED = {
    "product": "product name tradename",
    "crop": "crop crops",
    "pest": "pest pests target",
    "max_dose": "maxdose dose maximumdose maxrate rate",
    "unit": "unit doseunit units",
    "waiting_days": "waitingdays phi phidays preharvestinterval preharvestintervaldays waiting",
    "reentry_hours": "reentryhours rei reihours reentry reentryinterval reentryintervalhours",
    "irac_group": "iracgroup irac group moa modeofaction modeofactiongroup",
    "max_uses": "maxuses uses maxusesaseason usesaseason maxapplications applications",
    "source": "source label reference",
}
_MOST_LINES = 10_000
# cells in which nobody says a number
_NOT_KNOWN = frozenset({"", "-", "–", "?", "n/a", "not known", "unknown"})


def read_labels(source: Path | Upload) -> Imported[tuple[ProductLabel, ...]]:
    """Return the labels of a table that the user filled in: CSV with a header, see `COLUMNS`.

    Raises
    ------
    FileProblem
        If the file cannot be read, has no column for the product, or a line is no label: which
        line, and why.
    """
    name = source_name(source)
    try:
        data = source.data if isinstance(source, Upload) else source.read_bytes()
    except OSError as error:
        raise FileProblem(
            worded(
                "{name} must be readable, but it is not ({strerror}).",
                name=name,
                strerror=error.strerror,
            )
        ) from error
    text, messages = decode(data)
    table = own_table(text, name)
    column_of = _columns(name, table.columns)
    unread = [own for own in table.columns if own and own not in column_of.values()]
    if unread:
        messages = [
            *messages,
            seen(worded("Columns that say nothing of labels: {names}.", names=", ".join(unread))),
        ]
    made: list[ProductLabel] = []
    for where, cells in table.lines:
        said = {role: cells[column] for role, column in column_of.items()}
        if any(said.values()):
            made.append(_label(said, where))
    if not made:
        raise FileProblem(worded("{name} must hold a label or more, but it holds none.", name=name))
    if len(made) > _MOST_LINES:
        raise FileProblem(
            worded(
                "{name} may hold {most} labels, but it holds {n}.",
                name=name,
                most=_MOST_LINES,
                n=len(made),
            )
        )
    _refuse_two_of_one(name, made)
    return Imported(tuple(dict.fromkeys(made)), tuple(messages))


def _columns(name: str, names: tuple[str, ...]) -> dict[str, str]:
    """Return which column says what."""
    called = {plain(column): column for column in reversed(names)}
    at = {
        role: called[word]
        for role, words in _CALLED.items()
        for word in [next((w for w in words.split() if w in called), None)]
        if word is not None
    }
    if "product" not in at:
        raise FileProblem(
            worded(
                "{name}: a label table must have a column product, and may have "
                "{names}; but it has {own}.",
                name=name,
                names=", ".join(list(COLUMNS)[1:]),
                own=", ".join(names) or "none",
            )
        )
    return at


def _label(said: Mapping[str, str], where: str) -> ProductLabel:
    try:
        return ProductLabel(
            said.get("product", ""), said.get("crop", ""), said.get("pest", ""),
            _dose(said), _whole(said, "waiting_days"),
            _number(said, "reentry_hours"), irac_groups(said.get("irac_group", "")),
            _whole(said, "max_uses"), said.get("source", ""),
        )  # fmt: skip
    except SettingError as error:
        raise FileProblem(
            worded("{where}: {problem}", where=where, problem=error.args[0])
        ) from error


def _dose(said: Mapping[str, str]) -> Dose | None:
    _refuse_unit_in_cell(said.get("max_dose", ""))
    value, unit = _number(said, "max_dose"), said.get("unit", "")
    if value is not None and not unit:
        raise SettingError(
            worded("the dose is {value:g}, but of which unit is not said.", value=value)
        )
    return None if value is None else Dose(value, unit)


def _refuse_unit_in_cell(cell: str) -> None:
    """Raise `SettingError` where a number and the unit of a dose stand in one cell."""
    unit = cell.lstrip("0123456789., ")
    if unit == cell:
        return
    try:
        Dose(1.0, unit)
    except SettingError:
        return
    raise SettingError(
        worded(
            "max_dose must be a number, and its unit stand in the column unit, but both stand in "
            "one ({cell!r}).",
            cell=cell,
        )
    )


def _number(said: Mapping[str, str], role: str) -> float | None:
    cell = said.get(role, "")
    # never a zero
    return None if cell.casefold() in _NOT_KNOWN else told_number(cell, role)


def _whole(said: Mapping[str, str], role: str) -> int | None:
    value = _number(said, role)
    if value is not None and value != int(value) and role == "waiting_days":
        raise SettingError(
            worded(
                "waiting_days must be a whole number, but it is {value:g}. Harvest waits for whole "
                "days: round it up, {up}.",
                value=value,
                up=ceil(value),
            )
        )
    if value is not None and value != int(value):
        raise SettingError(
            worded("{role} must be a whole number, but it is {value:g}.", role=role, value=value)
        )
    return None if value is None else int(value)


def _refuse_two_of_one(name: str, made: list[ProductLabel]) -> None:
    """Raise `FileProblem` where two lines say different things of one product, crop and pest."""
    first: dict[tuple[str, str, str], ProductLabel] = {}
    for one in made:
        known = first.setdefault(
            (plain_name(one.product), plain_name(one.crop), plain_name(one.pest)), one
        )
        if known != one:
            differ = [f.name for f in fields(one) if getattr(one, f.name) != getattr(known, f.name)]
            of = " on ".join(part for part in (one.product, one.crop) if part)
            raise FileProblem(
                worded(
                    "{name}: two lines are about {of}, and differ in {names}. Which "
                    "holds? Leave one of them, or name the crop or the pest of each.",
                    name=name,
                    of=of,
                    names=", ".join(differ),
                )
            )
