"""A season's record as tables: treatments as a certifier asks for them, inspections, the log."""

from __future__ import annotations

import csv
import io
import math
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.writers.csv import safe_cell
from fieldmon.monitoring.cautions import label_of, waits

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fieldmon.monitoring import Season

#: a line of a table by its columns
Line = dict[str, object]


def treatments_table(season: Season) -> Iterator[Line]:
    """Yield a line for each treatment that counts: GLOBALG.A.P.'s fields, and how it is kept."""
    with season.one_moment():
        labels, treatments = season.labels(), season.treatments()
    for one in treatments:
        said, period = one.application, waits(one, label_of(one, labels))
        entry = period.entry_from
        yield {
            "plot": season.plot.field.name,
            "date": one.on,
            "began": said.began and f"{said.began:%H:%M}",
            "ended": said.ended and f"{said.ended:%H:%M}",
            "zone": one.clock.zone,
            "crop": said.crop,
            "product": said.product,
            "active_ingredient": said.active_ingredient,
            "irac_group": "+".join(said.irac_groups),
            "dose": said.dose and said.dose.value,
            "unit": said.dose and said.dose.unit,
            "water_l_ha": said.water_l_ha,
            "area_ha": one.place.area_ha,
            "plants": int(one.place.plants.sum()),
            "reason": said.reason,
            "pest": said.pest,
            "operator": said.operator,
            "authorised_by": said.authorised_by,
            "machinery": said.machinery,
            "weather": said.weather,
            "waiting_days": period.days,
            "harvest_from": period.harvest_from,
            "reentry_hours": period.hours,
            "entry_from": entry and f"{entry:%Y-%m-%d %H:%M}",
            "efficacy": one.efficacy,
            "batch": one.batch,
        }


def inspections_table(season: Season) -> Iterator[Line]:
    """Yield a line for each inspection that counts."""
    done, label, plot = season.history.inspections, season.label, season.plot.field.name
    texts: dict[object, str] = {}  # the same name stands in thousands of rows
    plants, of = np.unique(done.plant, return_inverse=True)
    places = [
        (round(lon, 7), round(lat, 7)) for lon, lat in season.plot.grid.lonlat(plants).tolist()
    ]
    columns = (
        [places[k] for k in of.tolist()],
        np.datetime_as_string(done.date).tolist(),
        done.second.tolist(),
        label.line[done.plant].tolist(),
        label.number[done.plant].tolist(),
        [RESULT_NAMES[result] for result in done.result.tolist()],
        done.count.tolist(),
        *([texts.setdefault(said, str(said)) for said in each] for each in (done.who, done.notes)),
    )
    for (lon, lat), on, second, row, number, result, count, who, notes in zip(
        *columns, strict=True
    ):
        minutes = None if math.isnan(second) else int(second // 60)
        yield {
            "plot": plot,
            "date": on,
            "time": None if minutes is None else f"{minutes // 60:02d}:{minutes % 60:02d}",
            "row": row,
            "plant": number,
            "lon": lon,
            "lat": lat,
            "result": result,
            "count": None if math.isnan(count) else count,
            "who": who,
            "notes": notes,
        }


def log_table(season: Season) -> Iterator[Line]:
    """Yield a line for each entry of the log."""
    for one in season.log():
        yield {
            "plot": season.plot.field.name,
            "entry": one.number,
            "at_utc": one.at,
            "who": one.who,
            "what": one.kind,
            "said": one.sentence(),
            "digest": one.digest,
        }


#: what can be handed out as a table
TABLES = {"treatments": treatments_table, "inspections": inspections_table, "log": log_table}


def csv_bytes(lines: Iterable[Line]) -> bytes:
    """Return lines as CSV in UTF-8, as spreadsheets open it; empty of none."""
    cells = _Cells()
    text = io.StringIO(newline="")
    table = csv.writer(text)
    for k, line in enumerate(lines):
        if k == 0:
            table.writerow(line)
        table.writerow(
            [cells[value] if isinstance(value, str) else value for value in line.values()]
        )
    data = text.getvalue()
    return data.encode("utf-8-sig") if data else b""


class _Cells(dict[str, str]):
    """What stands in a cell, by the text that belongs there: most stand in thousands of lines."""

    def __missing__(self, text: str) -> str:
        self[text] = safe = safe_cell(text)
        return safe
