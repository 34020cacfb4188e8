"""What the signs of a map mean, as HTML."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .colours import (
    AGE_COLOURS,
    AGE_FROM,
    AGE_IN_DARK,
    CHANCE_COLOURS,
    CHANCE_FROM,
    CHANCE_IN_DARK,
    CLEAN,
    FOUND,
    NEVER,
)

if TYPE_CHECKING:
    from .colours import Colour


def legend(items: list[tuple[Colour, str]], *, signs: tuple[str, ...] = ()) -> str:
    """Return signs with their meaning, as HTML: squares, or ``"ring"``, ``"dot"``, ``"find"``."""
    kinds = signs or ("square",) * len(items)
    parts = "".join(
        f'<span style="white-space:nowrap;margin-right:14px">{_sign(kind, colour)}{text}</span>'
        for kind, (colour, text) in zip(kinds, items, strict=True)
    )
    return f'<div style="line-height:1.9">{parts}</div>'


def _sign(kind: str, colour: Colour) -> str:
    shapes = {
        "square": f'<rect x="1" y="1" width="14" height="14" fill="rgb{colour}" stroke="#777"/>',
        "dot": f'<circle cx="8" cy="8" r="5" fill="rgb{colour}" stroke="#777"/>',
        "ring": f'<circle cx="8" cy="8" r="5" fill="none" stroke="rgb{colour}" stroke-width="2"/>',
        "find": f'<circle cx="8" cy="8" r="6.5" fill="#fff" stroke="#140000" stroke-width="2"/>'
        f'<circle cx="8" cy="8" r="4" fill="rgb{colour}"/>',
        "line": f'<rect x="0" y="6" width="16" height="4" fill="rgb{colour}"/>',
        "outline": f'<rect x="2" y="2" width="12" height="12" rx="4" fill="none" '
        f'stroke="rgb{colour}" stroke-width="3"/>',
    }
    return (
        '<svg width="16" height="16" aria-hidden="true" '
        f'style="vertical-align:-3px;margin-right:5px">{shapes[kind]}</svg>'
    )


def state_legend(names: dict[str, str]) -> str:
    """Return the legend of the three states."""
    items = [(FOUND, names["found"]), (CLEAN, names["clean"]), (NEVER, names["never"])]
    return legend(items, signs=("find", "dot", "ring"))


def age_legend(never: str, days: str, *, dark: bool = False) -> str:
    """Return the legend of the days since the last inspection."""
    tops = [*AGE_FROM[1:], None]
    names = [
        days.format(n=f"{low}-{top - 1}" if top and top - 1 > low else f"{low}" if top
                    else f"{low}+")
        for low, top in zip(AGE_FROM, tops, strict=True)
    ]  # fmt: skip
    shades = AGE_IN_DARK if dark else AGE_COLOURS
    items = [*zip(shades, names, strict=True), (NEVER, never)]
    return legend(items, signs=("square",) * len(names) + ("ring",))


def chance_legend(*, dark: bool = False) -> str:
    """Return the legend of the chance classes."""
    tops = [*CHANCE_FROM[1:], None]
    names = [
        f"{low * 100:g}-{high * 100:g} %" if high else f"over {low * 100:g} %"
        for low, high in zip(CHANCE_FROM, tops, strict=True)
    ]
    shades = CHANCE_IN_DARK if dark else CHANCE_COLOURS
    return legend(list(zip(shades, names, strict=True)))
