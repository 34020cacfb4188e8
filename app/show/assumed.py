"""What is assumed, in words beside the figures that rest on it. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.units import in_unit

from ..words import texts
from ..words.language import in_words, listed, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.plot.assumed import Assumed

    from ..words.units import UnitsInLanguage

_LENGTHS = frozenset({"row_spacing_m", "plant_spacing_m", "half_canopy_m"})
_OF_WHO_INSPECTS = frozenset({"speed_m_s", "row_change_s", "stop_s", "detects"})


def sentence(assumed: Sequence[Assumed], units: UnitsInLanguage) -> str:
    """Return what is assumed, as one line; empty if nothing is.

    Of who inspects it says only that something is: `of_who_inspects` says what.
    """
    if not assumed:
        return ""
    said = [_words(one, units) for one in assumed if one.setting not in _OF_WHO_INSPECTS]
    if len(said) < len(assumed):
        said.append(texts.ASSUMED_ROBOT_TOO)
    return texts.ASSUMED.format(what=listed(said))


def of_who_inspects(assumed: Sequence[Assumed], units: UnitsInLanguage) -> str:
    """Return what is assumed of who inspects; empty if nothing is."""
    said = [_words(one, units) for one in assumed if one.setting in _OF_WHO_INSPECTS]
    return texts.ASSUMED_OF_ROBOT.format(what=listed(said)) if said else ""


def of_rows(asked: Sequence[Assumed], units: UnitsInLanguage) -> str:
    """Return the question whether rows run so."""
    return texts.BEGIN_ASKS.format(what=listed([_words(one, units) for one in asked]))


def mark(label: str, assumed: Sequence[Assumed], settings: Sequence[str]) -> str:
    """Return the label of a figure, with a star if it rests on one of these settings."""
    return f"{label} *" if any(one.setting in settings for one in assumed) else label


def _words(one: Assumed, units: UnitsInLanguage) -> str:
    if one.setting in _LENGTHS:
        value = in_words(in_unit(units.shown(one.value), "g", units.length))
    elif one.setting == "speed_m_s":
        value = number(3.6 * one.value, ".3g")
    elif one.setting == "row_bearing_deg":
        value = number(one.value, ".1f")
    elif one.setting in {"row_change_s", "stop_s"}:
        value = number(one.value, "g")
    else:
        value = number(100 * one.value, "g")
    return texts.ASSUMED_WHAT[one.setting].format(value=value)
