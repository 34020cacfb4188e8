"""What was applied in a treatment, and how: what a certifier asks of each.

The fields are those of GLOBALG.A.P.'s application record (IFA, Crops Base 7.3): place, date and end
time, product and active ingredient, waiting period, operator, justification, who authorised it,
quantity, machinery, weather.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.decisions.doses import WATER_L_HA
from fieldmon.decisions.labels import checked_waits, plain_name
from fieldmon.errors import SettingError
from fieldmon.pests.weather import DAY_S

if TYPE_CHECKING:
    from datetime import time

    from fieldmon.decisions.doses import Dose
    from fieldmon.decisions.labels import ProductLabel

_MOST_LETTERS = 2000


@checked
@dataclass(frozen=True)
class Application:
    """What was applied, and how; what nobody said is empty or None.

    Parameters
    ----------
    product
        Trade name.
    dose
        Of the product.
    water_l_ha
        Litres of water a hectare.
    operator
        Who did it.
    reason
        Why: pest, and what was seen.
    waiting_days
        Whole days until harvest.
    reentry_hours
        Hours until people may enter.
    irac_groups
        Mode-of-action groups, as ``("4A", "28")``.
    began, ended
        Local times of the day. A treatment that ended earlier than it began ended the day after.
    machinery
        Sprayer, knapsack, by hand.
    crop, pest
        What it was for.
    authorised_by
        Who gave the technical authorisation.
    active_ingredient
        Of the product, as its label names it.
    weather
        At the time: wind, temperature, whether leaves were wet.

    Raises
    ------
    SettingError
        If a number cannot be, or a text is longer than a record.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Application("Acarol", fm.Dose(0.5, "l/ha"), waiting_days=7).said()["dose"]
    '0.5 l/ha'
    """

    product: str = ""
    dose: Dose | None = None
    water_l_ha: float | None = None
    operator: str = ""
    reason: str = ""
    waiting_days: int | None = None
    reentry_hours: float | None = None
    irac_groups: tuple[str, ...] = ()
    began: time | None = None
    ended: time | None = None
    machinery: str = ""
    crop: str = ""
    pest: str = ""
    authorised_by: str = ""
    active_ingredient: str = ""
    weather: str = ""

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A treatment's")
        checked_waits(self.waiting_days, self.reentry_hours)
        if self.water_l_ha is not None and WATER_L_HA.broken(self.water_l_ha):
            raise SettingError(
                worded(
                    "Water must be above 0 litres a hectare, but it is {water_l_ha:g}.",
                    water_l_ha=self.water_l_ha,
                )
            )
        for name, value in vars(self).items():
            if isinstance(value, str) and len(value) > _MOST_LETTERS:
                raise SettingError(
                    worded(
                        "What is said as {name} may have {most} letters, but it has {n}.",
                        name=name.replace("_", " "),
                        most=_MOST_LETTERS,
                        n=len(value),
                    )
                )

    @property
    def ends_next_day(self) -> bool:
        """Whether it ended on the day after: earlier in the day than it began."""
        return self.began is not None and self.ended is not None and self.ended < self.began

    @property
    def over_s(self) -> float:
        """Seconds since midnight of its day at which it was over; infinite where nobody said.

        Where only its beginning was said, that counts.
        """
        at = self.began if self.ended is None else self.ended
        if at is None:
            return math.inf
        of_day = at.hour * 3600.0 + at.minute * 60.0 + at.second
        return of_day + (DAY_S if self.ends_next_day else 0.0)

    def of_product(self, product: str) -> Application:
        """Return it with its `product`, where it names none; raise `SettingError` for another.

        Examples
        --------
        >>> import fieldmon as fm
        >>> fm.Application(operator="Bo").of_product("Soap").product
        'Soap'
        """
        if not self.product.strip():
            return replace(self, product=product)
        if product.strip() and plain_name(product) != plain_name(self.product):
            raise SettingError(
                worded(
                    "A treatment must be with one product, but it is with {product!r}, and its "
                    "application with {other!r}. Name it once.",
                    product=product,
                    other=self.product,
                )
            )
        return self

    def by_label(self, label: ProductLabel | None) -> Application:
        """Return it with what nobody said of waiting and group taken from the product's label."""
        if label is None:
            return self
        return replace(
            self,
            waiting_days=_said(self.waiting_days, label.waiting_days),
            reentry_hours=_said(self.reentry_hours, label.reentry_hours),
            irac_groups=self.irac_groups or label.irac_groups,
        )

    def said(self) -> dict[str, Any]:
        """Return what was said of it, as plain values by name."""
        plain = asdict(self) | {
            "dose": None if self.dose is None else str(self.dose),
            "irac_groups": "+".join(self.irac_groups),
            "began": None if self.began is None else f"{self.began:%H:%M}",
            "ended": None if self.ended is None else f"{self.ended:%H:%M}",
        }
        return {name: value for name, value in plain.items() if value not in {None, ""}}


def _said(value: Any, otherwise: Any) -> Any:  # noqa: ANN401 - a number or None
    return otherwise if value is None else value
