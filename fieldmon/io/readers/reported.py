"""What came back from the field, as a file says it: which plants, what was seen, when, by whom.

This half runs in the reading process and knows no plot; `findings_in` looks the plants up.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta, timezone, tzinfo
from typing import TYPE_CHECKING, NamedTuple, Self
from zoneinfo import ZoneInfo

import numpy as np
import shapely

from fieldmon.errors import ChoiceNeeded, FileProblem, SettingError
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.formats.open_layer import layers_of, open_layer
from fieldmon.io.import_report import Imported, ImportMessage, Remedy, doubtful, guessed, seen
from fieldmon.io.options import RecordOptions
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.values import counted, dates, decimal_mark, is_missing, numbers, presence

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import LayerInfo
    from fieldmon.io.options import Source
    from fieldmon.io.sandbox.unpack import Workroom

# The columns of findings that no pest record has; spellings as in `columns`
_NAMES = {
    "number": "number numberinrow plantinrow placeinrow nummerinreihe numeroenfila מספרבשורה",
    # a running number where there is a better one
    "ordinal": "no nr num nummer numero numéro número מספר",
    "time": "time hour when timestamp datetime inspected inspectedat visited visitedat zeit "
    "uhrzeit zeitpunkt hora heure ora שעה זמן",
    "who": "who scout inspector observer recordedby surveyor user username operator by wer "
    "prüfer kontrolleur quién quien inspecteur בודק פקח שםהבודק מי",
    "notes": "notes note remark remarks comment comments bemerkung bemerkungen notiz kommentar "
    "notas observaciones remarques commentaire cmt הערה הערות",
    "face": "face side seite cara lado צד",
    "id": "plantid idplant",
}
_PLAIN = {role: tuple(plain(name) for name in names.split()) for role, names in _NAMES.items()}
# Layers of files given out and of a season's project: what to read where nobody chose
_LAYERS = ("inspections", "stops", "plants", "waypoints")

_CLEAN = frozenset(
    {"clear", "ok", "okay", "sauber", "befallsfrei", "limpio", "limpia", "sano", "sana", "propre"}
    | {"sain", "saine", "pulito", "pulita", "limpo", "limpa", "sadio", "nil found", "no pests"}
    | {
        "kein befall",
        "nicht gefunden",
        "no encontrado",
        "pas trouvé",
        "non trovato",
        "ללא",
        "נקייה",
    }
)
_FOUND = frozenset(
    {"gefunden", "befall", "encontrado", "encontrada", "trouvé", "trouvée", "infesté", "trovato"}
    | {"infestato", "infestado", "plaga", "pest", "pests", "mite", "mites", "נמצאה", "נגועה", "✔"}
)
_NOT_INSPECTED = frozenset(
    {"not inspected", "uninspected", "could not inspect", "cannot inspect", "not visited", "ni"}
    | {"n/i", "skip", "skipped", "missed", "not done", "no access", "nicht geprüft", "ausgelassen"}
    | {"nicht kontrolliert", "no inspeccionado", "no inspeccionada", "sin inspeccionar", "saltado"}
    | {"non inspecté", "non inspectée", "non ispezionato", "não inspecionado", "לא נבדק"}
    | {"לא נבדקה", "דולג"}
)
_WORDS = (
    dict.fromkeys(_CLEAN, ABSENT)
    | dict.fromkeys(_FOUND, PRESENT)
    | dict.fromkeys(_NOT_INSPECTED, UNKNOWN)
)
_MINUS = frozenset({"-", "\u2212", "\u2013"})
_PLUS = re.compile(r"^\+\s*(\d*)$")
_LABEL = re.compile(r"^[^\d\s]{0,8}\s*(\d{1,6})\s*[/\-.,:;\s]\s*[^\d\s]{0,8}\s*(\d{1,6})([abAB]?)$")
_OWN_NAME = re.compile(r"(?:^|\s)(?:\d+\s+)?R(\d{1,6})/(\d{1,6})([ab]?)(?=\s|$)")
_CLOCK = re.compile(
    r"(?:^|[T\s,])(\d{1,2}):(\d{2})(?::(\d{2})(?:[.,]\d+)?)?\s*([AaPp]\.?[Mm]\.?)?\s*"
    r"(Z|UTC|GMT|[-+]\d{2}(?::?\d{2})?)?$"
)
_SERIAL = re.compile(r"^\d{5}(\.\d+)?$")
_OFFSET = re.compile(r"^([-+])(\d{1,2}):?(\d{2})?$")
_ROW = "\0row"
_FARTHEST_ZONE = timedelta(hours=14)


@dataclass(frozen=True)
class FindingsOptions(RecordOptions):
    """What can be chosen when findings are read.

    Parameters
    ----------
    day
        The day of findings whose file names none, as numpy's ``datetime64[D]``.
    who
        Who inspected, where the file does not say.
    accuracy_m
        How far off positions may be where the file does not say; None: they are taken as exact.
    zone
        Time zone of the plot (``"Asia/Jerusalem"``, ``"+02:00"``), for times that a file states in
        UTC or another zone, as all GPX files do. None: such times keep their own clock.
    take_doubtful
        Take what would be listed and left out: the nearest plant, the plant's id before its row
        and number or position, a find before a contradicting "clean".
    """

    day: np.datetime64 | None = None
    who: str | None = None
    accuracy_m: float | None = None
    zone: str | None = None
    take_doubtful: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.accuracy_m is not None and not 0 <= self.accuracy_m <= 1000:
            raise SettingError(
                f"The accuracy of positions must be 0 to 1000 m, but it is {self.accuracy_m}."
            )
        if self.zone is not None:
            zone_of(self.zone)

    def choose(self, option: str, value: str) -> Self:
        """Return these options with one of them set from text."""
        if option == "day":
            read = dates(np.array([value], dtype=object), self.date_order).day[0]
            if np.isnat(read):
                raise SettingError(f"A day must be a date (2026-11-18), but it is {value!r}.")
            return replace(self, day=read)
        if option == "accuracy_m":
            try:
                return replace(self, accuracy_m=float(value))
            except ValueError:
                raise SettingError(
                    f"The accuracy must be a number of metres, but it is {value!r}."
                ) from None
        return super().choose(option, value)


@dataclass(frozen=True, eq=False)
class Reported:
    """Findings as a file tells them, one entry a finding, ``(m,)`` each.

    Parameters
    ----------
    plant
        Number of the plant in the grid, as files given out have it; -1 where it is not named.
    line, number, face
        Row and number in it as people count, and which face; 0 where not named.
    lonlat
        ``(m, 2)`` degrees; NaN without a position.
    accuracy_m
        Of the position; NaN where not stated.
    result
        int8 `PRESENT`, `ABSENT` or `UNKNOWN` (could not be inspected).
    count
        Pests counted; NaN where not counted.
    doubt
        Why a finding is doubtful in itself; empty where it is not.
    when
        datetime64[s], local; NaT without a clock time.
    day
        datetime64[D]; NaT where none is stated.
    who, notes
        Text; empty where there is none.
    source_row
        Which record of the file, from 1.
    """

    plant: NDArray[np.int64]
    line: NDArray[np.int64]
    number: NDArray[np.int64]
    face: NDArray[np.int8]
    lonlat: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    result: NDArray[np.int8]
    count: NDArray[np.float64]
    doubt: NDArray[np.str_]
    when: NDArray[np.datetime64]
    day: NDArray[np.datetime64]
    who: NDArray[np.str_]
    notes: NDArray[np.str_]
    source_row: NDArray[np.int64]

    def __len__(self) -> int:
        """Return the number of findings."""
        return len(self.result)


def zone_of(name: str) -> tzinfo:
    """Return a time zone by its name or its offset; raise `SettingError` where there is none."""
    offset = _OFFSET.match(name.strip())
    if offset:
        sign, hours, minutes = offset.groups()
        ahead = timedelta(hours=int(hours), minutes=int(minutes or 0))
        if ahead <= _FARTHEST_ZONE:
            return timezone(-ahead if sign == "-" else ahead)
    else:
        with suppress(KeyError, ValueError, OSError):
            return ZoneInfo(name.strip())
    raise SettingError(
        f"A time zone must be named as Asia/Jerusalem or +02:00, but it is {name!r}."
    )


def reported_of(source: Source, options: FindingsOptions, workroom: Workroom) -> Imported[Reported]:
    """Return what a file says of plants that were inspected.

    Where a file has several layers and nobody chose, the first of `_LAYERS` that reports anything
    is read: QField and QGIS edit a layer of plants, of stops or of inspections in place.
    """
    if options.member is not None or options.layer is not None:
        return reported_in(open_layer(source, options, workroom), options)
    known = _known_layers(layers_of(source, workroom))
    said_nothing: list[Imported[Reported]] = []
    for info in known:
        own = replace(options, member=info.member, layer=info.layer)
        try:
            read = reported_in(open_layer(source, own, workroom), own)
        except (ChoiceNeeded, FileProblem):
            continue  # this one has no columns for findings
        said = seen(f"Findings were read from layer {info.layer}.")
        if len(read.value):
            return Imported(read.value, (said, *read.messages))
        said_nothing.append(Imported(read.value, (said, *read.messages)))
    return (
        said_nothing[0]
        if said_nothing
        else reported_in(open_layer(source, options, workroom), options)
    )


def _known_layers(infos: tuple[LayerInfo, ...]) -> list[LayerInfo]:
    """Return the layers that files of ours have, likeliest first; none where there is no choice."""
    if len(infos) < 2:
        return []
    ours = [info for info in infos if info.layer.casefold() in _LAYERS]
    return sorted(ours, key=lambda info: _LAYERS.index(info.layer.casefold()))


class _Columns(NamedTuple):
    """Which column holds what; None where none does."""

    result: str | None
    number_found: str | None
    marks: str | None
    plant: str | None
    line: str | None
    number: str | None
    face: str | None
    arrive: str | None


class _Results(NamedTuple):
    """What was seen, ``(n,)`` each; `said` where anything at all was written down."""

    result: NDArray[np.int8]
    how_many: NDArray[np.float64]
    doubt: NDArray[np.str_]
    said: NDArray[np.bool_]
    findings: list[ImportMessage]


def reported_in(layer: Layer, options: FindingsOptions) -> Imported[Reported]:
    """Return what one layer or table says of plants that were inspected."""
    layer, findings = _without_lines(layer)
    layer = _without_undone(layer)
    columns = _columns_of(layer, options)
    results = _results(layer, columns, options)
    notes = _texts(layer, _own("notes", layer))
    said = results.said
    noted = int((~said & (notes != "")).sum()) if columns.marks is None else 0
    if noted:
        findings.append(doubtful(f"{noted} record(s) have a note, but no result: left unknown."))
    if not said.all():
        what = "carry no finding in their name" if columns.marks else "are not filled in"
        findings.append(seen(f"{int((~said).sum())} of {len(layer)} record(s) {what}: unknown."))
    lonlat, accuracy_m, more = _positions(layer, columns, options)
    plant, line, number, face = _named(layer, columns)
    times = _times(layer, columns, options)
    whole = Reported(
        plant=plant,
        line=line,
        number=number,
        face=face,
        lonlat=lonlat,
        accuracy_m=accuracy_m,
        result=results.result,
        count=results.how_many,
        doubt=results.doubt,
        when=times.when,
        day=times.day,
        who=_who(layer, columns, options),
        notes=notes,
        source_row=np.arange(1, len(layer) + 1),
    )
    kept = Reported(**{name: values[said] for name, values in vars(whole).items()})
    every = (*layer.messages, *findings, *results.findings, *more, *times.findings)
    return Imported(kept, every)


def _without_lines(layer: Layer) -> tuple[Layer, list[ImportMessage]]:
    """Return the layer without the driven line that files given out hold beside the stops."""
    if layer.geometry is None:
        return layer, []
    kinds = shapely.get_type_id(layer.geometry)
    lines = np.isin(kinds, (1, 2, 5))
    if not lines.any() or lines.all():
        return layer, []
    said = seen(f"{int(lines.sum())} line(s) beside the points were passed over.")
    return layer.take(np.flatnonzero(~lines)), [said]


def _without_undone(layer: Layer) -> Layer:
    """Return the layer without what a season's file keeps, but marks as taken back."""
    name = next((n for n in layer.columns if plain(n) == "undone"), None)
    if name is None:
        return layer
    return layer.take(np.flatnonzero([text(v) in {"", "0", "False"} for v in layer.column(name)]))


def _own(role: str, layer: Layer, taken: Iterable[str | None] = ()) -> str | None:
    """Return the column of one of the roles that only findings have."""
    known = {plain(name): name for name in reversed(list(layer.columns)) if name not in taken}
    return next((known[name] for name in _PLAIN[role] if name in known), None)


def _columns_of(layer: Layer, options: FindingsOptions) -> _Columns:
    """Return the columns that matter; raise `ChoiceNeeded` where nothing says what was found."""
    names = list(layer.columns)
    line = options.column("row") or find("row", names)
    number = _own("number", layer, {line})
    plant = options.column("plant") or _own("id", layer)
    plant = plant or find("plant", names, frozenset({line} if line else ()))
    number = number or (_own("ordinal", layer) if plant is None else None)
    count = options.column("count") or find("count", names, frozenset({plant or "", number or ""}))
    result = options.column("present") or _result_name(layer, count)
    marks = None
    if result is None and count is None:
        marks = next((n for n in names if plain(n) in {"name", "title", "label"}), None)
        if marks is None:
            raise ChoiceNeeded(
                f"{layer.name} must have a column that says what was found (found, result, count), "
                f"but none was recognised among: {', '.join(names) or 'none'}. Name it.",
                "columns",
                tuple(names),
            )
    if plant is not None and line is not None and number is None and plain(plant) not in _IDS:
        plant, number = None, plant
    arrive = next((n for n in names if plain(n) == "arrive"), None)
    return _Columns(result, count, marks, plant, line, number, _own("face", layer), arrive)


_IDS = frozenset(_PLAIN["id"])


def _result_name(layer: Layer, count: str | None) -> str | None:
    for wanted in ("result", "found"):
        known = next((n for n in layer.columns if plain(n) == wanted), None)
        if known is not None:
            return known
    return find("present", layer.columns, frozenset({count} if count else ()))


def _texts(layer: Layer, name: str | None) -> NDArray[np.str_]:
    if name is None:
        return np.full(len(layer), "", dtype=np.str_)
    cells = [text(v) for v in layer.column(name)]
    return np.array(["" if c.casefold() in _BLANK else c for c in cells], dtype=np.str_)


_BLANK = frozenset({"", "nan", "nat", "none", "null", "<na>"})


def _who(layer: Layer, columns: _Columns, options: FindingsOptions) -> NDArray[np.str_]:
    taken = {columns.marks, columns.result}
    who = _texts(layer, _own("who", layer, taken))
    return np.where(who == "", options.who or "", who)


# --- what was seen -----------------------------------------------------------------------------


class _Said(NamedTuple):
    """What one cell says."""

    result: int
    how_many: float
    is_said: bool
    is_read: bool = True


_SILENT = _Said(UNKNOWN, np.nan, is_said=False)


def _results(layer: Layer, columns: _Columns, options: FindingsOptions) -> _Results:
    if columns.marks is not None:
        said = [_of_mark(text(v)) for v in layer.column(columns.marks)]
        return _put_together(said, [_SILENT] * len(said), [])
    by_result, by_count = [_SILENT] * len(layer), [_SILENT] * len(layer)
    findings: list[ImportMessage] = []
    if columns.result is not None:
        cells = [text(v) for v in layer.column(columns.result)]
        signs = any(_PLUS.match(cell) for cell in cells)
        mark = options.decimal or decimal_mark(cells) or "."
        known = {cell: _of_word(cell, mark, signs=signs) for cell in set(cells)}
        by_result = [known[cell] for cell in cells]
        findings += [seen(f"Results are in column {columns.result!r}."), *_unread(cells, known)]
    if columns.number_found is not None:
        cells = [text(v) for v in layer.column(columns.number_found)]
        mark = options.decimal or decimal_mark(cells) or "."
        known = {cell: _of_count(cell, mark) for cell in set(cells)}
        by_count = [known[cell] for cell in cells]
        findings += [
            seen(f"Counts are in column {columns.number_found!r}."),
            *_unread(cells, known),
        ]
    return _put_together(by_result, by_count, findings)


def _put_together(
    by_result: list[_Said], by_count: list[_Said], findings: list[ImportMessage]
) -> _Results:
    """Return what result and count say together.

    Forms fill in zeros by themselves: in a file with results, a zero beside an empty result is
    doubtful, and one beside "not inspected" says nothing.
    """
    first = np.array([s.result for s in by_result], dtype=np.int8)
    second = np.array([s.result for s in by_count], dtype=np.int8)
    spoken = np.array([s.is_said for s in by_result], dtype=bool)
    counted_too = np.array([s.is_said for s in by_count], dtype=bool)
    against = spoken & (second != UNKNOWN) & (first != second)
    against &= (first != UNKNOWN) | (second == PRESENT)
    zero_alone = ~spoken & (second == ABSENT) & spoken.any()
    doubt = np.where(against, "its result and its count contradict each other", "")
    doubt = np.where(zero_alone, "its count is 0, but its result is empty", doubt)
    result = np.where(against, PRESENT, np.where(spoken, first, second)).astype(np.int8)
    own = np.array([s.how_many for s in by_result], dtype=np.float64)
    count = np.array([s.how_many for s in by_count], dtype=np.float64)
    how_many = np.where(np.isnan(count), own, count)
    return _Results(result, how_many, doubt.astype(np.str_), spoken | counted_too, findings)


def _unread(cells: list[str], known: dict[str, _Said]) -> list[ImportMessage]:
    odd = [cell for cell in cells if not known[cell].is_read]
    if not odd:
        return []
    shown = ", ".join(repr(cell) for cell in list(dict.fromkeys(odd))[:5])
    said = f"{len(odd)} record(s) say neither clean nor found ({shown}); left unknown."
    return [doubtful(said)]


def _of_word(cell: str, mark: str, *, signs: bool) -> _Said:
    """Return what a cell for a result says: a word in many languages, a sign, or a count.

    A lone minus is "clean" only in a column that has a plus somewhere, else it is nothing. A number
    above 1 is a find with that count; 1 is "yes", which counts nothing.
    """
    word = " ".join(cell.casefold().replace("_", " ").split())
    plus = _PLUS.match(word)
    if plus:
        return _Said(PRESENT, float(plus.group(1) or "nan"), is_said=True)
    if signs and word in _MINUS:
        return _Said(ABSENT, np.nan, is_said=True)
    if word in _WORDS:
        return _Said(_WORDS[word], np.nan, is_said=True)
    result = presence(word)
    if result == UNKNOWN:
        return _Said(UNKNOWN, np.nan, is_said=False, is_read=is_missing(word))
    read = counted(word, mark)
    how_many = read.number if read.number > 1 and not read.is_rough else np.nan
    return _Said(result, how_many, is_said=True)


def _of_count(cell: str, mark: str) -> _Said:
    """Return what a cell for a count says; ``<5`` is a find that was not counted."""
    if cell.strip().casefold() in _NOT_INSPECTED:
        return _Said(UNKNOWN, np.nan, is_said=True)
    read = counted(cell.removeprefix("+"), mark)
    if read.present == UNKNOWN:
        return _Said(UNKNOWN, np.nan, is_said=False, is_read=not read.is_rough)
    # "no" and "0" count nothing; a range or a bound is a find, not a number
    number = read.number if read.present == PRESENT and not read.is_rough else np.nan
    return _Said(read.present, 0.0 if read.present == ABSENT else number, is_said=True)


def _of_mark(name: str) -> _Said:
    """Return what a waypoint's name says: ``+3``, ``+``, ``-``, ``0``, ``clean``, ``R3/17 +2``.

    A number alone is none: handhelds number their waypoints 001, 002.
    """
    words = name.split()
    last = words[-1] if words else ""
    for sign in (name.strip(), last):
        plus = _PLUS.match(sign)
        if plus:
            return _Said(PRESENT, float(plus.group(1) or "nan"), is_said=True)
        if sign in _MINUS:
            return _Said(ABSENT, np.nan, is_said=True)
    if name.strip() == "0":
        return _Said(ABSENT, np.nan, is_said=True)
    bare = _OWN_NAME.sub(" ", name).strip()
    if not bare or re.fullmatch(r"[\d\s]+", bare):
        return _SILENT
    said = _of_word(bare, ".", signs=True)
    return said if said.is_said else _SILENT


# --- which plant -------------------------------------------------------------------------------


def _named(
    layer: Layer, columns: _Columns
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int8]]:
    """Return the plant's number in the grid, or row, number and face, by which a file names it."""
    n = len(layer)
    plant = np.full(n, -1, np.int64)
    line, number, face = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int8)
    if columns.line is not None and columns.number is not None:
        line, number = (_whole(layer, name, 0) for name in (columns.line, columns.number))
        line[number <= 0] = number[line <= 0] = 0
    if columns.face is not None:
        words = [text(v).casefold() for v in layer.column(columns.face)]
        face[:] = [_FACES.get(word, 0) for word in words]
    if columns.plant is not None:
        plant = _whole(layer, columns.plant, -1)
    labels = columns.plant if columns.marks is None else columns.marks
    if labels is not None:
        pattern = _LABEL if columns.marks is None else _OWN_NAME
        for i, value in enumerate(layer.column(labels)):
            found = pattern.search(text(value))
            if found and plant[i] < 0:
                line[i], number[i] = int(found.group(1)), int(found.group(2))
                face[i] = _FACES.get(found.group(3).casefold(), 0)
    return plant, line, number, face


_FACES = {"1": 1, "a": 1, "2": 2, "b": 2}


def _whole(layer: Layer, name: str, otherwise: int) -> NDArray[np.int64]:
    values = numbers(layer.column(name))
    good = np.isfinite(values) & (values == np.round(values)) & (np.abs(values) < 2**31)
    return np.where(good, np.where(good, values, 0), otherwise).astype(np.int64)


def _positions(
    layer: Layer, columns: _Columns, options: FindingsOptions
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[ImportMessage, ...]]:
    """Return positions ``(n, 2)`` and their accuracy ``(n,)``, NaN where there is none."""
    lonlat, accuracy_m = np.full((len(layer), 2), np.nan), np.full(len(layer), np.nan)
    roles = {role for role in ("lon", "lat", "x", "y", "position") if _has(layer, role, options)}
    given = layer.geometry is not None or roles >= {"lon", "lat"} or "position" in roles
    is_named = columns.plant is not None or columns.number is not None
    if not given and (is_named or not roles >= {"x", "y"}):
        if not is_named:
            raise ChoiceNeeded(
                f"{layer.name} must say which plants were inspected (a plant's number, a row and a "
                f"number in it, or a position), but its columns are {', '.join(layer.columns)}. "
                "Name them.",
                "columns",
                tuple(layer.columns),
            )
        return lonlat, accuracy_m, ()
    rows = np.empty(len(layer), dtype=object)
    rows[:] = range(len(layer))
    try:
        found = located(replace(layer, columns={**layer.columns, _ROW: rows}, messages=()), options)
    except (ChoiceNeeded, FileProblem):
        if not is_named:
            raise
        return lonlat, accuracy_m, ()
    kept = found.layer.columns[_ROW].astype(np.int64)
    name = options.column("accuracy") or find("accuracy", layer.columns)
    stated = numbers(found.layer.column(name)) if name else np.full(len(kept), np.nan)
    lonlat[kept] = found.lonlat
    accuracy_m[kept] = np.fmax(np.where(stated > 0, stated, np.nan), found.accuracy_m)
    return lonlat, accuracy_m, found.messages


def _has(layer: Layer, role: str, options: FindingsOptions) -> bool:
    return (options.column(role) or find(role, layer.columns)) is not None


# --- when --------------------------------------------------------------------------------------


class _Times(NamedTuple):
    when: NDArray[np.datetime64]
    day: NDArray[np.datetime64]
    findings: list[ImportMessage]


def _times(layer: Layer, columns: _Columns, options: FindingsOptions) -> _Times:
    """Return local times and days.

    Where the file has no time of its own, the day is that of the planned arrival, which stands in
    the route files given out; else the day told by hand; else it is left open.
    """
    cells = _time_cells(layer, columns, options)
    read = dates(_object(cells), options.date_order)
    clocks = {cell: _clock(cell) for cell in set(cells)}
    when = np.full(len(layer), "NaT", dtype="datetime64[s]")
    zone = None if options.zone is None else zone_of(options.zone)
    n_utc = 0
    for i, cell in enumerate(cells):
        clock = clocks[cell]
        if clock is not None and not np.isnat(read.day[i]):
            when[i] = _moment(read.day[i], clock, zone)
            n_utc += clock.offset is not None and zone is None
    day = np.where(np.isnat(when), read.day, when.astype("datetime64[D]"))
    planned = dates(_object(_texts(layer, columns.arrive).tolist())).day
    told = np.datetime64("NaT", "D") if options.day is None else options.day
    day = np.where(np.isnat(day), planned, day)
    day = np.where(np.isnat(day), told, day).astype("datetime64[D]")
    return _Times(when, day, _about_times(read.n_broken, read.broken, read.is_ambiguous, n_utc))


def _about_times(
    n_broken: int,
    broken: tuple[str, ...],
    is_ambiguous: bool,  # noqa: FBT001 - one caller
    n_utc: int,
) -> list[ImportMessage]:
    findings = []
    if n_broken:
        shown = ", ".join(repr(cell) for cell in broken[:3])
        findings.append(doubtful(f"{n_broken} time(s) are none ({shown}); left open."))
    if is_ambiguous:
        remedy = Remedy("date_order", "mdy", "Read month first")
        findings.append(guessed("Dates could be day or month first; read day first.", None, remedy))
    if n_utc:
        remedy = Remedy("zone", "+02:00", "Name the plot's time zone")
        said = f"{n_utc} time(s) name a time zone of their own; their clock was kept as it is."
        findings.append(guessed(said, None, remedy))
    return findings


def _object(cells: list[str]) -> NDArray[np.object_]:
    values = np.empty(len(cells), dtype=object)
    values[:] = cells
    return values


def _time_cells(layer: Layer, columns: _Columns, options: FindingsOptions) -> list[str]:
    """Return the text of each record's time, put together from two columns where it is in two."""
    taken = {columns.arrive, columns.result, columns.marks}
    time = _own("time", layer, taken)
    away = frozenset(name for name in (*taken, time) if name)
    date = options.column("date") or find("date", layer.columns, away)
    clocks = _texts(layer, time).tolist()
    days = _texts(layer, date).tolist()
    return [
        f"{day} {clock}".strip() if day and _only_clock(clock) else (clock or day)
        for day, clock in zip(days, clocks, strict=True)
    ]


def _only_clock(cell: str) -> bool:
    found = _CLOCK.search(cell)
    return not cell or (found is not None and found.start() == 0)


class _Clock(NamedTuple):
    seconds: int
    offset: timedelta | None


def _clock(cell: str) -> _Clock | None:
    """Return the time of day that a cell holds beside its date, and its zone if it names one."""
    if _SERIAL.match(cell) and "." in cell:
        return _Clock(round(float(cell) % 1 * 86_400), None)
    found = _CLOCK.search(cell)
    if not found:
        return None
    hour, minute, second = (int(part or 0) for part in found.groups()[:3])
    half = (found.group(4) or "").replace(".", "").casefold()
    hour = hour % 12 + 12 * (half == "pm") if half else hour
    if hour > 23 or minute > 59 or second > 60:
        return None
    zone = found.group(5)
    if zone is None:
        return _Clock(3600 * hour + 60 * minute + second, None)
    try:
        ahead = (zone_of(zone) if zone[0] in "+-" else UTC).utcoffset(None)
    except SettingError:
        return None
    return _Clock(3600 * hour + 60 * minute + second, ahead)


def _moment(day: np.datetime64, clock: _Clock, zone: tzinfo | None) -> np.datetime64:
    here = day.astype("datetime64[s]") + np.timedelta64(clock.seconds, "s")
    if clock.offset is None or zone is None:
        return np.datetime64(here, "s")
    stated = here.astype(datetime).replace(tzinfo=timezone(clock.offset))
    return np.datetime64(stated.astimezone(zone).replace(tzinfo=None), "s")
