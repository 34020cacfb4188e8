"""What the first page shows before anything is planned: the plot's outline on the map.

Little is imported here: all else loads while the browser does (see `preload`).
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.errors import FieldmonError

from ..show import first_map
from ..state import plot_source, sample_estate
from ..words import texts
from . import preload

if TYPE_CHECKING:
    from streamlit.delta_generator import DeltaGenerator

    from fieldmon.plot.field import Field


class FirstScreen:
    """Waits until plants can be laid, shows the outline meanwhile, and says what takes so long.

    Parameters
    ----------
    place
        Where it is said: empty again at the end.
    """

    def __init__(self, place: DeltaGenerator) -> None:
        self._place = place

    def begin(self) -> bool:
        """Outline the sample estate where nothing can be planned yet; return whether it was."""
        if preload.start().ready.is_set() or plot_source.chosen() != plot_source.SAMPLE:
            return False
        with suppress(FieldmonError):  # it is said where the plot is wanted
            self._outline(sample_estate.plots()[0])
            return True
        return False

    def wait(self, field: Field | None) -> None:
        """Wait; compiling is once an installation, and how far it is stands here."""
        ready = preload.start().ready
        if field is not None and not ready.is_set():
            self._outline(field)
        while not ready.wait(0.5):
            if FIRST_USE.compiled:
                self._place.info(texts.COMPILING.format(n=FIRST_USE.compiled))
        self._place.empty()

    def _outline(self, field: Field) -> None:
        self._place.html(first_map.outline(field))
