"""Inspections: which plant was inspected when, what was found there, and by whom."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be_known, shown
from fieldmon.compute.array_arguments import entries_of, must_share_index, texts_of
from fieldmon.compute.arrays import as_kept, read_only
from fieldmon.compute.day_arguments import days_of, seconds_of
from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import counted
from fieldmon.errors import ObservationError
from fieldmon.infestation.inspection_columns import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.array_arguments import Column
    from fieldmon.compute.day_arguments import Day


CLEAN, FOUND, SKIPPED = 0, 1, 2
#: as files and people write them
RESULT_NAMES = {CLEAN: "clean", FOUND: "found", SKIPPED: "skipped"}
#: results by those names
RESULT_CODES = {name: code for code, name in RESULT_NAMES.items()}

_TYPES: dict[str, Any] = {column.name: column.dtype for column in COLUMNS}
#: what a caller's array of each may be to numpy, and how a sentence calls it
_GIVEN = {column.name: column.given for column in COLUMNS}


def _column(name: str, given: Any) -> NDArray[Any]:  # noqa: ANN401 - held to its kind here
    """Return a column as it is kept: no array that its caller may change later."""
    (letters, words), texts = _GIVEN[name], _TYPES[name] is object
    # of columns that were held to their kind before, as mostly, there is nothing to find out
    if type(given) is np.ndarray and given.ndim == 1 and given.dtype == _TYPES[name] and not texts:
        return as_kept(given)
    try:
        held: Any = days_of(given) if name == "date" else given
        # other programs may have put bytes into a season's file: they stay as they are
        if texts and (held := texts_of(given, (str, bytes))) is None:
            raise _wrong(name, given)
        values = np.atleast_1d(held)
        if values.ndim != 1:
            raise ObservationError(
                f"The {name} of inspections must be {words} in a row, one an inspection, but they "
                f"have the shape {values.shape}."
            )
        if values.size and values.dtype.kind not in letters:
            raise _wrong(name, given)
        with np.errstate(invalid="ignore"):
            column: NDArray[Any] = as_kept(values.astype(_TYPES[name], copy=False))
    except (ValueError, TypeError, OverflowError) as error:
        raise _wrong(name, given) from error
    if column.dtype.kind == "i" and not np.array_equal(column, values):
        raise _wrong(name, given)
    return column


def _wrong(name: str, given: object) -> ObservationError:
    """Say what a column must be, and which is the first of its values that is not."""
    wrong = _first_wrong(name, given)
    but = f"{shown(given)} does not hold them" if wrong is None else wrong
    return ObservationError(f"The {name} of inspections must be {_GIVEN[name][1]}, but {but}.")


def _first_wrong(name: str, given: Any) -> str | None:  # noqa: ANN401 - it is looked at here
    """Return which value of a column of numbers is none, or None where that cannot be told."""
    kind = np.dtype(_TYPES[name])
    is_row = hasattr(given, "__len__") and getattr(given, "ndim", 1) == 1
    if kind.kind not in "if" or not is_row or isinstance(given, (str, bytes)):
        return None
    limits = np.iinfo(kind) if kind.kind == "i" else None
    for k, one in enumerate(given):
        fits = isinstance(one, (Real, np.bool_))
        if limits:
            fits = fits and one == one // 1 and limits.min <= one <= limits.max
        elif one is None:
            continue
        if not fits:
            return f"that of inspection {k + 1} of {len(given)} is {shown(one)}"
    return None


def _no_date(given: object) -> ObservationError:
    return ObservationError(
        f"The date of inspections must be as 2026-11-18, but it is {shown(given)}."
    )


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
        Text; empty where nothing was noted. None, NaN and pandas's NA are nothing.
    detects
        Chance to see an infested plant that is inspected, as was said with the inspection; NaN
        where nothing was: then it is that of who inspects in the season.

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
    detects: NDArray[np.float64]

    def __post_init__(self) -> None:
        columns = {name: _column(name, getattr(self, name)) for name in _TYPES}
        k = len(columns["plant"])
        for name, column in columns.items():
            if len(column) != k:
                raise ObservationError(
                    f"All columns of the inspections must have {k} entries, "
                    f"but {name} has {len(column)}."
                )
            object.__setattr__(self, name, column)
        unknown = np.flatnonzero((self.result < CLEAN) | (self.result > SKIPPED))
        if unknown.size:
            raise ObservationError(
                f"A result must be 0 (clean), 1 (found) or 2 (skipped), but that of inspection "
                f"{unknown[0] + 1} of {k} is {self.result[unknown[0]]}."
            )
        beyond = np.flatnonzero((self.detects <= 0.0) | (self.detects > 1.0))
        if beyond.size:
            raise ObservationError(
                "The chance to see an infested plant (detects) must be above 0, and 1 at most, but "
                f"that of inspection {beyond[0] + 1} of {k} is {self.detects[beyond[0]]:g}."
            )

    def __repr__(self) -> str:
        finds = int(np.count_nonzero(self.result == FOUND))
        return f"<Inspections: {counted(len(self), 'inspection')}, {counted(finds, 'find')}>"

    def __len__(self) -> int:
        """Return the number of inspections."""
        return len(self.plant)

    @classmethod
    def of(
        cls,
        plant: Column,
        result: Column,
        on: Day | Column,
        **columns: Column,
    ) -> Inspections:
        """Return inspections of one date, or of a date each; columns not given are unknown.

        Parameters
        ----------
        plant
            ``(k,)`` numbers in the grid, from 0.
        result
            ``(k,)`` 1 found, 0 clean, 2 skipped.
        on
            The local date, or ``(k,)`` dates. With a time of day, as `datetime` has it, it is their
            `second`, too; midnight is a date alone. None may name a zone.
        columns
            Others of these columns by name, ``(k,)`` each.

        Raises
        ------
        ObservationError
            If plants are no whole numbers, results none of these, or dates no dates; if a time
            names a zone (that of the plot is not known here), or is said in both `on` and `second`.
        SettingError
            If columns of pandas differ in their index.
        """
        k, dates = len(_column("plant", plant)), days_of(on)
        if dates is None:
            raise _no_date(on)
        must_be_known("Columns of inspections", columns, list(_TYPES))
        for name, given in columns.items():
            if _TYPES[name] is object and texts_of(given) is None:  # bytes may be no text
                raise _wrong(name, given)
        must_share_index("inspections", {"plant": plant, "result": result, "on": on, **columns})
        seconds = seconds_of(on)
        if "second" in columns and not np.isnan(seconds).all():
            raise ObservationError(
                f"The time of inspections must be said once, but {shown(on)} has one and second "
                "is given too. Leave one out."
            )
        unsaid = {
            column.name: np.full(k, column.empty, column.dtype)
            for column in COLUMNS
            if column.empty is not None
        }
        known: dict[str, Any] = unsaid | {
            "plant": plant,
            "result": result,
            "date": np.full(k, dates) if dates.ndim == 0 else dates,
            "second": np.full(k, seconds) if seconds.ndim == 0 else seconds,
        }
        return cls(**(known | columns))

    @classmethod
    def none(cls) -> Inspections:
        """Return no inspections."""
        return cls.of(np.empty(0, np.int32), np.empty(0, np.int8), np.datetime64("NaT"))

    def take(self, which: Column | slice) -> Inspections:
        """Return those at `which` indices, or of a mask ``(k,)`` or a slice.

        Raise `SettingError` if `which` is none of them.
        """
        picked = entries_of("Inspections", which, len(self))
        return _held({name: getattr(self, name)[picked] for name in _TYPES})

    @checked
    def and_those(self, others: Inspections) -> Inspections:
        """Return these and then others."""
        both = {
            name: np.concatenate([getattr(self, name), getattr(others, name)]) for name in _TYPES
        }
        return _held(both)

    def on(self, date: Day) -> Inspections:
        """Return those of one date; raise `ObservationError` if it is none."""
        day = days_of(date)
        if day is None or day.ndim:
            raise _no_date(date)
        return self.take(self.date == day)

    @property
    def inspected(self) -> Inspections:
        """Return those at which the plant was really inspected."""
        return self.take(self.result != SKIPPED)


def _held(columns: dict[str, NDArray[Any]]) -> Inspections:
    """Return inspections of columns that nobody else has, of some that were held to their kind."""
    made = object.__new__(Inspections)
    for name, column in columns.items():
        object.__setattr__(made, name, read_only(column))
    return made


def after_their_find(
    plants: NDArray[np.integer[Any]], found: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Return which inspections are of a plant that was found infested before, ``(k,)``.

    Parameters
    ----------
    plants, found
        ``(k,)`` plants in the order in which they were inspected, and whether each was found
        infested.

    Examples
    --------
    >>> import numpy as np
    >>> after_their_find(np.array([7, 7, 3, 7]), np.array([False, True, True, True])).tolist()
    [False, False, False, True]
    """
    which, nth = np.unique(plants, return_inverse=True)
    first = np.full(len(which), len(plants))
    np.minimum.at(first, nth[found], np.flatnonzero(found))
    return np.arange(len(plants)) > first[nth]
