"""The made-up estate on the command line, and what scouts bring back from it."""

import csv

import geopandas as gpd
from shapely import box

from tests.paths import SAMPLE_DATA

ZIP, MITES = str(SAMPLE_DATA / "paran_estate.zip"), str(SAMPLE_DATA / "mite_records.csv")
BEGINS = "2026-11-02"


def square(**changes):
    """Return one square plot of about a hectare, with anything about it changed."""
    plot = {"name": "plot", "geometry": box(35.15, 30.36, 35.151, 30.361)} | changes
    return gpd.GeoDataFrame([plot], crs="EPSG:4326")


def table(path):
    """Return the rows of a table."""
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def filled_in(path, finds, n=None):
    """Fill in a route's CSV as a scout does: every n-th stop done, finds marked."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    done = rows[:n]
    for k, row in enumerate(done):
        row["found"] = "yes" if k in finds else "no"
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return [int(row["plant"]) for row in done]


def begin_next_year(run, folder):
    """Begin next year's season on the same plot by its command; return its file."""
    words = (ZIP, "--feature", "Nursery", "--begins", "2027-11-02", "--hours", "1")
    code, _, err, _ = run("init", folder / "next.gpkg", *words)
    assert code == 0, err
    return folder / "next.gpkg"
