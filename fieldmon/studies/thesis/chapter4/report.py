"""A study as one HTML page that needs nothing else: tables with verdicts, plots, plain words."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from fieldmon.studies.charts import Line, Range, line_chart, range_chart
from fieldmon.studies.thesis.chapter4.verdicts import AGREES, DIFFERS, EQUAL, MISPRINT, NEAR

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fieldmon.studies.thesis.chapter4.measures import NoPriorMeasure
    from fieldmon.studies.thesis.chapter4.study import NoPriorStudy, NoPriorTable

_SIGNS = {EQUAL: "=", NEAR: "≈", DIFFERS: "≠", MISPRINT: "!"}
_NEARNESS = (
    "near: one unit of the last digit where nothing is random, else within two standard "
    "deviations of a single run (table 5: at least 5 % of our runs)"
)
_MEANINGS = (
    ("=", "the thesis's cell is our mean as printed (table 5: our most likely day)"),
    ("≈", _NEARNESS),
    ("!", "differs, and is known to be a copy or a misprint"),
    ("≠", "differs"),
    ("✓", "our mean and the reference's are within three standard errors of their difference"),
    ("✗", "they are not"),
)
_WORDS = {
    "PVV_ED1": "visited day 1, %",
    "PVV_ED2": "visited day 2, %",
    "PVV_ED3": "visited day 3, %",
    "PCD_ED1": "detected day 1, %",
    "PCD_ED2": "detected day 2, %",
    "PCD_ED3": "detected day 3, %",
    "PCD_ALL": "detected in all, %",
    "curve_listed_day3": "detected in all as the listing counts, %",
    "visited_all": "visited in all, %",
    "infected": "infested",
    "detected": "detected",
    "not_detected": "not detected",
    "clear_pct": "clear, %",
    "MD_before": "missed, before the last night",
    "MD_after": "missed, after it",
    **{f"D{threshold}": f"day of {threshold} %" for threshold in (30, 50, 80, 100)},
}

_LONG = 60

STYLE = """
:root { color-scheme: light dark; --ink: #1b1f24; --paper: #fff; --soft: #5b6570; --grid: #d5dae0;
  --blue: #0b62b8; --red: #b3261e; --green: #1b6e3c; --violet: #7a3fb0; --brown: #8a5a00; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8eaed; --paper: #16191d; --soft: #a9b2bd;
  --grid: #3a424c; --blue: #7db8f5; --red: #ff8a80; --green: #7fd6a0; --violet: #cfa6f2;
  --brown: #e6b450; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 76rem; margin: 0 auto; padding: 1rem; }
dl { display: grid; grid-template-columns: 2rem auto; } dd { margin: 0; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: 0.85rem; }
th, td { border: 1px solid var(--grid); padding: 0.25rem 0.5rem; text-align: right;
  vertical-align: top; font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; white-space: nowrap; }
td small { display: block; color: var(--soft); white-space: nowrap; }
.differs { color: var(--red); } .equal, .agrees { color: var(--green); }
.misprint { color: var(--brown); } .near { color: var(--blue); }
figure { margin: 1rem 0; } figcaption { font-weight: 600; } svg { width: 100%; max-width: 44rem; }
svg text { font-size: 12px; fill: var(--ink); } .grid { stroke: var(--grid); }
.range { stroke: var(--blue); stroke-width: 3; opacity: 0.5; } .mean { fill: var(--blue); }
.other { stroke: var(--red); stroke-width: 2; } .line { fill: none; stroke-width: 2; }
.c0 { stroke: var(--blue); } .c1 { stroke: var(--red); } .c2 { stroke: var(--green); }
.c3 { stroke: var(--violet); } .c4 { stroke: var(--brown); } .dashed { stroke-dasharray: 5 4; }
"""


def report_html(study: NoPriorStudy) -> str:
    """Return the whole report as one HTML document."""
    legend = "".join(f"<dt>{sign}</dt><dd>{escape(text)}</dd>" for sign, text in _MEANINGS)
    sections = "".join(_section(table) for table in study.tables)
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>The thesis's samplers without prior information</title><style>{STYLE}</style>"
        "</head><body><h1>The thesis's samplers without prior information</h1>"
        "<p>A. Yehoshua (2023), chapter 4 and appendix A, run again by fieldmon: "
        f"{study.replicates} replicates a configuration, seed {study.seed}. In each cell: our mean "
        "and its 95 % interval, then what the thesis prints, then the reference (the thesis's "
        "listings under GNU Octave, 400 replicates). Runs that the listing aborts are left out; "
        "their share stands beside the strategy.</p>"
        f"<dl>{legend}</dl>{sections}</body></html>\n"
    )


def _section(table: NoPriorTable) -> str:
    said = "".join(f"<li>{escape(sentence)}</li>" for sentence in table.summary)
    names = _row_names(table.cells)
    notes = dict.fromkeys(
        f"{names[cell]}, {_WORDS.get(cell.measure, cell.measure)}: {cell.note}."
        for cell in table.cells
        if cell.thesis_verdict == MISPRINT
    )
    known = "".join(f"<li>{escape(note)}</li>" for note in notes)
    misprints = f"<details><summary>Known misprints</summary><ul>{known}</ul></details>"
    return (
        f"<section><h2>{escape(table.title)}</h2><p>{escape(table.about)}</p><ul>{said}</ul>"
        f"{_charts(table)}{_matrix(table.cells)}{misprints if known else ''}</section>"
    )


def _matrix(cells: Sequence[NoPriorMeasure]) -> str:
    """Return the cells as a table: configurations down, measures across."""
    measures = list(dict.fromkeys(cell.measure for cell in cells))
    names = _row_names(cells)
    rows: dict[str, dict[str, NoPriorMeasure]] = {}
    for cell in cells:
        rows.setdefault(names[cell], {})[cell.measure] = cell
    head = "".join(f'<th scope="col">{escape(_WORDS.get(m, m))}</th>' for m in measures)
    body = "".join(
        f'<tr><th scope="row">{escape(name)}</th>'
        + "".join(_td(row[m]) if m in row else "<td></td>" for m in measures)
        + "</tr>"
        for name, row in rows.items()
    )
    whole = (
        f'<div class="wide" tabindex="0"><table><thead><tr><th scope="col">configuration</th>{head}'
        f"</tr></thead><tbody>{body}</tbody></table></div>"
    )
    if len(rows) <= _LONG:
        return whole
    return f"<details><summary>All {len(rows)} configurations</summary>{whole}</details>"


def _row_names(cells: Sequence[NoPriorMeasure]) -> dict[NoPriorMeasure, str]:
    """Return what each cell's row is called: its strategy, and what differs within the table."""
    severities = {cell.severity for cell in cells}
    viewpoints = {cell.viewpoints for cell in cells}
    rules = {cell.rules for cell in cells}
    names = {}
    for cell in cells:
        n = f", N = {cell.n}" if cell.n not in ("1", "R") else ""
        parts = [f"{cell.field}: {cell.algorithm} {cell.strategy}{n}"]
        if len(severities) > 1:
            parts.append(f"severity {cell.severity:g}")
        if len(viewpoints) > 1:
            parts.append(_viewpoints(cell))
        if len(rules) > 1:
            parts.append(cell.rules)
        if cell.aborted:
            parts.append(f"{cell.aborted:.0%} aborted")
        names[cell] = ", ".join(parts)
    return names


def _viewpoints(cell: NoPriorMeasure) -> str:
    return f"{cell.viewpoints} viewpoint{'s' if cell.viewpoints > 1 else ''}"


def _td(cell: NoPriorMeasure) -> str:
    if cell.replicates == 0:
        ours = "-"
    elif math.isnan(cell.low) or cell.sd == 0:
        ours = _short(cell.mean)
    else:
        ours = f"{_short(cell.mean)} <small>{_short(cell.low)} to {_short(cell.high)}</small>"
    if cell.thesis_verdict:
        sign = _SIGNS[cell.thesis_verdict]
        ours += f'<small class="{cell.thesis_verdict}">thesis {cell.thesis:g} {sign}</small>'
    if cell.reference_verdict:
        sign = "✓" if cell.reference_verdict == AGREES else "✗"
        ours += (
            f'<small class="{cell.reference_verdict}">reference {_short(cell.reference)} '
            f"{sign}</small>"
        )
    note = f' title="{escape(cell.note)}"' if cell.note else ""
    return f"<td{note}>{ours}</td>"


def _short(value: float) -> str:
    return f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


def _charts(table: NoPriorTable) -> str:
    parts = [
        range_chart(
            f"{_WORDS[measure]}: our mean, 5 to 95 % of runs, and the thesis's run (cross)",
            [
                Range(f"{c.algorithm}, N = {c.n}", c.q05, c.mean, c.q95, c.thesis)
                for c in table.cells
                if c.measure == measure
            ],
            "%",
        )
        for measure in ("PCD_ED1", "PCD_ED2", "PCD_ED3")
        if table.curves
    ]
    if table.curves:
        lines = [Line(label, list(hours), list(found)) for label, hours, found in table.curves]
        title = "Detected so far, of the insects known that day, over working hours"
        parts.append(line_chart(title, lines, ("working hours", "%")))
    if table.name == "severity":
        parts.append(_by_strategy(table.cells, "severity", "severity"))
    if table.name == "trend":
        parts.append(_by_strategy(table.cells, "faces", "vine faces in the plot"))
    if table.name == "equal":
        parts += [_differences(table.cells, rules) for rules in _rules(table.cells)]
    if table.name in ("everywhere", "slips"):
        parts.append(_by_rules(table))
    return "".join(parts)


def _rules(cells: Iterable[NoPriorMeasure]) -> list[str]:
    return list(dict.fromkeys(cell.rules for cell in cells))


def _by_strategy(cells: Iterable[NoPriorMeasure], across: str, axis: str) -> str:
    """Return the share detected in three days over one property of the trials."""
    lines: dict[str, dict[float, list[float]]] = {}
    for cell in cells:
        if cell.measure == "PCD_ALL":
            line = lines.setdefault(f"{cell.algorithm}, N = {cell.n}", {})
            line.setdefault(float(getattr(cell, across)), []).append(cell.mean)
    drawn = [
        Line(label, sorted(line), [sum(line[x]) / len(line[x]) for x in sorted(line)])
        for label, line in lines.items()
    ]
    return line_chart(f"Detected in three days, by {axis}", drawn, (axis, "%"))


def _differences(cells: Iterable[NoPriorMeasure], rules: str) -> str:
    rows = [
        Range(
            f"{c.field}, N = {c.n}, {_viewpoints(c)}",
            c.low,
            c.mean,
            c.high,
        )
        for c in cells
        if c.rules == rules and c.measure == "snake - neighbor, found_day2"
    ]
    title = f"Snake minus neighbor, detected by the end of day 2, {rules} (mean and 95 % interval)"
    return range_chart(title, rows, "percentage points; right of 0 the snake is ahead")


def _by_rules(table: NoPriorTable) -> str:
    rows = [
        Range(f"{c.field}, {c.rules}", c.q05, c.mean, c.q95)
        for c in table.cells
        if c.measure == "PCD_ALL" and c.algorithm == 6
    ]
    return range_chart("Algorithm 6, detected in three days (5 to 95 % of runs)", rows, "%")
