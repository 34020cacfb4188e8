"""A season's record as tables: treatments as a certifier asks for them, inspections, the log."""

from __future__ import annotations

import csv
import io
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.readers.inspection_file.inspection_rows import mark_in_table
from fieldmon.io.writers.csv import safe_cell
from fieldmon.io.writers.day_file import faces
from fieldmon.monitoring.inspecting import inspection_lots
from fieldmon.monitoring.inspecting.inspection_table import time_text
from fieldmon.monitoring.inspecting.known_inspections import corrected_by
from fieldmon.monitoring.treating.cautions import groups, label_of, waits
from fieldmon.plot.named_rows import place_in_words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from fieldmon.monitoring.season.open_season import OpenSeason
    from fieldmon.monitoring.season.season_inspections import SeasonInspections
    from fieldmon.monitoring.season.season_treatments import SeasonTreatments

#: what stands in each line, by column
Table = dict[str, list[Any]]

# of treatments, also where there is none
_TREATMENT = (
    "plot",
    "date",
    "began",
    "ended",
    "zone",
    "crop",
    "product",
    "active_ingredient",
    "irac_group",
    "dose",
    "unit",
    "water_l_ha",
    "area_ha",
    "plants",
    "where",
    "reason",
    "pest",
    "operator",
    "authorised_by",
    "machinery",
    "weather",
    "waiting_days",
    "harvest_from",
    "reentry_hours",
    "entry_from",
    "efficacy",
    "batch",
)


def treatments_table(season: SeasonTreatments) -> Table:
    """Return a line for each treatment that counts: GLOBALG.A.P.'s fields, and how it is kept."""
    return {name: [] for name in _TREATMENT} | _by_column(_treatments(season))


def _by_column(lines: Iterable[dict[str, object]]) -> Table:
    table: Table = {}
    for line in lines:
        for name, value in line.items():
            table.setdefault(name, []).append(value)
    return table


def _treatments(season: SeasonTreatments) -> Iterator[dict[str, object]]:
    with season.store.one_moment():
        labels, treatments = season.labels(), season.treatments()
    for one in treatments:
        said, label = one.application, label_of(one, labels)
        period = waits(one, label)
        entry = period.entry_from
        values = (
            season.plot.field.name,
            one.on,
            said.began and f"{said.began:%H:%M}",
            said.ended and f"{said.ended:%H:%M}",
            one.clock.zone,
            said.crop,
            said.product,
            said.active_ingredient,
            "+".join(groups(one, label)),
            said.dose and said.dose.value,
            said.dose and said.dose.unit,
            said.water_l_ha,
            one.place.area_ha,
            int(season.plot.grid.vines_of(one.place.plants).sum()),
            str(place_in_words(season.plot.grid, one.place.plants)),
            said.reason,
            said.pest,
            said.operator,
            said.authorised_by,
            said.machinery,
            said.weather,
            period.days,
            period.harvest_from,
            period.hours,
            entry and f"{entry:%Y-%m-%d %H:%M}",
            one.efficacy,
            one.batch,
        )
        yield dict(zip(_TREATMENT, values, strict=True))


def inspections_table(season: SeasonInspections) -> Table:
    """Return a line for each inspection that counts: recorded again, they change nothing."""
    with season.store.one_moment():
        done, corrected = season.history.inspections, corrected_by(season)
        with season.store.reading() as db:
            marks = inspection_lots.digests(db)
    numbered, plot, grid = season.plant_numbers, season.plot.field.name, season.plot.grid
    plants, of = np.unique(done.plant, return_inverse=True)
    lon, lat = np.round(grid.lonlat(plants), 7).T
    results = [RESULT_NAMES[result] for result in done.result.tolist()]
    lines = numbered.line[done.plant].tolist()
    dates = np.datetime_as_string(done.date).tolist()
    counts = _each(done.count, float)
    which = zip(done.plant.tolist(), dates, results, counts, strict=True)
    beside: Table = {}
    for one in BESIDE:
        told = getattr(done, one.name)
        beside[one.kept] = told.tolist() if one.is_text else _each(told, float)
        if one.name == "who":
            beside["corrected_by"] = [corrected.get(key, "") for key in which]
    return {
        "plot": [plot] * len(done),
        "date": dates,
        "time": _each(done.second, time_text),
        "row": lines,
        # of all seasons, as they share columns: empty where the number says all
        "row_name": [grid.row_names.get(line, "") for line in lines],
        # no column "plant": in route files that is the number on the plot, from 0
        "number": numbered.number[done.plant].tolist(),
        "lon": lon[of].tolist(),
        "lat": lat[of].tolist(),
        "result": results,
        # spreadsheets of other languages take 2.0 for a text or a date
        "count": _each(done.count, lambda n: int(n) if n.is_integer() else n),
        **beside,
        "face": [face or None for face in faces(grid, done.plant).tolist()],
        "digest": [*map(mark_in_table, marks)],
    }


def _each(values: NDArray[np.float64], said: Callable[[float], object]) -> list[object]:
    """Return what is said of each number; None of those that are not known."""
    known, of = np.unique(values, return_inverse=True)
    each = [None if math.isnan(value) else said(value) for value in known.tolist()]
    return [each[k] for k in of.tolist()]


def log_table(season: OpenSeason) -> Table:
    """Return a line for each entry of the log, and below a merge those of the copy.

    Of these the entry is the merge's number; the last column has the one that they have there.
    """
    return _by_column(
        {
            "plot": season.plot.field.name,
            "entry": entry.number,
            "at_utc": one.at,
            "who": one.who,
            "what": one.kind,
            "said": one.sentence(),
            "digest": one.digest,
            "copy_entry": None if one is entry else one.number,
        }
        for entry in season.log()
        for one in (entry, *entry.theirs)
    )


#: what can be handed out as a table
TABLES: dict[str, Callable[[Any], Table]] = {
    "treatments": treatments_table,
    "inspections": inspections_table,
    "log": log_table,
}


def csv_bytes(tables: Iterable[Table]) -> bytes:
    """Return tables of the same columns below each other as CSV in UTF-8, as spreadsheets open it.

    Empty where they have no lines.
    """
    text = io.StringIO(newline="")
    written = csv.writer(text)
    for table in tables:
        if any(table.values()) and not text.tell():
            written.writerow(table)
        written.writerows(zip(*(_cells(column) for column in table.values()), strict=True))
    data = text.getvalue()
    return data.encode("utf-8-sig") if data else b""


def _cells(column: list[Any]) -> list[object]:
    """Return what stands in the cells of a column."""
    safe = _Cells()
    return [safe[value] if isinstance(value, str) else value for value in column]


class _Cells(dict[str, str]):
    """What stands in a cell, by the text that belongs there: most stand in thousands of lines."""

    def __missing__(self, text: str) -> str:
        self[text] = safe = safe_cell(text)
        return safe
