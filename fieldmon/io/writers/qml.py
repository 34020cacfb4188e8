"""How QGIS shows a layer of a GeoPackage: symbols, labels and forms in its own XML (QML)."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable

#: of the GeoPackages that we write, as the season's: QGIS 3.22 warns of later ones
GPKG_VERSION = "1.3"
STYLES_TABLE = """
CREATE TABLE IF NOT EXISTS layer_styles (
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


def qml(renderer: str, categories: str = "Symbology") -> str:
    """Return a style as QGIS writes it; `categories` says what is in it."""
    return (
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
        f'<qgis version="3.22" styleCategories="{categories}">{renderer}</qgis>'
    )


def single(symbol: Symbol) -> str:
    """Return a style with one symbol for all."""
    return qml(
        '<renderer-v2 type="singleSymbol" enableorderby="0" forceraster="0" symbollevels="0">'
        f"<symbols>{symbol.qml('0')}</symbols></renderer-v2>"
    )


def by_value(column: str, symbols: dict[str, tuple[str, Symbol]]) -> str:
    """Return a legend with an entry a value: value -> (label, symbol)."""
    categories = "".join(
        f'<category render="true" symbol="{i}" value="{escape(value)}" label="{escape(label)}"/>'
        for i, (value, (label, _)) in enumerate(symbols.items())
    )
    drawn = "".join(symbol.qml(str(i)) for i, (_, symbol) in enumerate(symbols.values()))
    return qml(
        f'<renderer-v2 type="categorizedSymbol" attr="{column}" enableorderby="0" '
        f'forceraster="0" symbollevels="0"><categories>{categories}</categories>'
        f"<symbols>{drawn}</symbols></renderer-v2>"
    )


def labelled(expression: str) -> str:
    """Return what writes an expression beside each feature, black on white."""
    return (
        '<labeling type="simple"><settings calloutType="simple"><text-style '
        f'fieldName="{escape(expression)}" isExpression="1" fontSize="9" fontFamily="Sans" '
        f'fontSizeUnit="Point" textColor="{BLACK}" textOpacity="1">'
        '<text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" '
        'bufferColor="255,255,255,255" bufferOpacity="1"/></text-style>'
        '<placement placement="6" dist="1" distUnits="MM"/>'
        '<rendering drawLabels="1" obstacle="1" scaleVisibility="1" scaleMin="2500" scaleMax="0"/>'
        "</settings></labeling>"
    )


def field(name: str, widget: str, inside: str = "") -> str:
    """Return how a column is filled in: by which widget, and its options."""
    return (
        f'<field name="{name}" configurationFlags="None"><editWidget type="{widget}"><config>'
        f'<Option type="Map">{inside}</Option></config></editWidget></field>'
    )


def option(name: str, value: str, kind: str = "QString") -> str:
    """Return an option of a widget."""
    return f'<Option type="{kind}" name="{escape(name)}" value="{escape(value)}"/>'


def choice_list(name: str, choices: Iterable[tuple[str, str]]) -> str:
    """Return a column that is chosen from a list of (what is read, what is written)."""
    each = "".join(f'<Option type="Map">{option(a, b)}</Option>' for a, b in choices)
    return field(name, "ValueMap", f'<Option type="List" name="map">{each}</Option>')


def numbered(name: str) -> str:
    """Return a column for a count, which may stay empty."""
    options = (
        *(option("AllowNull", "true", "bool"), option("Min", "0", "int")),
        *(option("Max", "999", "int"), option("Step", "1", "int"), option("Style", "SpinBox")),
    )
    return field(name, "Range", "".join(options))


def add(db: sqlite3.Connection, styles: dict[str, str], column: str = "geom") -> None:
    """Add a default style for each layer to the open GeoPackage."""
    for layer, style in styles.items():
        db.execute(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name, "
            "f_geometry_column, styleName, styleQML, styleSLD, useAsDefault, description, owner) "
            "VALUES ('', '', ?, ?, 'fieldmon', ?, '', 1, 'made by fieldmon', '')",
            (layer, column, style),
        )
