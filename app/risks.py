"""A raster of this session that says where plants are at more risk, and what its numbers mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.infestation.raster_risk import RELATIVE, RiskSettings

from . import cached, files, remembered, texts

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from .files import Heard

_FILE = "risk"
_MEANING, _SHARE, _LOW = "risk_meaning", "risk_share", "risk_low"


def bring() -> None:
    """Show the box for the raster, and what its numbers mean."""
    with st.expander(texts.RISK, expanded=_FILE in st.session_state):
        st.caption(texts.RISK_NOTE)
        files.bring_one(texts.RISK_FILE, _FILE)
        remembered.show(st.selectbox, texts.RISK_MEANS, list(texts.RISK_MEANINGS), key=_MEANING,
                        format_func=texts.RISK_MEANINGS.__getitem__, default="chance",
                        filter_mode=None)  # fmt: skip
        if remembered.value(_MEANING) in RELATIVE:
            remembered.show(st.number_input, texts.RISK_SHARE, 0.1, 50.0, step=0.5, key=_SHARE,
                            default=2.0)  # fmt: skip
            remembered.show(st.toggle, texts.RISK_LOW, key=_LOW, default=False)
        files.kept_one(_FILE)


def of(plot: Plot, key: str) -> tuple[cached.Array | None, tuple[Heard, ...], str]:
    """Return the risk of each plant ``(n,)`` or None, what the import said, and the longer key."""
    return files.read_kept(_FILE, key, _settings, cached.risk, plot)


def _settings() -> RiskSettings:
    meaning = remembered.value(_MEANING, "chance")
    if meaning not in RELATIVE:
        return RiskSettings(meaning)
    share = remembered.value(_SHARE, 2.0) / 100
    return RiskSettings(meaning, share, low_is_risky=bool(remembered.value(_LOW, default=False)))
