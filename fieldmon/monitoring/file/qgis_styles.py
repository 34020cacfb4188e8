"""How QGIS shows a season without a click: its `layer_styles` table."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

from fieldmon.io.writers.qml import (
    BLACK,
    BLUE,
    GREY,
    RED,
    STYLES_TABLE,
    YELLOW,
    Symbol,
    add,
    by_value,
    labelled,
    qml,
    single,
)

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable

_RAMP = (
    (0.01, "189,201,170,255"),
    (0.05, "254,217,118,255"),
    (0.15, "254,153,41,255"),
    (0.4, "217,95,14,255"),
    (1.0, "153,52,4,255"),
)
# of the routes of a team (Okabe & Ito 2008), those that stand out from a light map
_EACH = (
    *(BLUE, RED, "0,158,115,255", "204,121,167,255"),
    *("86,180,233,255", "230,159,0,255", BLACK),
)


def _by_size(column: str) -> str:
    """Return a legend with classes of a chance."""
    lower = [0.0, *(upper for upper, _ in _RAMP[:-1])]
    ranges = "".join(
        f'<range render="true" symbol="{i}" lower="{low:.6f}" upper="{up:.6f}" '
        f'label="{100 * low:g} - {100 * up:g} %"/>'
        for i, (low, (up, _)) in enumerate(zip(lower, _RAMP, strict=True))
    )
    drawn = "".join(Symbol("marker", color).qml(str(i)) for i, (_, color) in enumerate(_RAMP))
    return qml(
        f'<renderer-v2 type="graduatedSymbol" attr="{column}" graduatedMethod="GraduatedColor" '
        f'enableorderby="0" forceraster="0" symbollevels="0"><ranges>{ranges}</ranges>'
        f"<symbols>{drawn}</symbols></renderer-v2>"
    )


STYLES = {
    "plots": single(Symbol("fill", BLACK, 0.5)),
    "rows": single(Symbol("line", "120,150,90,255", 0.3)),
    "plants": single(Symbol("marker", "120,150,90,255", 1.0)),
    "chance": _by_size("chance"),
    "inspections": by_value(
        "result",
        {
            "found": ("found infested", Symbol("marker", RED, 2.6, "diamond")),
            "clean": ("looked clean", Symbol("marker", BLUE, 1.6)),
            "skipped": ("could not inspect", Symbol("marker", GREY, 2.0, "cross2")),
            # added there, and not taken in yet
            "gone": ("plant is gone", Symbol("marker", GREY, 2.0, "cross2")),
        },
    ),
    "observations": by_value(
        "present",
        {
            "1": ("pest recorded", Symbol("marker", RED, 2.2, "triangle")),
            "0": ("looked, nothing seen", Symbol("marker", BLUE, 1.8, "triangle")),
            "-1": ("undecided", Symbol("marker", GREY, 1.8, "triangle")),
        },
    ),
    "routes": single(Symbol("line", "0,0,0,255", 0.7)),
    "stops": single(Symbol("marker", YELLOW, 1.4))
    .replace(
        ' styleCategories="Symbology">', ' styleCategories="Symbology|Labeling" labelsEnabled="1">'
    )
    .replace("</qgis>", labelled('"stop"') + "</qgis>"),
    "hot_spots": single(Symbol("fill", RED, 0.8)),
    "treatments": single(Symbol("fill", BLUE, 0.6)),
}


def routes_of(team: Iterable[str]) -> str:
    """Return how the routes of a team are drawn: each of its own colour."""
    each = zip(team, cycle(_EACH), strict=False)
    return by_value("who", {who: (who, Symbol("line", color, 0.7)) for who, color in each})


# QGIS shows it over a photo's place, where map tips are on
_PHOTO_TIP = (
    '<mapTip>&lt;img width="480" src="data:[% content_type %];base64,'
    '[% to_base64(data) %]"&gt;&lt;br&gt;[% result %], [% date %], [% scout %]</mapTip>'
)
PHOTO_STYLES = {
    "photo_places": single(Symbol("marker", YELLOW, 3.0, "square")).replace(
        ' styleCategories="Symbology">', f' styleCategories="Symbology|MapTips">{_PHOTO_TIP}'
    ),
    "tellings": single(Symbol("marker", GREY, 1.2, "cross")),
}


ASKED_STYLES = {"photos_asked": single(Symbol("marker", YELLOW, 3.0, "star"))}


def add_photo_styles(db: sqlite3.Connection) -> None:
    """Add the styles of what phones bring."""
    add(db, PHOTO_STYLES)


def add_asked_styles(db: sqlite3.Connection) -> None:
    """Add the style of the photos that are asked for."""
    add(db, ASKED_STYLES)


def add_styles(db: sqlite3.Connection) -> None:
    """Add a default style for each layer."""
    db.execute(STYLES_TABLE)
    db.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier) "
        "VALUES ('layer_styles', 'attributes', 'layer_styles')"
    )
    add(db, STYLES)
