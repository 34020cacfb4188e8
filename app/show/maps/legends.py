"""What the signs of a map mean: parts of a legend, each for a layer or a shade."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...words import texts
from ...words.language import number
from . import colours

if TYPE_CHECKING:
    from .colours import Colour

    #: ``{"title", "of", "scale", "items": [(sign, colour, words), ...]}``
    LegendPart = dict[str, Any]


def part(title: str, items: list[tuple[str, Colour, str]], of: str = "") -> LegendPart:
    """Return signs with their meanings; `of` names the switch or ``shade:NAME`` they belong to."""
    return {"title": title, "of": of, "scale": False, "items": items}


def by_chance(*, dark: bool = False) -> LegendPart:
    """Return the scale of chances: the lower end of each class."""
    names = [texts.IN_PERCENT.format(value=number(low * 100, "g")) for low in colours.CHANCE_FROM]
    names[-1] += "+"
    classes = zip(colours.of_chance(dark=dark), names, strict=True)
    items = [("square", colour, name) for colour, name in classes]
    return {"title": texts.LEGEND_CHANCE, "of": "shade:chance", "scale": True, "items": items}


def by_state() -> LegendPart:
    """Return the three states."""
    names = texts.LEGEND_STATES
    items = [
        ("find", colours.FOUND, names["found"]),
        ("dot", colours.CLEAN, names["clean"]),
        ("ring", colours.NEVER, names["never"]),
    ]
    return part(texts.SHADES["state"], items, "shade:state")


def by_age(*, dark: bool = False) -> LegendPart:
    """Return the days since the last inspection."""
    tops = [*colours.AGE_FROM[1:], None]
    names = [
        texts.LEGEND_DAYS.format(
            n=f"{low}-{top - 1}" if top and top - 1 > low else f"{low}" if top else f"{low}+"
        )
        for low, top in zip(colours.AGE_FROM, tops, strict=True)
    ]
    shades = colours.AGE_IN_DARK if dark else colours.AGE_COLOURS
    ages = zip(shades, names, strict=True)
    items = [*(("square", colour, name) for colour, name in ages),
             ("ring", colours.NEVER, texts.LEGEND_NEVER)]  # fmt: skip
    return part(texts.SHADES["age"], items, "shade:age")


def signs(*, dark: bool = False) -> list[LegendPart]:
    """Return the signs of route, hot spots and records."""
    route = colours.ROUTE_IN_DARK if dark else colours.ROUTE
    hot = colours.HOT_IN_DARK if dark else colours.HOT
    return [
        part("", [("line", route, texts.LEGEND_ROUTE), ("ring", colours.GATE, texts.LEGEND_GATE)],
             "route"),
        part("", [("outline", hot, texts.LEGEND_HOT)], "hot"),
        part("", [("dot", hot, texts.LEGEND_SEEN), ("ring", hot, texts.LEGEND_NOT_SEEN)],
             "records"),
    ]  # fmt: skip


def markup(parts: list[LegendPart]) -> str:
    """Return parts of a legend as HTML for paper; on the map the browser draws them itself."""
    signs = "".join(
        f'<span style="white-space:nowrap;margin-right:14px">{_drawn(kind, colour)}{words}</span>'
        for part in parts
        for kind, colour, words in part["items"]
    )
    return f'<div style="line-height:1.9">{signs}</div>'


def _drawn(kind: str, colour: Colour) -> str:
    shapes = {
        "square": f'<rect x="1" y="1" width="14" height="14" fill="rgb{colour}"/>',
        "dot": f'<circle cx="8" cy="8" r="5" fill="rgb{colour}"/>',
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
