"""How far a season's pest has come in its weather: a line against its stages."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import streamlit as st

from ..words import texts
from ..words.language import number
from . import charts, pest_figures

if TYPE_CHECKING:
    from fieldmon.pests.development import Development
    from fieldmon.pests.pest import Pest

    from ..state.choices import Choices


def show(choices: Choices) -> None:
    """Show when the next generation is due, and the warmth gathered until then."""
    season = choices.open_season
    pest = season.settings.pest
    if pest is None:
        return
    st.markdown(f"**{pest_figures.title(pest)}**")
    there = season.development(choices.on)
    if there is None:
        has_weather = season.settings.weather is not None
        st.caption(texts.NO_DEVELOPMENT if has_weather else texts.NEEDS_WEATHER)
        return
    st.markdown(_sentence(choices, there))
    axes = (texts.DATE_AXIS, texts.DEGREE_DAYS)
    lines = [(pest_figures.stage_name(name), at) for name, at in _marks(pest, there)]
    named = choices.units.short_day
    chart = charts.development(there, [*lines, *_generations(there)], axes, named)
    st.altair_chart(chart, alt=texts.DEGREE_DAYS)
    if guessed := int(there.guessed[: there.elapsed].sum()):
        st.caption(texts.DAYS_FILLED.format(n=guessed))
    st.caption(texts.DEVELOPMENT_NOTE)


def _sentence(choices: Choices, there: Development) -> str:
    day = partial(choices.units.said_day, seen_from=choices.on)
    values = {
        "degree_days": number(there.so_far, ".0f"),
        "threshold": pest_figures.celsius(there.threshold_c),
        "needed": number(there.per_generation, "g"),
        "since": day(there.since),
    }
    said = texts.GATHERED.format(**values)
    if there.stage:
        said += " " + texts.STAGE_NOW.format(stage=pest_figures.stage_name(there.stage))
    if there.next_generation is None:
        return f"{said} {texts.NO_GENERATION}"
    when = texts.NEXT_GENERATION.format(when=choices.units.short_day(there.next_generation))
    return f"**{when}** {said}"


def _marks(pest: Pest, there: Development) -> list[tuple[str, float]]:
    """Return where each stage of the generation under way ends, in degree-days.

    A stage's part of its generation is that of its own degree-days.
    """
    if len(pest.stages) < 2:
        return []
    begun = int(there.generations) * there.per_generation
    whole = sum(stage.degree_days for stage in pest.stages)
    marks, gathered = [], 0.0
    for stage in pest.stages[:-1]:
        gathered += stage.degree_days
        marks.append((stage.name, begun + gathered / whole * there.per_generation))
    return marks


def _generations(there: Development) -> list[tuple[str, float]]:
    """Return where generations are complete, up to the next one."""
    last = int(there.generations) + 1
    first = max(1, last - 1)
    return [
        (texts.GENERATION_MARK.format(n=n), n * there.per_generation)
        for n in range(first, last + 1)
    ]
