"""Plants picked on the map: to be inspected too on the day, or not to be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.monitoring.estimates.plant_states import NO_LONGER
from fieldmon.planning.wishes import Wishes

from ..show.maps import plant_layers
from ..state import chosen_day, wishes
from ..words import texts

if TYPE_CHECKING:
    from pydeck import Layer

    from fieldmon.planning.plan import DayPlan

    from ..state.choices import Choices


def take(choices: Choices, plants: tuple[int, ...]) -> None:
    """Take plants as picked (for callbacks)."""
    wishes.pick(choices.laid, tuple(k for k in plants if 0 <= k < len(choices.plot.grid)))


def layers(choices: Choices) -> list[Layer]:
    """Return rings round the plants that are picked."""
    some = wishes.picked(choices.laid)
    return [plant_layers.picked(choices.plot.grid, np.array(some, np.intp))] if some else []


def show(choices: Choices, plan: DayPlan) -> None:
    """Show what can be done with the plants that are picked, and what is wished for already."""
    some = wishes.picked(choices.laid)
    if some:
        st.markdown(texts.PICKED.format(plants=texts.PLANTS_COUNTED.format(n=len(some))))
        with st.container(horizontal=True):
            for key, label in (("also", texts.PICKED_ALSO), ("never", texts.PICKED_NEVER)):
                st.button(label, key=f"picked_{key}", on_click=_wish, args=(choices, key, some))
            st.button(texts.PICKED_NONE, key="picked_none", on_click=take, args=(choices, ()))
    wanted, is_unused = choices.besides, choices.are_wishes_unused
    if not wanted and not is_unused:
        return
    said = [
        text.format(plants=texts.PLANTS_COUNTED.format(n=len(of)))
        for text, of in ((texts.WISHED, wanted.wanted), (texts.UNWISHED, wanted.unwanted))
        if of
    ]
    if is_unused:
        said.append(texts.WISHES_UNUSED)
    st.caption(" ".join(said))
    unmet = wanted.unmet(plan.route)
    gone = chosen_day.not_inspected(choices)[unmet] == NO_LONGER
    for text, n in ((texts.WISHES_GONE, gone.sum()), (texts.WISHES_UNMET, (~gone).sum())):
        if n:
            st.warning(text.format(n=int(n)))
    if wanted:
        st.button(texts.WISHES_DROP, key="wishes_drop", icon=":material/undo:", on_click=_drop,
                  args=(choices,))  # fmt: skip


def _wish(choices: Choices, kind: str, plants: tuple[int, ...]) -> None:
    now = choices.besides
    new = now.also(plants) if kind == "also" else now.never(plants)
    wishes.want(choices.laid, choices.day, new)
    take(choices, ())


def _drop(choices: Choices) -> None:
    wishes.want(choices.laid, choices.day, Wishes())
