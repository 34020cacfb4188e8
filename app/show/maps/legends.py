"""What the signs of a map mean: parts of a legend, each for a layer or a shade."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

from ...words import texts
from ...words.language import number
from . import colours

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

    from .colours import Colour

    #: a sign, its colour, and what it means
    Item = tuple[str, Colour, str]


class LegendPart(TypedDict):
    """Signs with their meanings, whose layer or shade they belong to, and whether on a scale."""

    title: str
    of: str
    scale: bool
    items: list[Item]


def part(title: str, items: list[Item], of: str = "") -> LegendPart:
    """Return signs with their meanings; `of` names the switch or ``shade:NAME`` they belong to."""
    return {"title": title, "of": of, "scale": False, "items": items}


def by_chance(*, dark: bool = False) -> LegendPart:
    """Return the scale of chances: the lower end of each class."""
    names = [texts.IN_PERCENT.format(value=number(low * 100, "g")) for low in colours.CHANCE_FROM]
    names[-1] += "+"
    classes = zip(colours.of_chance(dark=dark), names, strict=True)
    items = [("square", colour, name) for colour, name in classes]
    return {"title": texts.LEGEND_CHANCE, "of": "shade:chance", "scale": True, "items": items}


def by_state(*, recorded: bool = False, not_inspected: bool = False) -> LegendPart:
    """Return the three states, and finds of records alone where there are any.

    And plants that could not be inspected, or are gone.
    """
    names = texts.LEGEND_STATES
    items = [
        ("find", colours.FOUND, names["found"]),
        *([("ring", colours.FOUND, texts.LEGEND_RECORDED)] if recorded else []),
        ("dot", colours.CLEAN, names["clean"]),
        *([("dot", colours.NOT_INSPECTED, texts.LEGEND_NOT_INSPECTED)] if not_inspected else []),
        ("ring", colours.NEVER, names["never"]),
    ]
    return part("", items, "shade:state")  # its signs are its title


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


def plan(field: Field, *, dark: bool = False) -> list[LegendPart]:
    """Return the signs of a plan: what is driven on, and what is not."""
    tone = colours.PLAN_IN_DARK if dark else colours.PLAN
    items = [
        ("area", tone.headland, texts.LEGEND_HEADLAND),
        ("area", tone.aisle, texts.LEGEND_AISLE),
    ]
    if not field.no_go.is_empty:
        items.append(("hatch", tone.hatch, texts.LEGEND_NO_GO))
    return [part("", items, "plan")]


def gate() -> LegendPart:
    """Return the sign of the gate."""
    return part("", [("ring", colours.GATE, texts.LEGEND_GATE)])


def plants() -> LegendPart:
    """Return the sign of a plant of which nothing is said."""
    return part("", [("dot", colours.PLAIN, texts.LEGEND_PLANT)])


def records(*, dark: bool = False, unknown: bool = False) -> list[LegendPart]:
    """Return the signs of records, also of those of which nobody knows what was seen."""
    hot = colours.HOT_IN_DARK if dark else colours.HOT
    seen = [("dot", hot, texts.LEGEND_SEEN), ("ring", hot, texts.LEGEND_NOT_SEEN)]
    seen += [("ring", colours.UNKNOWN, texts.LEGEND_NOT_KNOWN)] if unknown else []
    return [part("", seen, "records")]


def signs(*, dark: bool = False) -> list[LegendPart]:
    """Return the signs of route, hot spots, records and what was treated, each of its switch."""
    route = colours.ROUTE_IN_DARK if dark else colours.ROUTE
    hot = colours.HOT_IN_DARK if dark else colours.HOT
    sprayed = colours.TREATED_IN_DARK if dark else colours.TREATED
    return [
        part("", [("line", route, texts.LEGEND_ROUTE)], "route"),
        part("", [("outline", hot, texts.LEGEND_HOT)], "hot"),
        *records(dark=dark),
        part("", [("outline", sprayed, texts.LEGEND_TREATED)], "treated"),
    ]
