"""What is brought to a season, held to what is recorded of the same plants and days."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import ContradictionError
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES, SKIPPED
from fieldmon.io.writers.day_file import with_face
from fieldmon.monitoring.inspecting.inspection_table import time_text
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.plot.grid import PlantGrid

    #: a plant and a day
    Key = tuple[int, int]

_MOST_NAMED = 5


@dataclass(frozen=True, eq=False)
class Contradictions:
    """Inspections that say otherwise than what is recorded of the same plant and day.

    Parameters
    ----------
    which
        ``(c,)`` their numbers among those brought.
    plant, date
        ``(c,)`` of what, and of which day.
    recorded, brought
        ``(c,)`` result that is recorded, and the one brought: `CLEAN` or `FOUND`.
    together
        ``(c,)`` whether none is recorded: both are brought at once.
    """

    which: NDArray[np.intp]
    plant: NDArray[np.int32]
    date: NDArray[np.datetime64]
    recorded: NDArray[np.int8]
    brought: NDArray[np.int8]
    together: NDArray[np.bool_]

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.which)

    def sentences(self, grid: PlantGrid) -> list[str]:
        """Return one sentence for each, with rows as the plot's file names them."""
        numbered = plant_numbers(grid, self.plant)
        told = (self.plant, *numbered, self.date, self.recorded, self.brought, self.together)
        sentences: list[str] = []
        columns = (values.tolist() for values in told)
        for plant, line, number, date, was, now, together in zip(*columns, strict=True):
            values = {
                "line": grid.line_signs[line],
                "number": with_face(grid, plant, number),
                "date": date,
                "result_names": worded(RESULT_NAMES[was]),
                "result_names_2": worded(RESULT_NAMES[now]),
            }
            if together:
                said = worded(
                    "Row {line}, plant {number} on {date}: brought as {result_names} and as "
                    "{result_names_2}.",
                    **values,
                )
            else:
                said = worded(
                    "Row {line}, plant {number} on {date}: recorded as {result_names}, now "
                    "{result_names_2}.",
                    **values,
                )
            sentences.append(said)
        return sentences

    def still(self, held: Inspections) -> Contradictions:
        """Return those of which both results are held."""
        results = _held(held, self)
        stays = np.array([len(results.get(key, ())) > 1 for key in _keys(self)], bool)
        columns = ("which", "plant", "date", "recorded", "brought", "together")
        return Contradictions(*(getattr(self, name)[stays] for name in columns))

    def concerns(self, brought: Inspections) -> NDArray[np.bool_]:
        """Return ``(k,)`` which of those brought are of these plants and days, on either side."""
        keys = {*_keys(self)}
        return np.array([key in keys for key in _keys(brought)], bool)

    def both_brought(self, brought: Inspections) -> bool:
        """Return whether of one of these plants and days both results are brought."""
        done = brought.take(self.concerns(brought)).inspected
        return any(len(results) > 1 for results in _held(done, done).values())

    def refuse(self, grid: PlantGrid, *, corrected: bool = False) -> None:
        """Raise `ContradictionError` if there are any, with the first few by name.

        `corrected`: those brought are corrections.
        """
        if not len(self):
            return
        named = joined(" ", self.sentences(grid)[:_MOST_NAMED])
        more = " ..." if len(self) > _MOST_NAMED else ""
        if corrected:
            raise ContradictionError(
                worded(
                    "Corrections must not contradict what else is recorded of the same plants and "
                    "days unless that is confirmed, but {n} of them {n:does|do}: {named}{more} "
                    "Nothing was taken: correct them otherwise, or confirm that both hold.",
                    n=len(self),
                    named=named,
                    more=more,
                )
            )
        if self.together.all():
            raise ContradictionError(
                worded(
                    "Results that are brought must not contradict each other unless that is "
                    "confirmed, but {n} of them {n:does|do}, of the same plant and day: "
                    "{named}{more} Check both; then leave out what is wrong, or confirm that both "
                    "hold.",
                    n=len(self),
                    named=named,
                    more=more,
                )
            )
        raise ContradictionError(
            worded(
                "Results must not contradict what is recorded of the same "
                "plants and day unless that is confirmed, but {n} of them "
                "{n:contradicts|contradict} it: {named}{more} Check both; then undo what was "
                "wrong, or confirm that these hold too.",
                n=len(self),
                named=named,
                more=more,
            )
        )


def contradictions(brought: Inspections, held: Inspections) -> Contradictions:
    """Return which of the inspections brought say otherwise than those held, or before them.

    Clean against found or found against clean, of one plant on one day, whether one is held or
    both are brought at once. Where both are held already, neither is news; a plant that could not
    be inspected says nothing.
    """
    same = _n_alike(brought, held)  # nearly all, of two copies of a season
    news = brought.take(slice(same, None))
    results = _held(held.inspected, news)
    recorded_of, found = frozenset(results), []
    for k, (key, result) in enumerate(zip(_keys(news), news.result.tolist(), strict=True), same):
        if result == SKIPPED:
            continue
        was = results.setdefault(key, set())
        if was and result not in was:
            found.append((k, min(was), key not in recorded_of))
        was.add(result)
    return _of(brought, found)


def corrected_against(now: Inspections, before: Inspections) -> Contradictions:
    """Return which of those held after a correction contradict others, and did not `before` it.

    They are of one plant and day; and where clean and found of a day were known to be of different
    times, of one minute.
    """
    of_days = contradictions(now, before).still(now)
    columns = of_days.which, of_days.recorded, of_days.together
    found = [*zip(*(column.tolist() for column in columns), strict=True)]
    told, was = {*_keys(of_days)}, _by_minute(before)
    for key, rows in _by_minute(now).items():
        stood = was.get(key, {})
        if len(rows) > 1 and len(stood) < 2 and key[:2] not in told:
            recorded = min(stood or rows)
            found.append((rows[FOUND if recorded == CLEAN else CLEAN], recorded, not stood))
    return _of(now, sorted(found))


def _by_minute(held: Inspections) -> dict[tuple[int, int, int], dict[int, int]]:
    """Return by plant, day and minute the inspections of each result; unknown times are left out.

    A plant that could not be inspected says nothing.
    """
    rows: dict[tuple[int, int, int], dict[int, int]] = {}
    told = zip(_keys(held), held.second.tolist(), held.result.tolist(), strict=True)
    for k, (key, second, result) in enumerate(told):
        if result != SKIPPED and not np.isnan(second):
            rows.setdefault((*key, int(second // 60)), {})[result] = k
    return rows


def _of(brought: Inspections, found: list[tuple[int, int, bool]]) -> Contradictions:
    """Return contradictions by numbers among those brought, what is recorded, and if `together`."""
    at = np.array([k for k, *_ in found], np.intp)
    recorded = np.array([result for _, result, _ in found], np.int8)
    together = np.array([both for *_, both in found], bool)
    of = brought.plant[at], brought.date[at]
    return Contradictions(at, *of, recorded, brought.result[at], together)


def _n_alike(one: Inspections, other: Inspections) -> int:
    """Return with how many inspections of the same plants, days and results both begin."""
    n = min(len(one), len(other))
    alike = np.ones(n, bool)
    for name in ("plant", "date", "result"):
        alike &= getattr(one, name)[:n] == getattr(other, name)[:n]
    return n if alike.all() else int(np.argmin(alike))


def contradicting(held: Inspections) -> Inspections:
    """Return those of which another says otherwise of the same plant and day, plant by plant."""
    done = held.inspected
    results = _held(done, done)
    both = [k for k, key in enumerate(_keys(done)) if len(results[key]) > 1]
    said = done.take(np.array(both, np.intp))
    return said.take(np.argsort(said.plant, kind="stable"))


def contradiction_lines(
    held: Inspections, grid: PlantGrid, named: Callable[[str], str] = str
) -> tuple[Worded, ...]:
    """Return of each plant that was both clean and found on a day who says what, a line each.

    `named` writes a name for where it is read.
    """
    said = contradicting(held)
    of: dict[int, list[Worded]] = {}
    for plant, result, who in zip(said.plant.tolist(), said.result, said.who, strict=True):
        each = worded(RESULT_NAMES[int(result)])
        if who:
            each = worded("{result} ({who})", result=each, who=named(str(who)))
        of.setdefault(plant, []).append(each)
    numbered = plant_numbers(grid, np.array([*of], dtype=np.int64))
    return tuple(
        worded(
            "Row {row}, plant {plant}: {said}",
            row=grid.line_signs[line], plant=with_face(grid, plant, number),
            said=joined(", ", each),
        )
        for (plant, each), line, number in zip(
            of.items(), numbered.line.tolist(), numbered.number.tolist(), strict=True
        )
    )  # fmt: skip


def said_before(brought: Inspections, held: Inspections) -> NDArray[np.bool_]:
    """Return ``(k,)`` whether each adds nothing to those held.

    The same is held, and it has no count, and no time or the same. A route file filled in after its
    stops were tapped in the field says what is known. That 0 were counted says no more than clean;
    of a find it says that nobody counted.
    """
    known = set(_told(held.take(np.isin(held.plant, brought.plant))))
    at_all = {told[:2] for told in known}
    same = [told[:2] in at_all if told[2] is None else told in known for told in _told(brought)]
    uncounted = np.isnan(brought.count) | (brought.count == 0)
    added_nothing: NDArray[np.bool_] = uncounted & np.array(same, bool)
    return added_nothing


def known_before(brought: Inspections, held: Inspections) -> NDArray[np.bool_]:
    """Return ``(k,)`` whether each adds nothing to those held, as the same count adds none."""
    held = held.take(np.isin(held.plant, brought.plant))
    counted = {*zip(_told(held), held.count.tolist(), strict=True)}
    same = [one in counted for one in zip(_told(brought), brought.count.tolist(), strict=True)]
    known: NDArray[np.bool_] = said_before(brought, held) | np.array(same, bool)
    return known


def _told(inspections: Inspections) -> Iterator[tuple[Key, int, str | None]]:
    """Yield plant and day, result and time of each, as files have them."""
    times = map(time_text, inspections.second.tolist())
    yield from zip(_keys(inspections), inspections.result.tolist(), times, strict=True)


def _held(held: Inspections, brought: Inspections | Contradictions) -> dict[Key, set[int]]:
    """Return the results held of the plants brought, by plant and day."""
    held = held.take(np.isin(held.plant, brought.plant))
    results: dict[Key, set[int]] = {}
    for key, result in zip(_keys(held), held.result.tolist(), strict=True):
        results.setdefault(key, set()).add(result)
    return results


def _keys(inspections: Inspections | Contradictions) -> Iterator[Key]:
    # a day that is no time is one number too
    days = inspections.date.astype(np.int64).tolist()
    return zip(inspections.plant.tolist(), days, strict=True)
