"""Where on earth a plot lies, in words. No Streamlit in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.plot.local_clock import clock_at

from ..words import texts
from ..words.language import country, number

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot


def of_zone(zone: str) -> str:
    """Return the country of a time zone, or that it is of the sea; empty: none is known."""
    if zone.startswith("Etc/"):
        return texts.AT_SEA
    return country(zone) or zone.replace("_", " ")


def at(lon: float, lat: float) -> str:
    """Return the country of a place, as its time zone says, or that it lies in the sea."""
    return of_zone(clock_at(lon, lat).zone)


def sentence(plot: Plot) -> str:
    """Return where a plot lies; corners that changed places lie in another country."""
    frame = plot.grid.frame
    lon, lat = (number(one, ".4f") for one in (frame.lon, frame.lat))
    return texts.PLOT_LIES.format(lat=lat, lon=lon, where=at(frame.lon, frame.lat))
