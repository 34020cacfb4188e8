"""What the labels of products allow, as the user's own table says; nothing of law is made up."""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.decisions.doses import Dose
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.import_report import Imported, seen
from fieldmon.io.options import Upload, source_name
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.text import decode
from fieldmon.io.parse.values import could_be_thousands, number

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
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
MOST_DAYS, MOST_HOURS = 3650, 10_000
_MOST_LINES = 10_000


@dataclass(frozen=True)
class ProductLabel:
    """What a label allows for a product; None: it does not say.

    Parameters
    ----------
    product
        Trade name.
    crop, pest
        What it holds for; empty: all.
    max_dose
        The most.
    waiting_days
        Whole days until harvest.
    reentry_hours
        Hours until people may enter.
    irac_groups
        Mode-of-action groups, as ``("4A", "28")``.
    max_uses
        Uses in a season.
    source
        Who says so.
    """

    product: str
    crop: str = ""
    pest: str = ""
    max_dose: Dose | None = None
    waiting_days: int | None = None
    reentry_hours: float | None = None
    irac_groups: tuple[str, ...] = ()
    max_uses: int | None = None
    source: str = ""

    def __post_init__(self) -> None:
        if not self.product.strip():
            raise SettingError(worded("A label must name its product, but this one names none."))
        checked_waits(self.waiting_days, self.reentry_hours)
        if self.max_uses is not None and self.max_uses < 1:
            raise SettingError(
                worded(
                    "A label allows one use or more in a season, but this one allows {max_uses}.",
                    max_uses=self.max_uses,
                )
            )

    def fits(self, product: str, crop: str, pest: str) -> bool:
        """Return whether it is of a product, and holds for what was said of crop and pest."""
        pairs = ((self.crop, crop), (self.pest, pest))
        return _same(self.product, product) and all(
            not own or not said or _same(own, said) for own, said in pairs
        )


def checked_waits(days: int | None, hours: float | None) -> None:
    """Raise `SettingError` unless waiting days and re-entry hours can be."""
    if days is not None and not (0 <= days <= MOST_DAYS and days == int(days)):
        raise SettingError(
            worded(
                "A waiting period must be 0 to {most} whole days, but it is {days:g}.",
                most=MOST_DAYS,
                days=days,
            )
        )
    if hours is not None and not 0 <= hours <= MOST_HOURS:
        raise SettingError(
            worded(
                "Re-entry must be after 0 to {most} hours, but it is {hours:g}.",
                most=MOST_HOURS,
                hours=hours,
            )
        )


def irac_groups(said: str) -> tuple[str, ...]:
    """Return the mode-of-action groups that are said, ``"4A+28"`` or ``"IRAC Group 6"``.

    Raises
    ------
    SettingError
        If one is no group of IRAC: a number with a letter at most, or UN, UNB, UNE and so on.
    """
    bare = re.sub(r"irac|groups?|moa|:", " ", said, flags=re.IGNORECASE)
    found = [part.upper() for part in re.split(r"[\s,;+/&]+", bare) if part]
    for one in found:
        if not re.fullmatch(r"\d{1,2}[A-Z]?|UN[A-Z]{0,2}", one):
            raise SettingError(
                worded(
                    "A mode-of-action group must be one of IRAC, as 6, 4A or UN, "
                    "several as 4A+28, but it is {said!r}.",
                    said=said,
                )
            )
    return tuple(dict.fromkeys(found))


def label_for(
    labels: Iterable[ProductLabel], product: str, crop: str = "", pest: str = ""
) -> ProductLabel | None:
    """Return what the labels of a product allow; None: there is none of it.

    Where several lines hold, since nobody said the crop or the pest, the strictest of each counts.
    """
    fit = [one for one in labels if one.fits(product, crop, pest)]
    if len(fit) < 2:
        return fit[0] if fit else None
    doses = [one.max_dose for one in fit if one.max_dose is not None]
    least = doses[0] if doses else None
    for one in doses[1:]:
        share = one.share_of(doses[0])
        if share is not None and least is not None and share < (least.share_of(doses[0]) or 1.0):
            least = one
    return ProductLabel(
        fit[0].product, crop, pest, least,
        max((one.waiting_days for one in fit if one.waiting_days is not None), default=None),
        max((one.reentry_hours for one in fit if one.reentry_hours is not None), default=None),
        tuple(dict.fromkeys(group for one in fit for group in one.irac_groups)),
        min((one.max_uses for one in fit if one.max_uses is not None), default=None),
        "; ".join(dict.fromkeys(one.source for one in fit if one.source)),
    )  # fmt: skip


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
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    head = lines[0] if lines else ""
    delimiter = max(",;\t", key=head.count)
    table = csv.reader(lines, delimiter=delimiter)
    names = next(table, [])
    at = _columns(name, names)
    unread = [own for k, own in enumerate(names) if k not in at.values() and own.strip()]
    if unread:
        messages = [
            *messages,
            seen(worded("Columns that say nothing of labels: {names}.", names=", ".join(unread))),
        ]
    made: list[ProductLabel] = []
    for line, cells in enumerate(table, 2):
        said = {role: cells[k].strip() for role, k in at.items() if k < len(cells)}
        if any(said.values()):
            made.append(_label(said, f"{name}, line {line}"))
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


def _columns(name: str, names: list[str]) -> dict[str, int]:
    """Return which column says what."""
    called = {plain(column): k for k, column in reversed(list(enumerate(names)))}
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
    value, unit = _number(said, "max_dose"), said.get("unit", "")
    if value is not None and not unit:
        raise SettingError(
            worded("the dose is {value:g}, but of which unit is not said.", value=value)
        )
    return None if value is None else Dose(value, unit)


def _number(said: Mapping[str, str], role: str) -> float | None:
    cell = said.get(role, "")
    if not cell:
        return None
    if could_be_thousands(cell):
        bare = cell.replace(",", ".")
        raise SettingError(
            worded(
                "{role} is {cell}: is that {bare:g} or {other:g}? Write it without the mark, "
                "or with other decimals.",
                role=role,
                cell=cell,
                bare=float(bare.replace(".", "")),
                other=float(bare.partition(".")[0] + "." + bare.partition(".")[2].replace(".", "")),
            )
        )
    value = number(cell, "," if "," in cell and "." not in cell else ".")
    if math.isnan(value):
        raise SettingError(
            worded("{role} must be a number, but it is {cell!r}.", role=role, cell=cell)
        )
    return value


def _whole(said: Mapping[str, str], role: str) -> int | None:
    value = _number(said, role)
    if value is not None and value != int(value):
        raise SettingError(
            worded("{role} must be a whole number, but it is {value:g}.", role=role, value=value)
        )
    return None if value is None else int(value)


def _refuse_two_of_one(name: str, made: list[ProductLabel]) -> None:
    """Raise `FileProblem` where two lines say different things of one product, crop and pest."""
    first: dict[tuple[str, str, str], ProductLabel] = {}
    for one in made:
        known = first.setdefault((_plain(one.product), _plain(one.crop), _plain(one.pest)), one)
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


def _plain(name: str) -> str:
    return " ".join(name.casefold().split())


def _same(one: str, other: str) -> bool:
    return _plain(one) == _plain(other)
