"""Which records belong to a plot, and how far away the others are."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, ImportDoubt, ObservationError
from fieldmon.infestation.records import NEARBY_M, usable
from fieldmon.io.import_report import Imported, ImportMessage, Remedy, doubtful, dropped, seen
from fieldmon.plot.grid import nearest_plants
from fieldmon.plot.plants_outside import PlantsOutside, between_m, distance_m

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.records import Records
    from fieldmon.io.readers.places import Plants
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

_DEGREE_M = 111_000.0
#: a tenth of a millimetre: one position, read twice
_SAME_DEG = 1e-9
#: records placed no better than that say nothing of single plants
_ROUGHEST_M = 1000.0


@dataclass(frozen=True, eq=False)
class RecordsNearPlot:
    """Records on a plot or close by, and those elsewhere.

    Parameters
    ----------
    inside
        Records on the plot or within `NEARBY_M` (or twice their accuracy, where that is more).
    outside
        All others.
    outside_m
        ``(len(outside),)`` distance of those to the plot's boundary.
    """

    inside: Records
    outside: Records
    outside_m: NDArray[np.float64]

    def messages(self, plot: str) -> list[ImportMessage]:
        """Return what there is to say about the records elsewhere."""
        n = len(self.outside)
        if n == 0:
            return []
        return [
            dropped(
                worded(
                    "{n} of {all} {all:record|records} {n:lies|lie} outside {plot} and "
                    "{n:was|were} kept apart: {away} away.",
                    n=n,
                    all=n + len(self.inside),
                    plot=plot,
                    away=between_m(self.outside_m),
                )
            )
        ]


def near_plot(records: Records, field: Field) -> RecordsNearPlot:
    """Return records on a plot or close by, and those elsewhere."""
    away = distance_m(records.lonlat, field)
    near = away <= records.reach_m()
    return RecordsNearPlot(records.take(near), records.take(~near), away[~near])


def warn_of_left_out(records: Records, on_day: np.datetime64, field: Field) -> None:
    """Warn the caller of the caller of records that say nothing of a plot on a day."""
    known = replace(usable(records, on_day), undated=0, old=0)
    for one in (*known.messages(), *_elsewhere(known.records, field)):
        warnings.warn(one, ImportDoubt, stacklevel=3)


def _elsewhere(known: Records, field: Field) -> list[str]:
    """Return what to say of records that lie elsewhere, or nobody knows where.

    Not where all do: `prior_chance` refuses these.
    """
    placed = ~np.asarray(np.isnan(known.lonlat).any(axis=1))
    split = near_plot(known.take(placed), field)
    if not len(split.inside):
        return []
    turned_m = distance_m(split.outside.lonlat[:, ::-1], field)
    doubts = [*split.messages(field.name), *doubt_of_order(split.outside_m, turned_m)]
    said = [doubt.sentence for doubt in doubts]
    if n := int(np.count_nonzero(~placed)):
        said.append(f"{n} of the {len(known)} records have no position and are left out.")
    if n := int(np.count_nonzero(split.inside.accuracy_m > _ROUGHEST_M)):
        said.append(
            f"{n} of the {len(known)} records are placed no better than to {_ROUGHEST_M:g} m and "
            "say nothing, or hardly anything, of single plants. Give accuracy_m in metres."
        )
    return said


def records_on_plot(records: Records, field: Field) -> Records:
    """Return the records on a plot or close by; those far from it are not even measured."""
    west, south, east, north = field.boundary.bounds
    reach_deg = 1.2 * records.reach_m() / _DEGREE_M
    widest_deg = reach_deg / max(np.cos(np.deg2rad(max(abs(south), abs(north)))), 0.01)
    lon, lat = records.lonlat.T
    middle, half = (west + east) / 2, (east - west) / 2
    off_deg = np.abs((lon - middle + 180.0) % 360.0 - 180.0)
    close = (off_deg <= half + widest_deg) & (lat >= south - reach_deg) & (lat <= north + reach_deg)
    return near_plot(records.take(close), field).inside


def of_plot(records: Records, field: Field) -> tuple[Records, list[ImportMessage]]:
    """Return the records of one plot; ask or refuse where not one is there."""
    records, corners = without_corners(records, (field,))
    split = near_plot(records, field)
    if len(split.inside):
        beyond = split.outside.lonlat
        doubts = doubt_of_order(split.outside_m, distance_m(beyond[:, ::-1], field))
        return split.inside, [*corners, *split.messages(field.name), *doubts]
    nearest = distance_figure(split.outside_m.min())
    swapped_m = distance_m(records.lonlat[:, ::-1], field)
    if np.median(swapped_m) < min(10_000.0, 0.01 * float(np.median(split.outside_m))):
        raise ChoiceNeeded(
            worded(
                "Records must lie on plot {name} or near it, but the nearest is {nearest} "
                "away. With longitude and latitude exchanged they would be {far} away: "
                "exchange them if that is right.",
                name=field.name,
                nearest=nearest,
                far=distance_figure(float(swapped_m.min())),
            ),
            "swap_axes",
            ("yes",),
        )
    raise ObservationError(
        worded(
            "Records must lie on plot {name} or near it, but the nearest of {n} is "
            "{nearest} away. Check the choice of plot, the coordinate system and the order "
            "of longitude and latitude.",
            name=field.name,
            n=len(records),
            nearest=nearest,
        )
    )


def without_corners(
    records: Records, fields: Sequence[Field]
) -> tuple[Records, list[ImportMessage]]:
    """Return the records besides the corners of plots, in a file that holds both.

    Of each plot all are left out, or none; none at all where they are not fewer than the others.
    """
    xy, of = shapely.get_coordinates([one.boundary for one in fields], return_index=True)
    corners, number = np.unique(xy, axis=0, return_inverse=True)
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    away_deg, nearest = cKDTree(corners).query(records.lonlat)
    met, number = away_deg < _SAME_DEG, number.ravel()
    missed = ~np.isin(number, nearest[met])
    met &= np.isin(nearest, number[~np.isin(of, of[missed])])
    n = int(np.count_nonzero(met))
    if n == 0 or 2 * n >= len(met):
        return records, []
    said = worded("{n} records are the corners of plots and were left out.", n=n)
    if len(fields) == 1:
        said = worded("{n} records are the corners of the plot and were left out.", n=n)
    return records.take(~met), [dropped(said)]


def on_other_plots(
    records: Records, field: Field, others: Iterable[Field]
) -> ObservationError | None:
    """Return what to say where records lie on other plots of the same file; None: on none."""
    known = [other for other in others if other.name != field.name]
    tree = shapely.STRtree([each.boundary for each in known])
    record, plot = tree.query(shapely.points(records.lonlat), predicate="intersects")
    on = np.bincount(plot, minlength=len(known))
    # what lies on a plot is of none of its neighbours
    beside = records.take(~np.isin(np.arange(len(records)), record))
    counts = {
        each.name: int(lying) + len(records_on_plot(beside, each))
        for each, lying in zip(known, on, strict=True)
    }
    most_first = sorted((name for name in counts if counts[name]), key=lambda name: -counts[name])
    if not most_first:
        return None
    named = [f"{name} ({counts[name]})" for name in most_first]
    return ObservationError(
        worded(
            "Records must lie on plot {name} or near it, but none of these {n} does. On other "
            "plots of the file, or near them, lie: {some}. Choose one of those, or records of "
            "{name}.",
            name=field.name,
            n=len(records),
            some=first_few(named),
        )
    )


def plants_on(measured: Plants, field: Field, far: str | None = None) -> Imported[Plants]:
    """Return which measured plants are those of a plot, see `PlantsOutside`."""
    split = PlantsOutside.of(measured.lonlat, field, far)
    messages = []
    if said := split.of_left_out():
        messages.append(dropped(said, remedy=Remedy("far", "keep", worded("Keep them"))))
    if beside := split.of_beside():
        # beside plants of other plots they may be of those, too
        say = doubtful if said else seen
        messages.append(say(beside, remedy=Remedy("far", "drop", worded("Leave them out"))))
    return Imported(measured.take(~split.left_out), tuple(messages))


def on_plants(records: Records, grid: PlantGrid) -> list[ImportMessage]:
    """Return what to say about records that cannot be told a plant of their own.

    A record belongs to the nearest plant within half a row and its own accuracy.
    """
    away = nearest_plants(grid, records.lonlat, NEARBY_M)[1]
    own_m = np.nan_to_num(records.accuracy_m)
    beside = (away > grid.row_spacing_m / 2 + own_m) & np.isfinite(away)
    rough = np.isfinite(away) & ~beside & (own_m > grid.plant_spacing_m)
    messages = []
    if beside.any():
        messages.append(
            doubtful(
                worded(
                    "{n} {n:record lies|records lie} on no plant: {away} from the nearest. "
                    "{n:It counts|They count} for plants nearby, if there are any, but "
                    "{n:belongs|belong} to no single one.",
                    n=int(beside.sum()),
                    away=between_m(away[beside]),
                )
            )
        )
    if rough.any():
        messages.append(
            seen(
                worded(
                    "{n} {n:record is|records are} placed to {far} while plants stand "
                    "{plant_spacing_m:g} m "
                    "apart: {n:it counts|they count} for the nearest plant and for those "
                    "around it.",
                    n=int(rough.sum()),
                    far=distance_figure(float(np.median(own_m[rough]))),
                    plant_spacing_m=grid.plant_spacing_m,
                )
            )
        )
    return messages


def doubt_of_order(
    here_m: NDArray[np.float64], exchanged_m: NDArray[np.float64]
) -> list[ImportMessage]:
    """Return a doubt where positions would fit the plot better with their axes exchanged.

    Parameters
    ----------
    here_m, exchanged_m
        ``(k,)`` how far each lies from the plot as it is, and with its axes exchanged.
    """
    odd = (here_m > 10_000) & (exchanged_m < 1000)
    if not odd.any():
        return []
    return [
        doubtful(
            worded(
                "{n} {n:record|records} would lie on the plot with longitude and latitude "
                "exchanged. "
                "Check their order.",
                n=int(odd.sum()),
            ),
            remedy=Remedy("swap_axes", "yes", worded("Exchange longitude and latitude")),
        )
    ]
