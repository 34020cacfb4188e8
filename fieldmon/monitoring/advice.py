"""What a season advises on a day: treat, do not, or look on; where; and how many looks more."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import timedelta
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.ranges import USUAL_SURE
from fieldmon.compute.units import Units
from fieldmon.compute.wording import chance_figure, counted, figure, joined, share_figure, worded
from fieldmon.decisions.map_verdict import AskedVerdict, verdict_of, zone_verdicts
from fieldmon.decisions.sequential import LEAVE, LOOK_ON, TREAT
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.zones import best_zones, outlines
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.jump_reach import RADIUS
from fieldmon.io.spray_rate import USUAL_RATE_L_HA, litres_figure, must_be_rate
from fieldmon.io.writers.treatment_map import TreatmentMap
from fieldmon.samplers.decide import Decide

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date

    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.compute.wording import Worded
    from fieldmon.decisions.map_verdict import MapVerdict, ZoneVerdicts
    from fieldmon.decisions.sequential import Verdict
    from fieldmon.decisions.zones import Zones
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.monitoring.treatment import Treatment
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Scene

# nobody looks at more plants than this for a verdict
_MOST_LOOKS = 1000
_LONG_DAY_S = 1e7
# zones of so much of a plot are called the plot
_WHOLE = 0.995
# plants out of reach of all inspections are said from this share on
_FEW = 0.1
# from here on a sum is said without its hundredths
_ROUND_FROM = 100.0


@dataclass(frozen=True)
class AdviceSettings:
    """What is asked of the season, and what is assumed for the answer.

    Parameters
    ----------
    level
        Share of the plants from which on treating pays.
    sure
        How sure a verdict must be, between 0.5 and 1.
    sprayer, costs
        What can be switched, and what it costs.
    rate_l_ha
        Litres a hectare where it is sprayed.
    learnt_of
        The product of which the season learnt how well treating works; empty: it was not learnt.

    Examples
    --------
    >>> import fieldmon as fm
    >>> asked = fm.AdviceSettings(level=0.08, sure=0.95)
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> season = fm.Season.create("of_advice.gpkg", plot, begins="2026-11-18")
    >>> season.advice("2026-11-18", asked).verdict  # nobody has inspected yet
    'look on'
    """

    level: float = 0.05
    sure: float = USUAL_SURE
    sprayer: Sprayer = field(default_factory=Sprayer)
    costs: TreatmentCosts = field(default_factory=TreatmentCosts)
    rate_l_ha: float = USUAL_RATE_L_HA
    learnt_of: str = ""

    def __post_init__(self) -> None:
        must_be_rate(self.rate_l_ha)
        must_hold_kinds(self, "The advice's")
        AskedVerdict(self.level, self.sure)  # refuses what cannot be

    def assumed(self, units: Units | None = None, *, finds_treated: bool = False) -> Worded:
        """Return in words what nobody measured here or set, and what was set.

        `units` says of which area costs are; `finds_treated`: finds are taken as treated at once.
        """
        costs, usual, known = self.costs, TreatmentCosts(), units or Units()
        said = {
            "per_ha": worded(
                "to treat {area} costs {cost:,.10g}",
                area=known.one_area, cost=known.by_area(costs.per_ha),
            ),
            "per_zone": worded("a zone costs {cost:,.10g}", cost=costs.per_zone),
            "infested_plant_day": worded(
                "an infested plant loses {loss:,.10g} a day", loss=costs.infested_plant_day
            ),
            "days": worded("it stays infested for {days}", days=_days(costs.days)),
            "works": worded("treating cleans {works:.0%}", works=costs.works),
        }  # fmt: skip
        learnt = said.pop("works") if self.learnt_of else ""
        left = {name for name in said if getattr(costs, name) == getattr(usual, name)}
        assumed, told = (
            joined(", ", [one for name, one in said.items() if (name in left) == is_left])
            for is_left in (True, False)
        )
        if finds_treated:
            finds = worded("finds are treated at once")
            assumed = joined(", ", [finds, *[assumed] * bool(assumed)])
        both = [worded("Assumed: {what}.", what=assumed)] * bool(assumed)
        both += [worded("As you said: {what}.", what=told)] * bool(told)
        of = worded(
            "As this season learnt of {product}: {what}.", product=self.learnt_of, what=learnt
        )
        return joined(" ", [*both, *[of] * bool(learnt)])


@dataclass(frozen=True)
class MoreInspections:
    """After how many looks more a verdict can come, at the earliest.

    Parameters
    ----------
    if_clean
        Looks after which it need not be treated if all of them are clean; None: too many.
    if_found
        Looks after which it must be treated if all of them find something; None: too many.
    """

    if_clean: int | None
    if_found: int | None


@dataclass(frozen=True)
class InspectAgain:
    """Until when a plot stays below its threshold with a chance of 95 %, if nobody inspects it.

    Parameters
    ----------
    by
        The first day on which it may be above; None: none of those that are foretold.
    nights
        How many nights are foretold.
    """

    by: date | None
    nights: int

    @classmethod
    def of(cls, ahead: Forecast, on: date, infested: float) -> InspectAgain:
        """Return it by what is foretold from a day on, of so many infested plants."""
        (above,) = np.nonzero(ahead.high[1:] > infested)
        by = on + timedelta(days=int(above[0]) + 1) if len(above) else None
        return cls(by, ahead.nights)

    def sentence(self, units: Units | None = None) -> Worded:
        """Return it in words."""
        if self.by is None:
            return worded(
                "Without inspections it stays below the threshold for {nights} at least, with a "
                "chance of 95 %.",
                nights=counted(self.nights, "night"),
            )
        return worded(
            "Inspect again by {day}: before, it stays below the threshold with a chance of 95 %.",
            day=(units or Units()).day(self.by),
        )


@dataclass(frozen=True)
class NotReached:
    """Plants of which no inspection says anything, as all were too far away.

    Parameters
    ----------
    share
        So many of all plants.
    reach_m
        Farther from any inspected plant than this.
    """

    share: float
    reach_m: float

    @classmethod
    def of(cls, grid: PlantGrid, inspected: NDArray[np.integer]) -> NotReached:
        """Return them where these plants were inspected in the season, some perhaps often.

        An inspection reaches as far as insects are thought to jump otherwise than anywhere.
        """
        reach_m = RADIUS * float(np.sqrt(grid.row_spacing_m * grid.plant_spacing_m))
        if not len(inspected):
            return cls(1.0, reach_m)
        near = cKDTree(grid.xy_m[np.unique(inspected)])
        away_m, _ = near.query(grid.xy_m, distance_upper_bound=reach_m)
        return cls(float(np.mean(np.isinf(away_m))), reach_m)

    def sentences(self, units: Units | None = None) -> list[str]:
        """Return it in words; nothing where few are meant."""
        if self.share < _FEW:
            return []
        if self.share == 1.0:
            return [worded("Nobody has inspected yet: the answer rests on what was told before.")]
        return [
            worded(
                "{share:.0%} of the plants are more than {reach} from any inspection of the "
                "season: of them the answer rests on what was told before. Inspect there before "
                "you rely on it.",
                share=self.share, reach=(units or Units()).metres(self.reach_m),
            )
        ]  # fmt: skip


@dataclass(frozen=True)
class FewInspected:
    """So few plants were inspected that they alone would not tell whether treating pays.

    Parameters
    ----------
    inspected
        How many plants were.
    enough
        If so many were, all of them clean, they would tell it by themselves.
    background
        The chance of a plant of which nothing is known, where nobody told it nor gave records;
        None: something was told.
    """

    inspected: int
    enough: int
    background: float | None

    @classmethod
    def of(
        cls,
        plants: tuple[int, int],
        asked: AdviceSettings,
        detects: float,
        background: float | None,
    ) -> FewInspected | None:
        """Return it; None where half as many as would be enough were inspected, or all are too few.

        `plants` is how many were inspected, all of them clean, and how many there are. Enough are
        as many as would all be clean with a chance of 1 - `sure` at most, if as many plants were
        infested as the threshold says, anywhere, and inspections found a share `detects` of them.
        """
        inspected, n = plants
        infested = max(int(np.ceil(asked.level * n)), 1)
        # each of them is among the inspected, and found there
        enough = int(np.ceil(n * -np.expm1(np.log(1.0 - asked.sure) / infested) / detects))
        few = 2 * inspected < enough <= n
        return cls(inspected, enough, background) if few else None

    def sentence(self) -> str:
        """Return what the answer rests on instead."""
        if self.background is None:
            return worded(
                "{plants} {n:was|were} inspected. By themselves they do not tell: about {enough} "
                "clean ones would. The answer rests mostly on what was told before.",
                plants=counted(self.inspected, "plant"), n=self.inspected, enough=self.enough,
            )  # fmt: skip
        return worded(
            "{plants} {n:was|were} inspected. By themselves they do not tell: about {enough} clean "
            "ones would. The answer rests mostly on our default, {share} infested where nothing "
            "is known, which nobody measured here.",
            plants=counted(self.inspected, "plant"), n=self.inspected, enough=self.enough,
            share=share_figure(self.background),
        )  # fmt: skip


def _days(days: float) -> Worded:
    """Return so many days in words; some languages have a form for some numbers."""
    if days == int(days):
        return counted(int(days), "day")
    return worded("{days:g} days", days=days)


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
        if self.verdict == LOOK_ON:
            return self._look_on()
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

    def _look_on(self) -> str:
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
        has_faces = bool((self.grid.twin >= 0).any())
        asked = self.asked.assumed(units, finds_treated=self.finds_treated)
        return joined(" ", [*[faces] * has_faces, asked])

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
        if above and self.verdict == LOOK_ON:
            return [
                worded(
                    "By these costs, spraying the zones today would save more than it costs. If "
                    "the costs are yours, go by them, else inspect first."
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
            open=verdicts.count(LOOK_ON),
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
    if scene is not None and plot.verdict == LOOK_ON:
        more = inspections_to_verdict(evening, scene, asked, found)
    return Advice(grid, asked, plot, zones, said, more, done)


def inspections_to_verdict(
    evening: Belief, scene: Scene, asked: AdviceSettings, found: NDArray[np.bool_] | None = None
) -> MoreInspections:
    """Return after how many looks, driven as Decide drives, a verdict can come at the earliest."""
    n = len(scene.chance)
    known = np.zeros(n, np.bool_) if found is None else found
    day = replace(scene, seconds_left=min(_LONG_DAY_S, 1e4 * n))
    order = Decide().walk(day, np.zeros(n, np.bool_)).plant[:_MOST_LOOKS]
    learning = Learning(scene.robot.detects, treated=False)

    def verdict(looks: int, *, all_found: bool) -> Verdict:
        after = evening.learn(order[:looks], np.full(looks, all_found), learning)
        now = known.copy()
        now[order[:looks]] |= all_found
        return verdict_of(scene.grid, after, asked.level, asked.sure, now).verdict

    return MoreInspections(
        _first(lambda looks: verdict(looks, all_found=False) == LEAVE, len(order)),
        _first(lambda looks: verdict(looks, all_found=True) == TREAT, len(order)),
    )


def _first(clear: Callable[[int], bool], most: int) -> int | None:
    """Return the fewest looks at which it is clear, by doubling and halving; None: not within."""
    high = 1
    while high < most and not clear(high):
        high *= 2
    high = min(high, most)
    if most == 0 or not clear(high):
        return None
    low = high // 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if clear(middle) else (middle, high)
    return high
