"""A pest's figures with their sources, as its file has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd
import streamlit as st

from fieldmon.compute.wording import worded
from fieldmon.io.readers.pest_file import shipped_words

from ..words import texts
from ..words.language import in_words, number

if TYPE_CHECKING:
    from fieldmon.pests.pest import Pest


def title(pest: Pest) -> str:
    """Return what a pest is called: in the page's words if it comes along, or by its file's."""
    return _said(pest.title or pest.name)


def stage_name(name: str) -> str:
    """Return what a stage is called."""
    return _said(name)


def _said(name: str) -> str:
    return in_words(worded(name)) if name in shipped_words() else texts.isolated(name)


def celsius(temperature_c: float) -> str:
    """Return a temperature, whose sign stays behind its number on a page from the right too."""
    return texts.isolated(texts.CELSIUS.format(n=number(temperature_c, "g")))


def show(pest: Pest) -> None:
    """Show what a pest's file says, each part with its source and its doubt."""
    if pest.species:
        st.caption(f"*{texts.isolated(pest.species)}*")
    for line in _figures(pest):
        st.markdown(f"- {line}")
    if pest.stages:
        st.dataframe(_stages(pest), hide_index=True, width="stretch")
    for citation in pest.citations:
        part = texts.PEST_PARTS.get(citation.part, citation.part)
        st.caption(f"**{part}**: {texts.isolated(citation.source)}")
        if citation.doubt:
            st.caption(f":material/warning: {texts.isolated(citation.doubt)}")
    if pest.not_found:
        said = texts.isolated(pest.not_found.strip())
        st.caption(f"**{texts.PEST_NOT_FOUND}**: {said}")


def _figures(pest: Pest) -> list[str]:
    """Return the figures in words."""
    made, moves = [], pest.movement
    if pest.generation is not None:
        made.append(
            texts.PEST_GENERATION.format(
                degree_days=number(pest.generation.degree_days, "g"),
                threshold=celsius(pest.generation.threshold_c),
            )
        )
    if pest.increase is not None:
        pairs = zip(pest.increase.at_c, pest.increase.per_day, strict=True)
        rates = [
            texts.PEST_RATE.format(rate=number(rate, "g"), at=celsius(at)) for at, rate in pairs
        ]
        made.append(f"{texts.PEST_INCREASE}: {', '.join(rates)}")
    form = texts.PEST_MOVES[moves.kernel]
    rate, reach = number(moves.rate_per_day, "g"), number(moves.reach_m or 0.0, "g")
    made.append(form.format(per_day=rate, reach=reach))
    if pest.assumed:
        made.append(texts.PEST_RATE_ASSUMED)
    if moves.wind == "with":
        made.append(texts.PEST_WITH_WIND)
    if moves.least_rain_mm > 0:
        form = texts.PEST_IN_RAINY_HOURS if moves.by_hour else texts.PEST_IN_RAIN
        made.append(form.format(rain=number(moves.least_rain_mm, "g")))
    return [*made, *_rest(pest)]


def _rest(pest: Pest) -> list[str]:
    """Return how it enters, how it goes on in a plant, and what is counted, in words."""
    made, entry = [], pest.entry
    ways = entry.edge_per_day, entry.paths_per_day, entry.anywhere_per_day
    if any(ways):
        edge, paths, anywhere = (number(chance, "g") for chance in ways)
        made.append(texts.PEST_ENTERS.format(edge=edge, paths=paths, anywhere=anywhere))
    if pest.hidden_days or pest.latency_days:
        hidden, latency = number(pest.hidden_days, "g"), number(pest.latency_days, "g")
        made.append(texts.PEST_COURSE.format(hidden=hidden, latency=latency))
    if pest.count_means:
        made.append(texts.PEST_COUNT.format(what=texts.isolated(pest.count_means)))
    return made


def _stages(pest: Pest) -> pd.DataFrame:
    columns = texts.PEST_COLUMNS
    return pd.DataFrame(
        {
            columns[0]: [stage_name(stage.name) for stage in pest.stages],
            columns[1]: [stage.threshold_c for stage in pest.stages],
            columns[2]: [stage.degree_days for stage in pest.stages],
        }
    )
