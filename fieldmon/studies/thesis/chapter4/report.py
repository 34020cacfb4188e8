"""A study as one HTML page that needs nothing else: tables with verdicts, plots, plain words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.io.html import page
from fieldmon.studies.charts import Line, Range, line_chart, range_chart
from fieldmon.studies.thesis.chapter4.verdicts import AGREES, DIFFERS, EQUAL, MISPRINT, NEAR

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from markupsafe import Markup

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


class _Entry(NamedTuple):
    """What a table's cell shows: our mean and interval, and verdict and words of each beside it."""

    ours: str
    interval: str
    beside: list[tuple[str, str]]
    note: str


class _Section(NamedTuple):
    """A table as its section shows it: measures across, configurations down."""

    table: NoPriorTable
    charts: list[Markup]
    heads: list[str]
    rows: dict[str, list[_Entry | None]]
    misprints: list[str]

    @property
    def is_long(self) -> bool:
        """Return whether the table is folded away."""
        return len(self.rows) > _LONG


def report_html(study: NoPriorStudy) -> str:
    """Return the whole report as one HTML document."""
    return page(
        "fieldmon/studies/thesis/chapter4/report.html.j2",
        study=study,
        meanings=_MEANINGS,
        sections=[_section(table) for table in study.tables],
    )


def _section(table: NoPriorTable) -> _Section:
    measures = list(dict.fromkeys(cell.measure for cell in table.cells))
    names = _row_names(table.cells)
    rows: dict[str, dict[str, NoPriorMeasure]] = {}
    for cell in table.cells:
        rows.setdefault(names[cell], {})[cell.measure] = cell
    return _Section(
        table,
        _charts(table),
        [_WORDS.get(measure, measure) for measure in measures],
        {
            name: [_entry(row[measure]) if measure in row else None for measure in measures]
            for name, row in rows.items()
        },
        _misprints(table.cells, names),
    )


def _misprints(cells: Sequence[NoPriorMeasure], names: dict[NoPriorMeasure, str]) -> list[str]:
    """Return a sentence for each cell that the thesis is known to print wrongly, each once."""
    said = dict.fromkeys(
        f"{names[cell]}, {_WORDS.get(cell.measure, cell.measure)}: {cell.note}."
        for cell in cells
        if cell.thesis_verdict == MISPRINT
    )
    return list(said)


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


def _entry(cell: NoPriorMeasure) -> _Entry:
    interval, beside = "", []
    if cell.replicates and not math.isnan(cell.low) and cell.sd != 0:
        interval = f"{_short(cell.low)} to {_short(cell.high)}"
    if cell.thesis_verdict:
        said = f"thesis {cell.thesis:g} {_SIGNS[cell.thesis_verdict]}"
        beside.append((cell.thesis_verdict, said))
    if cell.reference_verdict:
        sign = "✓" if cell.reference_verdict == AGREES else "✗"
        beside.append((cell.reference_verdict, f"reference {_short(cell.reference)} {sign}"))
    return _Entry(_short(cell.mean) if cell.replicates else "-", interval, beside, cell.note)


def _short(value: float) -> str:
    return f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


def _charts(table: NoPriorTable) -> list[Markup]:
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
    return parts


def _rules(cells: Iterable[NoPriorMeasure]) -> list[str]:
    return list(dict.fromkeys(cell.rules for cell in cells))


def _by_strategy(cells: Iterable[NoPriorMeasure], across: str, axis: str) -> Markup:
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


def _differences(cells: Iterable[NoPriorMeasure], rules: str) -> Markup:
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


def _by_rules(table: NoPriorTable) -> Markup:
    rows = [
        Range(f"{c.field}, {c.rules}", c.q05, c.mean, c.q95)
        for c in table.cells
        if c.measure == "PCD_ALL" and c.algorithm == 6
    ]
    return range_chart("Algorithm 6, detected in three days (5 to 95 % of runs)", rows, "%")
