"""Chapter 5 run again, as one HTML page that needs nothing else."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fieldmon.io.html import page
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.charts import Line, line_chart
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, SCENARIOS
from fieldmon.studies.thesis.chapter5.study import OWN, label_of
from fieldmon.studies.thesis.chapter5.verdicts import AGREES, DIFFERS, FAILS, HOLDS, NEAR, OPEN

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import numpy as np
    from markupsafe import Markup

    from fieldmon.simulation.statistics import SummaryStatistics
    from fieldmon.studies.thesis.chapter5.mapped_plots import MapMeasure
    from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
    from fieldmon.studies.thesis.chapter5.study import PriorStudy, StudyPart

# how a verdict is coloured: as the one of three that it comes to
_CLASSES = {
    AGREES: AGREES,
    HOLDS: AGREES,
    NEAR: NEAR,
    OPEN: NEAR,
    DIFFERS: DIFFERS,
    FAILS: DIFFERS,
}
_FIGURES = {"A": (20, 21), "B": (22, 23), "C": (24, 25)}
_SWEEP_FIGURES = {"size": 26, "spread": 27, "time": 28, "detection": 29}
_MEASURES = {
    "detection_end_pct": "detected at the end, %",
    "visited_a_day_pct": "visited a day, %",
    "D50": "day of 50 %",
    "D80": "day of 80 %",
    "D100": "day of 100 %",
    "days_to_50": "working days to 50 %",
    "days_to_80": "working days to 80 %",
    "days_to_100": "working days to 100 %",
    "infested_plant_days": "infested plant-days",
    "new_infestations": "new infestations",
    "left": "infested plants left",
}


def report_html(study: PriorStudy) -> str:
    """Return the whole report as one HTML document."""
    return page(
        "fieldmon/studies/thesis/chapter5/report.html.j2",
        study=study,
        classes=_CLASSES,
        heads=("configuration", *_MEASURES.values()),
        parts=[(part, charts(part), _rows(part)) for part in study.parts],
        short=_short,
    )


def maps_html(table: Sequence[MapMeasure]) -> str:
    """Return the samplers on real maps as one HTML document: a plot a map and date."""
    plots = dict.fromkeys((row.map, row.date, row.infested) for row in table)
    drawn = [
        line_chart(
            f"{name} {date}: found of {infested} infested plants",
            [_map_line(table, (name, date, each)) for each in SAMPLERS],
            ("plants visited, %", "found, %"),
        )
        for name, date, infested in plots
    ]
    return page("fieldmon/studies/thesis/chapter5/mapped_plots.html.j2", charts=drawn)


def _map_line(table: Sequence[MapMeasure], key: tuple[str, str, str]) -> Line:
    rows = [row for row in table if (row.map, row.date, row.sampler) == key]
    x, y, low, high = (
        [getattr(row, column) if row.seeds > 1 else math.nan for row in rows]
        for column in ("visited_pct", "mean", "low", "high")
    )
    return Line(key[2].capitalize(), x, y, low, high)


def _rows(part: StudyPart) -> list[tuple[str, list[SummaryStatistics]]]:
    """Return what each configuration of a part is called, and the spread of its measures."""
    return [
        (_name(part, runs), [summary_statistics(values) for values in runs.measures().values()])
        for runs in part.runs
    ]


def charts(part: StudyPart) -> list[Markup]:
    """Return the plots of a part as ``<svg>`` figures."""
    if part.name in SCENARIOS or part.name == OWN:
        numbers = _FIGURES.get(part.name)
        heads = [f"Figure {number}: " for number in numbers] if numbers else ["", ""]
        return [
            _by_day(part, "detection_pct", f"{heads[0]}detected so far"),
            _by_day(part, "visited_pct", f"{heads[1]}visited a day"),
        ]
    head = f"Figure {_SWEEP_FIGURES[part.name]}: "
    if part.name == "size":
        return [_by_size(part, f"{head}detected at the end, by field size")]
    return [_by_day(part, "detection_pct", f"{head}detected so far")]


def _by_day(part: StudyPart, measure: str, title: str) -> Markup:
    lines = [
        _line(
            label_of(part.name, runs.trial),
            [float(day) for day in range(1, runs.tables.shape[1] + 1)],
            list(getattr(runs, measure).T),
        )
        for runs in part.runs
    ]
    return line_chart(title, lines, ("day", "%"))


def _by_size(part: StudyPart, title: str) -> Markup:
    lines = []
    for name in SAMPLERS:
        runs = [each for each in part.runs if each.trial.sampler == name]
        sizes = [each.trial.hectares or math.nan for each in runs]
        lines.append(_line(name.capitalize(), sizes, [each.end_pct for each in runs]))
    return line_chart(title, lines, ("hectares", "%"))


def _line(label: str, x: list[float], values: Iterable[np.ndarray]) -> Line:
    """Return a line of means in their 95 % intervals; a day that few worked is left out."""
    spreads = [summary_statistics(column) for column in values]
    few = [each.replicates < 2 for each in spreads]
    y, low, high = (
        [math.nan if less else getattr(each, name) for each, less in zip(spreads, few, strict=True)]
        for name in ("mean", "low", "high")
    )
    # Student's interval does not know that a share ends at 0 and at 100 %
    return Line(label, x, y, [max(each, 0.0) for each in low], [min(each, 100.0) for each in high])


def _name(part: StudyPart, runs: PriorRuns) -> str:
    name = label_of(part.name, runs.trial)
    return f"{name}, {runs.trial.hectares:g} ha" if part.name == "size" else name


def _short(value: float) -> str:
    return f"{value:.1f}" if abs(value) < 1000 else f"{value:.0f}"
