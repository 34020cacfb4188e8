"""A picture of the ground under the map, from a GeoTIFF of this session."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.io.rasters.values import RasterOptions

from . import cached, files, maps, texts

if TYPE_CHECKING:
    from .choices import Choices


def bring() -> None:
    """Show the box for the picture; other sessions do not see it."""
    files.bring_one(texts.BACKDROP, "ground")
    files.kept_one("ground")


def layers(choices: Choices) -> list:
    """Return the picture's layer, if there is a picture that lies about the plot."""
    ground = st.session_state.get("ground")
    if ground is None:
        return []
    try:
        options = files.settled(ground, RasterOptions())
        picture = cached.backdrop(f"{ground.key} {options} {choices.key}", options, ground.source,
                                  choices.plot.field)  # fmt: skip
    except FieldmonError as error:
        files.say(error)
        return []
    return [maps.backdrop(picture.data_uri, picture.corners_lonlat.tolist())]
