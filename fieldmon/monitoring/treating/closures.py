"""Plants that people must not come to yet after a treatment, and how that is said of a plan."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.monitoring.treating.cautions import label_of, waits
from fieldmon.plot.named_rows import plants_in_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.units import Units
    from fieldmon.compute.wording import Worded
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Scene


class Closure(NamedTuple):
    """Plants that people may not come to before a time.

    Parameters
    ----------
    plants
        ``(n,)`` which they are.
    until
        Local time.
    product
        What was applied there; empty: nobody said.
    opens
        Whether that time is within the working hours: a later plan may have them.
    """

    plants: NDArray[np.bool_]
    until: datetime
    product: str
    opens: bool = False


class EntryWait(NamedTuple):
    """A treatment after which people have to wait: from when on, and until when."""

    plants: NDArray[np.bool_]
    began: datetime
    until: datetime
    product: str

    def closes(self, begins: datetime, ends: datetime) -> Closure | None:
        """Return what it closes to work between two local times; None: nothing."""
        if self.until <= begins or self.began >= max(begins, ends):
            return None
        return Closure(self.plants, self.until, self.product, self.until < ends)


def entry_waits(
    done: Iterable[KeptTreatment], labels: Sequence[ProductLabel], grid: PlantGrid
) -> tuple[EntryWait, ...]:
    """Return the treatments after which people have to wait, as was said or as labels say.

    They close whole rows: whoever goes to another plant of a row may pass those that were treated.
    One whose begin nobody said began with its day.
    """
    known = ((one, waits(one, label_of(one, labels)).entry_from) for one in done)
    return tuple(
        EntryWait(
            _of_their_rows(one.place.plants, grid),
            datetime.combine(one.on, one.application.began or time()),
            until,
            one.application.product,
        )
        for one, until in known
        if until is not None
    )


def _of_their_rows(plants: NDArray[np.bool_], grid: PlantGrid) -> NDArray[np.bool_]:
    if not grid.in_rows:
        return plants
    return np.isin(grid.row, grid.row[plants])


def closed_on(
    waits: Iterable[EntryWait], on: date, begins_s: float, ends_s: float,
    now: datetime | None = None,
) -> tuple[Closure, ...]:  # fmt: skip
    """Return what is closed to work between two seconds of a day.

    With what is closed to it if it begins `now`, where that is later.
    """
    midnight = datetime.combine(on, time())
    begins, ends = (midnight + timedelta(seconds=round(s)) for s in (begins_s, ends_s))
    late = begins if now is None else max(begins, now)
    closed = (one.closes(begins, ends) or one.closes(late, ends) for one in waits)
    return tuple(one for one in closed if one is not None)


def closed_plants(closed: Sequence[Closure], n: int) -> NDArray[np.bool_]:
    """Return ``(n,)`` which plants people may not come to."""
    return np.any([one.plants for one in closed], axis=0) if closed else np.zeros(n, np.bool_)


def open_to_people(scene: Scene, closed: Sequence[Closure]) -> Scene:
    """Return a scene in which nobody is sent to plants that are closed: they seem inspected."""
    if not closed:
        return scene
    plants = closed_plants(closed, len(scene.chance))
    last = np.where(plants, np.int32(scene.day), scene.last_inspected)
    skipped, flagged = (
        None if out is None else out & ~plants for out in (scene.skipped, scene.flagged)
    )
    return replace(scene, last_inspected=last, skipped=skipped, flagged=flagged)


def is_all_closed(scene: Scene, closed: Sequence[Closure]) -> bool:
    """Tell whether there is time, but no plant where people may be: others were inspected today."""
    if not closed or scene.seconds_left <= 0:
        return False
    left_out = closed_plants(closed, len(scene.chance)) | (scene.last_inspected == scene.day)
    return bool(left_out.all())


def closed_in_words(closed: Sequence[Closure], grid: PlantGrid, units: Units) -> tuple[Worded, ...]:
    """Return which plants are closed to people, and until when: the last to open first.

    A plant that several treatments close is said once, with the last time.
    """
    said, told = [], np.zeros(len(grid), np.bool_)
    for one in sorted(closed, key=lambda one: one.until, reverse=True):
        plants = one.plants & ~told
        told |= plants
        if plants.any():
            said.append(_in_words(one, plants_in_words(grid, plants), units))
    return tuple(said)


def _in_words(one: Closure, which: Worded, units: Units) -> Worded:
    values = {
        "time": f"{one.until:%H:%M}",
        "date": units.day(one.until.date()),
        "product": one.product or worded("a product that nobody named"),
        "which": which,
    }
    if one.opens:
        return worded(
            "Closed until {time} on {date} after {product}, so not on the route: {which}. A plan "
            "that begins then or later may have them.", **values,
        )  # fmt: skip
    return worded(
        "Closed until {time} on {date} after {product}, so not on the route: {which}.", **values
    )
