"""Chapter 5 run again, as one HTML page that needs nothing else."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.charts import Line, line_chart
from fieldmon.studies.thesis.chapter4.report import STYLE
from fieldmon.studies.thesis.chapter4.verdicts import AGREES as EQUAL
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, SCENARIOS
from fieldmon.studies.thesis.chapter5.study import OWN, label_of
from fieldmon.studies.thesis.chapter5.verdicts import AGREES, DIFFERS, FAILS, HOLDS, NEAR, OPEN

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import numpy as np

    from fieldmon.studies.thesis.chapter5.mapped_plots import MapMeasure
    from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
    from fieldmon.studies.thesis.chapter5.study import PriorStudy, StudyPart
    from fieldmon.studies.thesis.chapter5.verdicts import Compared

_CLASSES = {AGREES: EQUAL, HOLDS: EQUAL, NEAR: "near", OPEN: "near", DIFFERS: "differs"}
_CLASSES[FAILS] = "differs"
_FIGURES = {"A": (20, 21), "B": (22, 23), "C": (24, 25)}
_SWEEP_FIGURES = {"size": 26, "spread": 27, "time": 28, "detection": 29}
_BANDS = "".join(
    f".b{k} {{ fill: var(--{colour}); opacity: 0.15; }} "
    for k, colour in enumerate(("blue", "red", "green", "violet", "brown"))
)
_ABOUT = (
    "A. Yehoshua (2023), chapter 5, run again by fieldmon. The thesis gives these figures as text "
    "and not its insect data, so this is a calibrated reproduction: what the text leaves open is "
    "listed below, as chosen. Bands and brackets are 95 % intervals of the mean. The plots stand "
    "where figures 20 to 29 should stand by the order of the text; the numbering is ours."
)
_MAPS = (
    "Each map is the truth; a working day of 12 h is given to each of its dates. Records point to "
    "a fifth of the plants infested on the first date; what is found is taken out, and the next "
    "date's map is the spread. Bands are 95 % intervals of the mean over seeds."
)
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
    choices = "".join(f"<li>{escape(said)}</li>" for said in study.choices.sentences())
    stopped = "<p><strong>Stopped before the end: what was done by then.</strong></p>"
    return _page(
        "The thesis's samplers with prior information",
        f"<p>{escape(_ABOUT)}</p>{stopped if study.stopped else ''}"
        f"<p>{study.seeds} paired seeds a configuration, from seed {study.seed}.</p>"
        f"<details><summary>Open choices</summary><ul>{choices}</ul></details>"
        f"{_compared(study.compared)}{''.join(_part(part) for part in study.parts)}",
    )


def maps_html(table: Sequence[MapMeasure]) -> str:
    """Return the samplers on real maps as one HTML document: a plot a map and date."""
    plots = dict.fromkeys((row.map, row.date, row.infested) for row in table)
    charts = "".join(
        line_chart(
            f"{name} {date}: found of {infested} infested plants",
            [_map_line(table, (name, date, each)) for each in SAMPLERS],
            ("plants visited, %", "found, %"),
        )
        for name, date, infested in plots
    )
    return _page("The three samplers on real maps of plants", f"<p>{escape(_MAPS)}</p>{charts}")


def _map_line(table: Sequence[MapMeasure], key: tuple[str, str, str]) -> Line:
    rows = [row for row in table if (row.map, row.date, row.sampler) == key]
    x, y, low, high = (
        [getattr(row, column) if row.seeds > 1 else math.nan for row in rows]
        for column in ("visited_pct", "mean", "low", "high")
    )
    return Line(key[2].capitalize(), x, y, low, high)


def _page(title: str, body: str) -> str:
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLE}{_BANDS}</style></head><body>"
        f"<h1>{escape(title)}</h1>{body}</body></html>\n"
    )


def _compared(table: Sequence[Compared]) -> str:
    if not table:
        return ""
    body = "".join(
        f'<tr><th scope="row">{escape(f"{each.part}: {each.what}")}</th>'
        f"<td>{escape(each.published)}</td><td>{each.ours:.1f}"
        f"<small>{_short(each.low)} to {_short(each.high)}</small></td>"
        f'<td>{each.difference:+.1f}</td><td class="{_CLASSES[each.verdict]}">{each.verdict}</td>'
        f"<td>{'' if each.fitted else 'looked at only'}</td></tr>"
        for each in table
    )
    heads = ("figure", "published", "ours", "difference", "verdict", "in the fit")
    return f"<section><h2>Published and ours</h2>{_table(heads, body)}</section>"


def _part(part: StudyPart) -> str:
    body = "".join(
        f'<tr><th scope="row">{escape(_name(part, runs))}</th>'
        + "".join(_td(values) for values in runs.measures().values())
        + "</tr>"
        for runs in part.runs
    )
    table = _table(("configuration", *_MEASURES.values()), body)
    return f"<section><h2>{escape(part.title)}</h2>{''.join(charts(part))}{table}</section>"


def charts(part: StudyPart) -> list[str]:
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


def _by_day(part: StudyPart, measure: str, title: str) -> str:
    lines = [
        _line(
            label_of(part.name, runs.trial),
            [float(day) for day in range(1, runs.tables.shape[1] + 1)],
            list(getattr(runs, measure).T),
        )
        for runs in part.runs
    ]
    return line_chart(title, lines, ("day", "%"))


def _by_size(part: StudyPart, title: str) -> str:
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


def _td(values: np.ndarray) -> str:
    ours = summary_statistics(values)
    return f"<td>{_short(ours.mean)}<small>{_short(ours.low)} to {_short(ours.high)}</small></td>"


def _short(value: float) -> str:
    return f"{value:.1f}" if abs(value) < 1000 else f"{value:.0f}"


def _table(heads: Sequence[str], body: str) -> str:
    head = "".join(f'<th scope="col">{escape(each)}</th>' for each in heads)
    return (
        f'<div class="wide" tabindex="0"><table><thead><tr>{head}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )
