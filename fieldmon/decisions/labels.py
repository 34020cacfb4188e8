"""What the labels of products allow, as the user's own table says; nothing of law is made up."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import AllowedRange
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.decisions.doses import Dose

#: source of a line that nobody's table has: somebody said it of a treatment
SAID_BY_HAND = "said by hand"
#: whole days until harvest, and hours until people may enter
WAITS_DAYS, WAITS_HOURS = AllowedRange(0, 3650, unit=" days"), AllowedRange(0, 10_000, unit=" h")


@checked
@dataclass(frozen=True)
class ProductLabel:
    """What a label allows for a product; None: it does not say.

    Parameters
    ----------
    product
        Trade name.
    crop, pest
        What it holds for; empty: all.
    max_dose
        The most.
    waiting_days
        Whole days until harvest.
    reentry_hours
        Hours until people may enter.
    irac_groups
        Mode-of-action groups, as ``("4A", "28")``.
    max_uses
        Uses in a season.
    source
        Who says so.

    Examples
    --------
    >>> import fieldmon as fm
    >>> label = fm.ProductLabel("Some oil", crop="grapes", waiting_days=7)
    >>> label.fits("some oil", "grapes", "spider-mite")
    True
    """

    product: str
    crop: str = ""
    pest: str = ""
    max_dose: Dose | None = None
    waiting_days: int | None = None
    reentry_hours: float | None = None
    irac_groups: tuple[str, ...] = ()
    max_uses: int | None = None
    source: str = ""

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A label's")
        if not self.product.strip():
            raise SettingError(worded("A label must name its product, but this one names none."))
        checked_waits(self.waiting_days, self.reentry_hours)
        if self.max_uses is not None and self.max_uses < 1:
            raise SettingError(
                worded(
                    "A label allows one use or more in a season, but this one allows {max_uses}.",
                    max_uses=self.max_uses,
                )
            )

    def fits(self, product: str, crop: str, pest: str) -> bool:
        """Return whether it is of a product, and holds for what was said of crop and pest."""
        pairs = ((self.crop, crop), (self.pest, pest))
        return _same(self.product, product) and all(
            not own or not said or _same(own, said) for own, said in pairs
        )


def checked_waits(days: int | None, hours: float | None) -> None:
    """Raise `SettingError` unless waiting days and re-entry hours can be."""
    if days is not None and (WAITS_DAYS.broken(days) or days != int(days)):
        raise SettingError(
            worded(
                "A waiting period must be 0 to {most} whole days, but it is {days:g}.",
                most=int(WAITS_DAYS.most),
                days=days,
            )
        )
    if hours is not None and WAITS_HOURS.broken(hours):
        raise SettingError(
            worded(
                "Re-entry must be after 0 to {most} hours, but it is {hours:g}.",
                most=int(WAITS_HOURS.most),
                hours=hours,
            )
        )


def irac_groups(said: str) -> tuple[str, ...]:
    """Return the mode-of-action groups that are said, ``"4A+28"`` or ``"IRAC Group 6"``.

    Raises
    ------
    SettingError
        If one is no group of IRAC: a number with a letter at most, or UN, UNB, UNE and so on.
    """
    bare = re.sub(r"irac|groups?|moa|:", " ", said, flags=re.IGNORECASE)
    found = [part.upper() for part in re.split(r"[\s,;+/&]+", bare) if part]
    for one in found:
        if not re.fullmatch(r"\d{1,2}[A-Z]?|UN[A-Z]{0,2}", one):
            raise SettingError(
                worded(
                    "A mode-of-action group must be one of IRAC, as 6, 4A or UN, "
                    "several as 4A+28, but it is {said!r}.",
                    said=said,
                )
            )
    return tuple(dict.fromkeys(found))


def with_wait(labels: Iterable[ProductLabel], product: str, days: int) -> tuple[ProductLabel, ...]:
    """Return labels that say, too, how many whole days a product waits until harvest.

    What was said of it so before is replaced. Where a line of a table says more days, they count.
    """
    own = ProductLabel(product, waiting_days=days, source=SAID_BY_HAND)
    others = (
        one for one in labels if not (one.source == own.source and _same(one.product, product))
    )
    return (*others, own)


def label_for(
    labels: Iterable[ProductLabel],
    product: str,
    crop: str = "",
    pest: str = "",
    *,
    dose: Dose | None = None,
    water_l_ha: float | None = None,
) -> ProductLabel | None:
    """Return what the labels of a product allow; None: there is none of it.

    Where none is for that crop and pest, all of the product hold (`of_others`). Where several lines
    hold, since nobody said the crop or the pest, the strictest of each counts. Which dose is the
    strictest is seen from the `dose` used and its water: without, none is.
    """
    own = [one for one in labels if _same(one.product, product)]
    fit = own if of_others(own, product, crop, pest) else _fitting(own, product, crop, pest)
    if len(fit) < 2:
        return fit[0] if fit else None
    doses = [one.max_dose for one in fit if one.max_dose is not None]
    return ProductLabel(
        fit[0].product, crop, pest, _strictest(doses, dose, water_l_ha),
        max((one.waiting_days for one in fit if one.waiting_days is not None), default=None),
        max((one.reentry_hours for one in fit if one.reentry_hours is not None), default=None),
        tuple(dict.fromkeys(group for one in fit for group in one.irac_groups)),
        min((one.max_uses for one in fit if one.max_uses is not None), default=None),
        "; ".join(dict.fromkeys(one.source for one in fit if one.source)),
    )  # fmt: skip


def of_others(
    labels: Iterable[ProductLabel], product: str, crop: str, pest: str
) -> tuple[ProductLabel, ...]:
    """Return the lines of a product where all are for another crop or pest, else none.

    The other may be the same by another name: nobody knows that but the user.
    """
    own = [one for one in labels if _same(one.product, product) and one.source != SAID_BY_HAND]
    return () if _fitting(own, product, crop, pest) else tuple(own)


def _fitting(
    labels: Iterable[ProductLabel], product: str, crop: str, pest: str
) -> list[ProductLabel]:
    return [one for one in labels if one.fits(product, crop, pest)]


def _strictest(doses: list[Dose], used: Dose | None, water_l_ha: float | None) -> Dose | None:
    """Return the dose that what was used is most above, else one it cannot be compared with."""
    if used is None:
        return None

    def strictness(most: Dose) -> tuple[int, float]:
        share = used.share_of(most, water_l_ha)
        return (1, 0.0) if share is None else (2 if share > 1.0 else 0, share)

    return max(doses, key=strictness, default=None)


def plain_name(name: str) -> str:
    """Return a name as it is compared: however it is spaced and in capitals."""
    return " ".join(name.casefold().split())


def _same(one: str, other: str) -> bool:
    return plain_name(one) == plain_name(other)
