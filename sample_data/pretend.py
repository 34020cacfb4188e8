"""Fill in a route's CSV file as a scout would, with made-up mites: to practise a season.

    python sample_data/pretend.py monday.csv

Three spots on the sample plot Terrace are infested, and grow by half a metre a day from
2026-11-18 on; five of six infested plants looked at are found. Nothing of it exists.
"""

import csv
import hashlib
import math
import sys
from pathlib import Path

SPOTS = ((35.14753, 30.35223), (35.14808, 30.35219), (35.14772, 30.35257))
METRES = 111_320.0
FIRST_DAY = 18


def infested(lon: float, lat: float, day: int) -> bool:
    """Tell whether a plant is within reach of a spot on a day of November."""
    reach_m = 7.0 + 0.5 * (day - FIRST_DAY)
    east_m = METRES * math.cos(math.radians(lat))
    return any(math.hypot((lon - x) * east_m, (lat - y) * METRES) < reach_m for x, y in SPOTS)


def main(path: Path) -> None:
    """Fill in the columns found and count of every stop."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        day = int(row["arrive"][8:10])
        seen = hashlib.sha256(f"{row['plant']} {day}".encode()).digest()[0]
        there = infested(float(row["lon"]), float(row["lat"]), day) and seen < 5 * 256 / 6
        row["found"], row["count"] = ("yes", str(1 + seen % 9)) if there else ("no", "0")
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    found = sum(row["found"] == "yes" for row in rows)
    sys.stdout.write(f"{path}: {found} of {len(rows)} plants found infested\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
