"""Where a study's seasons are kept: a Parquet dataset, one part file a chunk.

A part appears whole or not at all, and is named by its chunk's key, so that a study that was
stopped, in whatever way, knows what it has.
"""

from __future__ import annotations

import json
from datetime import date
from io import BytesIO
from typing import TYPE_CHECKING, Any, cast

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
# what later versions added to a manifest: studies of before do not say it, and can go on
_LATER = ("first_day", "own_code")
# what people call the parts of a manifest
_CALLED = {
    "look_s": "inspection time", "infested": "share infested", "n_days": "days", "n_seeds": "seeds",
    "first_seed": "first seed", "robot_times": "robot times", "visit_every": "days between visits",
}  # fmt: skip


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
        said = design.content
        if plots:
            said["first_day"] = str(plots[0].day)
        said["plots"] = [f"{plot.field.name} {plot.digest}" for plot in plots]
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
            there = _said_in(self.folder)
        except OSError as error:
            raise FileProblem(
                f"{self.folder} must be a folder to write to, but it is not "
                f"({error.strerror or error}). Choose another one with -o."
            ) from error
        said = json.loads(text)
        if there is not None and (why := _why_another(there, said)):
            raise SettingError(
                f"{self.folder} holds another study (see {manifest}): {why}. Choose another folder "
                "with -o, or ask for the same again."
            )
        if there != said:
            write_whole(manifest, text.encode())


def first_day(folder: Path) -> date | None:
    """Return the first day of the study in a folder; None: there is none, or it does not say."""
    try:
        said = (_said_in(folder) or {}).get("first_day")
    except OSError:  # what is wrong with it is said when it is to be written to
        return None
    return None if said is None else date.fromisoformat(said)


def _said_in(folder: Path) -> dict[str, Any] | None:
    """Return what the study in a folder says of itself; None: there is none."""
    manifest = folder / MANIFEST
    if not manifest.exists():
        return None
    try:
        said = dict(json.loads(manifest.read_text(encoding="utf-8")))
        if "first_day" in said:
            date.fromisoformat(said["first_day"])
    except (ValueError, TypeError) as error:
        raise FileProblem(
            f"{manifest} must say what the study in its folder is, but it was changed or cut. "
            "Choose another folder with -o."
        ) from error
    return said


def _why_another(there: dict[str, Any], said: dict[str, Any]) -> str:
    """Return how the study that is there differs from the one asked for; "": it does not."""
    told = {name: said[name] for name in _LATER if name in said} | there
    others = [name for name in told | said if told.get(name) != said.get(name)]
    called, why = _CALLED | {"plots": "plots or records"}, []
    if "first_day" not in there:
        called["plots"] = "plots, records or first day (--date)"
    if "first_day" in others:
        why.append(f"its first day (--date) is {told['first_day']}, not {said['first_day']}")
        others.remove("first_day")
        # a plot's digest knows the day
        if _names(told) == _names(said) and "plots" in others:
            others.remove("plots")
    if "own_code" in others:
        others.remove("own_code")
        own, asked = told.get("own_code", {}), said.get("own_code", {})
        if changed := [name for name in own if asked.get(name, own[name]) != own[name]]:
            why.append(f"its seasons of {' and '.join(changed)} are of other code than the file's")
    if others:
        why.append(f"it differs in {' and '.join(called.get(name, name) for name in others)}")
    return ", and ".join(why)


def _names(said: dict[str, Any]) -> list[str]:
    return [str(plot).rpartition(" ")[0] for plot in said.get("plots", [])]


def seasons(folder: Path) -> pa.Table:
    """Return all seasons that a study has so far, in the order of their settings and seeds.

    Each once, also where parts overlap, as they may when chunks were cut in another way before.
    Those of a pest have no spread, though an older fieldmon named one.
    """
    if not any(folder.glob("sampler=*/*.parquet")):
        raise FileProblem(f"{folder} must hold a study with finished seasons, but it does not.")
    by_sampler = ds.partitioning(pa.schema([("sampler", pa.string())]), flavor="hive")
    table = ds.dataset(folder, format="parquet", partitioning=by_sampler).to_table()
    # all seasons of a study are of one pest, or of none
    if (spread := table["spread"]).null_count:
        none = pa.nulls(len(table), spread.type)
        table = table.set_column(table.column_names.index("spread"), "spread", none)
    by = [name for name in _ORDER if table[name].null_count < len(table)]
    table = table.sort_by([(column, "ascending") for column in by])
    columns = [table[name].to_numpy() for name in by]
    fresh = np.logical_or.reduce([column[1:] != column[:-1] for column in columns])
    return table.filter(pa.array(np.concatenate([[True], fresh])))
