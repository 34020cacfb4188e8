"""How QGIS shows a season without a click: its `layer_styles` table."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sqlite3

_TABLE = """
CREATE TABLE layer_styles (
  id INTEGER PRIMARY KEY AUTOINCREMENT, f_table_catalog TEXT(256), f_table_schema TEXT(256),
  f_table_name TEXT(256), f_geometry_column TEXT(256), styleName TEXT(30), styleQML TEXT,
  styleSLD TEXT, useAsDefault BOOLEAN, description TEXT, owner TEXT(30), ui TEXT(30),
  update_time DATETIME DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')))
"""

# colours that colour-blind people tell apart too (Okabe & Ito 2008), as in the app
RED, BLUE, GREY, YELLOW, BLACK = (
    "213,94,0,255",
    "0,114,178,255",
    "153,153,153,255",
    "240,228,66,255",
    "0,0,0,255",
)
_RAMP = (
    (0.01, "189,201,170,255"),
    (0.05, "254,217,118,255"),
    (0.15, "254,153,41,255"),
    (0.4, "217,95,14,255"),
    (1.0, "153,52,4,255"),
)


@dataclass(frozen=True)
class Symbol:
    """A marker, line or fill.

    Parameters
    ----------
    kind
        ``"marker"``, ``"line"`` or ``"fill"``.
    color
        ``"red,green,blue,alpha"``.
    size
        Diameter or width, millimetres on the screen.
    shape
        Of a marker: ``"circle"``, ``"diamond"``...
    """

    kind: str
    color: str
    size: float = 1.6
    shape: str = "circle"

    def qml(self, name: str) -> str:
        """Return the symbol as QGIS writes it."""
        layer, options = {
            "marker": (
                "SimpleMarker",
                {
                    "color": self.color,
                    "name": self.shape,
                    "size": str(self.size),
                    "outline_style": "no" if self.shape == "circle" else "solid",
                    "outline_color": BLACK,
                },
            ),
            "line": ("SimpleLine", {"line_color": self.color, "line_width": str(self.size)}),
            "fill": (
                "SimpleFill",
                {
                    "style": "no",
                    "outline_color": self.color,
                    "outline_width": str(self.size),
                },
            ),
        }[self.kind]
        inside = "".join(
            f'<Option type="QString" name="{key}" value="{escape(value)}"/>'
            for key, value in options.items()
        )
        old = "".join(f'<prop k="{key}" v="{escape(value)}"/>' for key, value in options.items())
        return (
            f'<symbol type="{self.kind}" name="{name}" alpha="1" clip_to_extent="1">'
            f'<layer class="{layer}" enabled="1" locked="0" pass="0">'
            f'<Option type="Map">{inside}</Option>{old}</layer></symbol>'
        )


def _qml(renderer: str) -> str:
    return (
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
        f'<qgis version="3.22" styleCategories="Symbology">{renderer}</qgis>'
    )


def _single(symbol: Symbol) -> str:
    return _qml(
        '<renderer-v2 type="singleSymbol" enableorderby="0" forceraster="0" symbollevels="0">'
        f"<symbols>{symbol.qml('0')}</symbols></renderer-v2>"
    )


def _by_value(column: str, symbols: dict[str, tuple[str, Symbol]]) -> str:
    """Return a legend with an entry a value: value -> (label, symbol)."""
    categories = "".join(
        f'<category render="true" symbol="{i}" value="{escape(value)}" label="{escape(label)}"/>'
        for i, (value, (label, _)) in enumerate(symbols.items())
    )
    drawn = "".join(symbol.qml(str(i)) for i, (_, symbol) in enumerate(symbols.values()))
    return _qml(
        f'<renderer-v2 type="categorizedSymbol" attr="{column}" enableorderby="0" '
        f'forceraster="0" symbollevels="0"><categories>{categories}</categories>'
        f"<symbols>{drawn}</symbols></renderer-v2>"
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
    return _qml(
        f'<renderer-v2 type="graduatedSymbol" attr="{column}" graduatedMethod="GraduatedColor" '
        f'enableorderby="0" forceraster="0" symbollevels="0"><ranges>{ranges}</ranges>'
        f"<symbols>{drawn}</symbols></renderer-v2>"
    )


STYLES = {
    "plots": _single(Symbol("fill", BLACK, 0.5)),
    "rows": _single(Symbol("line", "120,150,90,255", 0.3)),
    "plants": _single(Symbol("marker", "120,150,90,255", 1.0)),
    "chance": _by_size("chance"),
    "inspections": _by_value(
        "result",
        {
            "found": ("found infested", Symbol("marker", RED, 2.6, "diamond")),
            "clean": ("looked clean", Symbol("marker", BLUE, 1.6)),
            "skipped": ("could not be inspected", Symbol("marker", GREY, 2.0, "cross2")),
        },
    ),
    "observations": _by_value(
        "present",
        {
            "1": ("pest recorded", Symbol("marker", RED, 2.2, "triangle")),
            "0": ("looked, nothing seen", Symbol("marker", BLUE, 1.8, "triangle")),
            "-1": ("undecided", Symbol("marker", GREY, 1.8, "triangle")),
        },
    ),
    "routes": _single(Symbol("line", "0,0,0,255", 0.7)),
    "stops": _single(Symbol("marker", YELLOW, 1.4)),
    "hot_spots": _single(Symbol("fill", RED, 0.8)),
    "treatments": _single(Symbol("fill", BLUE, 0.6)),
}


# QGIS shows it over a photo's place, where map tips are on
_PHOTO_TIP = (
    '<mapTip>&lt;img width="480" src="data:[% content_type %];base64,'
    '[% to_base64(data) %]"&gt;&lt;br&gt;[% result %], [% date %], [% scout %]</mapTip>'
)
PHOTO_STYLES = {
    "photo_places": _single(Symbol("marker", YELLOW, 3.0, "square")).replace(
        ' styleCategories="Symbology">', f' styleCategories="Symbology|MapTips">{_PHOTO_TIP}'
    ),
    "tellings": _single(Symbol("marker", GREY, 1.2, "cross")),
}


ASKED_STYLES = {"photos_asked": _single(Symbol("marker", YELLOW, 3.0, "star"))}


def add_photo_styles(db: sqlite3.Connection) -> None:
    """Add the styles of what phones bring."""
    _add(db, PHOTO_STYLES)


def add_asked_styles(db: sqlite3.Connection) -> None:
    """Add the style of the photos that are asked for."""
    _add(db, ASKED_STYLES)


def add_styles(db: sqlite3.Connection) -> None:
    """Add a default style for each layer."""
    db.execute(_TABLE)
    db.execute(
        "INSERT INTO gpkg_contents (table_name, data_type, identifier) "
        "VALUES ('layer_styles', 'attributes', 'layer_styles')"
    )
    _add(db, STYLES)


def _add(db: sqlite3.Connection, styles: dict[str, str]) -> None:
    for layer, qml in styles.items():
        db.execute(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name, "
            "f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description, owner) "
            "VALUES ('', '', ?, 'geom', 'fieldmon', ?, '', 1, 'made by fieldmon', '')",
            (layer, qml),
        )
