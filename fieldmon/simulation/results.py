"""Where a study's seasons are kept: a Parquet dataset, one part file a chunk.

A part appears whole or not at all, and is named by its chunk's key, so that a study that was
stopped, in whatever way, knows what it has.
"""

from __future__ import annotations

import json
from io import BytesIO
from typing import TYPE_CHECKING, cast

import numpy as np
import pyarrow as pa
import pyarrow.dataset as ds
import pyarrow.parquet as pq

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.atomic_write import write_whole
from fieldmon.simulation.worker import DETECTION_LEVELS, RefusedPlot

if TYPE_CHECKING:
    from collections.abc import Hashable, Sequence
    from pathlib import Path

    from fieldmon.simulation.design import Design
    from fieldmon.simulation.study_plot import StudyPlot
    from fieldmon.simulation.worker import ChunkSeasons

# readers of datasets pass over names that begin so
MANIFEST = "_study.json"
SCHEMA = pa.schema(
    [
        *((name, pa.string()) for name in ("plot", "sampler")),
        *((name, pa.float64()) for name in ("hours", "look_s", "infested", "spread")),
        *((name, pa.int64()) for name in ("seed", "days", "plants")),
        *((name, pa.float64()) for name in ("detection_pct", "visited_pct", "ever_visited_pct")),
        *((name, pa.int64()) for name in ("infestations", "found", "left", "infested_plant_days")),
        *((name, pa.int32()) for name in DETECTION_LEVELS),
        *((name, pa.list_(pa.int32())) for name in ("found_by_day", "left_by_day")),
    ]
)
_ORDER = ("plot", "sampler", "hours", "look_s", "infested", "spread", "seed")


class StudyFolder:
    """A store of seasons on disk, by sampler and digest.

    Parameters
    ----------
    folder
        Made if it is not there. One that holds another study is refused.
    plots, design
        What is simulated; written beside the seasons.

    Attributes
    ----------
    refused
        Why plots were refused, by name; they have no seasons.
    """

    def __init__(self, folder: Path, plots: Sequence[StudyPlot], design: Design) -> None:
        self.folder = folder
        self.refused: dict[str, str] = {}
        said = design.content | {"plots": [f"{plot.field.name} {plot.digest}" for plot in plots]}
        self._begin(json.dumps(said, ensure_ascii=False, indent=1))

    def holds(self, key: Hashable) -> bool:
        """Tell whether a chunk's seasons are there."""
        return self.part(key).exists()

    def keep(self, key: Hashable, result: ChunkSeasons) -> None:
        """Write the seasons of a chunk, or note why there are none."""
        if isinstance(result, RefusedPlot):
            self.refused[result.name] = result.why
            return
        to = self.part(key)
        to.parent.mkdir(exist_ok=True)
        # the folder's name says the sampler, as everywhere in partitioned datasets
        table = pa.Table.from_pylist(result, SCHEMA).drop_columns(["sampler"])
        data = BytesIO()
        pq.write_table(table, data)
        write_whole(to, data.getvalue())

    def part(self, key: Hashable) -> Path:
        """Return the file of a chunk's seasons."""
        sampler, digest = cast("tuple[str, str]", key)
        return self.folder / f"sampler={sampler}" / f"{digest}.parquet"

    def _begin(self, text: str) -> None:
        manifest = self.folder / MANIFEST
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            there = manifest.read_text(encoding="utf-8") if manifest.exists() else None
        except OSError as error:
            raise FileProblem(
                f"{self.folder} must be a folder to write to, but it is not "
                f"({error.strerror or error}). Choose another one with -o."
            ) from error
        if there is None:
            write_whole(manifest, text.encode())
        elif there != text:
            raise SettingError(
                f"{self.folder} holds another study (see {manifest}): its plots, settings or seeds "
                "are not those asked for now. Choose another folder with -o, or ask for the same "
                "again."
            )


def seasons(folder: Path) -> pa.Table:
    """Return all seasons that a study has so far, in the order of their settings and seeds.

    Each once, also where parts overlap, as they may when chunks were cut in another way before.
    """
    if not any(folder.glob("sampler=*/*.parquet")):
        raise FileProblem(f"{folder} must hold a study with finished seasons, but it does not.")
    by_sampler = ds.partitioning(pa.schema([("sampler", pa.string())]), flavor="hive")
    table = ds.dataset(folder, format="parquet", partitioning=by_sampler).to_table()
    table = table.sort_by([(column, "ascending") for column in _ORDER])
    columns = [table[name].to_numpy() for name in _ORDER]
    fresh = np.logical_or.reduce([column[1:] != column[:-1] for column in columns])
    return table.filter(pa.array(np.concatenate([[True], fresh])))
