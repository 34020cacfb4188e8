"""Where the parts of the first page go, made before there is anything to put there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator


@dataclass(frozen=True, eq=False)
class Places:
    """The places of a page.

    Parameters
    ----------
    above
        What there is to wait for.
    heading, figures
        What stands over the map.
    picture
        The map, and what belongs to it.
    chart
        The map itself, in there.
    """

    above: DeltaGenerator
    heading: DeltaGenerator
    figures: DeltaGenerator
    picture: DeltaGenerator
    chart: DeltaGenerator
