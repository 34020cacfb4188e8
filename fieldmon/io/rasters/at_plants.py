"""What rasters say of a plot's plants: their risk, and which of them are not there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import joined, share_figure, worded
from fieldmon.infestation.prior.raster_risk import RELATIVE, meaning_of, risk_chance
from fieldmon.io.import_report import doubtful, seen
from fieldmon.io.options import source_name
from fieldmon.io.rasters.read import read_raster
from fieldmon.io.rasters.shared_values import doubts_of_alike

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.prior.raster_risk import RiskSettings
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import Source
    from fieldmon.io.rasters.values import How, RasterOptions
    from fieldmon.plot.plot import Plot

    Floats = NDArray[np.float64]

# a raster of chances seldom has more than this share infested; of other numbers many would
_MUCH = 0.2
# of risks, the plants of the lowest or highest value come first: few of them matter
_FEW = 0.01


def read_risk(
    source: Source,
    options: RasterOptions,
    plot: Plot,
    settings: RiskSettings | None,
    how: How | None = None,
) -> Imported[Floats]:
    """Return the risk of each plant ``(n,)``, NaN where the raster says nothing.

    Raise what `read_raster` raises, `ObservationError` if values are not what they are said to
    mean, and `ChoiceNeeded` if neither `settings` nor the file says what that is. A plant's value
    is the mean on its ground unless `how` says otherwise.
    """
    read = read_raster(source, options, plot.field, plot.grid.lonlat())
    values = read.value.of_plants(plot.grid, how or "mean")
    settings = settings or meaning_of(source_name(source), values, read.value.described)
    chance = risk_chance(values, settings)
    low, high, mean = np.nanmin(chance), np.nanmax(chance), np.nanmean(chance)
    said = worded(
        "Risk by {meaning}: {low:.3g} to {high:.3g}, {mean:.3g} on average",
        meaning=settings.meaning,
        low=low,
        high=high,
        mean=mean,
    )
    told = [seen(joined("", (said, _unseen(chance, worded("and have no risk by it")))))]
    absolute = settings.meaning not in RELATIVE
    if absolute and mean > _MUCH:
        much = worded(
            "By it alone {share} of all plants are infested: check that its numbers are chances, "
            "and no index, order or score.",
            share=share_figure(float(mean)),
        )
        told.append(doubtful(much))
    if settings.meaning == "percent" and 0.0 < 100.0 * high < 1.0:
        small = worded(
            "All its percents are below 1: check that they are no chances from 0 to 1 (meaning "
            "chance), and no index."
        )
        told.append(doubtful(small))
    told += doubts_of_alike(values, read.value, plot.grid, _FEW, zero_is_none=absolute)
    return read.having(chance, told)


def read_missing(
    source: Source,
    options: RasterOptions,
    plot: Plot,
    below: float,
    how: How | None = None,
) -> Imported[NDArray[np.bool_]]:
    """Return which plants are not there ``(n,)``: where the canopy is below a value.

    Plants that the raster does not show count as there. A plant's value is the highest on its
    ground unless `how` says otherwise. Raise what `read_raster` raises.
    """
    read = read_raster(source, options, plot.field, plot.grid.lonlat())
    values = read.value.of_plants(plot.grid, how or "highest")
    missing = values < below
    said = worded(
        "{n} of {total} plants are missing (canopy below {below:g})",
        n=int(missing.sum()),
        total=len(missing),
        below=below,
    )
    told = [seen(joined("", (said, _unseen(values, worded("and count as there")))))]
    return read.having(missing, [*told, *doubts_of_alike(values, read.value, plot.grid, _MUCH)])


def _unseen(values: Floats, what: str) -> str:
    unseen = int(np.isnan(values).sum())
    if not unseen:
        return worded(".")
    return worded("; {n} have no value on the raster {what}.", n=unseen, what=what)
