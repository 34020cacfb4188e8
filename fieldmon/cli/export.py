"""`fieldmon export`: a season's record as tables, for others. Heavy imports wait."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.monitoring import Season


class RecordTable(StrEnum):
    """What can be exported."""

    treatments = "treatments"
    inspections = "inspections"
    log = "log"


SeasonFiles = Annotated[
    list[Path], typer.Argument(help="Season files, made by fieldmon init; all go into one table.")
]
Of = Annotated[RecordTable, typer.Option("--of", help="What the table holds.")]
To = Annotated[
    Path,
    typer.Option(
        "--output", "-o", help="File to write: .csv, or .json for inspections by IPM Decisions."
    ),
]
Pest = Annotated[str, typer.Option(help="EPPO code of the pest, for .json: TETRUR.")]
Crop = Annotated[str, typer.Option(help="EPPO code of the crop, for .json: LYPES.")]


def export(
    seasons: SeasonFiles,
    output: To,
    of: Of = RecordTable.treatments,
    pest: Pest = "",
    crop: Crop = "",
) -> None:
    """Write treatments, inspections or the log of one season or several as a table.

    Inspections that were changed in the table are corrected with fieldmon correct. A .json holds
    inspections as IPM Decisions' field observations; inspections without a time stand at noon.

    Example: fieldmon export season.gpkg --of inspections -o inspections.csv
    """
    from fieldmon.cli.season_files import opened, refuse_unrecorded_in_any
    from fieldmon.io.atomic_write import write_whole

    ending = output.suffix.lower()
    if ending not in {".csv", ".json"}:
        raise SettingError(f"A table's file must end in .csv or .json, but it is {output.name!r}.")
    kept = opened(seasons)
    refuse_unrecorded_in_any(kept, [output])
    data = _observations(kept, pest, crop) if ending == ".json" else _table(kept, of.value)
    write_whole(output, data)
    typer.echo(f"Written to {output}")


def _table(kept: list[Season], of: str) -> bytes:
    from fieldmon.monitoring.inspecting.certifier_tables import TABLES, csv_bytes
    from fieldmon.monitoring.merging.other_seasons import called_apart

    tables = (
        (TABLES[of](season), called)
        for season, called in zip(kept, called_apart(kept), strict=True)
    )
    data = csv_bytes({**table, "plot": [called] * len(table["plot"])} for table, called in tables)
    if not data:
        raise SettingError(f"There must be {of} to write, but there are none. No file is written.")
    return data


def _observations(kept: list[Season], pest: str, crop: str) -> bytes:
    from fieldmon.io.writers.ipm_decisions import (
        EppoCodes,
        field_observations,
        observations_json,
    )
    from fieldmon.plot.local_clock import local_clock

    codes = EppoCodes(pest.strip().upper(), crop.strip().upper())
    return observations_json(
        *(
            field_observations(
                season.inspections, season.plot.grid, local_clock(season.plot.field), codes
            )
            for season in kept
        )
    )
