"""A season's record as tables: treatments as a certifier asks for them, inspections, the log."""

from __future__ import annotations

import csv
import io
import math
from typing import TYPE_CHECKING

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
    lonlat = season.plot.grid.lonlat(done.plant).tolist()
    for k, plant in enumerate(done.plant.tolist()):
        second, count = float(done.second[k]), float(done.count[k])
        minutes = None if math.isnan(second) else int(second // 60)
        yield {
            "plot": plot,
            "date": str(done.date[k]),
            "time": None if minutes is None else f"{minutes // 60:02d}:{minutes % 60:02d}",
            "row": int(label.line[plant]),
            "plant": int(label.number[plant]),
            "lon": round(lonlat[k][0], 7),
            "lat": round(lonlat[k][1], 7),
            "result": RESULT_NAMES[int(done.result[k])],
            "count": None if math.isnan(count) else count,
            "who": str(done.who[k]),
            "notes": str(done.notes[k]),
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
    kept = list(lines)
    if not kept:
        return b""
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, list(kept[0]))
    table.writeheader()
    table.writerows([{name: _cell(value) for name, value in line.items()} for line in kept])
    return text.getvalue().encode("utf-8-sig")


def _cell(value: object) -> object:
    if value is None:
        return ""
    return safe_cell(value) if isinstance(value, str) else value
