"""The study of samplers as one HTML page that needs nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import estimate
from fieldmon.io.html import page
from fieldmon.studies.charts import Range, range_chart
from fieldmon.studies.samplers.contenders import ABOUT, ADAPTIVE
from fieldmon.studies.samplers.summary import means, names_in, others_in, ratios, sentences

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from markupsafe import Markup

    from fieldmon.studies.samplers.seasons import SeasonOutcome

_WORDS = {
    "infested_plant_days": "Infested plant-days over the season",
    "d50": "Days until half of all infestations so far were found",
    "d80": "Days until 80 % of all infestations so far were found",
    "inspected": "Plants inspected over the season",
    "found": "Plants found infested",
    "visited_pct": "Plants inspected at least once, %",
}


def report_html(outcomes: Sequence[SeasonOutcome], about: Mapping[str, str] | None = None) -> str:
    """Return the whole report as one HTML document; `about` says what was added."""
    took_part, known = {outcome.contender for outcome in outcomes}, {**ABOUT, **(about or {})}
    names = tuple(name for name in names_in(outcomes) if name in took_part)
    return page(
        "fieldmon/studies/samplers/report.html.j2",
        seeds=len({outcome.seed for outcome in outcomes}),
        sentences=sentences(outcomes),
        charts=[_chart(outcomes, other) for other in others_in(outcomes) if other in took_part],
        about={name: known[name] for name in names},
        estimate=estimate,
        names=names,
        tables=[(_WORDS[measure], by_name) for measure, by_name in means(outcomes).items()],
    )


def _chart(outcomes: Sequence[SeasonOutcome], other: str) -> Markup:
    rows = [
        Range(scenario, made[other].low, made[other].value, made[other].high)
        for scenario, made in ratios(outcomes).items()
        if other in made
    ]
    title = f"Infested plant-days: {ADAPTIVE} over {other} (mean and 95 % interval)"
    return range_chart(title, rows, "ratio; left of 1 adaptive is ahead", even=1.0)
