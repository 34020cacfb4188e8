"""What the rasters of a session say of a plot's plants: which are missing, which are at risk."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior.raster_risk import RELATIVE, RiskSettings
from fieldmon.io.plot_request import CanopySource, RiskSource
from fieldmon.io.rasters.values import RasterOptions

from . import cached, cached_files, widget_memory
from .brought_files import brought, messages_of, settled

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.io.import_report import Imported
    from fieldmon.plot.plot import Plot

    from .brought_files import File, FileMessage

S = TypeVar("S", "CanopySource", "RiskSource")
T = TypeVar("T", "Plot", "cached.Array")
#: what the rasters are kept as
MISSING, RISK = "missing_plants", "risk"
#: the keys of the boxes that say how they are read
MISSING_BELOW, RISK_MEANING = "missing_below", "risk_meaning"
RISK_SHARE, RISK_LOW = "risk_share", "risk_low"


def without_missing(plot: Plot, key: str) -> tuple[Plot, tuple[FileMessage, ...], str]:
    """Return the plot without the plants that are not there, what was said, and the longer key."""
    left, said, key = _read(MISSING, key, _canopy, cached_files.without_missing, plot)
    return plot if left is None else left, said, key


def risk(plot: Plot, key: str) -> tuple[cached.Array | None, tuple[FileMessage, ...], str]:
    """Return the risk of each plant ``(n,)`` or None, what the import said, and the longer key."""
    return _read(RISK, key, _risk, cached_files.risk, plot)


def problem(kind: str) -> FieldmonError | None:
    """Return why a raster could not be used when it was last read."""
    found: FieldmonError | None = st.session_state.get(_problem_key(kind))
    return found


def _read(
    kind: str,
    key: str,
    source: Callable[[File, RasterOptions], S],
    read: Callable[[str, S, Plot], Imported[T]],
    plot: Plot,
) -> tuple[T | None, tuple[FileMessage, ...], str]:
    """Return what a raster says of a plot, what its import said, and the longer key.

    None if there is no raster. One that cannot be used is left out; `problem` says why.
    """
    file = brought().get(kind)
    if file is None:
        return None, (), key
    st.session_state[_problem_key(kind)] = None
    try:
        asked = source(file, settled(file, RasterOptions()))
        how = {name: value for name, value in vars(asked).items() if name != "file"}
        longer = f"{key} {kind} {file.key} {how}"
        imported = read(longer, asked, plot)
    except FieldmonError as error:
        st.session_state[_problem_key(kind)] = error
        return None, (), key
    return imported.value, messages_of(file, imported), longer


def _problem_key(kind: str) -> str:
    return f"{kind} problem"


def _canopy(file: File, options: RasterOptions) -> CanopySource:
    return CanopySource(file.source, float(widget_memory.value(MISSING_BELOW, 0.5)), options)


def _risk(file: File, options: RasterOptions) -> RiskSource:
    return RiskSource(file.source, _risk_settings(), options)


def _risk_settings() -> RiskSettings | None:
    meaning = widget_memory.value(RISK_MEANING)
    if meaning is None:  # as the file says
        return None
    if meaning not in RELATIVE:
        return RiskSettings(meaning)
    share = widget_memory.value(RISK_SHARE, 2.0) / 100
    low = bool(widget_memory.value(RISK_LOW, default=False))
    return RiskSettings(meaning, share, low_is_risky=low)
