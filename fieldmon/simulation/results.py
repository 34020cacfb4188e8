"""Where a study's seasons are kept: a Parquet dataset, one part file a chunk.

A part appears whole or not at all, and is named by its chunk's key, so that a study that was
stopped, in whatever way, knows what it has.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from io import BytesIO
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.dataset as ds
import pyarrow.parquet as pq

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.atomic_write import write_whole

if TYPE_CHECKING:
    from pathlib import Path

    from fieldmon.simulation.design import Chunk, Design, Site

# readers of datasets pass over names that begin so
MANIFEST = "_study.json"
_ORDER = ("plot", "sampler", "hours", "look_s", "infested", "spread", "seed")


def begin(folder: Path, sites: tuple[Site, ...], design: Design) -> None:
    """Make a study's folder, or go on in it; refuse one that holds another study."""
    said = asdict(design) | {"plots": [f"{site.field.name} {site.digest}" for site in sites]}
    text = json.dumps(said, ensure_ascii=False, indent=1)
    manifest = folder / MANIFEST
    try:
        folder.mkdir(parents=True, exist_ok=True)
        there = manifest.read_text(encoding="utf-8") if manifest.exists() else None
    except OSError as error:
        raise FileProblem(
            f"{folder} must be a folder to write to, but it is not ({error})."
        ) from error
    if there is None:
        write_whole(manifest, text.encode())
    elif there != text:
        raise SettingError(
            f"{folder} holds another study (see {manifest}): its plots, settings or seeds are not "
            "those asked for now. Choose another folder with -o, or ask for the same again."
        )


def part(folder: Path, chunk: Chunk) -> Path:
    """Return the file of a chunk's seasons."""
    return folder / f"sampler={chunk.case.sampler}" / f"{chunk.key}.parquet"


def keep(folder: Path, chunk: Chunk, seasons: pa.Table) -> None:
    """Write the seasons of a chunk."""
    to = part(folder, chunk)
    to.parent.mkdir(exist_ok=True)
    data = BytesIO()
    # the folder's name says the sampler, as everywhere in partitioned datasets
    pq.write_table(seasons.drop_columns(["sampler"]), data)
    write_whole(to, data.getvalue())


def seasons(folder: Path) -> pa.Table:
    """Return all seasons that a study has so far, in the order of their settings and seeds."""
    if not any(folder.glob("sampler=*/*.parquet")):
        raise FileProblem(f"{folder} must hold a study with finished seasons, but it does not.")
    by_sampler = ds.partitioning(pa.schema([("sampler", pa.string())]), flavor="hive")
    table = ds.dataset(folder, format="parquet", partitioning=by_sampler).to_table()
    return table.sort_by([(column, "ascending") for column in _ORDER])
