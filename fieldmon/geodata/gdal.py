"""Vector files that GDAL reads; `guard` has taken from it what leads to other files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyogrio.raw
import shapely
from pyogrio.errors import DataLayerError, DataSourceError

from fieldmon.errors import FileProblem
from fieldmon.geodata import limits
from fieldmon.geodata.layers import Layer

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_UNREADABLE = (DataSourceError, DataLayerError, RuntimeError, ValueError, OSError)


class Listed(NamedTuple):
    """A layer by name, with the type of its geometry (None for a plain table)."""

    name: str
    geometry_type: str | None


def list_layers(path: Path, name: str) -> list[Listed]:
    """Return the layers of a staged file."""
    try:
        listed = pyogrio.list_layers(path)
    except _UNREADABLE as bad:
        raise _unreadable(name, bad) from bad
    return [Listed(str(layer), kind) for layer, kind in listed]


def read_layer(path: Path, name: str, layer: str | None, encoding: str | None) -> Layer:
    """Return one layer of a staged file."""
    try:
        meta, _, wkb, values = pyogrio.raw.read(
            path, layer=layer, encoding=encoding, force_2d=True, datetime_as_string=True
        )
    except _UNREADABLE as bad:
        raise _unreadable(name, bad) from bad
    columns = {
        str(field): _objects(column) for field, column in zip(meta["fields"], values, strict=True)
    }
    geometry = None if wkb is None else shapely.from_wkb(wkb, on_invalid="ignore")
    if geometry is not None and int(shapely.get_num_coordinates(geometry).sum()) > limits.VERTICES:
        raise FileProblem(
            f"A file may hold {limits.VERTICES} vertices at most, but {name} holds more. "
            "Simplify the shapes or cut the file to the plots that matter."
        )
    return Layer(layer or name, columns, geometry, meta["crs"])


def _objects(column: NDArray[Any]) -> NDArray[np.object_]:
    values = np.empty(len(column), dtype=object)
    values[:] = column.tolist()
    return values


def _unreadable(name: str, bad: Exception) -> FileProblem:
    return FileProblem(
        f"{name} must be a whole file of its kind, but it cannot be read ({bad}). "
        "Export or download it again."
    )
