"""The comparison of teams as one HTML page that needs nothing else."""

from __future__ import annotations

from statistics import fmean
from typing import TYPE_CHECKING

from fieldmon.io.html import page
from fieldmon.studies.charts import Line, line_chart
from fieldmon.studies.teams.summary import HEADS, cells, sentences, short

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markupsafe import Markup

    from fieldmon.studies.teams.summary import TeamRow

# hectares a robot that differ by less are drawn as one
_ALIKE = 1.04


def report_html(made: Sequence[TeamRow]) -> str:
    """Return the whole report as one HTML document."""
    return page(
        "fieldmon/studies/teams/report.html.j2",
        sentences=sentences(made),
        charts=[*of_sizes(made), *charts(made)],
        heads=HEADS,
        rows=[cells(row) for row in made],
    )


def of_sizes(made: Sequence[TeamRow]) -> list[Markup]:
    """Return a chart of what a hectare loses by the hectares a robot has, over several sizes."""
    if len({row.hectares for row in made}) < 2:
        return []
    lines = []
    for who, nights in dict.fromkeys((row.who, row.nights) for row in made):
        of = [row for row in made if (row.who, row.nights) == (who, nights)]
        points = sorted((row.hectares / row.robots, row.loss.mean / row.hectares) for row in of)
        x, y = zip(*_together(points), strict=True)
        lines.append(Line(nights, x, y))
    title, up = "Infested plant-days a hectare", "infested plant-days a hectare"
    return [line_chart(title, lines, ("hectares a robot", up), powers=True)]


def _together(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return points in order, those of nearly one x taken together: plots of several sizes."""
    groups: list[list[tuple[float, float]]] = []
    for point in points:
        if groups and point[0] < _ALIKE * groups[-1][0][0]:
            groups[-1].append(point)
        else:
            groups.append([point])
    return [(fmean(x for x, _ in group), fmean(y for _, y in group)) for group in groups]


def charts(made: Sequence[TeamRow]) -> list[Markup]:
    """Return for each scenario the infested plant-days by the number of robots."""
    drawn = []
    for scenario in dict.fromkeys(row.scenario for row in made):
        here = [row for row in made if row.scenario == scenario]
        lines = []
        for who in dict.fromkeys(row.who for row in here):
            of = [row for row in here if row.who == who]
            x, y = [row.robots for row in of], [row.loss.mean for row in of]
            low, high = [max(row.loss.low, 0.0) for row in of], [row.loss.high for row in of]
            lines.append(Line(who, x, y, low, high))
        drawn.append(line_chart(short(scenario), lines, ("robots", "infested plant-days")))
    return drawn
