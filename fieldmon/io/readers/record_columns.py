"""Columns of records by what they hold: which plays a role, and which could."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import Remedy
from fieldmon.io.options import ROLES
from fieldmon.io.parse.columns import find, recognised
from fieldmon.io.parse.values import is_missing, numbers

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.io.options import RecordOptions

#: so many cells tell what a column could hold
LOOKED_AT = 200


@dataclass(frozen=True, eq=False)
class RecordColumns:
    """Columns by what they hold."""

    layer: Layer
    options: RecordOptions

    def __len__(self) -> int:
        return len(self.layer)

    def named(self, role: str, taken: frozenset[str] = frozenset()) -> str | None:
        """Return the column of a role, told or recognised by its name; None: there is none."""
        told = self.options.column(role)
        if told == "" and role == "species":  # none says it
            return None
        return told or find(role, self.layer.columns, taken)

    def used(self) -> set[str | None]:
        """Return the columns that play a role."""
        return {self.named(role) for role in ROLES}

    def cells(self, name: str) -> list[str]:
        """Return what a column says, as text."""
        return [text(v) for v in self.layer.column(name)]

    def numbers(self, role: str) -> NDArray[np.float64]:
        """Return the numbers of a role ``(n,)``; NaN where there are none."""
        name = self.named(role)
        if name is None:
            return np.full(len(self), np.nan)
        return numbers(self.layer.column(name), self.options.decimal)

    def texts(self, role: str) -> NDArray[np.str_]:
        """Return the texts of a role ``(n,)``; empty where nothing is said."""
        name = self.named(role)
        if name is None:
            return np.full(len(self), "", dtype=np.str_)
        cells = self.cells(name)
        known = {cell: "" if is_missing(cell) else cell for cell in set(cells)}
        return np.array([known[cell] for cell in cells], dtype=np.str_)

    def fitting(self, fits: Callable[[list[str]], bool]) -> list[str]:
        """Return the columns of unknown name whose cells fit."""
        unknown = [name for name in self.layer.columns if not recognised([name])]
        some = {name: [c for c in self.cells(name)[:LOOKED_AT] if c] for name in unknown}
        return [name for name, cells in some.items() if cells and fits(cells)]

    def offer(self, role: str, fits: Callable[[list[str]], bool]) -> Remedy | None:
        """Return the columns of unknown name that hold what could play a role, if there are any."""
        choices = tuple(f"{role}={name}" for name in self.fitting(fits))
        if not choices:
            return None
        one = worded(
            "Take the {role} from {other}",
            role=role,
            other=choices[0].partition("=")[2],
        )
        label = (
            one
            if len(choices) == 1
            else worded(
                "Name the column of the {role}",
                role=role,
            )
        )
        return Remedy("columns", choices[0], label, choices[1:])
