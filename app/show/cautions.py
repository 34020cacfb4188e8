"""What to beware of after treatments, when harvest may begin, and whether treatments worked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.monitoring.days.kept_routes import closed_to_kept
from fieldmon.monitoring.estimates.last_days import recorded_ahead
from fieldmon.monitoring.treating.closures import closed_in_words, closed_plants, is_all_closed
from fieldmon.planning.skips import left_out_in_words

from ..state import chosen_day
from ..words import texts
from ..words.language import in_words

if TYPE_CHECKING:
    from collections.abc import Iterable
    from datetime import date

    from fieldmon.monitoring import Caution, Season
    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices


def show(choices: Choices, kinds: tuple[str, ...] = ()) -> None:
    """Show what to beware of on the chosen day; `kinds`: of these alone."""
    if (season := choices.season) is None:
        return
    if not kinds:
        _show_left_out(choices, season)
        _show_found_again(choices)
    found = season.cautions(choices.on, choices.units.in_sentences(choices.on))
    _warn([one for one in found if not kinds or one.kind in kinds])


def show_if_treated(choices: Choices, advice: Advice, product: str) -> None:
    """Show what treating the zones with a product would bring."""
    units = choices.units.in_sentences(choices.on)
    _warn(choices.open_season.cautions_if_treated(choices.on, product, advice.sprayed, units))


def _warn(found: Iterable[Caution]) -> None:
    said = dict.fromkeys(in_words(one.sentence) for one in found)
    if said:
        st.warning("\n".join(f"- {sentence}" for sentence in said))


def show_today(choices: Choices, plan: DayPlan) -> None:
    """Show what counts on the day itself: where not to enter, a harvest to come, finds again."""
    if (season := choices.season) is None:
        return
    _show_left_out(choices, season)
    _show_found_again(choices)
    if not chosen_day.route(choices).worked:
        if left_off := _left_off(choices, season, plan):
            st.warning("\n".join(f"- {sentence}" for sentence in left_off))
        for said in left_out_in_words(plan.scene, plan.route):
            st.caption(in_words(said))
    harvest = season.settings.harvest
    is_ahead = harvest is not None and choices.on <= harvest
    show(choices, ("lost", "entry", "harvest") if is_ahead else ("lost", "entry"))


def are_all_closed(choices: Choices, plan: DayPlan) -> bool:
    """Tell whether people may not be yet at any plant that is left, and that is why none is."""
    if choices.season is None or len(plan.route):
        return False
    left_s = plan.scene.seconds_left
    closed = choices.season.closed(choices.on, choices.whose_day or "", left_s)
    return is_all_closed(plan.scene, closed)


def _left_off(choices: Choices, season: Season, plan: DayPlan) -> list[str]:
    """Return what is left off the route as people may not be there yet, and off a kept one."""
    units = choices.units.in_sentences(choices.on)
    closed = season.closed(choices.on, choices.whose_day or "", plan.scene.seconds_left)
    said = closed_in_words(closed, choices.plot.grid, units)
    to_kept = closed_to_kept(season, choices.on, choices.whose_day or "")
    plants = closed_plants(to_kept, len(choices.plot.grid))
    kept = np.count_nonzero(plants[chosen_day.given_out(choices)])
    told = texts.KEPT_CLOSED if len(plan.route) else texts.KEPT_ALL_CLOSED
    return [*map(in_words, said), *([told.format(n=int(kept))] if kept else [])]


def not_come(choices: Choices, last: date) -> str:
    """Return that the last day recorded has not come, if so: a slip in a date hides what was seen.

    With the ways to mend it; by the plot's calendar.
    """
    if choices.today is None or last <= choices.today:
        return ""
    day, today = (choices.units.said_day(on, choices.today) for on in (last, choices.today))
    said = texts.NOT_COME.format(day=day, today=today)
    if not choices.open_season.numbered(last):
        return said
    return f"{said} {texts.NOT_COME_CORRECT.format(correct=texts.CORRECT_WHEN)}"


def _show_left_out(choices: Choices, season: Season) -> None:
    """Say so on the pages of days before, which show none of it, and which drafts do not count."""
    ahead = recorded_ahead(season)
    if ahead is not None and (said := not_come(choices, ahead)):
        st.warning(said)
    if season.drafts:
        st.warning("\n".join(f"- {in_words(sentence)}" for sentence in season.drafts))


def _show_found_again(choices: Choices) -> None:
    """Say that plants were found again, though they are taken as treated."""
    if (said := chosen_day.found_again(choices)) is not None:
        st.warning(in_words(said.sentence(texts.FINDS_FLAGGED_HOW)))


def show_treatments(choices: Choices) -> None:
    """Show when harvest may begin, and what inspections tell of each treatment."""
    season, units = choices.open_season, choices.units.in_sentences(choices.on)
    if (harvest := season.harvest_from(choices.on)) is not None:
        first, _ = harvest
        if first is not None:  # else it is warned of already
            st.markdown(texts.HARVEST_FROM.format(day=choices.units.said_day(first, choices.on)))
    effects = season.effects(choices.on, units)
    if effects:
        st.markdown(f"**{texts.EFFECTS}**")
        st.markdown("\n".join(f"- {in_words(one.sentence())}" for one in effects))
    if effects and season.settings.belief.treated:
        st.caption(texts.EFFECTS_TREATED)
