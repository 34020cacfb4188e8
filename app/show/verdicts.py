"""What a comparison came to, in words and as a table. No Streamlit in here."""

from __future__ import annotations

from dataclasses import replace
from math import isnan
from typing import TYPE_CHECKING

import pandas as pd

from ..words import texts
from ..words.language import listed, number
from ..words.strategies import strategy_name

if TYPE_CHECKING:
    from fieldmon.simulation.statistics import SummaryStatistics
    from fieldmon.simulation.team_worth import MarginalGain

    from ..state.comparison import Outcome, Strategy


def name(strategy: Strategy) -> str:
    """Return what to call a strategy."""
    alone = strategy.sampler, strategy.hours, strategy.inspection_s
    return strategy_name(*alone, strategy.robots)


def sentence(ranked: list[Outcome]) -> str:
    """Return which strategy is best, and by how much."""
    if len(ranked) == 1:
        return ""
    best, second = ranked[0], ranked[1]
    names = {"best": name(best.strategy), "second": name(second.strategy)}
    behind = second.behind  # None: of the best alone
    if even := [name(one.strategy) for one in ranked[1:] if _is_even(one)]:
        return texts.VERDICT_EVEN.format(names=listed([names["best"], *even]), loss=best.loss.mean)
    if behind is None or isnan(behind.low):
        return texts.VERDICT_ONE.format(**names)
    if not behind.low > 0:
        return texts.VERDICT_TIED.format(**names)
    return texts.VERDICT.format(
        **names, loss=best.loss.mean, low=behind.low, high=behind.high,
        percent=100 * behind.mean / best.loss.mean,
    )  # fmt: skip


def _is_even(outcome: Outcome) -> bool:
    """Return whether a strategy came to the same as the best in every season."""
    behind = outcome.behind
    return behind is not None and behind.mean == 0 and (isnan(behind.low) or not behind.low < 0)


def robots_sentence(gains: list[MarginalGain]) -> str:
    """Return what each further robot would save on this plot."""
    if any(isnan(gain.saved.low) for gain in gains):
        return texts.GAIN_NONE
    if [(g.fewer, g.robots) for g in gains] != [(k, k + 1) for k in range(1, len(gains) + 1)]:
        return " ".join(
            texts.GAIN.format(robots=gain.robots, fewer=gain.fewer, **_saved(gain))
            for gain in gains
        )
    more = "".join(texts.GAIN_MORE[str(gain.robots)].format(**_saved(gain)) for gain in gains[1:])
    return texts.GAIN_FIRST.format(more=more, **_saved(gains[0]))


def _saved(gain: MarginalGain) -> dict[str, float]:
    """Return what is saved, without a minus before nothing."""
    return {"saved": round(gain.saved.mean) + 0.0, "low": round(gain.saved.low) + 0.0,
            "high": round(gain.saved.high) + 0.0}  # fmt: skip


def tables(ranked: list[Outcome], *, daily: bool = True) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return what each strategy lost and found, and how it worked; each with room in the panel."""
    whole = table(ranked, daily=daily)
    cut = list(whole.columns).index(_visited(daily=daily))
    return whole.iloc[:, :cut], whole.iloc[:, [0, *range(cut, whole.shape[1])]]


def _visited(*, daily: bool) -> str:
    return texts.COLUMN_VISITED if daily else texts.COLUMN_VISITED_EACH


def table(ranked: list[Outcome], *, daily: bool = True) -> pd.DataFrame:
    """Return what each strategy came to, the best first and marked; its verdict beside its name.

    `daily`: whether somebody comes on every day.
    """
    least_loss, shared = ranked[0].loss.mean, any(map(_is_even, ranked))
    return pd.DataFrame(
        {
            texts.COLUMN_STRATEGY: [name(o.strategy) for o in ranked],
            texts.COLUMN_VERDICT: [
                texts.EVEN if shared and (o.behind is None or _is_even(o)) else _word(o, least_loss)
                for o in ranked
            ],
            texts.COLUMN_LOSS: [_interval(_none_less(o.loss), ",.0f") for o in ranked],
            texts.COLUMN_FOUND: [_interval(_share(o.detection_pct), ".3g", " %") for o in ranked],
            _visited(daily=daily): [
                texts.IN_PERCENT.format(value=number(o.visited_pct, ".1f")) for o in ranked
            ],
            texts.COLUMN_HALF: [_day(o.half_day) for o in ranked],
            texts.COLUMN_MOST: [_day(o.most_day) for o in ranked],
            texts.COLUMN_WORKED: [number(o.worked_h, ",.0f") for o in ranked],
        }
    )


def _day(day: float | None) -> str:
    return "–" if day is None else number(day, "g")  # a table takes a dash for a list


def _none_less(loss: SummaryStatistics) -> SummaryStatistics:
    """Return an estimate of what is at least 0, which Student's t does not know of."""
    return replace(loss, low=max(loss.low, 0.0))


def _share(percent: SummaryStatistics) -> SummaryStatistics:
    """Return an estimate of a percentage within 0 to 100, which Student's t does not know of."""
    return replace(percent, low=max(percent.low, 0.0), high=min(percent.high, 100.0))


def _interval(estimate: SummaryStatistics, form: str, unit: str = "") -> str:
    mean = number(estimate.mean, form) + unit
    if isnan(estimate.low):
        return mean
    low, high = number(estimate.low, form), number(estimate.high, form)
    return texts.INTERVAL_OF.format(value=mean, low=low, high=high)


def _word(outcome: Outcome, least_loss: float) -> str:
    behind = outcome.behind
    if behind is None:
        return f"★ {texts.BEST}"
    if isnan(behind.low):
        return texts.ONE_SEASON
    if not behind.low > 0:
        return texts.NO_DIFFERENCE
    percent, low, high = (100 * of / least_loss for of in (behind.mean, behind.low, behind.high))
    return texts.WORSE.format(percent=percent, low=low, high=high)
