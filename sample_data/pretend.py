"""Fill in a route's CSV file as a scout would, with made-up mites: to practise a season.

    python sample_data/pretend.py monday.csv

Three spots on the sample plot Terrace are infested, and grow by half a metre a day from
2026-11-18 on; five of six infested plants looked at are found, and treated: `treated.txt` beside
the route remembers them. On the first day that begins anew. Nothing of it exists.
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


def treated(file: Path, day: int) -> dict[str, int]:
    """Return the plants that were treated before a day of November, with the days."""
    lines = file.read_text().split("\n") if file.exists() else []
    plants = {plant: int(on) for plant, on in (line.split() for line in lines if line)}
    return {plant: on for plant, on in plants.items() if on < day}


def main(path: Path) -> None:
    """Fill in the columns found and count of every stop."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    day = int(rows[0]["arrive"][8:10])
    gone = treated(path.with_name("treated.txt"), day)
    for row in rows:
        seen = hashlib.sha256(f"{row['plant']} {day}".encode()).digest()[0]
        there = infested(float(row["lon"]), float(row["lat"]), day) and row["plant"] not in gone
        found = there and seen < 5 * 256 / 6
        row["found"], row["count"] = ("yes", str(1 + seen % 9)) if found else ("no", "0")
    gone |= {row["plant"]: day for row in rows if row["found"] == "yes"}
    lines = [f"{plant} {on}\n" for plant, on in gone.items()]
    path.with_name("treated.txt").write_text("".join(lines))
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    found = sum(row["found"] == "yes" for row in rows)
    sys.stdout.write(f"{path}: {found} of {len(rows)} plants found infested\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
