"""The study of samplers as one HTML page that needs nothing else."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from fieldmon.studies.charts import Range, range_chart
from fieldmon.studies.samplers.contenders import ADAPTIVE, NAMES, TUNED, WORDED
from fieldmon.studies.samplers.summary import by_scenario, means, ratio, sentences

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.studies.samplers.seasons import SeasonOutcome

_WORDS = {
    "infested_plant_days": "Infested plant-days over the season",
    "d50": "Days until half of all infestations so far were found",
    "d80": "Days until 80 % of all infestations so far were found",
    "inspected": "Plants inspected over the season",
    "found": "Plants found infested",
    "visited_pct": "Plants inspected at least once, %",
}
STYLE = """
:root { color-scheme: light dark; --ink: #1b1f24; --paper: #fff; --grid: #d5dae0; --blue: #0b62b8; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8eaed; --paper: #16191d; --grid: #3a424c;
  --blue: #7db8f5; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 76rem; margin: 0 auto; padding: 1rem; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: 0.85rem; }
th, td { border: 1px solid var(--grid); padding: 0.25rem 0.5rem; text-align: right;
  font-variant-numeric: tabular-nums; }
th:first-child { text-align: left; white-space: nowrap; }
figure { margin: 1rem 0; } figcaption { font-weight: 600; } svg { width: 100%; max-width: 54rem; }
.line { fill: none; stroke-width: 2; } .c0 { stroke: var(--grid); }
.c1 { stroke: #b3261e; } .c2 { stroke: var(--blue); } .c3 { stroke: #1b6e3c; }
.c4 { stroke: #7a3fb0; }
svg text { font-size: 12px; fill: var(--ink); } .grid { stroke: var(--grid); }
.range { stroke: var(--blue); stroke-width: 3; opacity: 0.5; } .mean { fill: var(--blue); }
"""


def report_html(outcomes: Sequence[SeasonOutcome]) -> str:
    """Return the whole report as one HTML document."""
    seeds = len({outcome.seed for outcome in outcomes})
    said = "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences(outcomes))
    tables = "".join(
        f"<section><h2>{_WORDS[measure]}</h2>{_table(cells)}</section>"
        for measure, cells in means(outcomes).items()
    )
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Samplers compared</title><style>{STYLE}</style></head><body>"
        f"<h1>Samplers compared</h1><p>{seeds} seasons of 25 days a cell; all rivals meet the "
        "same insects and the same luck in looking. Intervals: 95 %, bootstrap over seeds.</p>"
        f"<ul>{said}</ul>{_chart(outcomes, WORDED)}{_chart(outcomes, TUNED)}{tables}"
        "</body></html>\n"
    )


def _chart(outcomes: Sequence[SeasonOutcome], other: str) -> str:
    rows = []
    for cell, who in by_scenario(outcomes, "infested_plant_days").items():
        r = ratio(who[ADAPTIVE], who[other])
        rows.append(Range(cell, r.low, r.value, r.high))
    title = f"Infested plant-days: {ADAPTIVE} over {other} (mean and 95 % interval)"
    return range_chart(title, rows, "ratio; left of 1 the adaptive sampler is ahead")


def _table(cells: dict[str, dict[str, float]]) -> str:
    head = "".join(f'<th scope="col">{escape(who)}</th>' for who in NAMES)
    body = "".join(
        f'<tr><th scope="row">{escape(cell)}</th>'
        + "".join(f"<td>{who[name]:.1f}</td>" for name in NAMES)
        + "</tr>"
        for cell, who in cells.items()
    )
    return (
        '<div class="wide" tabindex="0"><table><thead><tr><th scope="col">cell</th>'
        f"{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )
