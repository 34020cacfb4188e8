"""Vector files that GDAL reads; `process` keeps from it the drivers that lead to other files."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyogrio.raw
import shapely
from pyogrio.errors import DataLayerError, DataSourceError

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.formats.wkb import shapes
from fieldmon.io.import_report import ImportMessage, doubtful, repaired, seen
from fieldmon.io.parse.text import Decoder
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_UNREADABLE = (DataSourceError, DataLayerError, RuntimeError, ValueError, OSError)
_OWN_TABLE = re.compile(rb'\btype\s+"?(native|dbf)\b')
# of a column in it: its name and what follows
_COLUMN = re.compile(r"\s*(\S+?)_* +(\S.*;\s*)$")
_BYTE_FOR_BYTE = "ISO-8859-1"


class GdalLayer(NamedTuple):
    """A layer by name, with the type of its geometry (None for a plain table)."""

    name: str
    geometry_type: str | None


def list_layers(path: Path, name: str) -> list[GdalLayer]:
    """Return the layers of a staged file."""
    try:
        listed = pyogrio.list_layers(path)
    except _UNREADABLE as bad:
        raise _unreadable(name, bad) from bad
    return [GdalLayer(str(layer), kind) for layer, kind in listed]


def read_layer(path: Path, name: str, layer: str | None, encoding: str | None = None) -> Layer:
    """Return one layer of a staged file."""
    try:
        info = pyogrio.read_info(path, layer=layer, encoding=encoding, force_feature_count=True)
        meta, _, wkb, values = pyogrio.raw.read(
            path,
            layer=layer,
            encoding=encoding,
            datetime_as_string=True,
            # room is made for as many as are asked for, whether they exist or not
            max_features=min(max(int(info["features"]), 1), limits.FEATURES) + 1,
        )
    except _UNREADABLE as bad:
        raise _unreadable(name, bad) from bad
    n_features = len(wkb) if wkb is not None else len(values[0]) if len(values) else 0
    limits.check("features", n_features, limits.FEATURES, name)
    columns = {
        str(field): _objects(column) for field, column in zip(meta["fields"], values, strict=True)
    }
    limits.check("columns", len(columns), limits.COLUMNS, name)
    if wkb is None:
        return Layer(layer or name, columns, None, meta["crs"])
    geometry, messages = shapes(wkb)
    n_vertices = int(shapely.get_num_coordinates(geometry).sum())
    limits.check("vertices", n_vertices, limits.VERTICES, name)
    return Layer(layer or name, columns, geometry, meta["crs"], tuple(messages))


def read_shapefile(path: Path, name: str, encoding: str | None) -> Layer:
    """Return a staged shapefile, its text read by its own evidence, with what is missing said."""
    messages: list[ImportMessage] = []
    if not path.with_suffix(".shx").exists():
        messages.append(repaired(worded("The index (.shx) was missing and was made anew.")))
    if not path.with_suffix(".dbf").exists():
        messages.append(seen(worded("The table (.dbf) is missing: there are shapes only.")))
    try:
        raw = read_layer(path, name, None, _BYTE_FOR_BYTE)
    except (FileProblem, UnboundLocalError):  # the latter is pyogrio's own, for a broken .prj
        if not path.with_suffix(".prj").exists():
            raise
        path.with_suffix(".prj").unlink()
        messages.append(
            doubtful(worded("The coordinate system (.prj) cannot be understood; it was left."))
        )
        raw = read_layer(path, name, None, _BYTE_FOR_BYTE)
    decoder = Decoder(_all_bytes(raw), _stated_encoding(path), encoding)
    columns = {
        decoder(_bytes(column)): _decoded(values, decoder) for column, values in raw.columns.items()
    }
    said = (*messages, *raw.messages, *decoder.messages)
    return Layer(name, columns, raw.geometry, raw.crs, said)


def read_mapinfo(path: Path, name: str) -> Layer:
    """Return the one table of a staged MapInfo file; refuse one that only leads to others."""
    if path.suffix == ".tab":
        said = path.read_bytes()[: limits.CELL_CHARACTERS].lower()
        if b"isseamless" in said or b"create view" in said or not _OWN_TABLE.search(said):
            raise FileProblem(
                worded(
                    "{name} must be a MapInfo table of its own, but it only "
                    "leads to other files. Choose those.",
                    name=name,
                )
            )
    try:
        return read_layer(path, name, None)
    except FileProblem as problem:
        if path.suffix != ".tab" or not isinstance(problem.__cause__, UnicodeDecodeError):
            raise
        names = _mend_names(path)
        layer = read_layer(path, name, None)
        mended = repaired(
            worded(
                "Names of columns that were cut in the midst of a letter are read as {names}.",
                names=first_few([repr(one) for one in names]),
            )
        )
        return replace(layer, messages=(*layer.messages, mended))


def _mend_names(path: Path) -> list[str]:
    """Leave out of the columns' names in a staged MapInfo table what is no letter; return these.

    QGIS 3.22 writes such names where they are long and not Latin.
    """
    mended: list[str] = []
    lines = path.read_bytes().split(b"\n")
    whole = {line.split()[0].decode("utf-8", "replace") for line in lines if line.strip()}
    for k, line in enumerate(lines):
        plain = line.decode("utf-8", "ignore")
        if plain.encode() != line and (found := _COLUMN.match(plain)):
            mended.append(f"{found[1]}{k}" if found[1] in {*whole, *mended} else found[1])
            plain = f"    {mended[-1]} {found[2]}"
        lines[k] = plain.encode()
    path.write_bytes(b"\n".join(lines))
    return mended


def _stated_encoding(path: Path) -> str | None:
    stated = path.with_suffix(".cpg")
    return stated.read_bytes()[:40].decode("ascii", "ignore") if stated.exists() else None


def _all_bytes(layer: Layer) -> list[bytes]:
    values = (v for column in layer.columns.values() for v in column if isinstance(v, str))
    return [*(_bytes(name) for name in layer.columns), *(_bytes(v) for v in values)]


def _decoded(values: NDArray[np.object_], decoder: Decoder) -> NDArray[np.object_]:
    decoded = np.empty(len(values), dtype=object)
    decoded[:] = [decoder(_bytes(v)) if isinstance(v, str) else v for v in values]
    return decoded


def _bytes(text: str) -> bytes:
    return text.encode("latin-1", errors="replace")


def _objects(column: NDArray[Any]) -> NDArray[np.object_]:
    values = np.empty(len(column), dtype=object)
    values[:] = [_in_words(value) for value in column.tolist()]
    return values


def _in_words(value: object) -> object:
    """Return a cell; a list of names, as GML has them, as people would write it."""
    if isinstance(value, list | np.ndarray):
        return ", ".join(dict.fromkeys(text(one) for one in value))
    return value


def _unreadable(name: str, bad: Exception) -> FileProblem:
    return FileProblem(
        worded(
            "{name} must be a whole file of its kind, but it cannot be read "
            "({bad}). Export or download it again.",
            name=name,
            bad=bad,
        )
    )
