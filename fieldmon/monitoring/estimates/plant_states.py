"""What is known of each plant on a day: what was seen since its last treatment counts first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.infestation.hotspots import hot_spots
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.infestation.records import PRESENT, UNKNOWN
from fieldmon.io.parse.result_words import begins_gone

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.monitoring.estimates.history import History

#: why a plant is not inspected any more: nobody could when it was asked for last, or it is gone
NOT_LAST_TIME, NO_LONGER = 1, 2
#: found infested, treated since, and not inspected since then
TREATED_SINCE = 2


def latest_states(history: History, day: int, *, own: bool = False) -> NDArray[np.int8]:
    """Return ``(n,)`` 1 found infested, 0 only looked clean, -1 never seen, or `TREATED_SINCE`.

    Of a plant that was inspected after its last treatment only that counts; what was inspected on
    the day of a treatment without a time was so before it, as in `History.inspected_after`. `own`:
    by the season's inspections alone, without the records of before.
    """
    n, done = len(history.grid), history.until(day)
    looked = done.result != SKIPPED
    plant, result = done.plant[looked], done.result[looked]
    on, second = history.days[: len(done)][looked], done.second[looked]
    treated, treated_s = np.full(n, -1, np.int64), np.zeros(n)
    for treatment in sorted(history.treatments, key=lambda one: (one.day, one.second)):
        if treatment.day <= day:
            treated[treatment.plants] = treatment.day
            treated_s[treatment.plants] = treatment.second
    last = treated[plant]
    since = (on > last) | ((on == last) & (second > treated_s[plant]))
    before, after = np.full((2, n), UNKNOWN, np.int8)
    np.maximum.at(before, plant[~since], result[~since])
    np.maximum.at(after, plant[since], result[since])
    if history.recorded is not None and not own:
        counts = np.where(treated < 0, after, before)
        known = np.maximum(counts, history.recorded)
        before, after = np.where(treated < 0, before, known), np.where(treated < 0, known, after)
    state = np.where(after == UNKNOWN, before, after).astype(np.int8)
    state[(after == UNKNOWN) & (before == PRESENT)] = TREATED_SINCE
    return state


def shown_states(history: History, day: int, *, own: bool = False) -> NDArray[np.int8]:
    """Return `latest_states` with a plant that was treated as found until somebody looked again."""
    state = latest_states(history, day, own=own)
    return np.where(state == TREATED_SINCE, np.int8(PRESENT), state)


def not_inspected(history: History, day: int) -> NDArray[np.int8]:
    """Return ``(n,)`` `NOT_LAST_TIME`, `NO_LONGER`, or 0: neither, by the evening of a day."""
    skipped = history.skips(day).times > 0
    why = np.where(skipped, NOT_LAST_TIME, 0)
    return np.where(history.gone(day), NO_LONGER, why).astype(np.int8)


def not_inspected_said(history: History, day: int) -> list[Worded]:
    """Return how many plants nobody could inspect last time, and how many are gone, if any."""
    why = not_inspected(history, day)
    skipped, gone = (int(np.count_nonzero(why == one)) for one in (NOT_LAST_TIME, NO_LONGER))
    said = []
    if skipped:
        said.append(worded("{n:,} {n:plant|plants} could not be inspected last time.", n=skipped))
    if gone:
        said.append(
            worded(
                "{n:,} {n:plant is|plants are} gone: plans leave {n:it|them} out.",
                n=gone,
            )
        )
    return said


def gone_by_note_alone(history: History, day: int) -> tuple[int, str]:
    """Return how many plants are gone by the evening of a day by a note in other words alone.

    Also the first such note. Before version 0.2 they counted as skipped.
    """
    done, gone = history.until(day), history.gone(day)
    says = history.says_gone[: len(done)] & gone[done.plant]
    plants, notes = done.plant[says], done.notes[says].tolist()
    plainly = np.array([begins_gone(str(note)) for note in notes], np.bool_)
    others = ~np.isin(plants, plants[plainly])
    first = next((str(note) for note, is_other in zip(notes, others, strict=True) if is_other), "")
    return len(np.unique(plants[others])), first


def shown_apart(history: History, day: int) -> tuple[NDArray[np.int8], NDArray[np.bool_]]:
    """Return `shown_states`, found only by the season's inspections, and ``(n,)`` other finds.

    Those are of the records of before alone: of them the states say what inspections saw.
    """
    known, own = (shown_states(history, day, own=own) for own in (False, True))
    recorded = (known == PRESENT) & (own != PRESENT)
    return np.where(recorded, own, known), recorded


def finds_apart(history: History, day: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return ``(n,)`` which finds no inspection of the season made, and which count no more.

    The first count, by the records of before alone. The others were treated since, seen again or
    not: they make no hot spot.
    """
    vine = history.grid.vine

    def found(states: NDArray[np.int8]) -> NDArray[np.bool_]:
        either = np.zeros(len(vine), bool)
        either[vine[states == PRESENT]] = True  # the two faces of a vine are one
        return either[vine]

    counts, own = (found(latest_states(history, day, own=own)) for own in (False, True))
    return counts & ~own, found(history.known(day)) & ~counts


def hot_spots_on(history: History, day: int) -> HotSpots:
    """Return the hot spots of a day: finds that were treated since make none."""
    state = latest_states(history, day)
    return hot_spots(history.grid, np.where(state == TREATED_SINCE, np.int8(UNKNOWN), state))
