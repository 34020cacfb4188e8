"""Charts of seasons. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import altair as alt
import pandas as pd

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.metrics import SeasonFigures

    from .figures import DayFigures

# Okabe & Ito's colours for the colour-blind
_COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]


def detection(seasons: dict[str, SeasonFigures], day: int, axes: tuple[str, str]) -> alt.LayerChart:
    """Return detection per day, a line for each sampler, with a rule at the day shown."""
    table = pd.concat(
        pd.DataFrame(
            {"sampler": name, "day": range(1, len(f.found) + 1), "detection": f.detection_pct}
        )
        for name, f in seasons.items()
    )
    x = alt.X("day:Q", title=axes[0], axis=alt.Axis(tickMinStep=1))
    lines = (
        alt.Chart(table)
        .mark_line(point=True, strokeWidth=2.5)
        .encode(
            x=x,
            y=alt.Y("detection:Q", title=axes[1], scale=alt.Scale(domain=[0, 100])),
            color=alt.Color(
                "sampler:N",
                scale=alt.Scale(domain=list(seasons), range=_COLOURS[: len(seasons)]),
                legend=alt.Legend(orient="top", title=None, columns=2),
            ),
            tooltip=["sampler", "day", alt.Tooltip("detection:Q", format=".1f")],
        )
    )
    rule = alt.Chart(pd.DataFrame({"day": [day]})).mark_rule(strokeDash=[4, 4]).encode(x="day:Q")
    return alt.layer(lines, rule).properties(height=280)


def found(figures: SeasonFigures, axes: tuple[str, str]) -> alt.Chart:
    """Return the plants found on each day."""
    table = pd.DataFrame({"day": range(1, len(figures.found) + 1), "found": figures.found})
    return (
        alt.Chart(table)
        .mark_bar(color=_COLOURS[0])
        .encode(
            x=alt.X("day:O", title=axes[0], axis=alt.Axis(labelAngle=0)),
            y=alt.Y("found:Q", title=axes[1]),
            tooltip=["day", "found"],
        )
        .properties(height=200)
    )


def bands(
    curves: dict[str, tuple[NDArray[np.float64], ...]], axes: tuple[str, str]
) -> alt.LayerChart:
    """Return a line with its interval for each way of working.

    `curves` holds mean, low and high ``(d,)`` each.
    """
    table = pd.concat(
        pd.DataFrame({"way": name, "day": range(1, len(mean) + 1), "mean": mean, "low": low,
                      "high": high})
        for name, (mean, low, high) in curves.items()
    )  # fmt: skip
    colour = alt.Color(
        "way:N",
        scale=alt.Scale(domain=list(curves), range=_many(len(curves))),
        legend=alt.Legend(orient="top", title=None, columns=2, labelLimit=300),
    )
    base = alt.Chart(table).encode(
        x=alt.X("day:Q", title=axes[0], axis=alt.Axis(tickMinStep=1)), color=colour
    )
    y = alt.Y("mean:Q", title=axes[1], scale=alt.Scale(domain=[0, 100]))
    tooltip = [
        "way",
        "day",
        *(alt.Tooltip(f"{c}:Q", format=".1f") for c in ("mean", "low", "high")),
    ]
    band = base.mark_area(opacity=0.18).encode(y="low:Q", y2="high:Q")
    line = base.mark_line(point=True, strokeWidth=2.5).encode(y=y, tooltip=tooltip)
    return alt.layer(band, line).properties(height=320)


def season_days(days: list[DayFigures], axes: tuple[str, str, str]) -> alt.LayerChart:
    """Return plants inspected and found on each day of a season."""
    table = pd.DataFrame(
        {
            "day": [str(s.on)[5:] for s in days],
            "inspected": [s.inspected for s in days],
            "found": [s.found for s in days],
        }
    )
    x = alt.X("day:O", title=axes[0], axis=alt.Axis(labelAngle=0, labelOverlap=True))
    tip = ["day", "inspected", "found"]
    bars = (
        alt.Chart(table)
        .mark_bar(color=_COLOURS[5])
        .encode(x=x, y=alt.Y("inspected:Q", title=axes[1]), tooltip=tip)
    )
    found_ = (
        alt.Chart(table)
        .mark_line(color=_COLOURS[1], point={"color": _COLOURS[1], "size": 60}, strokeWidth=2.5)
        .encode(x=x, y=alt.Y("found:Q", title=axes[2]), tooltip=tip)
    )
    return alt.layer(bars, found_).resolve_scale(y="independent").properties(height=220)


def still_out(days: list[DayFigures], axes: tuple[str, str]) -> alt.LayerChart:
    """Return the expected number of infested plants by day, with its interval."""
    table = pd.DataFrame(
        {
            "day": [str(s.on)[5:] for s in days],
            "expected": [s.expected for s in days],
            "low": [s.low for s in days],
            "high": [s.high for s in days],
        }
    )
    base = alt.Chart(table).encode(
        x=alt.X("day:O", title=axes[0], axis=alt.Axis(labelAngle=0, labelOverlap=True)),
        tooltip=["day", alt.Tooltip("expected:Q", format=".1f"), "low", "high"],
    )
    band = base.mark_bar(opacity=0.3, color=_COLOURS[0], width=10).encode(y="low:Q", y2="high:Q")
    line = base.mark_line(point=True, color=_COLOURS[0]).encode(
        y=alt.Y("expected:Q", title=axes[1])
    )
    return alt.layer(band, line).properties(height=220)


def row_ages(days_since: NDArray[np.float64], lines: NDArray[np.int64],
             axes: tuple[str, str]) -> alt.Chart:  # fmt: skip
    """Return the days since each row was inspected, ``(r,)``; rows never inspected are left out."""
    table = pd.DataFrame({"row": lines, "days": days_since}).dropna()
    table = table.groupby("row", as_index=False)["days"].min()
    return (
        alt.Chart(table)
        .mark_bar(color=_COLOURS[2])
        .encode(
            x=alt.X("row:Q", title=axes[0], axis=alt.Axis(tickMinStep=1, format="d")),
            y=alt.Y("days:Q", title=axes[1], axis=alt.Axis(tickMinStep=1, format="d")),
            tooltip=["row", "days"],
        )
        .properties(height=180)
    )


def _many(n: int) -> list[str]:
    return [_COLOURS[k % len(_COLOURS)] for k in range(n)]
