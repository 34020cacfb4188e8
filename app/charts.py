"""Charts of seasons. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

import altair as alt
import pandas as pd

if TYPE_CHECKING:
    from fieldmon.metrics import SeasonFigures

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
                legend=alt.Legend(orient="top", title=None),
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
        .properties(height=160)
    )
