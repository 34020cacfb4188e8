"""Which columns of plants say what they, their rows and their blocks are called."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

# English, Spanish, French, German, Italian, Portuguese, Hebrew, Arabic, Dutch
_NAMES = {
    "block": "block blockname blockno blocknr blockid bloc blok bloque blocco bloco cuartel "
    "בלוק بلوك",
    "row": "row rowno rownumber rownr rowid reihe zeile fila hilera rang rangée rangee fileira "
    "filare linha שורה מספרשורה vinerow line rij صف الصف خط الخط",
    "plant": "plant plantno plantnumber plantid tree treeno treeid treenumber vine vineno vineid "
    "pflanze rebe baum planta arbol árbol cepa plante arbre cep pied souche pianta albero עץ שתיל "
    "צמח מספרעץ מספרצמח "
    "نبتة النبتة نبات النبات شجرة الشجرة نخلة النخلة "
    "col column quadrat position_in_row positioninrow",
    "name": "name plotname fieldname parcelname plot field parcel block title label nombre nom "
    "nome bezeichnung schlagname flurname lage naam parcela lote parcelle schlag שם שםחלקה שםשטח "
    "שםהחלקה חלקה uniqueid idparcel parcelid fieldid plotid",
    # in its row
    "number": "number numberinrow plantinrow placeinrow nummerinreihe numeroenfila מספרבשורה",
}
# what may stand behind the word for a row or a plant: ROW_NUM, Plant index
_NUMBERING = re.compile(r"(?<=\w)(?:number|num|nr|no|nbr|index|idx|id)$")
_CUT = 10


def plain(name: str) -> str:
    """Return a column name without capitals, accents, units in brackets and punctuation."""
    bare = re.sub(r"[(\[].*?[)\]]", "", name)
    letters = unicodedata.normalize("NFKD", (bare or name).casefold())
    return "".join(c for c in letters if c.isalnum())


#: what people call columns, by what these hold
PLANT_WORDS = {role: tuple(names.split()) for role, names in _NAMES.items()}
_PLAIN = {role: tuple(map(plain, names)) for role, names in PLANT_WORDS.items()}
_OF_TABLES = frozenset({"line", "linha", "ligne", "rang", "file", "zeile"})
#: the words of a role that a number makes no other thing: a line no. is of a table
NUMBERED_COLUMNS = {
    role: tuple(name for name in _PLAIN[role] if name not in _OF_TABLES)
    for role in ("row", "plant")
}


def without_numbering(name: str) -> str:
    """Return a `plain` name without what says that it numbers: rownum is row."""
    return _NUMBERING.sub("", name)


def column_called(
    words: Iterable[str],
    names: Iterable[str],
    taken: frozenset[str] = frozenset(),
    numbered: Iterable[str] = (),
) -> str | None:
    """Return the first of the names of columns that is one of the words, or None.

    Earlier `words` go before; those of `numbered` may number, as row no.
    """
    words = tuple(words)
    known = {plain(name): name for name in reversed(list(names)) if name not in taken}
    exact = next((known[name] for name in words if name in known), None)
    if exact is not None:
        return exact
    bare = {without_numbering(name): own for name, own in known.items()}
    if counting := next((bare[name] for name in numbered if name in bare), None):
        return counting
    # a shapefile cuts names to ten characters: decimalLon, individual, coordinate
    cut = {name for name, own in known.items() if len(own) == _CUT}
    return next((known[name[:_CUT]] for name in words if name[:_CUT] in cut), None)


class PlantColumns(NamedTuple):
    """The columns by which plants are called.

    Parameters
    ----------
    block, row, plant
        Their names; None: there is none.
    doubts
        What to say of a column of numbers that was not taken.
    """

    block: str | None
    row: str | None
    plant: str | None
    doubts: tuple[str, ...] = ()

    @property
    def said(self) -> dict[str, str]:
        """Return the name of each column that there is, by its role."""
        roles = {"block": self.block, "row": self.row, "plant": self.plant}
        return {role: name for role, name in roles.items() if name is not None}


def plant_columns(
    names: list[str], cells: Callable[[str], list[str]], told: Mapping[str, str] | None = None
) -> PlantColumns:
    """Return by which columns plants, their rows and their blocks are called.

    Of plants it is the number in the row where there is one, and what numbers them over the whole
    plot has numbers only. A column that tells no plant from another is none of them.

    Parameters
    ----------
    names
        All columns.
    cells
        What a column says of each plant, empty where nothing.
    told
        Columns by their role that somebody said.

    Examples
    --------
    >>> table = {"Reihe": ["1", "1", "2", "2"], "Pflanze": ["7", "8", "7", "8"]}
    >>> plant_columns(list(table), table.__getitem__).said
    {'row': 'Reihe', 'plant': 'Pflanze'}
    """
    told = told or {}

    def found(role: str, taken: Iterable[str | None]) -> str | None:
        not_these = frozenset(name for name in taken if name is not None)
        return column_called(_PLAIN[role], names, not_these, NUMBERED_COLUMNS.get(role, ()))

    block = told.get("block") or found("block", ())
    row = told.get("row") or found("row", {block})
    if told.get("plant"):
        return PlantColumns(block, row, told["plant"])
    doubts = []
    plant = found("plant", {block, row})
    number = found("number", {row})
    if number is not None and (plant is None or _are_numbers(cells(plant))):
        if _tells_apart(None if row is None else cells(row), cells(number), beside=plant):
            plant = number
        elif row is not None and any(cells(number)):
            doubts.append(_tells_nothing(number))
    plant = plant or found("name", {block, row})
    if plant is not None and len(said := cells(plant)) > 1 and len({*said}) == 1:
        if said[0].isdecimal() and not doubts:
            doubts.append(_tells_nothing(plant))
        plant = None
    return PlantColumns(block, row, plant, tuple(doubts))


def _tells_apart(row: list[str] | None, number: list[str], beside: str | None) -> bool:
    """Return whether numbers may be those of plants in their rows.

    Where no rows are told and another column is `beside` them, they must all differ.
    """
    if row is None:
        return beside is None or len({*number}) == len(number)
    # both faces of a plant may be there
    return 2 * len({*zip(row, number, strict=True)}) >= len(number)


def _tells_nothing(column: str) -> str:
    return worded(
        "Column {column!r} was not taken for the numbers of plants, as it does not tell those of a "
        "row apart. Give each plant of a row a number of its own.",
        column=column,
    )


def _are_numbers(cells: list[str]) -> bool:
    """Return whether cells hold plain numbers or nothing."""
    try:
        _ = [float(cell) for cell in cells if cell]
    except ValueError:
        return False
    return True
