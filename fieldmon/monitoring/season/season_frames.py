"""A season for pandas and GeoPandas, which are loaded when one of these is called."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.monitoring.estimates.day_figures import DayFigures
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.inspecting.certifier_tables import inspections_table, treatments_table
from fieldmon.monitoring.season.season_estimates import SeasonEstimates
from fieldmon.monitoring.season.season_inspections import SeasonInspections
from fieldmon.monitoring.season.season_treatments import SeasonTreatments
from fieldmon.plot.frames import plant_frame

if TYPE_CHECKING:
    from datetime import date

    from geopandas import GeoDataFrame
    from pandas import DataFrame

    from fieldmon.compute.day_arguments import Day


_DEGREES = "EPSG:4326"
# of the table of inspections: where each was, its plant says
_OF_PLANT = {"plot", "date", "row", "row_name", "number", "lon", "lat", "face"}


@checked
class SeasonFrames(SeasonInspections, SeasonTreatments, SeasonEstimates):
    """What a season holds, as frames."""

    def to_geopandas(
        self, of: Literal["inspections", "treatments", "plants"], on: Day | None = None
    ) -> GeoDataFrame:
        """Return what the season holds with its places, EPSG:4326; changing it changes no season.

        Across longitude 180 places run from 0 to 360, as the plot's boundary does.

        Parameters
        ----------
        of
            ``"inspections"``: a point for each that counts, with ``plant`` (number in the grid,
            from 0), ``row`` and ``number`` (from 1), ``date``, ``time``, ``result`` (clean, found
            or skipped), ``count`` (NaN: not counted), ``who``, ``corrected_by``, ``notes`` and
            ``digest``, by which ``fieldmon correct`` knows them.
            ``"treatments"``: the outline of each that counts, with the columns of
            ``fieldmon export --of treatments``.
            ``"plants"``: a point for each plant, with its chance on the ``morning`` and after what
            was recorded, ``evening``: of all infestations, a `DayPlan` of those that can be seen.
        on
            The day of the chances; None: the last on which anything was planned or recorded, but
            today at most. The others are of all days.

        Raises
        ------
        SettingError
            If `on` is before the season, or `of` is something else.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> season = fm.Season.create("frames.gpkg", plot, begins="2026-11-18")
        >>> _ = season.record(fm.Inspections.of([0, 1], [0, 1], "2026-11-18"))
        >>> season.to_geopandas("inspections")[["plant", "row", "number", "result"]].values.tolist()
        [[0, 1, 1, 'clean'], [1, 1, 2, 'found']]
        >>> plants = season.to_geopandas("plants", on="2026-11-18")
        >>> len(plants), bool(plants.evening[1] < plants.morning[1])
        (3825, True)
        """
        if of == "inspections":
            return _inspections(self)
        if of == "treatments":
            return _treatments(self)
        return _plants(self, default_date(self) if on is None else on)

    def to_pandas(self) -> DataFrame:
        """Return a line for each day on which anything was planned or recorded.

        Columns ``date``, ``inspected`` and ``found`` on it, and after its work ``expected``
        infested plants not found yet, between ``low`` and ``high`` (90 %), and ``chance_clean``.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> season = fm.Season.create("days.gpkg", plot, begins="2026-11-18")
        >>> _ = season.record(fm.Inspections.of([0, 1], [0, 1], "2026-11-19"))
        >>> season.to_pandas()[["inspected", "found"]].values.tolist()
        [[0, 0], [2, 1]]
        """
        return _days(self)


def _inspections(season: SeasonInspections) -> GeoDataFrame:
    """Return a point for each inspection that counts, at its plant."""
    import pandas as pd  # noqa: PLC0415 - loaded when it is asked for

    with season.store.one_moment():
        done, table = season.inspections, inspections_table(season)
    frame = plant_frame(season.plot.grid, done.plant, season.plot.field.boundary)
    columns = {name: pd.Series(column) for name, column in table.items() if name not in _OF_PLANT}
    columns = {"date": pd.Series(done.date.astype("datetime64[s]"))} | columns
    columns["count"] = pd.Series(done.count.copy())
    for name, column in columns.items():
        frame.insert(len(frame.columns) - 1, name, column)
    return frame


def _treatments(season: SeasonTreatments) -> GeoDataFrame:
    """Return the outline of each treatment that counts."""
    import geopandas  # noqa: PLC0415 - as above
    import pandas as pd  # noqa: PLC0415

    with season.store.one_moment():
        areas, table = [one.place.area for one in season.treatments()], treatments_table(season)
    frame = geopandas.GeoDataFrame(table, geometry=areas, crs=_DEGREES)
    for day in {"date", "harvest_from", "entry_from"}.intersection(table):
        frame[day] = pd.to_datetime(frame[day])
    return frame


def _plants(season: SeasonEstimates, on: date) -> GeoDataFrame:
    """Return a point for each plant, with its chance on the morning and the evening of a day."""
    with season.store.one_moment():
        chances = {"morning": season.morning(on), "evening": season.evening(on)}
    frame = plant_frame(season.plot.grid, boundary=season.plot.field.boundary)
    for name, chance in chances.items():
        frame.insert(len(frame.columns) - 1, name, chance)
    return frame


def _days(season: SeasonEstimates) -> DataFrame:
    """Return a line for each day on which anything was planned or recorded."""
    import pandas as pd  # noqa: PLC0415 - as above

    days = season.days()
    # a line is of its day
    columns = {
        field.name.removesuffix("_today"): [getattr(day, field.name) for day in days]
        for field in fields(DayFigures)
    }
    dates = pd.Series(np.array(columns.pop("on"), "datetime64[s]"))
    return pd.DataFrame({"date": dates} | columns)
