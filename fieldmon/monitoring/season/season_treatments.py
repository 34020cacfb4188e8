"""What was treated in a season, whether it worked, and what to beware of since."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from fieldmon.compute.array_arguments import plants_marked
from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import first_few, joined, worded
from fieldmon.decisions.labels import SAID_BY_HAND, label_for, plain_name, with_wait
from fieldmon.decisions.zones import ground_m2, outline_of
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.changes import outside_changes, season_log
from fieldmon.monitoring.estimates import treatment_effect
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.file import label_table
from fieldmon.monitoring.inspecting import batches
from fieldmon.monitoring.inspecting.batches import Recorded
from fieldmon.monitoring.phones.people import written_in
from fieldmon.monitoring.season.open_season import OpenSeason
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.monitoring.treating import cautions, treatments
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.cautions import Caution, RulesToKeep
from fieldmon.monitoring.treating.early_entries import early_entries
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.monitoring.treating.treatments import KeptTreatment, TreatedPlace, by_vine
from fieldmon.monitoring.treating.waiting_periods import end_of
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.named_rows import place_in_words

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Iterator, Sequence
    from datetime import date

    import numpy as np
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.compute.day_arguments import Day
    from fieldmon.compute.units import Units
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.monitoring.changes.log_entry import LogEntry
    from fieldmon.monitoring.estimates.treatment_effect import TreatmentEffect


# kinds of caution that can be told of a treatment before it is done
_BEFORE_TREATING = ("harvest", "uses", "group", "label")


@checked
class SeasonTreatments(OpenSeason):
    """The treatments of a season, and the labels of what was used."""

    def treat(
        self, on: Day, efficacy: float | None = None, area: MultiPolygon | None = None,
        product: str = "", *, application: Application | None = None,
        plants: NDArray[np.generic] | Sequence[Any] | None = None,
    ) -> Recorded:  # fmt: skip
        """Note that a part of the plot was treated.

        What was inspected on that day after `application` ended counts after it; of one without
        times nothing.

        Parameters
        ----------
        on
            The day.
        efficacy
            Chance that an infested plant is clean afterwards; None: what the season learnt of this
            product, see `effects`.
        area
            Outline, lon/lat; None: the whole plot, unless `plants` are given.
        product
            Trade name of what was used, where `application` names none.
        application
            What was applied and how. What it does not say of waiting periods and of the
            mode-of-action group comes from the product's label, where the season has one.
        plants
            ``(n,)`` the plants that were treated one by one, instead of an area.

        Raises
        ------
        SettingError
            If no plant was treated, nothing tells how well it works, or `product` is another than
            that of `application`.
        """
        said = (application or Application()).of_product(product)
        place = self._place(area, plants)
        works = self._efficacy(said.product) if efficacy is None else efficacy
        with self._writing() as db:
            before = self._read(db)
            day = settings_of(db).day(on)
            entered = replace(said, operator=written_in(db, said.operator))
            said = entered.by_label(
                label_for(label_table.read(db), said.product, said.crop, said.pest)
            )
            filled = [n for n in treatments.FILLED if getattr(said, n) != getattr(entered, n)]
            treatment = Treatment(day, place.plants, works)  # or raise
            batch = batches.begin(db, "treatment", said.product, said.operator)
            new = treatments.store(
                db, treatment, (place, on, said), batch, local_clock(self.plot.field), filled
            )
            batches.end(db, batch, new)
            if new:
                where = place_in_words(self.plot.grid, place.plants)
                once = replace(place, plants=self.plot.grid.vines_of(place.plants))
                season_log.append(
                    db, "treated", said.operator, states=season_log.states(db, [batch]),
                    batch=batch, date=str(on), said=treatments.in_words(once, said, where),
                    efficacy=works, **said.said(),
                )  # fmt: skip
                self._refresh(db, day, before)
        return Recorded(batch if new else None, new, 1 - new)

    def _place(
        self, area: MultiPolygon | None, plants: NDArray[np.generic] | Sequence[Any] | None
    ) -> TreatedPlace:
        """Return the place of a treatment, or raise `SettingError`."""
        if area is not None and plants is not None:
            raise SettingError(
                worded("A treatment is of an area or of plants, but both were given.")
            )
        place = self._treated(area) if plants is None else self._treated_one_by_one(plants)
        if not place.plants.any():
            raise SettingError(
                worded(
                    "The area treated must hold plants of this plot, but it holds none. Check its "
                    "coordinates."
                )
            )
        return place

    def _treated(self, area: MultiPolygon | None) -> TreatedPlace:
        ground = self.plot.field.boundary if area is None else area
        plants = self._inside(ground)
        return TreatedPlace(ground, plants, ground_m2(self.plot.grid, plants) / 1e4)

    def _treated_one_by_one(self, given: object) -> TreatedPlace:
        grid, plants = self.plot.grid, self._each_plant(given)
        area_ha = ground_m2(grid, plants) / 1e4
        return TreatedPlace(outline_of(grid, plants), plants, area_ha, by_plant=True)

    def _each_plant(self, given: object) -> NDArray[np.bool_]:
        """Return a caller's mask of plants, or raise `SettingError`."""
        n = len(self.plot.grid)
        return plants_marked(
            "The mask of treated plants", given, n,
            lambda size: worded(
                "Whether it was treated must be said of each of the {n} plants, but it is of "
                "{size}.",
                n=n, size=size,
            ),
        )  # fmt: skip

    def _efficacy(self, product: str) -> float:
        """Return how well a product works, as the season learnt it."""
        told = self.effects(last_date(self)) if product else ()
        known = treatment_effect.learnt_efficacy(told, product) if product else None
        if known is None:
            raise SettingError(
                worded(
                    "How well a treatment works must be said (its efficacy), for this season has "
                    "not learnt it: no plant was inspected before and after a treatment with "
                    "{product}.",
                    product=product or worded("a product that nobody named"),
                )
            )
        return known.efficacy

    def treatments(self) -> tuple[KeptTreatment, ...]:
        """Return the treatments that count, in the order in which they ended."""
        with self._lock, self.store.reading() as db:
            return self._treatments(db)

    def _treatments(self, db: sqlite3.Connection) -> tuple[KeptTreatment, ...]:
        outside_changes.refuse(db)
        return treatments.kept(db, self._inside, local_clock(self.plot.field))

    def keep_labels(self, labels: Iterable[ProductLabel], source: str = "", who: str = "") -> int:
        """Let these be what labels allow, instead of those before; return how many there are.

        Parameters
        ----------
        labels
            One for each line of a table, as `read_labels` returns them.
        source, who
            Where they come from and who brings them, for the log.
        """
        kept = tuple(labels)
        with self._lock, self.store.writing() as db:
            if kept != label_table.read(db):
                label_table.write(db, kept)
                season_log.append(
                    db, "labels", written_in(db, who), labels=len(kept), source=source,
                    states={"labels": season_log.labels_state(db)},
                )  # fmt: skip
        return len(kept)

    def say_wait(self, product: str, days: int, who: str = "") -> None:
        """Say how many whole days the label of a product that was used waits until harvest.

        It stands in the table of labels from then on, and counts unless the table says more days.
        `who` says so, for the log.
        Raise `SettingError` if no treatment was with it.
        """
        with self._lock:
            used = [one.application.product for one in self.treatments()]
            named = next((one for one in used if plain_name(one) == plain_name(product)), "")
            if not named:
                known = first_few([*dict.fromkeys(filter(None, used))]) or worded("none")
                raise SettingError(
                    worded(
                        "A wait can be said of a product that was used, but no treatment is with "
                        "{product!r}. Used were: {known}.",
                        product=product,
                        known=known,
                    )
                )
            self.keep_labels(with_wait(self.labels(), named, days), SAID_BY_HAND, who)

    def labels(self) -> tuple[ProductLabel, ...]:
        """Return what the labels of products allow, as the user's own table says."""
        with self.store.reading() as db:
            return label_table.read(db)

    def cautions(
        self, on: Day, units: Units | None = None, *, because_of: int | None = None
    ) -> tuple[Caution, ...]:
        """Return what to beware of on a day: harvest, entry, resistance, what labels allow.

        And who was where before entry was allowed, and what was lost with a damaged file.

        Parameters
        ----------
        on
            The day.
        units
            In which sentences speak; None: metres, hectares and dates as 2026-11-16.
        because_of
            Only because of this batch of a treatment, later uses among it; None: of all.
        """
        done, rules, seen, saved = self._held_to(units)
        every, own = by_vine(done, self.plot.grid), done
        if because_of is None:
            until, found = on, cautions.cautions(every, rules, on)
            found = (*_lost(saved, rules.units), *found)
        else:
            own = tuple(one for one in done if one.batch == because_of and one.on <= on)
            until, found = last_date(self), cautions.because_of(every, because_of, rules, on)
        early = early_entries(own, rules, seen, self.plot.grid, until)
        return cautions.by_urgency((*found, *early))

    def cautions_if_treated(
        self, on: Day, product: str, plants: NDArray[np.bool_], units: Units | None = None
    ) -> tuple[Caution, ...]:
        """Return what a treatment of plants ``(n,)`` with a product on a day would bring.

        As `cautions` says it `because_of` that once it is done: nothing is kept. Empty where there
        is no product, or no plant.

        Parameters
        ----------
        on
            The day.
        product
            Trade name, as in the labels.
        plants
            ``(n,)`` whether each plant is treated.
        units
            In which sentences speak; None: metres, hectares and dates as 2026-11-16.
        """
        plants = self._each_plant(plants)
        if not product.strip() or not plants.any():
            return ()
        with self._lock, self.store.reading() as db:  # all of one moment
            done, rules = self._done_and_rules(db, units)
            day = settings_of(db).day(on)
        batch = max((one.batch for one in done), default=0) + 1
        clock = local_clock(self.plot.field)
        place = TreatedPlace(self.plot.field.boundary, plants, None)
        wanted = KeptTreatment(
            batch, batch, day, on, place, 0.0, Application(product.strip()),
            end_of(clock, on, None), clock,
        )  # fmt: skip
        every = by_vine([*done, wanted], self.plot.grid)
        found = cautions.because_of(every, batch, replace(rules, asked=batch), on)
        return tuple(one for one in found if one.kind in _BEFORE_TREATING)

    def _held_to(
        self, units: Units | None
    ) -> tuple[tuple[KeptTreatment, ...], RulesToKeep, Inspections, tuple[LogEntry, ...]]:
        """Return the treatments that count, what they are held to, and what was inspected.

        And the entries of the log that note what was lost.
        """
        with self._lock, self.store.reading() as db:  # all of one moment
            done, rules = self._done_and_rules(db, units)
            seen = self._inspections(db) if done else Inspections.none()
            return done, rules, seen, season_log.saved_without(db)

    def _done_and_rules(
        self, db: sqlite3.Connection, units: Units | None
    ) -> tuple[tuple[KeptTreatment, ...], RulesToKeep]:
        """Return the treatments that count, and what they are held to."""
        settings = settings_of(db)
        rules = RulesToKeep(label_table.read(db), settings.harvest, settings.starts)
        return self._treatments(db), rules if units is None else replace(rules, units=units)

    def harvest_from(self, on: Day) -> tuple[date | None, KeptTreatment] | None:
        """Return the first day of harvest that treatments until `on` allow, and which one waits.

        The day is None where nobody said how long to wait from a treatment: that one, or the last
        of them. None: there was no treatment.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            done = [one for one in self._treatments(db) if one.on <= on]
            labels = label_table.read(db)
        return cautions.harvest_from(done, labels)

    def effects(self, on: Day, units: Units | None = None) -> tuple[TreatmentEffect, ...]:
        """Return what inspections up to the evening of `on` tell of each treatment before it.

        Parameters
        ----------
        on
            The day.
        units
            In which sentences speak; None: metres, hectares and dates as 2026-11-16.

        Raises
        ------
        SettingError
            If the day is not of the season.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            done = self._treatments(db)
            if not done:
                settings_of(db).day(on)  # or raise
                return ()
            now = self._read(db)
        day = now.settings.day(on)
        return treatment_effect.effects(done, now.history, day, units)


def _lost(saved: Iterable[LogEntry], units: Units) -> Iterator[Caution]:
    """Yield what was lost when the file was saved from a damaged one."""
    for entry in saved:
        yield Caution(
            "lost",
            worded(
                "On {day} the season was saved from a damaged file, without {lost}. Go back "
                "to a copy, or record again what is missing.",
                day=units.day(entry.at[:10]), lost=joined(", ", entry.lost),
            ),
            0,
        )  # fmt: skip
