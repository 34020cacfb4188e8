"""Which plots of a file are wanted: all, one by its name or a part of it, or one by its number."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import ImportMessage, seen

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field


def asked_by_name(names: list[str], feature: str | int | None) -> NDArray[np.int64]:
    """Return which features are wanted, by name."""
    if feature is None:
        return np.arange(len(names))
    wanted = str(feature).strip()
    if wanted in names:
        return np.array([names.index(wanted)])
    alike = [n for n in names if wanted.casefold() in n.casefold()]
    if len(alike) == 1:
        return np.array([names.index(alike[0])])
    raise which_plot(names, wanted, alike)


def number_asked(names: list[str], feature: str | int | None) -> int:
    """Return the number of the plot that is wanted, 0 where it is named or all are."""
    wanted, number = _asked(feature)
    return 0 if wanted in names else number


def numbered(
    fields: tuple[Field, ...], messages: list[ImportMessage], number: int
) -> tuple[tuple[Field, ...], list[ImportMessage]]:
    """Return the plot with a number, as `fieldmon plots` counts those that can be used."""
    if number > len(fields):
        raise which_plot([f.name for f in fields], str(number))
    one = fields[number - 1]
    others = {field.name for field in fields} - {one.name}
    return (one,), [message for message in messages if message.feature not in others]


def named_by_number(names: list[str], feature: str | int | None) -> list[ImportMessage]:
    """Return what to say of a plot that was chosen by a name which is another one's number."""
    wanted, number = _asked(feature)
    if wanted not in names or not 0 < number <= len(names) or names[number - 1] == wanted:
        return []
    return [
        seen(
            worded(
                "{wanted} was taken as the plot's name; number {wanted} of the list is {other!r}.",
                wanted=wanted,
                other=names[number - 1],
            )
        )
    ]


def _asked(feature: str | int | None) -> tuple[str, int]:
    """Return the plot that is asked for, and its number if that is one, else 0."""
    wanted = "" if feature is None else str(feature).strip()
    return wanted, int(wanted) if re.fullmatch(r"[0-9]{1,9}", wanted) else 0


def which_plot(names: list[str], wanted: str, alike: list[str] | None = None) -> ChoiceNeeded:
    """Return the question which of plots is meant, as none is called so, or several are `alike`."""
    offered = alike or names
    said = {"n": len(names), "wanted": wanted, "names": ", ".join(offered[:20])}
    return ChoiceNeeded(
        worded(
            "There {n:is|are} {n} {n:plot|plots}, but none is called {wanted!r}: several have it "
            "in their names. Choose one of: {names}; or its number from 1, as fieldmon plots lists "
            "it.",
            **said,
        )
        if alike
        else worded(
            "There {n:is|are} {n} {n:plot|plots}, but none is called {wanted!r}. Choose one of: "
            "{names}; or its number from 1, as fieldmon plots lists it.",
            **said,
        ),
        "feature",
        tuple(offered),
    )
