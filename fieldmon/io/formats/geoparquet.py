"""GeoParquet, the table format with geometry."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import WGS84, Layer
from fieldmon.io.formats.wkb import shapes
from fieldmon.io.sandbox import limits

if TYPE_CHECKING:
    from pathlib import Path


def read_parquet(path: Path, name: str) -> Layer:
    """Return a GeoParquet file as a layer; raise `FileProblem` for a plain Parquet table."""
    try:
        file = pq.ParquetFile(path, memory_map=False)
        metadata = file.schema_arrow.metadata or {}
        limits.check("features", file.metadata.num_rows, limits.FEATURES, name)
        geo = json.loads(metadata.get(b"geo", b"{}"))
        table = file.read(use_threads=False) if geo else None
    except (pa.ArrowException, OSError, ValueError, RecursionError) as bad:
        raise FileProblem(
            worded(
                "{name} must be a whole GeoParquet file, but it cannot be "
                "read ({bad}). Export or download it again.",
                name=name,
                bad=bad,
            )
        ) from bad
    primary = geo.get("primary_column") if isinstance(geo, dict) else None
    if table is None or primary not in table.column_names:
        raise FileProblem(
            worded(
                "{name} must be GeoParquet, but it names no column with "
                "geometry. Export it as GeoParquet or GeoPackage.",
                name=name,
            )
        )
    stated = geo.get("columns", {}).get(primary, {})
    if stated.get("encoding", "WKB") != "WKB":
        raise FileProblem(
            worded(
                "The geometry in {name} must be written as WKB, but it is "
                "{encoding}. Export it as GeoPackage.",
                name=name,
                encoding=stated.get("encoding"),
            )
        )
    wkb = np.empty(table.num_rows, dtype=object)
    wkb[:] = table.column(primary).to_pylist()
    geometry, messages = shapes(wkb)
    columns = {
        str(column): _objects(table.column(column).to_pylist())
        for column in table.column_names
        if column != primary
    }
    return Layer(name, columns, geometry, _crs(stated), tuple(messages))


def _crs(stated: dict[str, Any]) -> str | None:
    """Return the coordinate system: without one it is OGC:CRS84, with null it is unknown."""
    if "crs" not in stated:
        return WGS84
    return None if stated["crs"] is None else json.dumps(stated["crs"])


def _objects(values: list[Any]) -> np.ndarray[Any, np.dtype[np.object_]]:
    column = np.empty(len(values), dtype=object)
    column[:] = [v if v is None or isinstance(v, str | int | float) else str(v) for v in values]
    return column
