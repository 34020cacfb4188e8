"""What to beware of after treatments: harvest, entry, resistance, and what labels allow.

Labels are the user's own table; where it does not say, nothing is made up.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import date, datetime
from itertools import combinations, groupby
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted, figure, first_few, worded
from fieldmon.decisions.labels import label_for, of_others, plain_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from datetime import time

    from numpy.typing import NDArray

    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.monitoring.treating.waiting_periods import WaitingPeriod

_Wait = TypeVar("_Wait", int, float)
# day, begin and end; where no end was said, the batch
_Spraying = tuple[int, "time | None", "time | None", "int | None"]
_Said = tuple["KeptTreatment", "ProductLabel | None"]
#: uses of one mode-of-action group after another that breed resistance
MOST_IN_A_ROW = 2
# crops and pests of labels that a sentence names
_MOST_LINES = 5
# kinds of caution, the most urgent first
_URGENT = (
    "lost", "entry", "entered", "harvest", "dose", "twice", "uses", "group", "waiting", "label",
)  # fmt: skip


@dataclass(frozen=True)
class Caution:
    """One thing to beware of.

    Parameters
    ----------
    kind
        ``"harvest"``, ``"entry"``, ``"entered"``, ``"group"``, ``"dose"``, ``"twice"``,
        ``"uses"``, ``"waiting"``, ``"label"`` or ``"lost"``.
    sentence
        What, where and from when on.
    batch
        Of the treatment that it is about; 0: of none.
    """

    kind: str
    sentence: str
    batch: int


@dataclass(frozen=True)
class RulesToKeep:
    """What treatments are held to.

    Parameters
    ----------
    labels
        What labels allow; empty: the user gave none.
    harvest
        The first day of harvest; None: not known.
    starts
        Local time at which a day's work starts.
    units
        How dates are written.
    asked
        Batch of a treatment that nobody did: what it would bring is asked; None: there is none.
    """

    labels: tuple[ProductLabel, ...]
    harvest: date | None
    starts: time
    units: Units = field(default_factory=Units)
    asked: int | None = None


def cautions(
    treatments: Sequence[KeptTreatment], rules: RulesToKeep, on: date
) -> tuple[Caution, ...]:
    """Return what to beware of on a day, after the treatments up to it, the most urgent first.

    Of one kind, that of the last treatment comes first; a wait that is known to be too long comes
    before one that nobody said.

    Those whose mode-of-action group nobody said are no use of any group, and end no row of uses.
    What may be recorded twice is said on its day.
    """
    said = _labelled(treatments, rules, on)
    twice = _twice([one for one, _ in said if one.on == on], rules.units)
    return _urgent_first(said, [*twice, *_in_a_row(said, rules.units)], rules, on)


def because_of(
    treatments: Sequence[KeptTreatment], batch: int, rules: RulesToKeep, on: date
) -> tuple[Caution, ...]:
    """Return what to beware of on a day because of one treatment, and what it adds to later ones.

    One that is entered late may make a later use one too many.
    """
    said = _labelled(treatments, rules, date.max)
    of_several = [*_of_several(said, rules.units)]
    own = [(one, label) for one, label in said if one.batch == batch and one.on <= on]
    of_own = [caution for caution in of_several if own and caution.batch == batch]
    others = [(one, label) for one, label in said if one.batch != batch]
    without = {caution.sentence for caution in _of_several(others, rules.units)}
    added = [one for one in of_several if one.batch != batch and one.sentence not in without]
    return (*_urgent_first(own, of_own, rules, on), *_urgent_first([], added, rules, on))


def _labelled(treatments: Iterable[KeptTreatment], rules: RulesToKeep, until: date) -> list[_Said]:
    """Return the treatments up to a day with their labels, in the order of their days."""
    # one that went on over midnight is of the day on which it began
    done = sorted((one for one in treatments if one.on <= until), key=lambda one: one.on)
    return [(one, label_of(one, rules.labels)) for one in done]


def _urgent_first(
    said: Sequence[_Said], in_a_row: Iterable[Caution], rules: RulesToKeep, on: date
) -> tuple[Caution, ...]:
    """Return what to beware of because of each treatment, and of several in a row."""
    found = [
        *(caution for one, label in said for caution in _unsaid_wait(one, label, rules)),
        *(caution for one, label in said for caution in _of_waits(one, label, rules, on)),
        *in_a_row,
        *(caution for one, label in said for caution in _of_dose(one, label, rules)),
    ]
    found.reverse()
    return by_urgency(found)


def by_urgency(found: Iterable[Caution]) -> tuple[Caution, ...]:
    """Return cautions, the most urgent kind first; those of one kind stay in order."""
    return tuple(sorted(found, key=lambda one: _URGENT.index(one.kind)))


def _of_several(said: Sequence[_Said], units: Units) -> Iterator[Caution]:
    """Yield what to beware of because of several treatments: one recorded twice, or in a row."""
    yield from _twice([one for one, _ in said], units)
    yield from _in_a_row(said, units)


def _twice(done: Iterable[KeptTreatment], units: Units) -> Iterator[Caution]:
    """Yield which of several treatments may be one that is recorded twice."""
    for one, other in combinations(done, 2):
        named = [plain_name(each.application.product) for each in (one, other)]
        if one.on != other.on or named[0] != named[1]:
            continue
        if said := same_plants_twice(one, other, units):
            yield Caution("twice", said, max(one.batch, other.batch))


def _in_a_row(said: Sequence[_Said], units: Units) -> Iterator[Caution]:
    """Yield what to beware of because of several treatments of one group, or with one product."""
    yield from _groups_in_a_row(said, units)
    yield from _uses(said, units)


def label_of(one: KeptTreatment, labels: Iterable[ProductLabel]) -> ProductLabel | None:
    """Return what the label of a treatment's product allows; None: there is none of it."""
    said = one.application
    if not said.product:
        return None
    return label_for(
        labels, said.product, said.crop, said.pest, dose=said.dose, water_l_ha=said.water_l_ha
    )


def waits(one: KeptTreatment, label: ProductLabel | None) -> WaitingPeriod:
    """Return what has to be waited for: as entered, or longer where the label says so."""
    period = one.entered_waits
    if label is None:
        return period
    return replace(
        period,
        days=_longer(period.days, label.waiting_days),
        hours=_longer(period.hours, label.reentry_hours),
    )


def groups(one: KeptTreatment, label: ProductLabel | None) -> tuple[str, ...]:
    """Return the mode-of-action groups: as people said, else those of its label, then and now."""
    kept = one.application.irac_groups
    if label is None or (kept and one.groups_said):
        return kept
    return tuple(dict.fromkeys((*kept, *label.irac_groups)))


def closed_until(
    one: KeptTreatment, label: ProductLabel | None, starts: time, on: date
) -> datetime | None:
    """Return the local time until which nobody may enter a treated place on a day.

    None: they may when work starts, or nobody said.
    """
    entry = waits(one, label).entry_from
    return entry if entry is not None and entry > datetime.combine(on, starts) else None


def harvest_from(
    treatments: Iterable[KeptTreatment], labels: Sequence[ProductLabel]
) -> tuple[date | None, KeptTreatment] | None:
    """Return the first day on which harvest is allowed everywhere, and after which treatment.

    The day is None where nobody said how long to wait from a treatment: that one, or the last of
    them. None: there was no treatment.
    """
    days = [(waits(one, label_of(one, labels)).harvest_from, one) for one in treatments]
    unsaid = [(day, one) for day, one in days if day is None]
    if unsaid:
        return max(unsaid, key=lambda item: item[1].on)
    return max(days, key=lambda item: item[0] or date.min, default=None)


def harvest_unsaid(one: KeptTreatment, units: Units | None = None) -> str:
    """Return that no day of harvest can be named, as nobody said how long to wait from `one`."""
    return worded(
        "From when on harvest is allowed is not known: how long to wait from {product} on {day} "
        "was not said.", **_named(one, units or Units()),
    )  # fmt: skip


def counts_no_more(one: KeptTreatment, label: ProductLabel | None, why: str) -> str:
    """Return that a treatment of two copies does not count any more, what ends, and `why`."""
    first, named = waits(one, label).harvest_from, _named(one, Units()) | {"day": one.on}
    if first is None:
        return worded(
            "The treatment with {product} on {day} {why}: it does not count, nor do its warnings. "
            "If it was done, record it again: in the app, or with: fieldmon treat",
            why=why, **named,
        )  # fmt: skip
    return worded(
        "The treatment with {product} on {day} {why}: it does not count, nor do its warnings and "
        "its wait (harvest from {first}). If it was done, record it again: in the app, or with: "
        "fieldmon treat",
        why=why, first=first, **named,
    )  # fmt: skip


def same_plants_twice(one: KeptTreatment, other: KeptTreatment, units: Units | None = None) -> str:
    """Return that two treatments with one product on one day may be one; "": of other plants."""
    n = int(np.count_nonzero(one.place.plants & other.place.plants))
    if not n:
        return ""
    first, second = sorted((one.batch, other.batch))
    return worded(
        "Two treatments of {plants} with {product} on {day}: batches {first} and {second}. Both "
        "count; undo one if it was the same.",
        plants=counted(n, "plant"), first=figure(first), second=figure(second),
        **_named(one, units or Units()),
    )  # fmt: skip


def _longer(one: _Wait | None, other: _Wait | None) -> _Wait | None:
    return max((wait for wait in (one, other) if wait is not None), default=None)


def _named(one: KeptTreatment, units: Units) -> dict[str, str]:
    product = one.application.product or worded("a product that nobody named")
    return {"product": product, "day": units.day(one.on)}


def _unsaid_wait(
    one: KeptTreatment, label: ProductLabel | None, rules: RulesToKeep
) -> Iterator[Caution]:
    if waits(one, label).harvest_from is not None:
        return
    said = worded(
        "How long to wait from {product} on {day} until harvest was not said.",
        **_named(one, rules.units),
    )
    if rules.harvest is not None and one.on <= rules.harvest:
        said = worded(
            "How long to wait from {product} on {day} until the harvest on {harvest} was not said.",
            harvest=rules.units.day(rules.harvest), **_named(one, rules.units),
        )  # fmt: skip
    if one.batch == rules.asked:
        said = worded(
            "If {product} is sprayed here, how long to wait until harvest is not known: no label "
            "in the season says it.", product=one.application.product,
        )  # fmt: skip
    todo = worded("Look at its label, and say it as it stands there.")
    if not one.application.product:
        todo = worded("Take the treatment back, and record it again with its product and its wait.")
    said = worded("{said} {todo}", said=said, todo=todo)
    yield Caution("harvest", said, one.batch)


def _of_waits(
    one: KeptTreatment, label: ProductLabel | None, rules: RulesToKeep, on: date
) -> Iterator[Caution]:
    period, named = waits(one, label), _named(one, rules.units)
    first, entry = period.harvest_from, closed_until(one, label, rules.starts, on)
    if rules.harvest is not None and first is not None and one.on <= rules.harvest < first:
        said = worded(
            "Harvest on {harvest} is too soon after {product} on {day}: it has to wait {days}, "
            "until {first}.",
            harvest=rules.units.day(rules.harvest), days=counted(period.days or 0, "day"),
            first=rules.units.day(first), **named,
        )  # fmt: skip
        yield Caution("harvest", said, one.batch)
    if entry is not None:
        said = worded(
            "Do not enter before {time} on {date} where {product} was applied on {day}.",
            time=f"{entry:%H:%M}", date=rules.units.day(entry.date()), **named,
        )  # fmt: skip
        yield Caution("entry", said, one.batch)
    yield from _shorter_than_the_label(one, label, named)


def _shorter_than_the_label(
    one: KeptTreatment, label: ProductLabel | None, named: dict[str, str]
) -> Iterator[Caution]:
    days, asked = one.application.waiting_days, label.waiting_days if label else None
    if days is not None and asked is not None and days < asked:
        said = worded(
            "The waiting period of {product} on {day} is recorded as {days}, but its label says "
            "{asked}: the label's counts.",
            days=counted(days, "day"), asked=counted(asked, "day"), **named,
        )  # fmt: skip
        yield Caution("waiting", said, one.batch)
    hours, least = one.application.reentry_hours, label.reentry_hours if label else None
    if hours is not None and least is not None and hours < least:
        said = worded(
            "Re-entry after {product} on {day} is recorded as {hours} h, but its label says "
            "{least} h: the label's counts.",
            hours=figure(hours, "g"), least=figure(least, "g"), **named,
        )  # fmt: skip
        yield Caution("waiting", said, one.batch)


def _groups_in_a_row(said: Sequence[_Said], units: Units) -> Iterator[Caution]:
    """Yield uses of one mode-of-action group after another on the same plants.

    A day is one use of each of its groups: its insects are those of one generation.
    """
    row: dict[str, NDArray[np.int64]] = {}
    of = {one.batch: groups(one, label) for one, label in said}
    for _, same_day in groupby((one for one, _ in said if of[one.batch]), lambda one: one.on):
        today = list(same_day)
        any_group = np.logical_or.reduce([one.place.plants for one in today])
        for group in {*row, *(g for one in today for g in of[one.batch])}:
            used = np.zeros(len(any_group), bool)
            for one in today:
                if group in of[one.batch]:
                    used |= one.place.plants
            before = row.get(group, np.zeros(len(any_group), np.int64))
            row[group] = np.where(used, before + 1, np.where(any_group, 0, before))
        for one in today:
            for group in of[one.batch]:
                for uses, n in _beyond(row[group][one.place.plants], MOST_IN_A_ROW):
                    sentence = worded(
                        "Use {n} of mode-of-action group {group} in a row on {plants}: {product} "
                        "on {day}. Take another group, or mites become resistant.",
                        n=uses, group=group, plants=counted(n, "plant"), **_named(one, units),
                    )  # fmt: skip
                    yield Caution("group", sentence, one.batch)


def _uses(said: Sequence[_Said], units: Units) -> Iterator[Caution]:
    """Yield uses of a product beyond what its label allows in a season, on the same plants."""
    uses: dict[str, NDArray[np.int64]] = {}
    sprayings: dict[tuple[str, _Spraying], NDArray[np.bool_]] = {}
    for one, label in said:
        if label is None:
            continue
        name, plants = plain_name(label.product), one.place.plants
        count = uses.setdefault(name, np.zeros(len(plants), np.int64))
        spraying = name, _spraying(one)
        before = sprayings.get(spraying, np.zeros(len(plants), np.bool_))
        count += plants & ~before
        sprayings[spraying] = before | plants
        if (most := label.max_uses) is None:
            continue
        for use, n in _beyond(count[plants], most):
            sentence = worded(
                "Use {n} in this season on {plants}: {product} on {day}. Its label allows {most}.",
                n=use, plants=counted(n, "plant"), most=figure(most), **_named(one, units),
            )  # fmt: skip
            yield Caution("uses", sentence, one.batch)


def _spraying(one: KeptTreatment) -> _Spraying:
    """Return what is alike in the records of one spraying: its day, and from when to when it was.

    A plant in two such records, of two zones or of two copies, was treated once. Where nobody said
    when it ended, each record is a spraying: it is its batch.
    """
    said = one.application
    unsaid = None if said.ended is not None else one.batch
    return one.day, said.began, said.ended, unsaid


def _beyond(uses: NDArray[np.int64], most: int) -> list[tuple[int, int]]:
    """Return numbers of uses beyond the most, and on how many plants there were so many each."""
    numbers, plants = np.unique(uses[uses > most], return_counts=True)
    return list(zip(numbers.tolist(), plants.tolist(), strict=True))


def _of_another_crop(one: KeptTreatment, rules: RulesToKeep) -> Iterator[Caution]:
    """Yield that no label of the product is for the crop and the pest, as they are written."""
    said = one.application
    lines = of_others(rules.labels, said.product, said.crop, said.pest)
    if not lines:
        return
    each = dict.fromkeys(_crop_and_pest(line.crop, line.pest) for line in lines)
    sentence = worded(
        "The label of {product} in the season's table is for {lines}, but the treatment on {day} "
        "says {said}. Until both are written alike, the strictest line of {product} counts.",
        lines=first_few([*each], _MOST_LINES), said=_crop_and_pest(said.crop, said.pest),
        **_named(one, rules.units),
    )  # fmt: skip
    yield Caution("label", sentence, one.batch)


def _crop_and_pest(crop: str, pest: str) -> str:
    return " / ".join(filter(None, (crop, pest)))


def _of_dose(
    one: KeptTreatment, label: ProductLabel | None, rules: RulesToKeep
) -> Iterator[Caution]:
    named, dose = _named(one, rules.units), one.application.dose
    if label is None:
        if rules.labels and one.application.product:
            said = worded(
                "No label of {product} stands in the season's table: what it allows was not "
                "looked at.", product=named["product"],
            )  # fmt: skip
            yield Caution("label", said, one.batch)
        return
    yield from _of_another_crop(one, rules)
    if dose is None or label.max_dose is None:
        return
    share = dose.share_of(label.max_dose, one.application.water_l_ha)
    if share is None:
        said = worded(
            "The dose of {product} on {day}, {dose}, cannot be compared with its label's, {most}. "
            "Look yourself.", dose=str(dose), most=str(label.max_dose), **named,
        )  # fmt: skip
        yield Caution("dose", said, one.batch)
    elif share > 1.0:
        said = worded(
            "The dose of {product} on {day}, {dose}, is more than its label allows, {most}.",
            dose=str(dose), most=str(label.max_dose), **named,
        )  # fmt: skip
        yield Caution("dose", said, one.batch)
