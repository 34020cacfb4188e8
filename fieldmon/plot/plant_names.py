"""What people call the row and the block of each plant."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class PlantNames(NamedTuple):
    """The names ``(n,)`` of the row and of the block of each measured plant; None: not known."""

    row: NDArray[np.str_] | None = None
    block: NDArray[np.str_] | None = None

    def __repr__(self) -> str:
        return f"<PlantNames: {0 if self.row is None else len(self.row)} plants>"
