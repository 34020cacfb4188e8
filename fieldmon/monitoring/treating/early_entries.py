"""Who inspected where entry was not allowed yet after a treatment: known once it is recorded."""

from __future__ import annotations

from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.monitoring.treating.cautions import Caution, label_of, waits
from fieldmon.plot.named_rows import plants_in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.treating.cautions import RulesToKeep
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.plot.grid import PlantGrid

# as times are compared
_SECONDS = "datetime64[s]"


def early_entries(
    treatments: Iterable[KeptTreatment],
    rules: RulesToKeep,
    seen: Inspections,
    grid: PlantGrid,
    on: date,
) -> tuple[Caution, ...]:
    """Return who was at treated plants before entry was allowed, up to a day: the last one first.

    An inspection without a time was made when the day's work starts. Before a treatment began (or,
    if nobody said, ended) its place was open.
    """
    seen = seen.take(seen.date <= np.datetime64(on, "D"))
    at = _moments(seen, rules.starts)
    found = [
        caution
        for one in sorted(treatments, key=lambda one: one.ended, reverse=True)
        for caution in _after(one, rules, (seen, at), grid)
    ]
    return tuple(found)


def _moments(seen: Inspections, starts: time) -> NDArray[np.datetime64]:
    """Return ``(k,)`` the local time of each inspection."""
    midnight = timedelta(hours=starts.hour, minutes=starts.minute, seconds=starts.second)
    second = np.where(np.isnan(seen.second), midnight.total_seconds(), seen.second)
    at: NDArray[np.datetime64] = seen.date.astype(_SECONDS) + second.astype("timedelta64[s]")
    return at


def _after(
    one: KeptTreatment,
    rules: RulesToKeep,
    inspected: tuple[Inspections, NDArray[np.datetime64]],
    grid: PlantGrid,
) -> Iterator[Caution]:
    entry = waits(one, label_of(one, rules.labels)).entry_from
    if entry is None:
        return
    seen, at = inspected
    began = one.application.began
    closed = one.clock.at(one.ended) if began is None else datetime.combine(one.on, began)
    there = one.place.plants[seen.plant] & (at >= _plain(closed)) & (at < _plain(entry))
    seen, at = seen.take(there), at[there]
    for day in np.unique(seen.date).tolist():
        that_day = seen.date == np.datetime64(day, "D")
        for who in sorted({*seen.who[that_day].tolist()}):
            which = that_day & (seen.who == who)
            plants = np.zeros(len(grid), np.bool_)
            plants[seen.plant[which]] = True
            units = rules.units
            sentence = worded(
                "{who} was at {plants} on {date} {when}, where {product} was applied on {day}: "
                "entry was allowed from {time} on {first}.",
                who=who or worded("Somebody"), plants=plants_in_words(grid, plants),
                date=units.day(day), when=_when(seen.second[which], at[which]),
                product=one.application.product or worded("a product that nobody named"),
                day=units.day(one.on), time=f"{entry:%H:%M}", first=units.day(entry.date()),
            )  # fmt: skip
            yield Caution("entered", sentence, one.batch)


def _when(seconds: NDArray[np.float64], at: NDArray[np.datetime64]) -> str:
    """Return the times between which somebody was there, as far as they were noted."""
    noted = at[~np.isnan(seconds)]
    if not noted.size:
        return worded("(no time noted)")
    first, last = (f"{moment.item():%H:%M}" for moment in (noted.min(), noted.max()))
    if first == last:
        return worded("at {time}", time=first)
    return worded("from {begin} to {end}", begin=first, end=last)


def _plain(moment: datetime) -> np.datetime64:
    """Return a local time without its zone."""
    return np.datetime64(moment.replace(tzinfo=None), "s")
