"""Dated pest records as people bring them, before anything is believed of them."""

from __future__ import annotations

from dataclasses import dataclass
from types import NoneType
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be, must_be_known, shown
from fieldmon.compute.array_arguments import array_of, entries_of, must_share_index, texts_of
from fieldmon.compute.arrays import as_kept
from fieldmon.compute.day_arguments import days_of
from fieldmon.compute.kinds import must_be_of, must_hold_kinds
from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.plot.positions import lonlat_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.array_arguments import Column
    from fieldmon.compute.day_arguments import Day
    from fieldmon.compute.wording import Worded


UNKNOWN, ABSENT, PRESENT = -1, 0, 1
#: a record this close to a plot is taken for one of its own
NEARBY_M = 100.0
_DAY = np.timedelta64(1, "D")
_READ = ", or read the file with read_records"
_TEXTS = frozenset({"species", "stage"})


def _column(name: str, given: object) -> NDArray[np.generic]:
    """Return a column of records as it is kept."""
    what = f"The {name} of records"
    if name not in _TEXTS:
        if getattr(given, "dtype", None) == np.bool_:
            must_be_of(what, "NDArray[np.float64]", given)
        return np.atleast_1d(array_of(np.float64, what, given))
    texts = texts_of(given)
    if texts is None or texts.ndim != 1:
        raise SettingError(
            f"{what} must be texts, one a record, but {shown(given)} does not hold them."
        )
    return texts.astype(np.str_)


@dataclass(frozen=True, eq=False)
class Records:
    """Dated pest records at positions, one array entry a record, in the file's order.

    Parameters
    ----------
    lonlat
        ``(m, 2)`` degrees.
    present
        ``(m,)`` int8: `PRESENT`, `ABSENT` (looked, nothing seen) or `UNKNOWN`.
    day
        ``(m,)`` datetime64[D]; NaT where the record has no date.
    count
        ``(m,)`` pests counted; NaN where only presence was noted.
    accuracy_m
        ``(m,)`` 1-sigma position accuracy, metres; NaN where unknown.
    species, stage
        ``(m,)`` text; empty where unknown.
    leaves_sampled
        ``(m,)`` leaves looked at; NaN where unknown.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> lonlat = np.array([[35.1501, 30.3601], [35.1504, 30.3602]])
    >>> day = np.array(["2026-11-16", "NaT"], "datetime64[D]")
    >>> fm.Records.of(lonlat, np.array([1, 0]), day, count=np.array([12.0, np.nan]))
    <Records: 2 records>
    """

    lonlat: NDArray[np.float64]
    present: NDArray[np.int8]
    day: NDArray[np.datetime64]
    count: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    species: NDArray[np.str_]
    stage: NDArray[np.str_]
    leaves_sampled: NDArray[np.float64]

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The records'")
        lonlat_of("Positions of records", self.lonlat, _READ, nowhere=True)
        m = len(self.lonlat)
        for name, values in [*vars(self).items()]:
            if len(values) != m:
                raise ObservationError(
                    f"All columns of the records must have {m} entries, "
                    f"but {name} has {len(values)}."
                )
            object.__setattr__(self, name, as_kept(values))

    def __repr__(self) -> str:
        return f"<Records: {counted(len(self), 'record')}>"

    def __len__(self) -> int:
        """Return the number of records."""
        return len(self.lonlat)

    def in_words(self, units: Units | None = None) -> Worded:
        """Return how many there are and of which days, with the years: last year's count, too.

        Days are written as `units` has them; None: as usual.

        Examples
        --------
        >>> import numpy as np
        >>> import fieldmon as fm
        >>> days = np.array(["2024-08-11", "2024-06-03", "NaT"], "datetime64[D]")
        >>> fm.Records.of(np.full((3, 2), 30.0), np.ones(3, np.int8), days).in_words()
        '3 records of 2024-06-03 to 2024-08-11, 1 of them without a date'
        """
        n, days = counted(len(self), "record"), self.day[~np.isnat(self.day)]
        if not len(days):
            return worded("{records} without a date", records=n)
        say_day = (units or Units()).day
        first, last = say_day(str(days.min())), say_day(str(days.max()))
        said = worded("{records} of {first} to {last}", records=n, first=first, last=last)
        if first == last:
            said = worded("{records} of {day}", records=n, day=first)
        if undated := len(self) - len(days):
            said = worded("{records}, {n:,} of them without a date", records=said, n=undated)
        return said

    def sentence(self, units: Units | None = None) -> Worded:
        """Return that chances and hot spots begin with them, and of which days they are.

        Days are written as `units` has them; None: as usual.
        """
        said = self.in_words(units)
        return worded("Chances and hot spots begin with {records}.", records=said)

    def reach_m(self) -> NDArray[np.float64]:
        """Return ``(m,)`` metres outside a plot at which a record is still one of its own.

        That is `NEARBY_M`, or twice the record's accuracy where that is more.
        """
        return np.fmax(NEARBY_M, 2.0 * self.accuracy_m)

    @classmethod
    def of(
        cls,
        lonlat: Column,
        present: Column,
        day: Day | Column | None = None,
        **columns: Column,
    ) -> Records:
        """Return records with every column that is not given unknown.

        Parameters
        ----------
        lonlat
            ``(m, 2)`` degrees, longitude first.
        present
            ``(m,)`` 1 infested, 0 clean, -1 not said.
        day
            ``(m,)`` datetime64[D], the plot's, or the one of all; None: of no date.
        columns
            Others of these columns by name, ``(m,)`` each. Where a text is missing (None, NaN,
            pandas's NA) it is unknown.

        Raises
        ------
        ObservationError
            If columns have different lengths, a position is none on earth (NaN: not known), a
            result is not 1, 0 or -1, a day names a time zone, or a number is below 0 or has no
            end. A count that contradicts its result is taken: the result is believed.
        SettingError
            If columns of pandas differ in their index, or texts are none.
        """
        must_share_index("records", {"lonlat": lonlat, "present": present, "day": day, **columns})
        points = lonlat_of("Positions of records", lonlat, _READ, nowhere=True)
        results = np.atleast_1d(array_of(np.float64, "Results of records", present))
        if not np.isin(results, (UNKNOWN, ABSENT, PRESENT)).all():
            raise ObservationError(
                "Results of records must be 1 (infested), 0 (clean) or -1 (not said), but one is "
                f"{results[~np.isin(results, (UNKNOWN, ABSENT, PRESENT))][0]:g}."
            )
        m = len(points)
        unknown: dict[str, NDArray[np.generic]] = {
            "count": np.full(m, np.nan),
            "accuracy_m": np.full(m, np.nan),
            "species": np.full(m, "", dtype=np.str_),
            "stage": np.full(m, "", dtype=np.str_),
            "leaves_sampled": np.full(m, np.nan),
        }
        days = days_of(np.full(m, np.datetime64("NaT")) if day is None else day)
        if days is None:
            raise ObservationError(
                f"Days of records must be as 2026-11-18, but they are {shown(day)}."
            )
        days = days if days.ndim else np.full(m, days)
        must_be_known("Columns of records", columns, list(unknown))
        given = {name: _column(name, values) for name, values in columns.items()}
        _must_make_sense(given)
        return cls(points, results.astype(np.int8), days, **(unknown | given))  # type: ignore[arg-type]

    def take(self, which: Column | slice) -> Records:
        """Return the records at `which` indices, or of a mask ``(k,)``.

        Raise `SettingError` if `which` is neither.
        """
        picked = entries_of("Records", which, len(self))
        return Records(**{name: values[picked] for name, values in vars(self).items()})

    @classmethod
    def none(cls) -> Records:
        """Return no records at all."""
        return cls.of(np.empty((0, 2)), np.empty(0, np.int8))


@dataclass(frozen=True, eq=False)
class UsableRecords:
    """The records that speak on a day, and how many others there were.

    Parameters
    ----------
    records
        Records that say infested or clean, not later than the day; undated ones included.
    undecided, future, undated, old
        How many were left out because they say neither, because they are of a later day; and how
        many of those kept have no date, or are so old that they hardly count.
    prior
        How old that is, and how old undated ones are taken to be.
    """

    records: Records
    undecided: int
    future: int
    undated: int
    old: int
    prior: PriorSettings

    def messages(self) -> tuple[str, ...]:
        """Return a sentence for each thing that a person should know about the records."""
        neither, later = self.undecided, self.future
        said = (
            worded(
                "{n} of the records {n:says|say} neither infested nor clean and {n:is|are} left "
                "out.",
                n=neither,
            ),
            worded(
                "{n} of the records {n:is|are} of a later day and {n:is|are} left out.", n=later
            ),
            worded(
                "{n} of the records {n:has|have} no date and {n:counts|count} as {days:g} days "
                "old, whatever day is planned.",
                n=self.undated,
                days=self.prior.undated_days,
            ),
            worded(
                "{n} of the records {n:is|are} more than {days} days old and hardly "
                "{n:counts|count}.",
                n=self.old,
                days=round(self.prior.hardly_days),
            ),
        )
        return tuple(sentence for sentence in said if sentence.values["n"])


def _must_make_sense(given: dict[str, Any]) -> None:
    """Raise `ObservationError` where a number cannot be."""
    for name, values in given.items():
        if values.dtype.kind == "f" and (wrong := (values < 0) | np.isinf(values)).any():
            raise ObservationError(
                f"Records' {name} must be numbers from 0 on, but one is {values[wrong][0]:g}."
            )


def usable(
    records: Records, on_day: np.datetime64, prior: PriorSettings | None = None
) -> UsableRecords:
    """Return the records that speak on a day; the caller tells of the others.

    Those that are so old that they hardly count by `prior` (None: the usual one) are counted, and
    kept.
    """
    prior = prior or PriorSettings()
    today = on_day.astype("datetime64[D]")
    undecided = records.present == UNKNOWN
    future = ~undecided & (records.day > today)
    kept = records.take(~undecided & ~future)
    return UsableRecords(
        records=kept,
        undecided=int(np.count_nonzero(undecided)),
        future=int(np.count_nonzero(future)),
        undated=int(np.count_nonzero(np.isnat(kept.day))),
        old=int(np.count_nonzero((today - kept.day) / _DAY > prior.hardly_days)),
        prior=prior,
    )


def must_be_records(given: object) -> None:
    """Raise `SettingError` unless this is `Records`, or None: there are none."""
    must_be(
        "Records must be fm.Records", given, (Records, NoneType),
        "Read them with read_records(path, near=plot).",
    )  # fmt: skip
