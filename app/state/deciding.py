"""What is asked of a season's advice, from the boxes of the page, and its answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.decisions.thresholds import in_order_for, published
from fieldmon.monitoring.settings.advice_settings import AdviceSettings

from . import cached, widget_memory
from .chosen_units import units
from .unit_boxes import DECIDE_BY_AREA, DECIDE_LENGTHS

if TYPE_CHECKING:
    from fieldmon.decisions.thresholds import Threshold
    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.monitoring.estimates.treatment_effect import TreatmentEffect

    from .choices import Choices

_USUAL = AdviceSettings()
#: boxes of numbers by their keys: what they begin with
BEGINS: dict[str, float] = {
    "decide level": 100 * _USUAL.level,
    "decide sure": 100 * _USUAL.sure,
    "decide rate": _USUAL.rate_l_ha,
    "decide rows": _USUAL.sprayer.rows,
    "decide on": _USUAL.sprayer.least_on_m,
    "decide off": _USUAL.sprayer.least_off_m,
    "decide ring": _USUAL.sprayer.ring,
    "decide per_ha": _USUAL.costs.per_ha,
    "decide per_zone": _USUAL.costs.per_zone,
    "decide loss": _USUAL.costs.infested_plant_day,
    "decide days": _USUAL.costs.days,
    "decide works": 100 * _USUAL.costs.works,
    "decide reserve": 100 * _USUAL.costs.reserve,
}
#: the box of the product's name
PRODUCT = "decide product"
#: the box of the share from which treating pays, in percent
LEVEL = "decide level"
#: that of how well treating works, in percent; it is empty until somebody says
WORKS = "decide works"
_OWN = "own thresholds"


def shown(key: str, value: float) -> float:
    """Return metres, or what is of a hectare, as its box shows it."""
    if key in DECIDE_LENGTHS:
        return units().shown(value)
    return units().by_area(value) if key in DECIDE_BY_AREA else value


def _meant(key: str, now: float) -> float:
    if key in DECIDE_LENGTHS:
        return units().in_metres(now)
    return units().by_hectare(now) if key in DECIDE_BY_AREA else now


def learnt(choices: Choices) -> TreatmentEffect | None:
    """Return what the season learnt of how well the product works; None: nothing yet."""
    return cached.learnt_efficacy(
        choices.key, choices.revision, choices.day, product(), choices.open_season
    )


def asked(known: TreatmentEffect | None = None) -> AdviceSettings:
    """Return what the boxes say; an empty one says what it began with, or what is `known`."""
    known = known if widget_memory.value(WORKS) is None else None
    said = {
        key: begins if (now := widget_memory.value(key)) is None else _meant(key, float(now))
        for key, begins in BEGINS.items()
    }
    if known is not None:
        said[WORKS] = 100 * known.efficacy
    box = {key.partition(" ")[2]: value for key, value in said.items()}
    return AdviceSettings(
        box["level"] / 100, box["sure"] / 100,
        Sprayer(int(box["rows"]), box["on"], box["off"], int(box["ring"])),
        TreatmentCosts(box["per_ha"], box["per_zone"], box["loss"], box["days"],
                       box["works"] / 100, box["reserve"] / 100),
        box["rate"],
        learnt_of="" if known is None else known.product,
    )  # fmt: skip


def thresholds(pest: str = "") -> dict[str, Threshold]:
    """Return published thresholds and one's own by their names; those of other pests come last."""
    own: tuple[Threshold, ...] = st.session_state.get(_OWN, ())
    known = {one.name: one for one in (*published(), *own)}
    return {one.name: one for one in in_order_for(pest, known.values())}


def keep_thresholds(own: tuple[Threshold, ...]) -> None:
    """Keep thresholds of one's own for this visit, in place of those before."""
    st.session_state[_OWN] = own


def product() -> str:
    """Return what is to be sprayed, as it was called; empty: not said."""
    return str(widget_memory.value(PRODUCT) or "").strip()


def advice(choices: Choices) -> Advice:
    """Return what the season advises on the chosen day."""
    return cached.advice(
        choices.key, choices.revision, choices.day, asked(learnt(choices)), choices.open_season
    )
