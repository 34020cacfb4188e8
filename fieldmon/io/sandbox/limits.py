"""How big a file may be: an upload is opened as if an enemy had made it."""

from __future__ import annotations

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem

MB = 1_000_000

#: one file as it comes, and everything together that an archive unpacks to
FILE_BYTES = 500 * MB
UNPACKED_BYTES = 1_000 * MB
#: entries of an archive, and archives inside archives
ARCHIVE_ENTRIES = 2_000
ARCHIVE_DEPTH = 2
#: above `RATIO_FROM_BYTES`, an archive may not unpack to more than so many times its size
COMPRESSION_RATIO = 100
RATIO_FROM_BYTES = 100 * MB
#: what a layer or a table may hold
FEATURES = 1_000_000
VERTICES = 5_000_000
RECORDS = 1_000_000
COLUMNS = 1_000
#: text in one cell or attribute
CELL_CHARACTERS = 1_000_000
#: what the reading process may take: working time of its own, however busy the machine is, and
#: memory; real time is a far backstop only, so many times that
READ_SECONDS = 10.0
PATIENCE = 30.0
MEMORY_BYTES = 1_000 * MB
#: pixels of a raster that are kept, bands it may have, one of its tiles or strips unpacked, and all
#: that is unpacked of it (its smaller copies are used where they do)
PIXELS = 16_000_000
BANDS = 512
BLOCK_BYTES = 200 * MB
RASTER_BYTES = 1_000 * MB
#: pixels of a raster that is written
WRITTEN_PIXELS = 100_000_000


def size(n_bytes: float) -> str:
    """Return a number of bytes as people write it."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if n_bytes >= scale:
            return f"{n_bytes / scale:.3g} {unit}"
    return f"{n_bytes:.0f} bytes"


def check(what: str, n: int, most: int, name: str) -> None:
    """Raise `FileProblem` where a file holds more of something than it may."""
    if n > most:
        raise FileProblem(
            worded(
                "A file may hold {most} {what} at most, but {name} holds "
                "more. Cut it to the plots and the season that matter.",
                most=most,
                what=what,
                name=name,
            )
        )
