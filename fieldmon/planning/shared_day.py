"""One day on many plots: who goes to which plot, when, and for how long.

The rule is simple, so that anybody can follow it. Plots come in the order of what is expected to be
infested on them. Each goes to whoever then has the most time for what is expected on his plots, and
stays his own for the day. Everybody shares his hours among his plots by what is expected there. No
plot gets more time than inspecting all of it takes, and none less than a quarter of an hour: such a
plot waits for another day. Nobody goes to a plot where there is nothing to inspect.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.members import TeamMember

    Float = NDArray[np.float64]

#: going from one plot to the next takes so long where nobody said it
MOVE_S = 900.0
_LEAST_S = 900.0


@dataclass(frozen=True)
class PlotNeed:
    """What calls for work on a plot.

    Parameters
    ----------
    expected
        Infested plants, as expected.
    most_s
        To inspect all of it takes so long at most.
    """

    expected: float
    most_s: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.expected) and self.expected >= 0 and self.most_s >= 0):
            raise SettingError(
                worded(
                    "A plot must have 0 or more infested plants expected and take 0 s or more, but "
                    "they are {expected} and {most_s}.",
                    expected=self.expected,
                    most_s=self.most_s,
                )
            )


@dataclass(frozen=True)
class PlotTurn:
    """One works on one plot.

    Parameters
    ----------
    plot
        Number of the plot, from 0.
    who
        Number of the member, from 0.
    starts_s
        Seconds after the member's own start.
    seconds
        How long.
    """

    plot: int
    who: int
    starts_s: float
    seconds: float


def share_day(
    needs: Sequence[PlotNeed], members: Sequence[TeamMember], move_s: float = MOVE_S
) -> tuple[PlotTurn, ...]:
    """Return who works on which plot when; a plot that is not among the turns waits.

    Parameters
    ----------
    needs
        What calls for work on each plot.
    members
        Who works; of each, the hours count.
    move_s
        What going from one plot to the next takes.

    Examples
    --------
    >>> from fieldmon.planning.shared_day import PlotNeed, share_day
    >>> from fieldmon.planning.members import team_of
    >>> needs = [PlotNeed(10, 40_000), PlotNeed(30, 40_000)]
    >>> [(turn.plot, round(turn.seconds / 3600, 2)) for turn in share_day(needs, team_of(1))]
    [(1, 8.81), (0, 2.94)]
    """
    if move_s < 0:
        raise SettingError(
            worded(
                "Going to the next plot must take 0 s or more, but it is {move_s}.",
                move_s=move_s,
            )
        )
    wanted = np.array([max(need.expected, 1e-9) for need in needs])
    most_s = np.array([need.most_s for need in needs])
    day_s = np.array([member.robot.day_s for member in members])
    own = _given_out(np.where(most_s > 0, wanted, 0.0), day_s, move_s)
    turns = []
    for who, plots in enumerate(own):
        kept, seconds = _worth_it(plots, (wanted, most_s), float(day_s[who]), move_s)
        starts_s = np.append(0.0, np.cumsum(seconds + move_s))
        turns += [
            PlotTurn(plot, who, float(at), float(long))
            for plot, at, long in zip(kept, starts_s, seconds, strict=False)
        ]
    return tuple(turns)


def _given_out(wanted: Float, day_s: Float, move_s: float) -> list[list[int]]:
    """Return each member's plots, the most urgent first; nobody's where nothing is wanted."""
    own: list[list[int]] = [[] for _ in day_s]
    held, left_s = np.zeros(len(day_s)), day_s.copy()
    order = [plot for plot in np.argsort(-wanted, kind="stable").tolist() if wanted[plot]]
    for plot in order if len(day_s) else ():
        time_s = np.where(held > 0, left_s - move_s, left_s) / (held + wanted[plot])
        who = int(np.argmax(time_s))
        left_s[who] -= move_s if own[who] else 0.0
        held[who] += wanted[plot]
        own[who].append(plot)
    return own


def _worth_it(
    plots: list[int], need: tuple[Float, Float], day_s: float, move_s: float
) -> tuple[list[int], Float]:
    """Return the plots for which there is time enough, and how long each gets."""
    kept = [*plots]
    while kept:
        wanted, most_s = (part[kept] for part in need)
        seconds = _divided(wanted, most_s, day_s - move_s * (len(kept) - 1))
        if len(kept) == 1 or (seconds >= np.minimum(most_s, _LEAST_S)).all():
            return kept, seconds
        kept.pop()  # the one on which least is expected
    return [], np.empty(0)


def _divided(wanted: Float, most_s: Float, seconds: float) -> Float:
    """Return what each gets of some seconds: by what is wanted, but no more than the most."""
    got, is_open = np.zeros(len(wanted)), np.ones(len(wanted), np.bool_)
    left = max(seconds, 0.0)
    while is_open.any():
        share = left * wanted / wanted[is_open].sum()
        full = is_open & (share >= most_s)
        if not full.any():
            got[is_open] = share[is_open]
            break
        got[full] = most_s[full]
        left -= float(most_s[full].sum())
        is_open &= ~full
    return got
