"""The comparison of teams as one HTML page that needs nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.io.html import page
from fieldmon.studies.charts import Line, line_chart
from fieldmon.studies.teams.summary import HEADS, cells, sentences, short

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markupsafe import Markup

    from fieldmon.studies.teams.summary import TeamRow


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
    for who, spread in dict.fromkeys((row.who, row.spread) for row in made):
        of = [row for row in made if (row.who, row.spread) == (who, spread)]
        # where several sizes share a robot's hectares, they are taken together
        by: dict[float, list[float]] = {}
        for row in of:
            share = round(row.hectares / row.robots, 1)
            by.setdefault(share, []).append(row.loss.mean / row.hectares)
        x = sorted(by)
        lines.append(Line(f"{spread:.0%} a night", x, [sum(by[k]) / len(by[k]) for k in x]))
    title, up = "Infested plant-days a hectare", "infested plant-days a hectare"
    return [line_chart(title, lines, ("hectares a robot", up), powers=True)]


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
