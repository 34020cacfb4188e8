"""What is asked of a season's advice, and what is assumed for the answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.ranges import USUAL_SURE
from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted, joined, worded
from fieldmon.decisions.map_verdict import AskedVerdict
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.io.spray_rate import USUAL_RATE_L_HA, must_be_rate

if TYPE_CHECKING:
    from fieldmon.compute.wording import Worded


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
    'inspect more'
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


def _days(days: float) -> Worded:
    """Return so many days in words; some languages have a form for some numbers."""
    if days == int(days):
        return counted(int(days), "day")
    return worded("{days:g} days", days=days)
