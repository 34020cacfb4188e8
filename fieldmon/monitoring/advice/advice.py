"""What a season advises on a day: treat, do not, or inspect more; where; and how many looks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.units import Units
from fieldmon.compute.wording import chance_figure, counted, figure, joined, share_figure, worded
from fieldmon.decisions.map_verdict import AskedVerdict, verdict_of, zone_verdicts
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT
from fieldmon.decisions.zones import best_zones, outlines
from fieldmon.io.spray_rate import litres_figure
from fieldmon.io.writers.treatment_map import TreatmentMap
from fieldmon.monitoring.advice.more_inspections import MoreInspections, inspections_to_verdict

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.compute.wording import Worded
    from fieldmon.decisions.map_verdict import MapVerdict, ZoneVerdicts
    from fieldmon.decisions.sequential import Verdict
    from fieldmon.decisions.zones import Zones
    from fieldmon.infestation.belief import Belief
    from fieldmon.monitoring.advice.left_plot import FewInspected, InspectAgain, NotReached
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.monitoring.treating.treatment import Treatment
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Scene

# zones of so much of a plot are called the plot
_WHOLE = 0.995
# from here on a sum is said without its hundredths
_ROUND_FROM = 100.0


def _money(value: float) -> str:
    return figure(value, ",.0f" if abs(value) >= _ROUND_FROM else ",.2f")


@dataclass(frozen=True, eq=False)
class Advice:
    """The answer to "do I have to spray, and where?".

    Parameters
    ----------
    grid
        The plants.
    asked
        What was asked, and what was assumed.
    plot
        The verdict of the plot.
    zones
        Where spraying is expected to lose least.
    said
        What is said of each of them.
    more
        Looks to a verdict; None: there is one.
    done
        What was treated that day: its plants are in no zone.
    again
        When to inspect again; None: the plot is not below the threshold.
    not_reached
        Plants too far from any inspection; None as above.
    few
        That few plants were inspected; None: enough were, or the plot is not below the threshold.
    finds_treated
        Whether finds are taken as treated at once.
    """

    grid: PlantGrid
    asked: AdviceSettings
    plot: MapVerdict
    zones: Zones
    said: ZoneVerdicts
    more: MoreInspections | None = None
    done: tuple[Treatment, ...] = ()
    again: InspectAgain | None = None
    not_reached: NotReached | None = None
    few: FewInspected | None = None
    finds_treated: bool = False

    def __repr__(self) -> str:
        return f"<Advice: {self.verdict}, {counted(len(self.zones), 'zone')}>"

    @property
    def verdict(self) -> Verdict:
        """Return the verdict of the plot."""
        return self.plot.verdict

    @property
    def above(self) -> int:
        """Return how many zones are above the threshold by themselves."""
        return sum(one.verdict == TREAT for one in self.said.zones)

    @property
    def sprayed(self) -> NDArray[np.bool_]:
        """Return ``(n,)`` the plants in the zones; all where there is none: whoever treats then."""
        return self.zones.treated if len(self.zones) else np.ones(len(self.grid), np.bool_)

    @property
    def is_whole(self) -> bool:
        """Return whether the zones are the whole plot."""
        return self.zones.m2 >= _WHOLE * self.zones.plot_m2

    @property
    def litres(self) -> float:
        """Return what is sprayed in the zones altogether."""
        return self.zones.m2 / 10_000 * self.asked.rate_l_ha

    @property
    def saving(self) -> float:
        """Return what treating the zones costs less than treating the whole plot."""
        return self.zones.whole_cost - self.zones.cost

    @property
    def saved(self) -> str:
        """Return that in words, in no more figures than can be meant."""
        return _money(self.saving)

    @property
    def lost(self) -> str:
        """Return in words what infested plants outside the zones lose: that is no part of it."""
        return _money(self.zones.outside * self.asked.costs.lost_per_infested_plant)

    @cached_property
    def outlines(self) -> list[MultiPolygon]:
        """Return the area of each zone, lon/lat."""
        return outlines(self.grid, self.zones)

    def headline(self, units: Units | None = None) -> str:
        """Return the daily question's answer in one sentence; `units` writes its area."""
        if self.verdict == INSPECT_MORE:
            return self._inspect_more()
        written = units or Units()
        area = {
            "area": written.square(self.zones.m2),
            "zones": counted(len(self.zones), "zone"),
            "share": share_figure(self.zones.m2 / self.zones.plot_m2),
            "of": written.square(self.zones.plot_m2),
        }  # fmt: skip
        if self.verdict == TREAT and self.is_whole:
            return worded("Treat the whole plot, {area} under plants.", area=area["area"])
        if self.verdict == TREAT and len(self.zones):
            return worded("Treat {area} in {zones}, {share} of the {of} under plants.", **area)
        if self.verdict == TREAT:
            return self._pays_nowhere()
        return self._left(area)

    def _left(self, area: dict[str, str]) -> str:
        """Return that the plot is left, and of which zones that is not so."""
        if self.above:
            return worded(
                "Do not treat the whole plot, but {area} of it in {zones}, {share} of the {of} "
                "under plants.",
                **area,
            )
        if len(self.zones):
            return worded(
                "Do not treat by the threshold; by these costs alone {area} in {zones} would pay, "
                "{share} of the {of} under plants.",
                **area,
            )
        return worded("Do not treat today.")

    def _pays_nowhere(self) -> str:
        if self.done:
            return worded(
                "Do not treat again today: the plot is still above the threshold, but what is left "
                "of it pays nowhere."
            )
        return worded(
            "Treat: the plot is above the threshold, though by these costs it pays nowhere."
        )

    def before_inspections(self) -> Advice:
        """Return it where nobody has inspected yet: neither the plot nor a zone has a verdict."""
        zones = tuple(one.where(inspected=False) for one in self.said.zones)
        plot = self.plot.where(inspected=False)
        return replace(self, plot=plot, said=replace(self.said, zones=zones), more=None)

    def _inspect_more(self) -> str:
        if not self.plot.inspected:
            return worded("Keep inspecting before you decide: nobody has inspected yet.")
        more = self.more or MoreInspections(None, None)
        if more.if_clean is not None:
            return worded(
                "Keep inspecting: look at about {plants} more; if nothing is found there, the plot "
                "need not be treated.",
                plants=counted(more.if_clean, "plant"),
            )
        if more.if_found is not None:
            return worded(
                "Keep inspecting: look at about {plants} more, then you can decide at the "
                "earliest.",
                plants=counted(more.if_found, "plant"),
            )
        return worded(
            "Keep inspecting: the plot is near the threshold, a few inspections do not decide."
        )

    def sentences(self, units: Units | None = None) -> list[str]:
        """Return the answer and what it rests on, in sentences."""
        return [self.headline(units), *self.reasons(units), *self.said_of_zones(units)]

    def in_short(self) -> str:
        """Return what the season's log keeps of it: the answer, and what it rests on."""
        return joined(" ", (self.headline(), self.plot.believed()))

    def reasons(self, units: Units | None = None) -> list[str]:
        """Return what the answer rests on, how long it holds, and what would end it sooner."""
        again = [] if self.again is None else [self.again.sentence(units)]
        away = [] if self.not_reached is None else self.not_reached.sentences(units)
        few = [] if self.few is None else [self.few.sentence()]
        done, sooner = self._done_said(), self._sooner_said()
        return [self.plot.believed(), *away, *few, *done, *again, *sooner]

    def _done_said(self) -> list[str]:
        if not self.done:
            return []
        plants = self.grid.vines_of(np.logical_or.reduce([one.plants for one in self.done]))
        works = sorted({one.efficacy for one in self.done})
        return [
            worded(
                "{plants} {n:was|were} treated that day and {n:is|are} in no zone: {works} of the "
                "infested ones are taken for clean since.",
                plants=counted(int(np.count_nonzero(plants)), "plant"),
                n=int(np.count_nonzero(plants)),
                works=joined(" / ", [figure(one, ".0%") for one in works]),
            )
        ]

    def _sooner_said(self) -> list[str]:
        more = self.more
        if more is None or more.if_found is None:
            return []
        return [
            worded(
                "If {plants} more {n:is|are all} infested, it must be treated.",
                plants=counted(more.if_found, "plant"), n=more.if_found,
            )
        ]  # fmt: skip

    def said_of_zones(self, units: Units | None = None, *, above: bool = True) -> list[str]:
        """Return where it pays, and what was assumed; `above` compares with the threshold."""
        said = [*self.though(above=above), self.zones.sentence()]
        if len(self.zones):
            said += (
                [self._zones_said()] * above + [self._worth_said()] + [self._enough_said()] * above
            )
        return [*said, self.assumed(units)]

    def assumed(self, units: Units | None = None) -> Worded:
        """Return in words what is assumed, and what a plant is where it has two faces."""
        faces = worded(
            "Each face counts as a plant: in the threshold, among the infested, and in what one "
            "loses a day. Where it is treated, its two faces are one plant."
        )
        asked = self.asked.assumed(units, finds_treated=self.finds_treated)
        return joined(" ", [*[faces] * self.grid.has_faces, asked])

    def though(self, *, above: bool = True) -> list[str]:
        """Return why there are zones, where what is said of the plot does not ask for them."""
        if not len(self.zones):
            return []
        if above and (self.verdict == TREAT or (self.verdict == LEAVE and self.above)):
            return []  # the headline asks for them
        if above and self.is_below:
            return [
                worded(
                    "The zones are below the threshold too. By these costs, spraying them would "
                    "still save more than it costs."
                )
            ]
        if above and self.verdict == INSPECT_MORE:
            return [
                worded(
                    "If you cannot inspect any more today and the costs are yours, spray the "
                    "zones: that would save more than it costs."
                )
            ]
        return [
            worded(
                "By these costs, spraying the zones would save more than it costs, whatever the "
                "threshold says."
            )
        ]

    @property
    def is_below(self) -> bool:
        """Return whether there are zones, though they are below the threshold as the plot is."""
        below = [one.verdict == LEAVE for one in self.said.zones]
        return self.verdict == LEAVE and len(below) > 0 and all(below)

    def _zones_said(self) -> str:
        verdicts = [one.verdict for one in self.said.zones]
        return worded(
            "Of the zones {treat} are above the threshold by themselves, {leave} are not, and of "
            "{open} it is not clear.",
            treat=verdicts.count(TREAT), leave=verdicts.count(LEAVE),
            open=verdicts.count(INSPECT_MORE),
        )  # fmt: skip

    def _worth_said(self) -> str:
        if self.is_whole:
            return worded("It takes {litres} l.", litres=litres_figure(self.litres))
        return worded(
            "It takes {litres} l and costs {saved} less than treating the whole plot; the infested "
            "plants elsewhere lose {lost}.",
            litres=litres_figure(self.litres), saved=self.saved, lost=self.lost,
        )  # fmt: skip

    def _enough_said(self) -> str:
        enough = chance_figure(self.said.enough, drawn=True)
        return worded("The chance that it is enough is {enough}.", enough=enough)

    def treatment_map(self, field: Field, product: str = "") -> TreatmentMap:
        """Return what the sprayer needs.

        Raises
        ------
        SettingError
            If there is no zone.
        """
        return TreatmentMap(
            field.name, field.boundary, self.outlines, self.asked.rate_l_ha, product
        )


def advice(
    grid: PlantGrid, evening: Belief, asked: AdviceSettings, scene: Scene | None = None,
    done: tuple[Treatment, ...] = (), found: NDArray[np.bool_] | None = None,
) -> Advice:  # fmt: skip
    """Return what is advised on what is believed after a day's work.

    Parameters
    ----------
    grid
        The plants.
    evening
        What is believed.
    asked
        What is asked and assumed.
    scene
        The day, for the looks to a verdict; None: they are not asked for.
    done
        What was treated that day.
    found
        ``(n,)`` plants that were found infested and left, of which nothing is in doubt.
    """
    plot = verdict_of(grid, evening, asked.level, asked.sure, found)
    spared = np.logical_or.reduce([one.plants for one in done]) if done else None
    zones = best_zones(grid, evening.chance, asked.sprayer, asked.costs, spared)
    question = AskedVerdict.on(evening, asked.level, asked.sure, found)
    said = zone_verdicts(
        grid, (evening.chance, evening.pair_chance), zones.zone, question, asked.costs.works
    )
    more = None
    if scene is not None and plot.verdict == INSPECT_MORE:
        more = inspections_to_verdict(evening, scene, asked, found)
    return Advice(grid, asked, plot, zones, said, more, done)
