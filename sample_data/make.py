"""Draw the made-up sample estate: `python sample_data/make.py [FOLDER]`.

Nothing here exists. The plots are laid on open ground by Paran in the Arava, because the work that
fieldmon builds on was done there; shapes, names, records and the picture are drawn by this script
from one seed. Shapes are given in estate metres: x runs along the estate's common bearing, y to
the left of it, and the origin is the south-western corner of the plot *Gate*.
"""

from __future__ import annotations

import csv
import json
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from datetime import date, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

import geopandas as gpd
import numpy as np
import rasterio
import shapely
from rasterio.features import rasterize
from rasterio.transform import from_origin
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.affinity import affine_transform

if TYPE_CHECKING:
    from affine import Affine
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

SEED = 2026
ISRAELI_GRID = "EPSG:2039"
ORIGIN_M = (213600.0, 473200.0)
# grid north is 0.03 degrees off true north here: less than the bearings are rounded to
ESTATE_BEARING_DEG = 68.0
NOTE = "made up for fieldmon; no such plot exists"
SAVED = (2026, 11, 21)
LAST_MONDAY = date(2026, 11, 16)
WEEKS = 10
SPECIES = "Tetranychus urticae"
PIXEL_M = 1.0
MARGIN_M = 60.0


@dataclass(frozen=True)
class Plot:
    """A plot in estate metres; `turned_deg` is the row direction, clockwise from the estate's."""

    name: str
    name_he: str
    crop: str
    shape: Polygon | MultiPolygon
    row_spacing_m: float
    plant_spacing_m: float
    turned_deg: float
    planted: date
    gate: tuple[float, float]

    @property
    def row_bearing_deg(self) -> float:
        """Return the direction of the rows, degrees clockwise from north, below 180."""
        return (ESTATE_BEARING_DEG + self.turned_deg) % 180.0

    def along_across(self, x: Float, y: Float) -> tuple[Float, Float]:
        """Return estate metres along and across the rows."""
        turn = np.deg2rad(self.turned_deg)
        return x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)

    def on_a_plant(self, x: float, y: float) -> tuple[float, float]:
        """Return the place of the plant that stands about there."""
        along, across = self.along_across(np.float64(x), np.float64(y))
        along = np.round(along / self.plant_spacing_m) * self.plant_spacing_m
        across = (np.floor(across / self.row_spacing_m) + 0.5) * self.row_spacing_m
        back = np.deg2rad(self.turned_deg)
        return (
            float(along * np.cos(back) + across * np.sin(back)),
            float(across * np.cos(back) - along * np.sin(back)),
        )


@dataclass(frozen=True)
class Outbreak:
    """Mites that came in at a place in a week (0 is the first) and went on along the rows."""

    x: float
    y: float
    week: int
    metres_a_week: float


def bank_m(x: Float) -> Float:
    """Return how far the wadi's bank swings out, metres."""
    return 18 * np.sin(x / 70.0) + 8 * np.sin(x / 23.0 + 1.0) - 0.02 * x


def box(x: float, y: float, wide: float, high: float) -> Polygon:
    """Return a rectangle by its lower left corner."""
    return shapely.box(x, y, x + wide, y + high)


def wadi() -> Polygon:
    """Return the long thin plot that follows the wadi's bank."""
    x = np.linspace(0.0, 540.0, 28)
    lower = np.stack([x, -215 + bank_m(x)], axis=1)
    upper = np.stack([x, -172 + 0.45 * bank_m(x)], axis=1)
    return Polygon(np.concatenate([lower, upper[::-1]]))


def bend() -> Polygon:
    """Return the plot inside the bend of the road."""
    turn = np.linspace(0.0, np.pi / 2, 24)
    arc = np.stack([560 + 190 * np.cos(turn), 150 * np.sin(turn)], axis=1)
    return Polygon([(560, 0), *arc])


def pond() -> Polygon:
    """Return the fenced yard of the irrigation pond and its pump house."""
    return box(380, 70, 46, 34)


def halves() -> MultiPolygon:
    """Return one plot in two parts, with a track between them."""
    trapezium = Polygon([(526, 385), (650, 385), (610, 485), (526, 485)])
    return MultiPolygon([box(400, 385, 118, 100), trapezium])


L_SHAPE = [(-221, 0), (-20, 0), (-20, 71), (-120, 71), (-120, 191), (-221, 191)]
TERRACE = [(400, 215), (640, 230), (600, 330), (400, 360)]

# pepper stands as wide as in the published experiments (4 m, 3 m) on most plots
PLOTS = (
    Plot("Gate", "שער", "pepper", box(0, 0, 261, 181), 4.0, 3.0, 0.0, date(2026, 8, 3), (4, 0)),
    Plot("Pond", "בריכה", "pepper", Polygon(box(280, 0, 251, 181).exterior, [pond().exterior]),
         4.0, 3.0, 0.0, date(2026, 8, 6), (284, 0)),
    Plot("Wadi", "ואדי", "pepper", wadi(), 3.5, 2.5, 2.0, date(2026, 8, 20), (0, -180)),
    Plot("Big field", "השדה הגדול", "pepper", box(0, 215, 373, 277), 4.0, 3.0, 0.0,
         date(2026, 8, 10), (4, 215)),
    Plot("Elbow", "מרפק", "pepper", Polygon(L_SHAPE), 3.0, 2.0, 0.0, date(2026, 8, 17), (-24, 0)),
    Plot("Terrace", "טרסה", "vine", Polygon(TERRACE), 3.0, 1.5, -3.6, date(2019, 2, 12),
         (403, 215.1875)),
    Plot("Two halves", "שני חצאים", "vine", halves(), 3.0, 1.5, 0.0, date(2021, 2, 8), (516, 385)),
    Plot("Bend", "עיקול", "vine", bend(), 3.0, 1.5, 90.0, date(2017, 2, 20), (564, 0)),
    Plot("Nursery", "משתלה", "pepper", box(-110, 215, 62.5, 48.5), 2.0, 1.0, 0.0, date(2026, 9, 1),
         (-106, 215)),
)  # fmt: skip

WADI_X = np.linspace(-20.0, 560.0, 18)
# name, Hebrew name, kind, width in metres, line in estate metres
TRACKS = (
    ("Estate road", "דרך המשק", "road", 6.0,
     [(-340, -34), (-230, -10), (0, -9), (270, -8), (545, -8), (790, -7), (900, 6)]),
    ("Middle track", "שביל אמצע", "track", 5.0,
     [(-130, 201), (-10, 199), (270, 197), (386, 199), (520, 207), (662, 216)]),
    ("Gate track", "שביל השער", "track", 4.0, [(-10, -9), (-11, 95), (-10, 199)]),
    ("Cross track", "שביל רוחב", "track", 4.0, [(270, -8), (270, 100), (270, 197)]),
    ("Field track", "שביל השדה", "track", 4.0, [(386, 199), (386, 372), (387, 500)]),
    ("Terrace track", "שביל הטרסה", "track", 4.0,
     [(386, 372), (522, 371), (640, 368), (658, 300), (662, 216)]),
    ("Bend track", "שביל העיקול", "track", 4.0, [(546, 208.4), (545, 90), (545, -8)]),
    ("Vine track", "שביל הכרם", "track", 4.0, [(522, 371), (522, 500)]),
    ("Wadi path", "שביל הוואדי", "path", 2.5,
     [(-62, -9), (-66, -110), *zip(WADI_X, -162 + 0.45 * bank_m(WADI_X), strict=True)]),
)  # fmt: skip

OUTBREAKS = {
    "Gate": (
        Outbreak(258, 62, 1, 6.0),  # in from the cross track
        Outbreak(196, 70, 6, 5.0),  # carried down the rows
        Outbreak(110, 2, 5, 5.0),  # in from the estate road
    ),
    "Terrace": (Outbreak(520, 224, 3, 6.0), Outbreak(566, 262, 7, 5.0)),
}

CLEAN_NOTES = (*[""] * 17, "clean", "old webbing, no live mites", "predatory mites seen")
FEW_NOTES = ("", "", "few, on lower leaves", "some stippling", "מעט כתמים")
MANY_NOTES = ("stippling", "webbing on tips", "leaves bronzed", "eggs underneath", "קורים על העלים")


def to_grid(shape: shapely.Geometry) -> shapely.Geometry:
    """Return estate metres as Israeli grid coordinates, to the centimetre."""
    turn = np.deg2rad(ESTATE_BEARING_DEG)
    sin, cos = float(np.sin(turn)), float(np.cos(turn))
    moved = affine_transform(shape, [sin, -cos, cos, sin, *ORIGIN_M])
    return shapely.transform(moved, lambda xy: np.round(xy, 2))


def to_degrees(shapes: list[shapely.Geometry]) -> list[shapely.Geometry]:
    """Return estate metres as lon/lat to a centimetre, outer rings counter-clockwise."""
    placed = gpd.GeoSeries([to_grid(shape) for shape in shapes], crs=ISRAELI_GRID)
    rounded = shapely.transform(placed.to_crs(4326).to_numpy(), lambda xy: np.round(xy, 7))
    return list(shapely.orient_polygons(rounded))


def attributes(plot: Plot) -> dict[str, str | float]:
    """Return what the plot's files say about it, under full names."""
    return {
        "name": plot.name,
        "name_he": plot.name_he,
        "crop": plot.crop,
        "row_spacing_m": plot.row_spacing_m,
        "plant_spacing_m": plot.plant_spacing_m,
        "row_bearing_deg": plot.row_bearing_deg,
        "planted": plot.planted.isoformat(),
        "note": NOTE,
    }


def records(rng: np.random.Generator) -> list[dict[str, str | float]]:
    """Return ten weeks of scouting: pepper on Mondays, vines on Tuesdays."""
    seen: list[dict[str, str | float]] = []
    places: list[Point] = []
    for week in range(WEEKS):
        monday = LAST_MONDAY - timedelta(weeks=WEEKS - 1 - week)
        for plot in PLOTS:
            day = monday + timedelta(days=int(plot.crop == "vine"))
            for x, y in scouted(plot, week, rng):
                record = looked_at(plot, (x, y), week, rng)
                off = rng.normal(0.0, record["accuracy_m"] / 2, 2)
                places.append(Point(x + off[0], y + off[1]))
                seen.append({"date": day.isoformat(), **record})
    for record, place in zip(seen, to_degrees(places), strict=True):
        record["longitude"], record["latitude"] = f"{place.x:.7f}", f"{place.y:.7f}"
    return seen


def scouted(plot: Plot, week: int, rng: np.random.Generator) -> list[tuple[float, float]]:
    """Return the plants a scout looked at: all over, and more where mites were known."""
    known = [spot for spot in OUTBREAKS.get(plot.name, ()) if spot.week < week]
    n = max(5, round(plot.shape.area / 4000)) + 6 * len(known)
    inner = plot.shape.buffer(-0.5)
    low_x, low_y, high_x, high_y = inner.bounds
    places: list[tuple[float, float]] = []
    while len(places) < n:
        if known and rng.random() < 0.5:
            spot = known[rng.integers(len(known))]
            x, y = spot.x + rng.normal(0, 30), spot.y + rng.normal(0, 20)
        elif rng.random() < 0.1:
            edge = plot.shape.boundary.interpolate(rng.random(), normalized=True)
            x, y = edge.x, edge.y
        else:
            x, y = rng.uniform(low_x, high_x), rng.uniform(low_y, high_y)
        x, y = plot.on_a_plant(x, y)
        if inner.contains(Point(x, y)):
            places.append((x, y))
    return places


def looked_at(
    plot: Plot, place: tuple[float, float], week: int, rng: np.random.Generator
) -> dict[str, str | float]:
    """Return what the scout wrote down about one plant."""
    leaves = 10 if rng.random() < 0.1 else 5
    mean = 0.012 + float(mites_due(plot, np.float64(place[0]), np.float64(place[1]), week))
    mean *= leaves / 5
    mites = int(rng.negative_binomial(1.1, 1.1 / (1.1 + mean)))
    accuracy_m = float(rng.choice([1.5, 2.0, 3.0, 6.0], p=[0.3, 0.4, 0.26, 0.04]))
    notes = CLEAN_NOTES if not mites else FEW_NOTES if mites < 8 else MANY_NOTES
    note = notes[rng.integers(len(notes))]
    stage = ("adult", "adult", "nymph", "egg")[rng.integers(4)]
    return {
        "count": mites,
        "leaves_sampled": leaves,
        "stage": stage if mites else "",
        "species": SPECIES,
        "accuracy_m": accuracy_m,
        "plot": plot.name,
        "notes": "GPS weak under the net" if accuracy_m > 5 and not note else note,
        "source": "made up",
    }


def mites_due(plot: Plot, x: Float, y: Float, week: int) -> Float:
    """Return the mites to expect on five leaves at places in estate metres in a week."""
    expected = np.zeros(np.shape(x))
    for spot in OUTBREAKS.get(plot.name, ()):
        weeks = week - spot.week + 1
        if weeks > 0:
            reach = 4.0 + spot.metres_a_week * weeks
            along, across = plot.along_across(x - spot.x, y - spot.y)
            away = np.hypot(along / reach, across / (0.6 * reach))
            expected = expected + 24.0 * (1 - np.exp(-0.4 * weeks)) * np.exp(-0.5 * away**2)
    return expected


class Canvas:
    """A picture of the estate in the Israeli grid, painted layer on layer."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        bounds = MultiPolygon([p for plot in PLOTS for p in parts(to_grid(plot.shape))]).bounds
        self.west, south = np.floor(np.array(bounds[:2]) - MARGIN_M)
        east, self.north = np.ceil(np.array(bounds[2:]) + MARGIN_M)
        self.shape = (round((self.north - south) / PIXEL_M), round((east - self.west) / PIXEL_M))
        self.image = np.empty((*self.shape, 3))
        down, over = np.indices(self.shape) * PIXEL_M + 0.5 * PIXEL_M
        east_m, north_m = self.west + over - ORIGIN_M[0], self.north - down - ORIGIN_M[1]
        turn = np.deg2rad(ESTATE_BEARING_DEG)
        self.x = east_m * np.sin(turn) + north_m * np.cos(turn)
        self.y = north_m * np.sin(turn) - east_m * np.cos(turn)

    @property
    def transform(self) -> Affine:
        """Return where the pixels lie."""
        return from_origin(self.west, self.north, PIXEL_M, PIXEL_M)

    def inside(self, shape: shapely.Geometry) -> NDArray[np.bool_]:
        """Return the pixels within a shape given in estate metres."""
        return rasterize([to_grid(shape)], self.shape, transform=self.transform).astype(bool)

    def about(self, shape: shapely.Geometry) -> tuple[slice, slice]:
        """Return the rows and columns of all pixels about a shape given in estate metres."""
        west, south, east, north = to_grid(shape).bounds
        (top, low), (left, right) = (
            np.clip([first / PIXEL_M - 1, last / PIXEL_M + 2], 0, most).astype(int)
            for first, last, most in (
                (self.north - north, self.north - south, self.shape[0]),
                (west - self.west, east - self.west, self.shape[1]),
            )
        )
        return slice(top, low), slice(left, right)

    def paint(
        self,
        where: Float,
        colour: tuple[int, int, int] | Float,
        at: tuple[slice, slice] = (slice(None), slice(None)),
    ) -> None:
        """Mix a colour in, by weights ``(h, w)`` from 0 to 1; `at` are rows and columns of them."""
        image, touched = self.image[at], where > 0
        weight = where[touched][:, None]
        own = np.broadcast_to(np.asarray(colour, dtype=np.float64), image.shape)[touched]
        image[touched] += weight * (own - image[touched])

    def fill(self, shape: shapely.Geometry, colour: tuple[int, int, int], much: float = 1) -> None:
        """Paint a shape given in estate metres."""
        at = self.about(shape)
        self.paint(much * self.inside(shape)[at], colour, at)

    def clouds(self, cell: int) -> Float:
        """Return smooth noise of mean 0 and spread about 1, with features `cell` pixels wide."""
        h, w = self.shape
        coarse = self.rng.normal(0, 1.5, (h // cell + 3, w // cell + 3))
        i, u = np.divmod(np.arange(h) / cell, 1)
        j, v = np.divmod(np.arange(w) / cell, 1)
        i, j = i.astype(int), j.astype(int)
        u, v = (u * u * (3 - 2 * u))[:, None], v * v * (3 - 2 * v)
        upper = coarse[i][:, j] * (1 - v) + coarse[i][:, j + 1] * v
        lower = coarse[i + 1][:, j] * (1 - v) + coarse[i + 1][:, j + 1] * v
        return upper * (1 - u) + lower * u


def parts(shape: shapely.Geometry) -> list[shapely.Geometry]:
    """Return the single polygons of a shape."""
    return list(shapely.get_parts(shape))


def picture(rng: np.random.Generator) -> tuple[NDArray[np.uint8], Affine]:
    """Return a painted view of the estate, ``(3, h, w)``, and where its pixels lie."""
    canvas = Canvas(rng)
    paint_ground(canvas)
    paint_plots(canvas)
    paint_tracks(canvas)
    paint_buildings(canvas)
    paint_trees(canvas)
    soft = canvas.image
    for axis in (0, 1):
        soft = 0.5 * soft + 0.25 * (np.roll(soft, 1, axis) + np.roll(soft, -1, axis))
    soft += rng.normal(0, 3.5, (*canvas.shape, 1))
    return soft.clip(0, 255).astype(np.uint8).transpose(2, 0, 1), canvas.transform


def paint_ground(canvas: Canvas) -> None:
    """Paint desert soil, the gravel bed of the wadi and the levelled ground of the estate."""
    canvas.image[:] = (203, 177, 139)
    for cell, much in ((150, 7.0), (40, 5.0), (9, 3.0)):
        canvas.image += much * canvas.clouds(cell)[..., None] * (1.0, 0.95, 0.85)
    away = canvas.y - (-262 + bank_m(canvas.x))
    bed = np.exp(-((away / 26.0) ** 4))
    channel = np.exp(-(((away + 6 * np.sin(canvas.x / 31.0)) / 6.0) ** 2))
    canvas.paint(0.6 * bed, (221, 206, 180))
    canvas.paint(0.5 * channel, (186, 168, 140))
    levelled = shapely.union_all([plot.shape.buffer(16) for plot in PLOTS])
    canvas.fill(levelled.buffer(-4), (196, 172, 136), 0.5)


def paint_plots(canvas: Canvas) -> None:
    """Paint the plants in their rows, with gaps, and yellower where mites feed."""
    vigour, gap = canvas.clouds(25), canvas.clouds(4) > 2.6
    shade = 7 * canvas.clouds(30)[..., None] + 5 * canvas.clouds(3)[..., None]
    for plot in PLOTS:
        canvas.fill(plot.shape, (172, 148, 112), 0.85)
        at = canvas.about(plot.shape)
        x, y = canvas.x[at], canvas.y[at]
        along, across = plot.along_across(x, y)
        wave = np.cos(2 * np.pi * (across / plot.row_spacing_m - 0.5))
        beads = np.cos(2 * np.pi * along / plot.plant_spacing_m) * (plot.crop == "pepper")
        cover = np.clip(0.55 + 0.9 * wave + 0.15 * beads + 0.12 * vigour[at], 0, 1)
        cover *= canvas.inside(plot.shape.buffer(-2.5))[at] & ~gap[at]
        green = np.array((92, 128, 62) if plot.crop == "pepper" else (84, 108, 74))
        canvas.paint(0.9 * cover, green + shade[at], at)
        eaten = np.clip(mites_due(plot, x, y, WEEKS - 1) / 24.0, 0, 1)
        canvas.paint(0.4 * cover * eaten, (168, 146, 82), at)


def paint_tracks(canvas: Canvas) -> None:
    """Paint the road grey and the tracks as pale dust with ruts."""
    for _, _, kind, wide, points in sorted(TRACKS, key=lambda track: track[3]):
        line = LineString(points)
        verge = (214, 194, 160) if kind == "road" else (222, 203, 170)
        canvas.fill(line.buffer(wide / 2 + 1.5), verge, 0.5)
        canvas.fill(line.buffer(wide / 2), (146, 141, 134) if kind == "road" else (229, 213, 184))
        if kind == "track":
            canvas.fill(line.buffer(0.5), (206, 186, 152), 0.7)


def paint_buildings(canvas: Canvas) -> None:
    """Paint the pond with its pump house, and the packing house with its yard and roofs."""
    canvas.fill(pond(), (190, 170, 138))
    canvas.fill(pond().buffer(-3), (214, 206, 190))
    water = shapely.box(388, 75, 421, 99).buffer(3)
    canvas.fill(water, (72, 112, 128))
    canvas.fill(box(382, 72, 6, 8), (232, 230, 226))
    canvas.fill(box(-215, -75, 120, 58).buffer(3), (208, 190, 160))
    for x, y, wide, high, roof in (
        (-205, -66, 48, 26, (226, 226, 224)), (-148, -64, 30, 18, (176, 112, 92)),
        (-112, -66, 12, 34, (206, 210, 212)), (-150, -36, 22, 12, (190, 196, 200)),
    ):  # fmt: skip
        canvas.fill(box(x + 3, y - 3, wide, high), (96, 84, 70), 0.6)
        canvas.fill(box(x, y, wide, high), roof)
        canvas.fill(box(x, y, wide, high / 2), (120, 120, 120), 0.12)


def paint_trees(canvas: Canvas) -> None:
    """Paint palms along the road, a windbreak by the big field and acacias in the wadi."""
    rng = canvas.rng
    palms = [(x, -17.0, 2.6) for x in np.arange(-90, 540, 12.0) if abs(x + 62) > 8]
    windbreak = [(x, 502.0 + rng.normal(0, 0.7), 3.2) for x in np.arange(-4, 376, 6.0)]
    west = [(-9.0 + rng.normal(0, 0.7), y, 3.0) for y in np.arange(222, 500, 6.5)]
    x = rng.uniform(-120, 720, 46)
    acacias = np.stack([x, -262 + bank_m(x) + rng.normal(0, 22, 46), rng.uniform(1.5, 4, 46)], 1)
    yard = [(-220.0, y, 3.4) for y in (-70.0, -58.0, -44.0, -30.0)]
    plots = shapely.union_all([plot.shape.buffer(5) for plot in PLOTS])
    trees = np.array([*palms, *windbreak, *west, *acacias, *yard])
    x, y, wide = trees[~shapely.contains_xy(plots, trees[:, 0], trees[:, 1])].T
    for shift_x, shift_y, size, colour, much in (
        (1.4, -1.8, 1.0, (104, 90, 70), 0.55), (0, 0, 1.0, (70, 92, 56), 1),
        (-0.6, 0.8, 0.5, (104, 124, 78), 0.8),
    ):  # fmt: skip
        crowns = shapely.buffer(shapely.points(x + shift_x, y + shift_y), size * wide)
        canvas.fill(shapely.union_all(crowns), colour, much)


def write_shapefile(to: Path) -> None:
    """Write the plots as a zipped shapefile, with fixed dates inside."""
    table = gpd.GeoDataFrame(
        [attributes(plot) for plot in PLOTS],
        geometry=[to_grid(plot.shape) for plot in PLOTS],
        crs=ISRAELI_GRID,
    )
    # a shapefile cuts names to ten characters, hence its own, which stay apart
    short = {"row_spacing_m": "row_m", "plant_spacing_m": "plant_m", "row_bearing_deg": "bearing"}
    with tempfile.TemporaryDirectory() as folder:
        table.rename(columns=short).to_file(Path(folder) / "paran_estate.shp", encoding="UTF-8")
        with zipfile.ZipFile(to, "w") as archive:
            for part in sorted(Path(folder).iterdir()):
                data = bytearray(part.read_bytes())
                if part.suffix == ".dbf":
                    data[1:4] = bytes([SAVED[0] - 1900, *SAVED[1:]])
                info = zipfile.ZipInfo(part.name, (*SAVED, 0, 0, 0))
                info.compress_type = zipfile.ZIP_DEFLATED
                info.create_system = 3  # the same bytes on every system
                archive.writestr(info, bytes(data))


def write_geojson(
    to: Path, shapes: list[shapely.Geometry], said: list[dict[str, str | float]]
) -> None:
    """Write shapes in estate metres as lon/lat GeoJSON (RFC 7946), one feature a line."""
    features = [
        json.dumps(
            {"type": "Feature", "properties": about, "geometry": shapely.geometry.mapping(shape)},
            ensure_ascii=False,
        )
        for shape, about in zip(to_degrees(shapes), said, strict=True)
    ]
    head = f'{{"type": "FeatureCollection", "description": "{NOTE}", "features": [\n'
    to.write_text(head + ",\n".join(features) + "\n]}\n", encoding="utf-8", newline="\n")


def write_records(to: Path, table: list[dict[str, str | float]]) -> None:
    """Write the scouting records as CSV."""
    last = [name for name in table[0] if name not in {"date", "longitude", "latitude"}]
    with to.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, ["date", "longitude", "latitude", *last], lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)


def write_picture(to: Path, image: NDArray[np.uint8], transform: Affine) -> None:
    """Write the painted view as a GeoTIFF."""
    with rasterio.open(
        to, "w", driver="GTiff", count=3, height=image.shape[1], width=image.shape[2],
        dtype="uint8", crs=ISRAELI_GRID, transform=transform, compress="JPEG",
        photometric="YCBCR", jpeg_quality=72, tiled=True,
    ) as tif:  # fmt: skip
        tif.update_tags(TIFFTAG_IMAGEDESCRIPTION=f"Painted by a script: {NOTE}")
        tif.write(image)


def main(folder: Path) -> None:
    """Write all files of the estate into a folder."""
    records_rng, picture_rng = np.random.default_rng(SEED).spawn(2)
    write_shapefile(folder / "paran_estate.zip")
    write_geojson(
        folder / "paran_estate.geojson",
        [plot.shape for plot in PLOTS],
        [attributes(plot) for plot in PLOTS],
    )
    write_geojson(
        folder / "tracks.geojson",
        [LineString(points) for *_, points in TRACKS],
        [
            {"name": name, "name_he": hebrew, "kind": kind, "width_m": wide, "note": NOTE}
            for name, hebrew, kind, wide, _ in TRACKS
        ],
    )
    write_geojson(
        folder / "gates.geojson",
        [Point(plot.gate) for plot in PLOTS],
        [{"plot": plot.name, "name_he": plot.name_he, "note": NOTE} for plot in PLOTS],
    )
    write_records(folder / "mite_records.csv", records(records_rng))
    write_picture(folder / "backdrop.tif", *picture(picture_rng))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
