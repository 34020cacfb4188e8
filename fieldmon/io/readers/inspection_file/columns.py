"""Which column of a file of inspections holds what."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.ranges import DETECTS
from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, ObservationError, SettingError
from fieldmon.infestation.records import ABSENT, UNKNOWN
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.parse.columns import find, is_confidence, is_id, is_of_rows, plain, recognised
from fieldmon.io.parse.result_words import tells_infestation
from fieldmon.io.parse.values import is_missing, presence, told_number
from fieldmon.io.writers.csv import said_cell
from fieldmon.plot.plant_columns import PLANT_WORDS
from fieldmon.plot.plant_names import faces_called

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.readers.inspection_options import InspectionOptions

# The columns of inspections that no pest record has; spellings as in `columns`
_NAMES = {
    "number": " ".join(PLANT_WORDS["number"]),
    # a running number where there is a better one
    "ordinal": "no nr num nummer numero numéro número מספר",
    "time": "time hour when timestamp datetime inspected inspectedat visited visitedat zeit "
    "uhrzeit zeitpunkt hora heure ora שעה זמן وقت الوقت الساعة",
    "who": "who scout inspector observer recordedby surveyor user username operator by wer "
    "prüfer kontrolleur quién quien inspecteur בודק פקח שםהבודק מי",
    "notes": "notes note remark remarks comment comments bemerkung bemerkungen notiz kommentar "
    "notas observaciones remarques commentaire cmt הערה הערות",
    "detects": "detects",
    "face": "face side seite cara lado צד",
    "id": "plantid idplant",
    "leaf": "leaf leafno leafnr leafnumber leafid blatt blattnr blattnummer hoja numerohoja "
    "feuille numérofeuille foglia folha עלה מספרעלה ورقة",
}
_PLAIN = {role: tuple(plain(name) for name in names.split()) for role, names in _NAMES.items()}
#: what a waypoint given out says of its plan, in front of what its scout noted: see `writers.gpx`
PLANNED = re.compile(
    r"^plant \d+; (?:arrive (?P<arrive>[^;]*)|after [^;]* s); stay [^;]* s; "
    r"chance [\d.]+ ?%(?:; detects (?P<detects>[\d.]+(?<!\.)))?[\s.,;]*"
)
# so many cells tell whether a column numbers its records
_LOOKED_AT = 200
_BLANK = frozenset({"", "nan", "nat", "none", "null", "<na>"})


class InspectionColumns(NamedTuple):
    """Which column holds what; None where none does."""

    result: str | None
    number_found: str | None
    marks: str | None
    plant: str | None
    line: str | None
    number: str | None
    face: str | None
    arrive: str | None
    block: str | None = None
    leaf: str | None = None
    species: str | None = None


def own_column(role: str, layer: Layer, taken: Iterable[str | None] = ()) -> str | None:
    """Return the column of one of the roles that only inspections have."""
    known = {plain(name): name for name in reversed(list(layer.columns)) if name not in taken}
    return next((known[name] for name in _PLAIN[role] if name in known), None)


def faces_named(layer: Layer) -> tuple[str, NDArray[np.int8]] | None:
    """Return the column of a layer that names faces, and which each is ``(n,)``; None: none does.

    Blank is the first. A column of other words may be of anything.
    """
    if (name := own_column("face", layer)) is None:
        return None
    cells = [text(v) for v in layer.column(name)]
    face, blank = faces_called(cells), np.array([is_missing(cell) for cell in cells], np.bool_)
    if not face.any() or ((face == 0) & ~blank).any():
        return None
    return name, np.where(blank, np.int8(1), face)


def is_own(role: str, name: str) -> bool:
    """Return whether a column plays by its name one of the roles that only inspections have."""
    return plain(name) in _PLAIN[role]


def columns_of(layer: Layer, options: InspectionOptions) -> InspectionColumns:
    """Return the columns that matter; raise `ChoiceNeeded` where nothing says what was found."""
    names = list(layer.columns)
    line = _line(layer, options)
    number = own_column("number", layer, {line})
    plant = options.column("plant") or own_column("id", layer)
    plant = plant or find("plant", names, frozenset({line} if line else ()))
    number = number or (own_column("ordinal", layer) if plant is None else None)
    count = options.column("count") or find("count", names, frozenset({plant or "", number or ""}))
    result = options.column("present") or _result_name(layer, count)
    if result is None and count is None:
        result = by_its_words(layer, options)
    marks = None
    if result is None and count is None:
        marks = names_in(layer)
        if marks is None:
            raise _what_was_found(layer)
    _must_be_apart(
        {
            worded("row"): line,
            worded("plant"): plant,
            worded("result"): result,
            worded("count"): count,
        }
    )
    if plant is not None and line is not None and number is None:
        _must_count_in_rows(plant, options)
        plant, number = None, plant
    arrive = _arrival(names)
    block = options.column("block") or find("block", names, frozenset({line or "", plant or ""}))
    used = (result, count, marks, plant, line, number, block)
    species = options.column("species")  # empty: none says it
    if species is None:
        species = find("species", names, frozenset(n for n in used if n))
    face, leaf = own_column("face", layer), own_column("leaf", layer, used)
    return InspectionColumns(
        result, count, marks, plant, line, number, face, arrive, block, leaf, species or None
    )


def _what_was_found(layer: Layer) -> ChoiceNeeded:
    """Return the question which column says what was found, where none was recognised."""
    return ChoiceNeeded(
        worded(
            "{name} must have a column that says what was found "
            "(found, result, count), but none was recognised among: "
            "{value}. Name it.",
            name=layer.name,
            value=", ".join(layer.columns) or "none",
        ),
        "columns",
        tuple(f"{role}={n}" for role in ("present", "count") for n in _open(layer)),
    )


def _arrival(names: list[str]) -> str | None:
    """Return the column of the planned arrival."""
    arrive = next((n for n in names if plain(n) == "arrive"), None)
    if arrive is None and any(plain(n) == plain("arrive_s") for n in names):
        # a KML given out, in which the planned arrival is the time of a place
        arrive = next((n for n in names if plain(n) == "timestamp"), None)
    return arrive


def _line(layer: Layer, options: InspectionOptions) -> str | None:
    """Return the column of rows; ask where an unknown one seems to be of rows, as none else is."""
    if (told := options.column("row")) is not None:
        return told or None  # empty: none is of rows
    named = find("row", layer.columns)
    known = recognised(layer.columns) | options.named_columns
    alike = [name for name in layer.columns if name not in known and is_of_rows(name)]
    alike = [name for name in alike if any(texts_in(layer, name))]
    by_number = options.column("plant") or find("plant", layer.columns)
    by_number = by_number or own_column("id", layer) or own_column("number", layer)
    placed = any(find(role, layer.columns) for role in ("position", "lon", "x"))
    placed |= layer.geometry is not None
    if named is not None or not alike or by_number is None or placed:
        return named
    raise ChoiceNeeded(
        worded(
            "A plant must be known by its row and its number in it, but whether {names} "
            "{n:says|say} the row is not clear. Name the column of rows, or none (columns=row=) "
            "where plants are numbered through the whole plot.",
            names=", ".join(map(repr, alike)),
            n=len(alike),
        ),
        "columns",
        (*(f"row={name}" for name in alike), "row="),
    )


def by_its_words(layer: Layer, options: InspectionOptions) -> str | None:
    """Return the one column of unknown name whose words say what is infested; None: no such.

    Yes and no, marks and figures alone may be of anything.
    """
    known = recognised(layer.columns) | options.named_columns
    alike = [
        name
        for name in layer.columns
        if name not in known
        and not any(is_own(role, name) for role in _PLAIN)
        and tells_infestation(texts_in(layer, name).tolist())
        and UNKNOWN not in _meanings(layer, name)
    ]
    return alike[0] if len(alike) == 1 else None


def _meanings(layer: Layer, name: str) -> set[int]:
    """Return what the filled cells of a column say of an infestation."""
    cells = {text(v) for v in layer.columns[name]}
    return {presence(cell) for cell in cells if not is_missing(cell)}


def _must_count_in_rows(plant: str, options: InspectionOptions) -> None:
    """Ask whether numbers of plants beside rows are those in the row, where their name is an id."""
    if plain(plant) not in _PLAIN["id"] or options.column("plant") is not None:
        return
    raise ChoiceNeeded(
        worded(
            "A plant must be known by one number, but {name!r} beside a row may be its number in "
            "the row or on the whole plot. Name it as the plant's for the first, or no column of "
            "rows (columns=row=) for the second.",
            name=plant,
        ),
        "columns",
        (f"plant={plant}", "row="),
    )


def _must_be_apart(roles: dict[str, str | None]) -> None:
    """Raise `SettingError` if two of row, plant, result and count are one column."""
    called = [(role, name) for role, name in roles.items() if name is not None]
    for k, (role, name) in enumerate(called):
        for other, same in called[:k]:
            if same == name:
                raise SettingError(_one_column(other, role, name))


def _one_column(one: str, other: str, name: str) -> str:
    return worded(
        "What is the {one} and what is the {other} must be in two columns, but both are said to "
        "be {name!r}. Name another column for one of them.",
        one=one, other=other, name=name,
    )  # fmt: skip


def plot_column(layer: Layer, columns: InspectionColumns, options: InspectionOptions) -> str | None:
    """Return the column that names plots; None: none does, as one may say of any."""
    told = options.column("plot")
    if told is not None:
        return told or None
    others = {*columns, *options.named_columns} - {None, columns.block}
    named = find("plot", layer.columns, frozenset(name for name in others if name))
    return None if options.column("block") and named == columns.block else named


def names_in(layer: Layer) -> str | None:
    """Return the column of the names of waypoints, which may say what was found; None: no such."""
    return next((n for n in layer.columns if plain(n) in {"name", "title", "label"}), None)


def _open(layer: Layer) -> list[str]:
    """Return the columns that could hold results: none of known use, no running number.

    Those whose cells look like results come first.
    """
    known = recognised(layer.columns)
    open_yet = [
        name
        for name in layer.columns
        if name not in known
        and not is_confidence(name)
        and not is_id(name, [text(v) for v in layer.columns[name][:_LOOKED_AT]])
    ] or list(layer.columns)
    told = {name: tells_infestation([name, *texts_in(layer, name).tolist()]) for name in open_yet}
    return sorted(open_yet, key=lambda name: (not told[name], not _looks_like_results(layer, name)))


def _looks_like_results(layer: Layer, name: str) -> bool:
    """Return whether every cell says found or clean, and one says clean: no plant's number does."""
    said = _meanings(layer, name)
    return ABSENT in said and UNKNOWN not in said


def _result_name(layer: Layer, count: str | None) -> str | None:
    for wanted in ("result", "found"):
        known = next((n for n in layer.columns if plain(n) == wanted), None)
        if known is not None:
            return known
    return find("present", layer.columns, frozenset({count} if count else ()))


def texts_in(layer: Layer, name: str | None) -> NDArray[np.str_]:
    """Return a column as text ``(n,)``, empty where it holds nothing or there is no column."""
    if name is None:
        return np.full(len(layer), "", dtype=np.str_)
    cells = [text(v) for v in layer.column(name)]
    return np.array(["" if c.casefold() in _BLANK else c for c in cells], dtype=np.str_)


def notes_in(layer: Layer) -> NDArray[np.str_]:
    """Return what was noted of each ``(n,)``, without the plan that a waypoint given out says."""
    noted = _written_in(layer, own_column("notes", layer))
    return np.array([PLANNED.sub("", note) for note in noted.tolist()], dtype=np.str_)


def _written_in(layer: Layer, name: str | None) -> NDArray[np.str_]:
    """Return a column as `texts_in` does, as it was written before it came to a table."""
    return np.array([said_cell(cell) for cell in texts_in(layer, name).tolist()], np.str_)


def detects_in(layer: Layer, columns: InspectionColumns, file: str) -> NDArray[np.float64]:
    """Return what inspections find of what is there ``(n,)``; NaN where nothing is said.

    Raise `ObservationError` where what is said is no such chance: in which file and record.
    """
    name = own_column("detects", layer, columns)
    cells = texts_in(layer, name).tolist()
    if name is None:
        plans = [PLANNED.match(one) for one in texts_in(layer, own_column("notes", layer)).tolist()]
        cells = [(plan and plan["detects"]) or "" for plan in plans]
    known = {cell: _number(cell) for cell in set(cells)}
    for record, cell in enumerate(cells, 1):
        if cell and (rule := DETECTS.broken(known[cell])):
            raise ObservationError(
                worded(
                    "The chance to see an infested plant (detects) must be {rule}, but record "
                    "{record} of {name} says {cell!r}. Write 0.3 for 30 %, or leave it empty: "
                    "then the season's own counts.",
                    rule=rule, record=record, name=file, cell=cell,
                )
            )  # fmt: skip
    return np.array([known[cell] for cell in cells], np.float64)


def _number(cell: str) -> float:
    try:
        return told_number(cell, "detects", DETECTS.most) if cell else np.nan
    except SettingError:
        return np.nan


def arrivals_in(layer: Layer, columns: InspectionColumns) -> NDArray[np.str_]:
    """Return when each was planned to be reached ``(n,)``, as files given out say it."""
    if columns.arrive is not None:
        return texts_in(layer, columns.arrive)
    plans = [PLANNED.match(note) for note in texts_in(layer, own_column("notes", layer)).tolist()]
    return np.array([(plan and plan["arrive"]) or "" for plan in plans], dtype=np.str_)


def who_in(
    layer: Layer, columns: InspectionColumns, options: InspectionOptions
) -> NDArray[np.str_]:
    """Return who inspected ``(n,)``, as the file says or as told; empty where nobody is."""
    taken = {columns.marks, columns.result}
    who = _written_in(layer, own_column("who", layer, taken))
    return np.where(who == "", options.who or "", who)
