"""Draw the made-up sample estate: `python sample_data/make.py [FOLDER]`.

Nothing here exists. The plots lie on open ground near Paran in the Arava, because the work that
fieldmon builds on was done there; shapes, names, records and the picture are drawn by this script
from one seed.
"""

from __future__ import annotations

import json
import struct
import sys
import tempfile
import zipfile
from datetime import date, timedelta
from pathlib import Path

import geopandas as gpd
import numpy as np
import pandas as pd
import rasterio
import shapely
from pyproj import Transformer
from rasterio.features import rasterize
from rasterio.transform import from_origin
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.affinity import affine_transform

SEED = 2023
CENTRE = (35.1560, 30.3510)
ESTATE_BEARING_DEG = 68.0
ISRAELI_GRID = "EPSG:2039"
NOTE = "made up for fieldmon; no such plot exists"
LAST_MONDAY = date(2026, 11, 16)
WEEKS = 10
PIXEL_M = 2.0
TO_GRID = Transformer.from_crs("EPSG:4326", ISRAELI_GRID, always_xy=True)
TO_DEGREES = Transformer.from_crs(ISRAELI_GRID, "EPSG:4326", always_xy=True)


def box(x: float, y: float, wide: float, high: float) -> Polygon:
    """Return a rectangle in estate metres by its lower left corner."""
    return shapely.box(x, y, x + wide, y + high)


def wadi() -> Polygon:
    """Return the long crooked plot along the wadi."""
    x = np.linspace(0.0, 520.0, 27)
    bank = 18 * np.sin(x / 70.0) + 9 * np.sin(x / 23.0 + 1.0) - 0.02 * x
    lower = np.stack([x, -215 + bank], axis=1)
    upper = np.stack([x, -150 + 0.35 * bank], axis=1)
    return Polygon(np.concatenate([lower, upper[::-1]]))


def bend() -> Polygon:
    """Return the plot inside the bend of the track."""
    turn = np.linspace(0.0, np.pi / 2, 24)
    arc = np.stack([560 + 190 * np.cos(turn), 150 * np.sin(turn)], axis=1)
    return Polygon([(560, 0), *arc])


# name, Hebrew name, crop, shape in estate metres, row spacing, plant spacing, rows against estate
PLOTS = [
    ("Gate", "שער", "pepper", box(0, 0, 260, 180), 4.0, 3.0, 0.0),
    ("Pond", "בריכה", "pepper",
     Polygon(box(280, 0, 250, 180).exterior, [box(380, 70, 46, 34).exterior.coords]),
     4.0, 3.0, 0.0),
    ("Wadi", "ואדי", "pepper", wadi(), 4.0, 3.0, 0.0),
    ("Big field", "השדה הגדול", "pepper", box(0, 215, 372, 276), 4.0, 3.0, 0.0),
    ("Elbow", "מרפק", "pepper",
     Polygon([(-220, 0), (-20, 0), (-20, 70), (-120, 70), (-120, 190), (-220, 190)]),
     4.0, 3.0, 0.0),
    ("Terrace", "טרסה", "vine", Polygon([(400, 215), (640, 230), (600, 330), (400, 360)]),
     3.0, 1.5, 4.0),
    ("Two halves", "שני חצאים", "vine",
     MultiPolygon([box(400, 385, 118, 100),
                   Polygon([(526, 385), (650, 385), (610, 485), (526, 485)])]),
     3.0, 1.5, 0.0),
    ("Bend", "עיקול", "vine", bend(), 3.0, 1.5, 90.0),
    ("Nursery", "משתלה", "pepper", box(-110, 215, 62, 48), 2.0, 1.0, 0.0),
]  # fmt: skip

TRACKS = {
    "Estate road": [(-240, -8), (0, -9), (270, -8), (540, -8), (790, -6)],
    "Middle track": [(-125, 200), (0, 198), (280, 197), (390, 200), (660, 208)],
    "Cross track": [(270, -8), (270, 100), (270, 197)],
    "Vine track": [(522, 376), (522, 495)],
    "Wadi path": [(-10, -140), (120, -132), (300, -140), (525, -152)],
}

GATES = {
    "Gate": (2, 0), "Pond": (282, 0), "Wadi": (4, -149), "Big field": (2, 215),
    "Elbow": (-22, 0), "Terrace": (402, 216), "Two halves": (517, 386), "Bend": (561, 1),
    "Nursery": (-108, 215),
}  # fmt: skip

# where mites came in, when (week), and how many metres a week they went on
OUTBREAKS = {"Gate": [((255, 60), 1, 7.0), ((150, 2), 5, 6.0)], "Terrace": [((520, 226), 3, 6.0)]}


def to_grid(shape: shapely.Geometry) -> shapely.Geometry:
    """Return estate metres as Israeli grid coordinates."""
    east, north = TO_GRID.transform(*CENTRE)
    turn = np.deg2rad(ESTATE_BEARING_DEG)
    sin, cos = float(np.sin(turn)), float(np.cos(turn))
    return affine_transform(shape, [sin, -cos, cos, sin, east - 100.0, north])


def to_degrees(shape: shapely.Geometry, digits: float = 1e-7) -> shapely.Geometry:
    """Return Israeli grid coordinates as lon/lat, rounded to a centimetre."""
    moved = shapely.transform(shape, lambda xy: np.stack(TO_DEGREES.transform(*xy.T), axis=1))
    return shapely.set_precision(moved, digits, mode="pointwise")


def estate() -> gpd.GeoDataFrame:
    """Return the plots in the Israeli grid."""
    rows = []
    for number, (name, hebrew, crop, _, rows_m, plants_m, turned) in enumerate(PLOTS):
        rows.append(
            {
                "name": name,
                "name_he": hebrew,
                "crop": crop,
                "row_m": rows_m,
                "plant_m": plants_m,
                "bearing": (ESTATE_BEARING_DEG + turned) % 180.0,
                "planted": str(date(2026, 8, 2) + timedelta(days=3 * number)),
                "note": NOTE,
            }
        )
    shapes = [shapely.set_precision(to_grid(plot[3]), 0.01, mode="pointwise") for plot in PLOTS]
    return gpd.GeoDataFrame(rows, geometry=shapes, crs=ISRAELI_GRID)


def records(rng: np.random.Generator) -> pd.DataFrame:
    """Return ten weeks of scouting: leaves looked at, mites counted, at GPS positions."""
    rows = []
    for week in range(WEEKS):
        day = LAST_MONDAY - timedelta(weeks=WEEKS - 1 - week)
        for name, _, crop, shape, *_ in PLOTS:
            n = max(5, round(shape.area / 4500))
            for x, y in scouted(shape, OUTBREAKS.get(name, []), n, rng):
                mites = counted((x, y), OUTBREAKS.get(name, []), week, rng)
                accuracy = float(rng.choice([1.5, 2.0, 3.0, 5.0], p=[0.3, 0.4, 0.25, 0.05]))
                off = rng.normal(0.0, accuracy / 2, 2)
                lon, lat = to_degrees(to_grid(Point(x + off[0], y + off[1]))).coords[0]
                rows.append(
                    {
                        "date": str(day),
                        "longitude": f"{lon:.7f}",
                        "latitude": f"{lat:.7f}",
                        "count": mites,
                        "leaves_sampled": 5,
                        "species": "Tetranychus urticae",
                        "stage": "" if not mites else str(rng.choice(["adult", "egg", "nymph"])),
                        "accuracy_m": accuracy,
                        "plot": name,
                        "crop": crop,
                    }
                )
    return pd.DataFrame(rows)


def scouted(
    shape: shapely.Geometry, outbreaks: list, n: int, rng: np.random.Generator
) -> list[tuple[float, float]]:
    """Return where a scout looked: anywhere on the plot, more often where mites were known."""
    inner = shape.buffer(-5.0)
    low_x, low_y, high_x, high_y = inner.bounds
    places: list[tuple[float, float]] = []
    while len(places) < n:
        if outbreaks and rng.random() < 0.35:
            (x, y), _, _ = outbreaks[rng.integers(len(outbreaks))]
            x, y = x + rng.normal(0, 25), y + rng.normal(0, 25)
        else:
            x, y = rng.uniform(low_x, high_x), rng.uniform(low_y, high_y)
        if inner.contains(Point(x, y)):
            places.append((round(float(x) / 3.0) * 3.0, round(float(y) / 4.0) * 4.0))
    return places


def counted(
    place: tuple[float, float], outbreaks: list, week: int, rng: np.random.Generator
) -> int:
    """Return the mites counted on five leaves at a place in a week."""
    expected = 0.01
    for (x, y), since, metres in outbreaks:
        if week >= since:
            reach = metres * (week - since + 1)
            away = np.hypot(place[0] - x, place[1] - y)
            expected += 14.0 * np.exp(-0.5 * (away / reach) ** 2)
    return int(rng.negative_binomial(1.2, 1.2 / (1.2 + expected)))


def feature_collection(features: list[tuple[shapely.Geometry, dict]]) -> str:
    """Return lon/lat features as GeoJSON text, one feature a line."""
    lines = [
        json.dumps(
            {"type": "Feature", "properties": properties, "geometry": shapely.geometry.mapping(g)},
            ensure_ascii=False,
        )
        for g, properties in features
    ]
    return '{"type": "FeatureCollection", "features": [\n' + ",\n".join(lines) + "\n]}\n"


def picture(plots: gpd.GeoDataFrame, rng: np.random.Generator) -> tuple[np.ndarray, tuple]:
    """Return a painted view of the estate, ``(3, h, w)`` uint8, and its origin (west, north)."""
    west, south, east, north = plots.total_bounds + np.array([-60, -60, 60, 60])
    west, north = np.floor(west), np.ceil(north)
    w, h = int((east - west) / PIXEL_M), int((north - south) / PIXEL_M)
    at = from_origin(west, north, PIXEL_M, PIXEL_M)
    across_px, down_px = np.arange(w) + 0.5, np.arange(h) + 0.5
    x, y = np.meshgrid(west + across_px * PIXEL_M, north - down_px * PIXEL_M)
    image = np.empty((h, w, 3))
    coarse = rng.normal(0, 1, (h // 12 + 2, w // 12 + 2))
    soil = np.kron(coarse, np.ones((12, 12)))[:h, :w]
    image[:] = [206, 184, 148]
    image += 5.0 * soil[..., None]
    for number, plot in enumerate(plots.itertuples()):
        inside = rasterize([plot.geometry], (h, w), transform=at).astype(bool)
        turn = np.deg2rad(plot.bearing)
        across = x * -np.cos(turn) + y * np.sin(turn)
        rows = (across / 6.0) % 1.0 < 0.55
        green = np.array([[118, 142, 84], [96, 124, 88]][plot.crop == "vine"]) + 4 * (number % 3)
        image[inside & rows] = green
        image[inside & ~rows] = [176, 160, 120]
    for points in TRACKS.values():
        track = to_grid(LineString(points)).buffer(2.6)
        image[rasterize([track], (h, w), transform=at).astype(bool)] = [226, 212, 184]
    pond = to_grid(box(384, 73, 38, 28))
    image[rasterize([pond], (h, w), transform=at).astype(bool)] = [86, 126, 148]
    image += rng.normal(0, 5, (h, w, 1))
    return image.clip(0, 255).astype(np.uint8).transpose(2, 0, 1), (west, north)


def write_shapefile(plots: gpd.GeoDataFrame, to: Path) -> None:
    """Write the plots as a zipped shapefile, with fixed dates inside."""
    with tempfile.TemporaryDirectory() as folder:
        plots.to_file(Path(folder) / "paran_estate.shp", encoding="UTF-8")
        with zipfile.ZipFile(to, "w", zipfile.ZIP_DEFLATED) as archive:
            for part in sorted(Path(folder).iterdir()):
                data = bytearray(part.read_bytes())
                if part.suffix == ".dbf":
                    data[1:4] = struct.pack("BBB", 126, 11, 21)
                info = zipfile.ZipInfo(part.name, (2026, 11, 21, 0, 0, 0))
                info.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(info, bytes(data))


def main(folder: Path) -> None:
    """Write all files of the estate into a folder."""
    rng = np.random.default_rng(SEED)
    plots = estate()
    write_shapefile(plots, folder / "paran_estate.zip")
    known = plots.drop(columns="geometry").to_dict("records")
    shapes = [shapely.geometry.polygon.orient(g) if g.geom_type == "Polygon" else g
              for g in map(to_degrees, plots.geometry)]  # fmt: skip
    (folder / "paran_estate.geojson").write_text(
        feature_collection(list(zip(shapes, known, strict=True))), encoding="utf-8"
    )
    tracks = [
        (to_degrees(to_grid(LineString(points))), {"name": name, "note": NOTE})
        for name, points in TRACKS.items()
    ]
    (folder / "tracks.geojson").write_text(feature_collection(tracks), encoding="utf-8")
    gates = [
        (to_degrees(to_grid(Point(place))), {"plot": name, "note": NOTE})
        for name, place in GATES.items()
    ]
    (folder / "gates.geojson").write_text(feature_collection(gates), encoding="utf-8")
    records(rng).to_csv(folder / "mite_records.csv", index=False, lineterminator="\n")
    image, (west, north) = picture(plots, rng)
    with rasterio.open(
        folder / "backdrop.tif", "w", driver="GTiff", width=image.shape[2],
        height=image.shape[1], count=3, dtype="uint8", crs=ISRAELI_GRID,
        transform=from_origin(west, north, PIXEL_M, PIXEL_M), compress="JPEG",
        photometric="YCBCR", jpeg_quality=70,
    ) as tif:  # fmt: skip
        tif.update_tags(note=NOTE)
        tif.write(image)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
