"""Plots as GeoDataFrames, in and out. GeoPandas is loaded when one of these is called."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyproj
import shapely
from pyproj.exceptions import ProjError
from scipy.spatial import cKDTree
from shapely import MultiPolygon

from fieldmon.compute.arguments import must_be
from fieldmon.compute.rounding_step import step_of
from fieldmon.compute.wording import counted, first_few
from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.grid import block_number, plant_numbers
from fieldmon.plot.near_doubles import near_doubles
from fieldmon.plot.plant_columns import plain, plant_columns
from fieldmon.plot.plant_names import PlantNames, faces_called
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import goes_round, metres_per_unit
from fieldmon.plot.rounding import doubts_of_rounding

if TYPE_CHECKING:
    from geopandas import GeoDataFrame, GeoSeries
    from numpy.typing import NDArray
    from pandas import Series

    from fieldmon.plot.grid import PlantGrid

_DEGREES = "EPSG:4326"
# columns as `plant_frame` has them
_OWN = frozenset({"block", "row", "row_name", "number", "plant"})
# no plot reaches so far
_NEAR_180 = 175.0


def plant_frame(
    grid: PlantGrid,
    plants: NDArray[np.integer] | None = None,
    boundary: MultiPolygon | None = None,
) -> GeoDataFrame:
    """Return the given plants ``(k,)``, or all, as points in EPSG:4326.

    Across longitude 180 they lie in one piece: within the `boundary` as it is drawn; where it is
    not told, from 0 to 360.

    Columns ``plant`` (number in the grid, from 0), ``block`` where there are several, ``row`` and
    ``number`` (from 1; in no rows there is no ``row``), ``row_name`` where the plot's file has
    names of rows that say more than their numbers, and ``face`` (1 or 2) where both faces are
    inspected.
    """
    import geopandas  # noqa: PLC0415 - half a second to import

    chosen = np.arange(len(grid)) if plants is None else np.asarray(plants, np.int64)
    numbered = plant_numbers(grid, chosen)
    block = {"block": block_number(grid, chosen)} if grid.n_blocks > 1 else {}
    row: dict[str, object] = {"row": numbered.line} if grid.in_rows else {}
    if row and grid.row_names:
        row["row_name"] = [grid.row_names.get(line, "") for line in numbered.line.tolist()]
    columns = {"plant": chosen, **block, **row, "number": numbered.number}
    twin = grid.twin[chosen]
    if grid.has_faces:
        columns["face"] = np.where(twin < 0, 1, np.where(chosen < twin, 1, 2))
    lon, lat = grid.lonlat(chosen).T
    lon = _in_one_piece(lon, grid, boundary)
    return geopandas.GeoDataFrame(
        columns, geometry=geopandas.points_from_xy(lon, lat), crs=_DEGREES
    )


def _in_one_piece(
    lon: NDArray[np.float64], grid: PlantGrid, boundary: MultiPolygon | None
) -> NDArray[np.float64]:
    """Return longitudes of a plot's plants so that all that belongs to it lies in one piece."""
    if boundary is None:
        across = abs(grid.frame.lon) > _NEAR_180 and goes_round(grid.lonlat()[:, 0])
        return lon % 360.0 if across else lon
    west, _, east, _ = boundary.bounds
    if west >= -180.0 and east <= 180.0:
        return lon
    turned: NDArray[np.float64] = lon + 360.0 * np.round(((west + east) / 2 - lon) / 360.0)
    return turned


class FacesOfFrame(NamedTuple):
    """Which plants of a frame have both faces in it, and whether its planting was said besides."""

    lonlat: NDArray[np.float64]
    both: NDArray[np.bool_]
    planting: Planting | None

    def __repr__(self) -> str:
        """Say of how many plants."""
        return f"<FacesOfFrame: both of {int(self.both.sum())} of {len(self.both)} plants>"

    def doubts(self, grid: PlantGrid) -> list[str]:
        """Return what to say where the faces that are made are others than the frame's.

        Raises
        ------
        PlotError
            If nobody said the planting: they would be made up, or dropped.
        """
        n_both, n_one = int(self.both.sum()), int((~self.both).sum())
        one = f" and one face of {n_one:,}" if n_one else ""
        found = f"The GeoDataFrame has both faces of {counted(n_both, 'plant')}{one}"
        if self.planting is not None and self.planting.faces == 1:
            keep = "Say Planting(faces=2, ...) to keep both."
            return [f"{found}, but one is inspected by the planting. {keep}"]
        made = grid.twin >= 0
        if (self.both[cKDTree(self.lonlat).query(grid.lonlat())[1]] == made).all():
            return []
        if self.planting is not None:
            return [f"{found}, but the planting says of which plants both are inspected."]
        raise PlotError(
            f"Both faces must be there of all plants, or of all but those that look at no other "
            f"row. {found}. Keep both faces of each plant, or one line of each, "
            'gdf.drop_duplicates("geometry"), and say Planting(faces=2) if both are inspected.'
        )


def faces_in(
    frame: GeoDataFrame | GeoSeries, planting: Planting | None
) -> tuple[GeoDataFrame | GeoSeries, Planting | None, FacesOfFrame | None]:
    """Return a frame with each plant once, of whose faces its column ``face`` tells.

    And a planting of both faces where none was given, and which plants have both; None: none has.
    """
    held = [name for name in getattr(frame, "columns", ()) if isinstance(name, str)]
    column = next((name for name in held if plain(name) == "face"), None)
    if column is None:
        return frame, planting, None
    _must_say_where(frame)
    placed = _placed(frame.geometry.to_numpy())
    face = np.where(placed, faces_called(map(_written, frame[column].tolist())), 0)
    of_face: tuple[dict[bytes, int], ...] = ({}, {}, {})
    for i, place in enumerate(frame.geometry.to_wkb().tolist()):
        of_face[face[i]].setdefault(place, i)
    both = of_face[1].keys() & of_face[2].keys()
    if not both:
        return frame, planting, None
    has_both, kept = np.zeros(len(frame), np.bool_), np.ones(len(frame), np.bool_)
    has_both[[of_face[1][place] for place in both]] = True
    kept[[of_face[2][place] for place in both]] = False
    outer = bool(has_both[kept & (face > 0)].all())
    shapes = frame.geometry.to_crs(_DEGREES)
    points = kept & placed & shapes.geom_type.isin(["Point", "MultiPoint"]).to_numpy()
    lonlat, which = shapely.get_coordinates(shapes.to_numpy()[points], return_index=True)
    of_frame = FacesOfFrame(lonlat, has_both[points][which], planting)
    return frame[kept], planting or Planting(faces=2, outer_faces=outer), of_frame


class PointsOfFrame(NamedTuple):
    """The points of a frame ``(m,)``: where each is, its line of the frame, and its face or 0."""

    lonlat: NDArray[np.float64]
    line: NDArray[np.int64]
    face: NDArray[np.integer]

    def __repr__(self) -> str:
        """Say how many."""
        return f"<PointsOfFrame: {len(self.line):,} points>"

    @classmethod
    def of(cls, frame: GeoDataFrame | GeoSeries) -> PointsOfFrame:
        """Take a frame's points; raise `PlotError` if it holds none."""
        _must_say_where(frame)
        kinds = frame.geometry.geom_type.isin(["Point", "MultiPoint"]).to_numpy()
        there = np.flatnonzero(_placed(frame.geometry.to_numpy()) & kinds)
        if not len(there):
            raise PlotError("The plants of a GeoDataFrame must be points, but it holds none.")
        places = frame.geometry.iloc[there].to_crs(_DEGREES).to_numpy()
        lonlat, which = shapely.get_coordinates(places, return_index=True)
        line = there[which]
        held = [name for name in getattr(frame, "columns", ()) if isinstance(name, str)]
        column = next((name for name in held if plain(name) == "face"), None)
        if column is None:
            return cls(lonlat, line, np.zeros(len(line), np.int8))
        return cls(lonlat, line, faces_called(map(_written, frame[column].iloc[line].tolist())))


def boundary_and_plants(
    frame: GeoDataFrame,
) -> tuple[MultiPolygon | None, NDArray[np.float64], PlantNames, list[str]]:
    """Return the area of a frame, if it has one, its points ``(n, 2)``, and what these are called.

    And what there is to say of its lines that have no place.

    Places are in degrees WGS84. Names are those of its columns ``row`` (or ``row_name``, where that
    says something), ``number`` or else ``plant``, and ``block``, as `plant_frame` has them, or as
    files of plants call these.

    Raises
    ------
    SettingError
        If the frame has no coordinate system, or one that does not lead to WGS84.
    PlotError
        If it is empty, holds several areas, one that crosses itself, or anything but areas and
        points.
    """
    _must_say_where(frame)
    there = np.flatnonzero(_placed(frame.geometry.to_numpy()))
    shapes = frame.geometry.iloc[there].to_crs(_DEGREES)
    kinds = shapes.geom_type.str.removeprefix("Multi")
    boundary, points = _area_of(shapes, kinds), shapes[kinds == "Point"]
    places = points.to_numpy()
    which = np.repeat(there[kinds == "Point"], shapely.get_num_coordinates(places))
    names, of_names = _names_in(frame, which)
    said = [*_of_no_place(frame, there), *of_names]
    xy = shapely.get_coordinates(frame.geometry.iloc[there][kinds == "Point"].to_numpy())
    lonlat = shapely.get_coordinates(places)
    step_m = step_of(xy) * metres_per_unit(frame.crs)
    said += doubts_of_rounding(lonlat, step_m, names.row, PlotError)
    if doubles := near_doubles(lonlat):
        said.append(doubles.sentence)
    return boundary, lonlat, names, said


def _must_say_where(frame: GeoDataFrame | GeoSeries) -> None:
    """Raise `SettingError` unless this is a frame whose geometry has a coordinate system."""
    import geopandas  # noqa: PLC0415 - as above

    must_be(
        "A plot's area and plants must be a GeoDataFrame", frame,
        (geopandas.GeoDataFrame, geopandas.GeoSeries),
        "Make one: geopandas.GeoDataFrame(df, geometry=..., crs=4326), or read a file with it.",
    )  # fmt: skip
    if isinstance(frame, geopandas.GeoDataFrame) and frame.active_geometry_name is None:
        raise SettingError(
            "A GeoDataFrame must say which column holds its geometry, but none is set. "
            'Set it first: gdf.set_geometry("geometry"), for instance.'
        )
    if frame.crs is None:
        raise SettingError(
            "A GeoDataFrame must say its coordinate system, but its crs is None. "
            "Set it first: gdf.set_crs(4326), for instance."
        )
    try:
        pyproj.Transformer.from_crs(frame.crs, _DEGREES)
    except ProjError:
        raise SettingError(
            "The coordinate system of a GeoDataFrame must lead to WGS84, but PROJ finds no way "
            f"from {frame.crs.name!r}. Say in which its coordinates are: "
            "gdf.set_crs(2039, allow_override=True), for instance."
        ) from None
    placed = frame.geometry.to_numpy()[_placed(frame.geometry.to_numpy())]
    if frame.crs.is_geocentric and not shapely.has_z(placed).all():
        raise SettingError(
            f"Positions in {frame.crs.name!r}, measured from the middle of the earth, must have x, "
            "y and z, but those of the GeoDataFrame have no z. Give their heights, too, or say in "
            "which coordinate system they are: gdf.set_crs(2039, allow_override=True), for "
            "instance."
        )


def _area_of(shapes: GeoSeries, kinds: Series) -> MultiPolygon | None:
    """Return the one area among shapes; raise `PlotError` for several, or for other kinds."""
    areas = shapes[kinds == "Polygon"]
    if not len(shapes) or not kinds.isin(["Polygon", "Point"]).all():
        found = ", ".join(sorted(set(kinds))) or "nothing"
        raise PlotError(
            f"A plot must be an area, measured plants as points, or both, but the GeoDataFrame "
            f"holds {found}."
        )
    if len(areas) > 1:
        raise PlotError(
            f"One area must be the plot, but the GeoDataFrame holds {len(areas)}. Choose a row, "
            "gdf.iloc[[0]], or join its parts, gdf.dissolve()."
        )
    if not len(areas):
        return None
    area = MultiPolygon(list(shapely.get_parts(areas.iloc[0])))
    if not area.is_valid:
        reason, _, at = shapely.is_valid_reason(area).rstrip("]").partition("[")
        where = " / ".join(f"{float(one):.6f}" for one in at.split()[:2])
        raise PlotError(
            "The area of a plot must be one that can be walked round, but that of the "
            f"GeoDataFrame is not valid: {reason.lower()} at {where}. Look at what "
            "gdf.set_geometry(gdf.make_valid()) makes of it, or draw it again."
        )
    return area


def _placed(shapes: NDArray[np.object_]) -> NDArray[np.bool_]:
    """Return which shapes are anywhere: there, not empty, no point at NaN."""
    # NaN of what is not there or empty, too
    placed: NDArray[np.bool_] = np.isfinite(shapely.bounds(shapes).sum(axis=1))
    return placed


def _of_no_place(frame: GeoDataFrame | GeoSeries, there: NDArray[np.intp]) -> list[str]:
    """Return what to say of lines that have no place: plants get no number of theirs."""
    gone = np.setdiff1d(np.arange(len(frame)), there)
    if not len(gone):
        return []
    named = first_few([str(one) for one in frame.index[gone]])
    n = f"{len(gone)} of {len(frame)}"
    return [f"Lines of the GeoDataFrame without a place were left out: {n} ({named})."]


def _names_in(
    frame: GeoDataFrame | GeoSeries, which: NDArray[np.intp]
) -> tuple[PlantNames, list[str]]:
    """Return what the columns of a frame call the points in these lines of it, ``(n,)``.

    And what there is to say of these columns.
    """
    import pandas as pd  # noqa: PLC0415 - as above

    held = [*dict.fromkeys(one for one in getattr(frame, "columns", ()) if isinstance(one, str))]
    if not held or not len(which):
        return PlantNames(), []

    @cache
    def cells(name: str) -> list[str]:
        column = frame.iloc[:, int(np.argmax(frame.columns == name))]
        return ["" if pd.isna(one) else _written(one) for one in column.iloc[which].tolist()]

    def called(name: str | None) -> NDArray[np.str_] | None:
        return None if name is None or not any(cells(name)) else np.array(cells(name), np.str_)

    names = [name for name in held if name != frame.active_geometry_name]
    label = next((name for name in names if plain(name) == "rowname"), None)
    columns = plant_columns(names, cells)
    if columns.row is None and label is not None:
        columns = plant_columns(names, cells, {"row": label})
    row, labelled = called(columns.row), called(label)
    if row is not None and labelled is not None:
        row = np.where(labelled == "", row, labelled)
    block, plant = called(columns.block), called(columns.plant)
    said = [*columns.doubts]
    if _over_rows(row, plant) and plain(str(columns.plant)) == "plant":
        plant = None
        said.append(
            f"The column {columns.plant} counts the plants of all rows on, from 0, as "
            "Plot.to_geopandas does: it was not taken for their numbers within their rows. Keep "
            "its column number, too."
        )
    taken = {"blocks": (columns.block, block), "rows": (columns.row, row),
             "plants": (columns.plant, plant)}  # fmt: skip
    by = {what: name for what, (name, called_so) in taken.items() if called_so is not None}
    if not _OWN.issuperset(by.values()):
        said.append(
            "Names were taken from columns of the GeoDataFrame: "
            f"{', '.join(f'{what} from {name!r}' for what, name in by.items())}. Leave a column "
            "out, or call it something else, if it means something else."
        )
    return PlantNames(row, block, plant), said


def _over_rows(row: NDArray[np.str_] | None, plant: NDArray[np.str_] | None) -> bool:
    """Return whether plants are called as a grid counts them: from 0 on over several rows."""
    if row is None or plant is None or len(np.unique(row)) == 1:
        return False
    if not np.char.isdecimal(plant).all():
        return False
    counted = np.unique(plant.astype(np.int64))
    # second faces may have been left out of them
    return len(counted) == len(plant) and counted[0] == 0 and counted[-1] < 2 * len(plant)


def _written(name: object) -> str:
    """Return a name as a file would have it: 7.0 is 7."""
    return f"{name:.15g}" if isinstance(name, float) else str(name).strip()
