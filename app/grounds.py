"""A picture of the ground under the map, from a GeoTIFF of this session."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .choices import Choices


def available() -> bool:
    """Tell whether this installation reads rasters."""
    return importlib.util.find_spec("fieldmon.geodata.rasters") is not None


def bring() -> None:
    """Show the box for the picture."""


def layers(choices: Choices) -> list:  # noqa: ARG001
    """Return the picture's layer, if there is a picture."""
    return []
