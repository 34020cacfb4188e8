"""When a sequential plan stops: on counts one by one, at the earliest, and on simulated ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.arrays import read_only
from fieldmon.compute.wording import worded
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT, OperatingCurve
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.decisions.sequential import Plan, Verdict

    Floats = NDArray[np.float64]

_CODES: tuple[Verdict, ...] = (INSPECT_MORE, LEAVE, TREAT)
# how far one looks ahead for the next moment at which a verdict is possible
_MOST_AHEAD = 100_000


def decided(plan: Plan, counts: Any) -> tuple[Verdict, int]:  # noqa: ANN401 - whatever is a list
    """Return the first verdict on counts ``(n,)`` one by one, and after how many it came.

    Examples
    --------
    >>> from fieldmon.decisions.sequential import WaldPlan
    >>> decided(WaldPlan(0.05, 0.15), [0] * 30)
    ('do not treat', 20)
    """
    counts = np.asarray(counts, float)
    verdict, looks = _first(plan, counts[None, :])
    return _CODES[verdict[0]], int(looks[0])


def after(plan: Plan, looks: int, total: float) -> Verdict:
    """Return the verdict after so many looks, 1 or more, that counted so much together.

    Examples
    --------
    >>> from fieldmon.decisions.sequential import IwaoPlan
    >>> after(IwaoPlan(0.22), 40, 20)
    'treat'
    """
    lines = plan.lines(looks)
    return LEAVE if total <= lines.low[-1] else TREAT if total >= lines.high[-1] else INSPECT_MORE


def least_more(plan: Plan, looks: int, total: float) -> int:
    """Return after how many looks more a verdict can come at the earliest; 0: there is one.

    Parameters
    ----------
    looks, total
        Looks so far, and what they counted together.
    """
    ahead = 16
    while ahead <= _MOST_AHEAD:
        lines = plan.lines(looks + ahead)
        later = np.arange(ahead + 1)
        low, high = (np.concatenate([[np.nan], line])[looks:] for line in lines)
        # all that come are clean, or each counts as much as one can
        clear = total <= low
        clear |= total + np.where(later > 0, later * min(plan.most_per_look, 1e12), 0.0) >= high
        if clear.any():
            return int(np.argmax(clear))
        ahead *= 4
    raise SettingError(
        worded(
            "A verdict must be possible within {looks} looks, but these levels are too "
            "near each other. Set them further apart.",
            looks=_MOST_AHEAD,
        )
    )


class Trials(NamedTuple):
    """What a plan did on simulated looks: shares of verdicts, and looks ``(trials,)``."""

    treats: float
    leaves: float
    looks: NDArray[np.int64]

    def __repr__(self) -> str:
        return f"<Trials: {len(self.looks)} trials>"


def tried(plan: Plan, counts: NDArray[Any]) -> Trials:
    """Return what a plan does on counts ``(trials, n)``, in the order in which they are seen.

    The formulas of a plan take looks as independent. Neighbours on a drive are not: here the
    looks may come from any simulated plot and any order.
    """
    verdict, looks = _first(plan, np.asarray(counts, float))
    return Trials(float(np.mean(verdict == 2)), float(np.mean(verdict == 1)), read_only(looks))


def simulated_curve(
    plan: Plan,
    means: Any,  # noqa: ANN401 - a list of them
    draw: Callable[[float], NDArray[Any]],
) -> OperatingCurve:
    """Return what a plan does at true means ``(k,)`` on looks that are drawn, clustered or not.

    Parameters
    ----------
    draw
        ``draw(mean)`` returns counts ``(trials, n)`` in the order in which they are seen.

    Examples
    --------
    >>> from fieldmon.decisions.sequential import WaldPlan
    >>> rng = np.random.default_rng(1)
    >>> clustered = lambda share: rng.random((500, 400)) < rng.beta(share, 1 - share, (500, 1))
    >>> bool(simulated_curve(WaldPlan(0.05, 0.2), [0.2], clustered).leaves_it[0] > 0.5)
    True
    """
    mean = np.atleast_1d(np.asarray(means, float))
    trials = [tried(plan, draw(one)) for one in mean.tolist()]
    leaves = np.array([one.leaves for one in trials])
    looks = np.array([one.looks.mean() for one in trials])
    return OperatingCurve(read_only(mean), read_only(leaves), read_only(looks))


def _first(plan: Plan, counts: Floats) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
    """Return the code of the first verdict of each line of counts, and after how many looks."""
    n = counts.shape[1]
    lines, totals = plan.lines(n), np.cumsum(counts, axis=1)
    code = np.where(totals <= lines.low, 1, np.where(totals >= lines.high, 2, 0))
    clear = code > 0
    at = np.where(clear.any(axis=1), np.argmax(clear, axis=1), n - 1)
    return code[np.arange(len(code)), at], at + 1
