"""A field with its plants and the ways between them: what everything else is worked out on."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from math import isclose
from typing import TYPE_CHECKING, Literal

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.compute.arguments import must_be
from fieldmon.compute.array_arguments import must_be_shaped
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import joined, worded
from fieldmon.errors import ImportDoubt, PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.layout import check_apart, grid_from_plants, lay, planting_in
from fieldmon.plot.line_layout import lay_along
from fieldmon.plot.measured_rows import said_rows
from fieldmon.plot.missing_plants import without
from fieldmon.plot.names_on_ground import doubts_of_order, said_of_strays
from fieldmon.plot.order_in_frame import must_be_lines, nearest_lines, said_of_order
from fieldmon.plot.outline_bearing import doubt_of_bearing
from fieldmon.plot.plant_names import PlantNames, doubts_of_numbers, numbered
from fieldmon.plot.planting import Planting
from fieldmon.plot.plants_outside import PlantsOutside
from fieldmon.plot.polygons import polygons_of
from fieldmon.plot.positions import lonlat_of
from fieldmon.plot.row_detection import frame_around, rows_from_plants
from fieldmon.plot.row_lines import Ground
from fieldmon.plot.row_report import RowReport, row_report
from fieldmon.plot.travel import Aisles
from fieldmon.plot.trees import trees_grid
from fieldmon.plot.way_joining import CutOffError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from geopandas import GeoDataFrame, GeoSeries
    from numpy.typing import NDArray
    from shapely import MultiLineString

    from fieldmon.plot.assumed import Assumed
    from fieldmon.plot.grid import PlantGrid


_LEAST_ROWS = 2


def planting_of(field: Field, **given: float | None) -> Planting:
    """Return how a field is planted: as given by hand, else as the field states, else the default.

    Parameters
    ----------
    field
        Its ``row_bearing_deg``, ``row_spacing_m`` and ``plant_spacing_m`` count where not None.
    given
        Settings of `Planting`; None: not given.
    """
    stated = {
        name: getattr(field, name)
        for name in ("row_bearing_deg", "row_spacing_m", "plant_spacing_m")
    }
    by_hand = {name: value for name, value in given.items() if value is not None}
    known = {name: value for name, value in stated.items() if value is not None} | by_hand
    return Planting(**known)


def _in_rows(
    plants: NDArray[np.float64],
    names: PlantNames,
    field: Field | None,
    planting: Planting | None,
) -> tuple[PlantGrid, RowReport]:
    """Return measured plants in their rows, and how well they stand in them."""
    planting = planting or Planting()
    check_apart(plants)
    rows = rows_from_plants(plants, planting.row_bearing_deg)
    bearing = planting.row_bearing_deg is not None
    said = said_rows(plants, names, field, bearing=bearing).checked(plants)
    grid = grid_from_plants(plants, planting_in(rows, planting), field, said)
    report = row_report(grid, rows, said, planting)
    report = replace(report, strayed=said_of_strays(said.strays, names, plants))
    return numbered(grid, plants, names), report


@checked
@dataclass(frozen=True, eq=False)
class Plot:
    """A field with its plants and the ways between them.

    Parameters
    ----------
    field, aisles
        The field; its plants, and the ways between them.
    assumed
        What was taken for its rows because nobody said it.
    rows
        How well its measured plants stand in rows; None where plants were laid, or read back.
    headland_m
        Metres at both row ends that were kept free as it was laid; None: nothing is known of it.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> plot.n_plants, plot.grid.n_rows, plot.grid.xy_m.shape
    (3825, 45, (3825, 2))
    """

    field: Field
    aisles: Aisles
    assumed: tuple[Assumed, ...] = ()
    rows: RowReport | None = None
    headland_m: float | None = None

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A plot's")

    def __repr__(self) -> str:
        return f"<Plot {self.field.name}: {self.grid.counts}>"

    @property
    def grid(self) -> PlantGrid:
        """Return the plants."""
        return self.aisles.grid

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return what to look at before rows of measured plants are used; empty: nothing."""
        if self.rows is None or not self.grid.in_rows:
            return ()
        return (*self.rows.doubts, *doubts_of_numbers(self.grid), *doubts_of_order(self.grid))

    @property
    def chosen(self) -> tuple[str, ...]:
        """Return which spacings, by name, somebody said: neither assumed nor as files have them."""
        assumed = {one.setting for one in self.assumed}
        names = ("row_spacing_m", "plant_spacing_m")
        return tuple(name for name in names if name not in assumed and not self._has(name))

    def _has(self, spacing: str) -> bool:
        """Return whether the plot's files have a spacing: plants, rows, blocks or words of them."""
        field = self.field
        if field.plants is not None:
            return True
        if spacing == "row_spacing_m" and len(field.row_lines.geoms) > 1:
            return True
        if field.blocks and all(getattr(one, spacing) is not None for one in field.blocks):
            return True
        stated = getattr(field, spacing)
        return stated is not None and isclose(stated, getattr(self.grid, spacing))

    @classmethod
    def of(cls, field: Field, planting: Planting | None = None) -> Plot:
        """Take a field's measured plants, or lay some, and find the ways between them.

        Parameters
        ----------
        field
            The plot as it is known; its plants stand where they were measured, if they were.
        planting
            Bearing, spacings and headland; None: what the field states, else the defaults.

        Warns
        -----
        ImportDoubt
            Where rows are laid along the longest side of a ragged outline, and may run otherwise.

        Raises
        ------
        PlotError
            If there is no room for a plant, or no way to a row.
        """
        _warn_of(_doubts_of_bearing(field, planting))
        return plot_of(field, planting)

    @classmethod
    def around(
        cls,
        name: str,
        plants: NDArray[np.float64],
        planting: Planting | None = None,
        gate: tuple[float, float] | None = None,
        names: PlantNames | None = None,
    ) -> Plot:
        """Return the plot of measured plants whose boundary nobody drew.

        Parameters
        ----------
        name
            What to call it.
        plants
            ``(n, 2)`` degrees, longitude first, in any order: the plot numbers them along its
            rows, and `order_in` says which of them each plant is.
        planting
            Bearing and headland; None: found from the plants, as their spacings always are.
        gate
            ``(lon, lat)`` where days start and end; None: the nearest row end.
        names
            Of each plant, its row and its block, where these are known.

        Warns
        -----
        ImportDoubt
            For each of `doubts`, and where plants are numbered in another order than given.

        Raises
        ------
        PlotError
            If two plants are in one place, or no rows can be found.
        """
        plot = plot_around(name, plants, planting, gate, names)
        _warn_of((*plot.doubts, *said_of_order(plot.grid, lonlat_of("Plants", plants), "plants")))
        return plot

    @classmethod
    def of_trees(cls, field: Field) -> Plot:
        """Take a field's measured plants as they stand, in no rows, and the ways among them.

        Raise `PlotError` where none were measured: what is laid stands in rows.
        """
        if field.plants is None:
            raise PlotError(
                worded(
                    "Plants in no rows must be measured, but of plot {name!r} nobody gave their "
                    "positions. Give them, or let plants be laid in rows.",
                    name=field.name,
                )
            )
        check_apart(field.plants)
        return cls._with(field, trees_grid(field.plants, field))

    @classmethod
    def among(
        cls, name: str, plants: NDArray[np.float64], gate: tuple[float, float] | None = None
    ) -> Plot:
        """Return the plot called `name` of measured plants in no rows, whose boundary nobody drew.

        `plants` are ``(n, 2)`` degrees, in any order: `order_in` says which of them each plant of
        the plot is, and `ImportDoubt` warns where they are numbered otherwise. `gate` is ``(lon,
        lat)``. Raise `PlotError` where two plants are in one place.
        """
        plot = plot_among(name, plants, gate)
        _warn_of(said_of_order(plot.grid, lonlat_of("Plants", plants), "plants"))
        return plot

    @classmethod
    def along(
        cls,
        name: str,
        rows: MultiLineString,
        planting: Planting | None = None,
        gate: tuple[float, float] | None = None,
    ) -> Plot:
        """Return the plot of rows drawn as lines, lon/lat, whose boundary nobody drew.

        Parameters
        ----------
        name
            What it is called.
        rows
            A line a row, degrees.
        planting
            Spacings, headland and faces; None: the usual ones.
        gate
            ``(lon, lat)`` where days start and end; None: the nearest row end.

        Raises
        ------
        PlotError
            Of a single row: how far its copies reach is not known then.
        """
        if len(rows.geoms) < _LEAST_ROWS:
            raise PlotError(
                worded(
                    "Rows without a plot must be two or more, but {name!r} has {n}. Give the "
                    "plot's boundary: it tells how far the copies of one row reach.",
                    name=name,
                    n=len(rows.geoms),
                )
            )
        planting = planting or Planting()
        frame = frame_around(shapely.get_coordinates(rows))
        lines = [frame.xy_m(shapely.get_coordinates(line)) for line in rows.geoms]
        grid = lay_along(name, frame, lines, Ground(None, MultiPolygon()), planting)
        boundary = _outline(grid)
        field = Field(name, boundary, gate=gate, row_lines=rows)
        return replace(cls._with(field, grid), headland_m=planting.headland_m)

    @classmethod
    def from_geopandas(
        cls,
        frame: GeoDataFrame | GeoSeries,
        planting: Planting | None = None,
        name: str = "plot",
        gate: tuple[float, float] | None = None,
        far: Literal["keep", "drop"] | None = None,
    ) -> Plot:
        """Return the plot whose area, measured plants, or both are in a GeoDataFrame.

        Parameters
        ----------
        frame
            One polygon, points, or both, in any coordinate system; rows are found from the points,
            or laid in the polygon. Plants are numbered along rows, whatever the order of the
            points: `order_in` brings other columns over. Columns ``row``, ``number`` (or ``plant``)
            and ``block`` say what points are called; they are recognised as those of a file of
            plants are (``Row``, ``Reihe``), and other names than these are said. A column ``face``
            of 1 and 2, as `to_geopandas` has it, or a and b, says whether both faces are inspected:
            of all plants, or of all but those that look at no other row.
        planting
            Bearing, spacings and headland; None: the defaults (rows 4 m and plants 3 m apart, along
            the longest side). Points keep their own spacings, and their bearing unless it is said.
        name
            What the plot is called.
        gate
            ``(lon, lat)`` where days start and end; None: the nearest row end.
        far
            Points more than 5 m outside the polygon are left out; ``"keep"``: they stay;
            ``"drop"``: all outside are left out.

        Warns
        -----
        ImportDoubt
            Of lines without a place, of points that are left out, of columns that were taken for
            names, of rows along a ragged outline, of plants that are numbered in another order than
            the points, and for each of `doubts`.

        Raises
        ------
        SettingError
            If the frame has no coordinate system, or one that does not lead to WGS84.
        PlotError
            If it holds no area and no point, several areas, one that crosses itself, no room for a
            plant, or both faces of other plants.

        Examples
        --------
        >>> import geopandas, fieldmon as fm
        >>> estate = geopandas.read_file("sample_data/paran_estate.geojson")
        >>> gate = estate[estate["name"] == "Gate"]
        >>> fm.Plot.from_geopandas(gate, fm.Planting(row_spacing_m=4, plant_spacing_m=3)).n_plants
        3825
        """
        from fieldmon.plot.frames import (  # noqa: PLC0415 - loads GeoPandas
            boundary_and_plants,
            faces_in,
        )

        frame, planting, faces = faces_in(frame, planting)
        boundary, plants, names, said = boundary_and_plants(frame)
        if boundary is None:
            plot = plot_around(name, plants, planting, gate, names)
        elif not len(plants):
            field = Field(name, boundary, gate=gate)
            plot = plot_of(field, planting)
            said += _doubts_of_bearing(field, planting)
        else:
            field = Field(name, boundary, gate=gate)
            outside = PlantsOutside.of(plants, field, far)
            if left_out := outside.of_left_out():
                keeps = "" if far else ' (far="keep" keeps them.)'
                said += [left_out + keeps, outside.of_beside()]
            here = ~outside.left_out
            field = names.take(here).on(replace(field, plants=plants[here]))
            plot = plot_of(field, planting)
        if faces is not None:
            said += faces.doubts(plot.grid)
        if len(plants):
            said += said_of_order(plot.grid, plants)
        _warn_of(one for one in (*said, *plot.doubts) if one)
        return plot

    def to_geopandas(self) -> GeoDataFrame:
        """Return the plants as points, EPSG:4326, with ``plant``, ``row`` and ``number``.

        They lie within ``field.boundary``: across longitude 180, from 0 to 360 as that does.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plants = fm.read_plot("sample_data/paran_estate.zip", feature="Gate").to_geopandas()
        >>> list(plants.columns), plants.crs.to_epsg()
        (['plant', 'row', 'number', 'geometry'], 4326)
        """
        from fieldmon.plot.frames import plant_frame  # noqa: PLC0415 - loads GeoPandas

        return plant_frame(self.grid, boundary=self.field.boundary)

    def order_in(self, given: GeoDataFrame | GeoSeries | NDArray[np.float64]) -> NDArray[np.int64]:
        """Return which line of a frame each plant is ``(n,)``, from 0, by where they stand.

        A column of the frame is brought over with it, also to a plot that was read, or is that of
        a season. Both faces of a plant are one line, unless the frame has a column ``face``.

        Parameters
        ----------
        given
            Points in any coordinate system, or ``(m, 2)`` degrees, longitude first.

        Raises
        ------
        PlotError
            If a plant has no line within 0.5 m, or none of its own.

        Examples
        --------
        >>> import numpy as np, fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> frame = plot.to_geopandas()[::-1].reset_index(drop=True)
        >>> frame["risk"] = np.where(frame["row"] == 45, 0.3, 0.01)
        >>> risk = frame["risk"].to_numpy()[plot.order_in(frame)]
        >>> np.unique(plot.to_geopandas()["row"][risk > 0.1]).tolist()
        [45]
        """
        from fieldmon.plot.frames import PointsOfFrame  # noqa: PLC0415 - loads GeoPandas

        if hasattr(given, "geometry"):
            points = PointsOfFrame.of(given)
        else:
            lonlat = lonlat_of("Plants", given)
            points = PointsOfFrame(lonlat, np.arange(len(lonlat)), np.zeros(len(lonlat), np.int8))
        which, away_m = nearest_lines(self.grid, points.lonlat, points.face)
        must_be_lines(self.grid, points.line[which], away_m)
        return points.line[which]

    @property
    def n_plants(self) -> int:
        """Return the number of plants (of faces, where both faces are inspected)."""
        return len(self.grid)

    def without(self, missing: NDArray[np.bool_]) -> Plot:
        """Return the plot without the plants marked `missing` ``(n,)``, which are not there.

        Raise `SettingError` unless each plant is marked or not.
        """
        must_be_shaped("A plot's", {"missing": (missing, (len(self.grid),))})
        if not missing.any():
            return self
        return replace(
            self._with(self.field, without(self.grid, missing)),
            assumed=self.assumed,
            rows=self.rows,
            headland_m=self.headland_m,
        )

    def with_gate(self, gate: tuple[float, float]) -> Plot:
        """Return the same plot with days that start and end at another `gate`, ``(lon, lat)``."""
        moved = self._with(replace(self.field, gate=gate), self.grid)
        return replace(moved, headland_m=self.headland_m)

    @classmethod
    def _measured(
        cls, field: Field, grid: PlantGrid, rows: RowReport, planting: Planting | None
    ) -> Plot:
        """Return measured plants in their rows; where no way leads to some, say what may be why."""
        try:
            headland_m = (planting or Planting()).headland_m
            return replace(cls._with(field, grid), rows=rows, headland_m=headland_m)
        except CutOffError as error:
            if not (why := rows.may_be_mixed):
                raise
            raise CutOffError(joined(" ", [error.args[0], *why])) from None

    @classmethod
    def _with(cls, field: Field, grid: PlantGrid) -> Plot:
        gate = None if field.gate is None else grid.frame.xy_m(field.gate)[0]
        gate_xy_m = None if gate is None else (float(gate[0]), float(gate[1]))
        return cls(field, Aisles.of(grid, gate_xy_m, grid.frame.geometry_m(field.no_go)))


def _outline(grid: PlantGrid) -> MultiPolygon:
    """Return where one may drive on a plot whose boundary nobody drew, lon/lat.

    Edges that nearly meet in metres may cross once they are rounded to degrees.
    """
    outline = grid.frame.geometry_lonlat(grid.drivable_m)
    if outline.is_valid:
        return outline
    return polygons_of(shapely.make_valid(outline, method="structure", keep_collapsed=False))


def plot_of(field: Field, planting: Planting | None = None) -> Plot:
    """Return `Plot.of` a field, without a warning: imports say its doubts themselves."""
    if not field.in_rows:
        return Plot.of_trees(field)
    if field.plants is not None:
        names = PlantNames.of(field)
        grid, rows = _in_rows(field.plants, names, field, planting)
        return Plot._measured(field, grid, rows, planting)  # noqa: SLF001 - its own module
    planting = planting or planting_of(field)
    plot = Plot._with(field, lay(field, planting))  # noqa: SLF001 - as above
    return replace(plot, headland_m=planting.headland_m)


def _doubts_of_bearing(field: Field, planting: Planting | None) -> list[str]:
    doubt = doubt_of_bearing(field, planting or planting_of(field))
    return [doubt] if doubt else []


def plot_around(
    name: str,
    plants: NDArray[np.float64],
    planting: Planting | None = None,
    gate: tuple[float, float] | None = None,
    names: PlantNames | None = None,
) -> Plot:
    """Return `Plot.around` these plants, without a warning: imports say its doubts themselves."""
    names, plants = names or PlantNames(), lonlat_of("Plants", plants)
    grid, rows = _in_rows(plants, names, None, planting)
    boundary = _outline(grid)
    field = names.on(Field(name, boundary, gate=gate, plants=plants))
    return Plot._measured(field, grid, rows, planting)  # noqa: SLF001 - its own module


def plot_among(
    name: str, plants: NDArray[np.float64], gate: tuple[float, float] | None = None
) -> Plot:
    """Return `Plot.among` these plants, without a warning: imports say their doubts themselves."""
    plants = lonlat_of("Plants", plants)
    check_apart(plants)
    grid = trees_grid(plants)
    field = Field(name, _outline(grid), gate=gate, plants=plants, in_rows=False)
    return Plot._with(field, grid)  # noqa: SLF001 - its own module


def _warn_of(doubts: Iterable[str]) -> None:
    """Warn whoever called a checked method that calls this."""
    for doubt in doubts:
        warnings.warn(doubt, ImportDoubt, stacklevel=4)


def must_be_plot(given: object) -> None:
    """Raise `SettingError` unless this is a `Plot`: plants alone have no ways between them."""
    must_be(
        "A plot must be what read_plot or Plot.from_geopandas returns", given, Plot,
        "Give the plot itself; its plants are plot.grid. Of outlines (read_plots) read one: "
        "read_plot(source, feature=NAME).",
    )  # fmt: skip
