"""What leaves say that somebody looked at: to be treated, not, or how many more."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.decisions.sequential import LEAVE, TREAT, IwaoPlan, Verdict
from fieldmon.decisions.stopping import after, least_more
from fieldmon.decisions.taylor import TaylorLaw, mean_band
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.decisions.thresholds import Threshold


def of_leaves(threshold: Threshold, leaves: int, counted: float, *, presence: bool = False) -> str:
    """Return in a sentence what leaves say of a threshold of leaves.

    By Iwao's plan, 90 % sure; a mean by presence alone by `mean_band`.

    Parameters
    ----------
    threshold
        Of a share of the leaves, or of a mean on one.
    leaves, counted
        Leaves looked at, from all over the plot; and of them the infested ones for a share, or
        the animals counted on them for a mean.
    presence
        Of a mean: only the infested leaves were counted.

    Raises
    ------
    SettingError
        If more leaves are infested than were looked at, or a part of one is, or presence says
        nothing of a mean.

    Examples
    --------
    >>> from fieldmon.decisions.thresholds import threshold_of
    >>> of_leaves(threshold_of("almond"), 40, 20)
    "40 leaves, 20 counted: treat (Iwao's plan, 90 % sure)."
    """
    plan = IwaoPlan(threshold.level, None if threshold.is_share else TaylorLaw())
    if not leaves:
        return worded(
            "The season holds plants, and this threshold is of leaves: look at leaves from all "
            "over the plot, and say how many they were and what was counted on them."
        )
    if (threshold.is_share or presence) and counted > leaves:
        raise SettingError(
            f"No more leaves can be infested than were looked at, but {counted:g} of {leaves} are."
        )
    if (threshold.is_share or presence) and counted % 1:
        raise SettingError(
            f"Infested leaves must be a whole number, but {counted:g} of {leaves} are given."
        )
    if presence and not threshold.is_share:
        return _by_presence(threshold, leaves, int(counted))
    return _counted(plan, leaves, counted, after(plan, leaves, counted))


def _counted(plan: IwaoPlan, leaves: int, counted: float, verdict: Verdict) -> str:
    said = {"leaves": leaves, "counted": counted}
    if verdict == TREAT:
        return worded(
            "{leaves} {leaves:leaf|leaves}, {counted:g} counted: treat (Iwao's plan, 90 % sure).",
            **said,
        )
    if verdict == LEAVE:
        return worded(
            "{leaves} {leaves:leaf|leaves}, {counted:g} counted: do not treat (Iwao's plan, 90 % "
            "sure).",
            **said,
        )
    return worded(
        "{leaves} {leaves:leaf|leaves}, {counted:g} counted: keep inspecting; after "
        "{more} more you can decide at the earliest (Iwao's plan, 90 % sure).",
        more=least_more(plan, leaves, counted), **said,
    )  # fmt: skip


def _by_presence(threshold: Threshold, leaves: int, infested: int) -> str:
    """Return what the share of leaves infested says of the animals on one."""
    band = mean_band(leaves, infested)
    said = {
        "leaves": leaves, "infested": infested, "mean": band.mean, "low": band.low,
        "high": band.high,
    }  # fmt: skip
    if band.low >= threshold.level:
        return worded(
            "{leaves} {leaves:leaf|leaves}, {infested} infested: {mean:.1f} animals a leaf "
            "({low:.1f} to {high:.1f}, by all published laws): treat.", **said,
        )  # fmt: skip
    if band.high < threshold.level:
        return worded(
            "{leaves} {leaves:leaf|leaves}, {infested} infested: {mean:.1f} animals a leaf "
            "({low:.1f} to {high:.1f}, by all published laws): do not treat.", **said,
        )  # fmt: skip
    return worded(
        "{leaves} {leaves:leaf|leaves}, {infested} infested: {mean:.1f} animals a leaf "
        "({low:.1f} to {high:.1f}, by all published laws): keep inspecting, or count the animals.",
        **said,
    )  # fmt: skip
