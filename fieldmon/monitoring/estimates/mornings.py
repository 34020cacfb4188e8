"""What is believed on each morning: worked out once, and kept in the file for the next command."""

from __future__ import annotations

import io
import sqlite3
import threading
import zipfile
import zlib
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import fieldmon.infestation
import fieldmon.pests
from fieldmon.compute.digest import digest
from fieldmon.infestation.ancestry.kept_ancestry import ancestry_of, arrays_of
from fieldmon.infestation.ancestry.origins import OriginCounts
from fieldmon.infestation.insects.cohorts import Age, Cohorts
from fieldmon.infestation.insects.latency import Latency
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.pairs.uninspected_days import UninspectedDays
from fieldmon.infestation.plot_estimate import PlotEstimate
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.monitoring.estimates import history as causes_of_a_morning
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import insert, unpacked

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.monitoring.estimates.history import History

    Arrays = dict[str, NDArray[np.generic]]

# every so many days a morning stays at hand, and the last two of these in the file beside the
# newest and the one before: of a plot of 100 000 plants each is 4 MB
_EVERY, _IN_FILE = 8, 2
# how the names of arrays begin that are of what hides
_LATENCY = "latency_"
# and that are of who infested whom
_ANCESTRY = "ancestry_"
_OTHER, _WEIGHED = "other", "weighed"
# and that are of how old infestations of a named pest are
_COHORTS = "cohorts_"
_UNINSPECTED = "unwatched"


class _KeptMorning(NamedTuple):
    """A morning as the file keeps it: a name for what it follows from, and for what it is."""

    causes: str
    content: str
    chances: bytes


@dataclass(eq=False)
class Mornings:
    """The mornings of a season, worked out from one another as they are asked for.

    Parameters
    ----------
    history
        What happened.
    known
        Mornings that are worked out already, by their days; the first is known without.
    kept
        Those that a file keeps; each is looked at once it is asked for.
    """

    history: History
    known: dict[int, Belief] = field(default_factory=dict)
    kept: dict[int, _KeptMorning] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._lock = threading.RLock()
        self.known[0] = self.history.first_morning

    def of(self, day: int) -> Belief:
        """Return what is believed on the morning of a day; others wait, or would do it, too."""
        with self._lock:
            last = self.last_until(day)
            morning = self.known[last]
            for number in range(last, day):
                morning = self.history.night_after(morning, number)
                self._know(number + 1, morning)
            return morning

    def last_until(self, day: int) -> int:
        """Return the last day up to a day whose morning need not be worked out."""
        with self._lock:
            return self._last_until(day)

    def _last_until(self, day: int) -> int:
        last = max(known for known in self.known if known <= day)
        for number in sorted((n for n in self.kept if last < n <= day), reverse=True):
            morning = self._unpacked(number, self.kept.pop(number))
            if morning is not None:
                self.known[number] = morning
                return number
        return last

    def after_change(self, history: History, since: int) -> Mornings:
        """Return them for a history that is another since a day."""
        with self._lock:
            known = {day: morning for day, morning in self.known.items() if day <= since}
            kept = {day: morning for day, morning in self.kept.items() if day <= since}
        return Mornings(history, known, kept)

    def _unpacked(self, day: int, kept: _KeptMorning) -> Belief | None:
        """Return a morning that the file keeps; None: it is not that of what happened."""
        if kept.causes != causes_until(self.history, day) or kept.content != digest(kept.chances):
            return None
        return _unpacked(self.history.first_morning, kept.chances)

    def _know(self, day: int, morning: Belief) -> None:
        self.known[day] = morning
        passing = [known for known in self.known if known % _EVERY]
        for known in passing[:-_EVERY]:
            del self.known[known]


def take(db: sqlite3.Connection, mornings: Mornings) -> None:
    """Add the mornings that the file keeps, and the estimate of its last day."""
    late = "SELECT day, causes, content, chances FROM mornings WHERE day > 0"
    for day, *kept in db.execute(late):
        mornings.kept[day] = _KeptMorning(*kept)
    rows = db.execute(
        "SELECT day, expected_left, low, high, chance_clean, causes FROM days "
        "WHERE causes IS NOT NULL"
    )
    for day, *figures, causes in rows.fetchall():
        estimate = PlotEstimate(*figures)
        if causes == causes_of(mornings.history, day, estimate) and mornings.last_until(day) == day:
            mornings.history.remember(mornings.known[day], day, estimate)


def causes_of(history: History, day: int, estimate: PlotEstimate) -> str:
    """Return a name for an estimate of a day's evening and all from which it follows."""
    said = estimate.expected, estimate.low, estimate.high, estimate.chance_clean
    return digest(causes_until(history, day + 1), said)


def keep(db: sqlite3.Connection, mornings: Mornings, newest: int) -> None:
    """Keep the latest mornings in the file, within the transaction that changes it."""
    eighths = range(newest - newest % _EVERY, 0, -_EVERY)[:_IN_FILE]
    # that before the newest: who corrects the last day's work begins there
    wanted = {day for day in (*eighths, newest - 1, newest) if day > 0}
    causes = {day: causes_until(mornings.history, day) for day in wanted}
    for day, of_kept in db.execute("SELECT day, causes FROM mornings WHERE day > 0").fetchall():
        if causes.get(day) == of_kept:
            wanted.discard(day)
        else:
            db.execute("DELETE FROM mornings WHERE day = ?", (day,))
    for day in sorted(wanted & mornings.known.keys()):
        chances = _packed(mornings.known[day])
        if chances is not None:
            insert(db, schema.MORNINGS, [(day, causes[day], digest(chances), chances)])


def is_behind(db: sqlite3.Connection, mornings: Mornings, newest: int) -> bool:
    """Tell whether the newest morning was worked out that the file does not keep, or not so.

    As after a new version of fieldmon: who only reads works it out again each time.
    """
    if newest not in mornings.known or newest == 0:
        return False
    row = db.execute("SELECT causes FROM mornings WHERE day = ?", (newest,)).fetchone()
    return row is None or row[0] != causes_until(mornings.history, newest)


def causes_until(history: History, day: int) -> str:
    """Return a name for all from which the morning of a day follows, our own rules among it."""
    done = history.until(day - 1)
    first, told = history.first_morning, history.detections[: len(done)]
    said = history.belief, history.begins
    treated = [
        digest(one.day, one.plants, one.efficacy, one.second, history.inspected_after(one))
        for one in history.treatments
        if one.day < day
    ]
    pest = () if history.pest_in_weather is None else history.pest_in_weather.content
    return digest(
        *pest,
        *(rules(), first.chance, first.pair_chance, _learnt_before(first), said, day, treated),
        *(done.plant, done.result, done.date, told, history.says_gone[: len(done)]),
    )


def _learnt_before(first: Belief) -> bytes:
    """Return what an earlier season taught, which the settings tell only in part."""
    if not isinstance(first, TracedPairs):
        return b""
    return np.concatenate([first.counts.found, first.counts.expected, first.evidence]).tobytes()


@cache
def rules() -> str:
    """Return a name for the program that works mornings out: another one begins at the first."""
    rooms = [Path(room.__path__[0]) for room in (fieldmon.infestation, fieldmon.pests)]
    files = [file for room in rooms for file in sorted(room.rglob("*.py"))]
    files.append(Path(causes_of_a_morning.__file__))
    return digest(*(file.read_bytes() for file in files))


def _packed(morning: Belief) -> bytes | None:
    """Return a morning as bytes; None: it holds more than these arrays."""
    arrays = _arrays(morning)
    if arrays is None:
        return None
    file = io.BytesIO()
    np.savez(file, allow_pickle=False, **arrays)
    # pressed it would be two thirds of that, and each command would wait ten times as long
    return zlib.compress(file.getvalue(), 0)


def _arrays(morning: Belief) -> Arrays | None:
    if isinstance(morning, PairApproximation):
        return {"chance": morning.chance, "pair_chance": morning.pair_chance}
    if not isinstance(morning, TracedPairs):
        return None
    latency = {} if morning.latency is None else vars(morning.latency)
    ancestry = {} if morning.ancestry is None else arrays_of(morning.ancestry)
    return {
        "chance": morning.chance,
        "pair_chance": morning.pair_chance,
        "shares": morning.shares,
        "unseen": morning.unseen,
        "evidence": morning.evidence,
        "slope_sums": morning.slope_sums,
        "counts": np.array([morning.counts.found, morning.counts.expected]),
        "at_start": morning.at_start,
        _WEIGHED: np.array([morning.likely, morning.is_heavier, morning.others is not None]),
        _UNINSPECTED: morning.uninspected.array,
        **{f"{_LATENCY}{name}": values for name, values in latency.items()},
        **{f"{_ANCESTRY}{name}": values for name, values in ancestry.items()},
        **{f"{_COHORTS}{name}": values for name, values in _aged(morning).items()},
        **{
            f"{_OTHER}{k}_{name}": values
            for k, other in enumerate(morning.others or ())
            for name, values in (_arrays(other) or {}).items()
        },
    }


def _aged(morning: TracedPairs) -> Arrays:
    """Return how old infestations of a named pest are, and where the wind has gone of late."""
    if morning.cohorts is None:
        return {}
    ages = np.array([[age.stage, age.progress, age.days] for age in morning.cohorts.ages])
    return {
        "ages": ages.reshape((-1, 3)),
        "shares": morning.cohorts.shares,
        "wind_m_s": np.array(morning.wind_m_s),
    }


def _arrays_in(chances: bytes) -> dict[str, NDArray[Any]]:
    """Return the arrays that bytes hold, which are never pressed: pressed ones may be endless."""
    with np.load(io.BytesIO(unpacked(chances, len(chances))), allow_pickle=False) as file:
        if any(part.compress_type for part in file.zip.infolist()):
            raise ValueError("A kept morning must not be pressed, but it is.")
        return dict(file)


def _unpacked(first: Belief, chances: bytes) -> Belief | None:
    """Return a kept morning of the season that began with `first`, or None: it is of another."""
    try:
        arrays = _arrays_in(chances)
    except (sqlite3.DatabaseError, zipfile.BadZipFile, ValueError, OSError, EOFError):
        return None
    others: list[Belief | None] = []
    while kept := _taken_out(arrays, f"{_OTHER}{len(others)}_"):
        others.append(_believed(first, kept, []))
    return _believed(first, arrays, others)


def _believed(first: Belief, arrays: dict[str, Any], others: list[Belief | None]) -> Belief | None:
    """Return what such arrays hold, and `others` beside it; None: they are of another season."""
    wanted = _arrays(first)
    if wanted is None or None in others:
        return None
    ancestry, aged = _taken_out(arrays, _ANCESTRY), _taken_out(arrays, _COHORTS)
    of_ancestry = _taken_out(wanted, _ANCESTRY).keys()
    ages = _taken_out(wanted, _COHORTS).keys()
    # a day without inspections has more of it
    uninspected = arrays.pop(_UNINSPECTED, None)
    if (uninspected is None) != (wanted.pop(_UNINSPECTED, None) is None):
        return None
    names = wanted.keys(), of_ancestry, ages
    if names != (arrays.keys(), ancestry.keys(), aged.keys()):
        return None
    if any(wanted[name].shape != values.shape for name, values in arrays.items()):
        return None
    own: dict[str, object] = {}
    if isinstance(first, TracedPairs):
        likely, is_heavier, inspected = arrays.pop(_WEIGHED).tolist()
        own = _of_traced(first, arrays, ancestry, aged) | {
            "likely": likely, "is_heavier": bool(is_heavier),
            "others": tuple(others) if inspected else None,
        }  # fmt: skip
    if uninspected is not None:
        own["uninspected"] = UninspectedDays.of_array(uninspected)
    return replace(first, **arrays, **own)  # type: ignore[type-var]


def _of_traced(
    first: TracedPairs, arrays: Arrays, ancestry: dict[str, Any], aged: dict[str, Any]
) -> dict[str, object]:
    """Take out of `arrays` what is more than an array of a morning; return it by its name."""
    pest = first.pest
    own: dict[str, object] = {
        "counts": OriginCounts(*arrays.pop("counts")),
        "ancestry": ancestry_of(first.grid, ancestry, pest) if ancestry else None,
    }
    latency = _taken_out(arrays, _LATENCY)
    if latency:
        own["latency"] = Latency(**latency)
    if pest is not None:
        ages = tuple(Age(int(stage), *rest) for stage, *rest in aged["ages"].tolist())
        own["cohorts"] = Cohorts(pest, ages, aged["shares"])
        own["wind_m_s"] = tuple(aged["wind_m_s"].tolist())
    return own


def _taken_out(arrays: Arrays, beginning: str) -> dict[str, Any]:
    """Take out the arrays whose names begin so; return them by the rest of their names."""
    names = [name for name in arrays if name.startswith(beginning)]
    return {name[len(beginning) :]: arrays.pop(name) for name in names}
