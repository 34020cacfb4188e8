"""Inspections: which plant was inspected when, what was found there, and by whom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import shown
from fieldmon.compute.wording import counted
from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    import datetime as dt

    from numpy.typing import NDArray


CLEAN, FOUND, SKIPPED = 0, 1, 2
#: as files and people write them
RESULT_NAMES = {CLEAN: "clean", FOUND: "found", SKIPPED: "skipped"}

_TYPES: dict[str, Any] = {
    "plant": "int32",
    "result": "int8",
    "date": "datetime64[D]",
    "second": "float64",
    "count": "float64",
    "who": object,
    "notes": object,
}
_WHOLE = frozenset({"plant", "result"})


@dataclass(frozen=True, eq=False)
class Inspections:
    """What was found at which plants, one array entry an inspection, ``(k,)`` each.

    Parameters
    ----------
    plant
        int32, number in the grid.
    result
        int8: `CLEAN`, `FOUND`, or `SKIPPED` (stood before it but could not inspect it).
    date
        datetime64[D], the local date; NaT where it is not known.
    second
        Seconds since local midnight; NaN where no time was noted.
    count
        Pests counted; NaN where they were not.
    who, notes
        Text; empty where nothing was noted.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> seen = fm.Inspections.of(np.array([3, 4]), np.array([1, 0]), np.datetime64("2026-11-18"))
    >>> seen.take(seen.result == 1)
    <Inspections: 1 inspection, 1 find>
    """

    plant: NDArray[np.int32]
    result: NDArray[np.int8]
    date: NDArray[np.datetime64]
    second: NDArray[np.float64]
    count: NDArray[np.float64]
    who: NDArray[np.object_]
    notes: NDArray[np.object_]

    def __post_init__(self) -> None:
        k = np.size(self.plant)
        for name, type_ in _TYPES.items():
            values = np.atleast_1d(getattr(self, name))
            if len(values) != k:
                raise ObservationError(
                    f"All columns of the inspections must have {k} entries, "
                    f"but {name} has {len(values)}."
                )
            # a view: the caller's own array stays as it is
            try:
                column = values.astype(type_, copy=False).view()
            except (ValueError, TypeError) as error:
                raise ObservationError(
                    f"The {name} of inspections must be of type {type_} each, but they are not "
                    f"({error})."
                ) from error
            if name in _WHOLE and not np.array_equal(column, values):
                raise ObservationError(
                    f"The {name} of inspections must be whole numbers of {type_}."
                )
            column.setflags(write=False)
            object.__setattr__(self, name, column)

    def __repr__(self) -> str:
        finds = int(np.count_nonzero(self.result == FOUND))
        return f"<Inspections: {counted(len(self), 'inspection')}, {counted(finds, 'find')}>"

    def __len__(self) -> int:
        """Return the number of inspections."""
        return len(self.plant)

    @classmethod
    def of(
        cls,
        plant: NDArray[np.integer],
        result: NDArray[np.integer],
        on: dt.date | np.datetime64 | NDArray[np.datetime64],
        **columns: NDArray[np.generic],
    ) -> Inspections:
        """Return inspections of one date, or of a date each; columns not given are unknown.

        Parameters
        ----------
        plant
            ``(k,)`` numbers in the grid, from 0.
        result
            ``(k,)`` 1 found, 0 clean, 2 skipped.
        on
            The local date, or ``(k,)`` dates.
        columns
            Others of these columns by name, ``(k,)`` each.

        Raises
        ------
        ObservationError
            If plants or results are no whole numbers of their type, or dates no dates.
        """
        k = np.size(plant)
        try:
            dates = np.asarray(on, "datetime64[D]")
        except ValueError as error:
            raise ObservationError(
                f"The date of inspections must be as 2026-11-18, but it is {shown(on)}."
            ) from error
        known: dict[str, Any] = {
            "plant": plant,
            "result": result,
            "date": np.full(k, dates) if dates.ndim == 0 else dates,
            "second": np.full(k, np.nan),
            "count": np.full(k, np.nan),
            "who": np.full(k, "", object),
            "notes": np.full(k, "", object),
        }
        return cls(**(known | columns))

    @classmethod
    def none(cls) -> Inspections:
        """Return no inspections."""
        return cls.of(np.empty(0, np.int32), np.empty(0, np.int8), np.datetime64("NaT"))

    def take(self, which: NDArray[np.generic] | slice) -> Inspections:
        """Return those at `which` indices, or of a mask ``(k,)`` or a slice."""
        return Inspections(**{name: getattr(self, name)[which] for name in _TYPES})

    def and_those(self, others: Inspections) -> Inspections:
        """Return these and then others."""
        both = {
            name: np.concatenate([getattr(self, name), getattr(others, name)]) for name in _TYPES
        }
        return Inspections(**both)

    def on(self, date: dt.date | np.datetime64) -> Inspections:
        """Return those of one date."""
        return self.take(self.date == np.asarray(date, "datetime64[D]"))

    @property
    def inspected(self) -> Inspections:
        """Return those at which the plant was really inspected."""
        return self.take(self.result != SKIPPED)
