"""A drawing on paper, in millimetres: parts that a painter of PDF or of SVG puts down in order.

x runs to the right and y downwards, from the drawing's upper left corner.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Colour = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Strokes:
    """Lines ``(k, 2)`` of one colour and width."""

    lines: tuple[Floats, ...]
    colour: Colour
    width: float
    dashed: bool = False


@dataclass(frozen=True, eq=False)
class Segments:
    """Many short lines, ``(k, 4)`` from x, y to x, y, with flat ends."""

    ends: Floats
    colour: Colour
    width: float


@dataclass(frozen=True, eq=False)
class Areas:
    """Closed rings ``(k, 2)``; a ring inside another one is a hole."""

    rings: tuple[Floats, ...]
    fill: Colour | None = None
    edge: Colour | None = None
    width: float = 0.2
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Discs:
    """Discs or rings about places ``(k, 2)``."""

    places: Floats
    radius: float
    fill: Colour | None = None
    edge: Colour | None = None
    width: float = 0.2


@dataclass(frozen=True)
class Lettering:
    """Words at a place: its height is their middle, `anchor` their ``start``, middle or end."""

    x: float
    y: float
    text: str
    size_pt: float = 7.0
    colour: Colour = (20, 26, 30)
    anchor: str = "start"
    bold: bool = False


@dataclass(frozen=True)
class Bitmap:
    """A PNG picture."""

    x: float
    y: float
    width: float
    height: float
    png: bytes


Part = Strokes | Segments | Areas | Discs | Lettering | Bitmap


@dataclass(frozen=True, eq=False)
class Drawing:
    """Parts in the order in which they are put down, on so much paper."""

    width: float
    height: float
    parts: tuple[Part, ...]

    def turned(self) -> Drawing:
        """Return it as it is read from the right: what was at the left is at the right."""
        return replace(self, parts=tuple(_turned(part, self.width) for part in self.parts))

    def words(self) -> list[str]:
        """Return every text in it."""
        return [part.text for part in self.parts if isinstance(part, Lettering)]


_OTHER_END = {"start": "end", "end": "start", "middle": "middle"}


def _turned(part: Part, width: float) -> Part:
    if isinstance(part, Lettering):
        return replace(part, x=width - part.x, anchor=_OTHER_END[part.anchor])
    if isinstance(part, Bitmap):
        return replace(part, x=width - part.x - part.width)
    if isinstance(part, Strokes):
        return replace(part, lines=tuple(_from_right(line, width) for line in part.lines))
    if isinstance(part, Areas):
        return replace(part, rings=tuple(_from_right(ring, width) for ring in part.rings))
    if isinstance(part, Discs):
        return replace(part, places=_from_right(part.places, width))
    return replace(part, ends=_from_right(part.ends, width))


def _from_right(places: Floats, width: float) -> Floats:
    """Return places ``(k, 2)``, or two beside each other ``(k, 4)``, counted from the right."""
    turned = places.copy()
    turned[:, ::2] = width - turned[:, ::2]
    return turned
