"""Throw damaged GeoTIFFs at the doors for rasters: ``python tests/fuzz_rasters.py --inputs 2500``.

Every input is a small GeoTIFF, of one compression or another, with tags or bytes changed or its end
cut off. It must be read, or end in a `FieldmonError`, in time.
"""

import argparse
import struct
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import rasterio
from rasterio.transform import from_origin

from fieldmon.errors import FieldmonError
from fieldmon.io.options import Upload
from fieldmon.io.rasters.read import RasterOptions, read_backdrop, read_raster
from fieldmon.io.sandbox import limits
from tests.io.rasters.raster_files import PLOT, declared, palette, ramp, turned, write

_NASTY = (0, 1, 2, 3, 7, 255, 65_535, 100_000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
#: the clock of the reading process, and what ending it may take on a busy machine
_SECONDS = limits.READ_SECONDS + 3.0


@dataclass
class Tally:
    """What became of all inputs."""

    outcomes: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)
    slowest_s: float = 0.0


def seeds(folder):
    """Return GeoTIFFs as bytes: all usual ways to store pixels, masks, scales, colour tables."""
    cube = np.random.default_rng(1).integers(0, 255, (4, 64, 64), dtype="uint8")
    tiled = {"tiled": True, "blockxsize": 64, "blockysize": 64}

    def scaled(tif):
        tif.scales = (0.01,)

    def masked(tif):
        tif.write_mask(np.eye(64, dtype="uint8") * 255)

    degrees = {"crs": "EPSG:4326", "transform": from_origin(35.15, 30.361, 1e-5, 1e-5)}
    files = [
        (cube, {"compress": "lzw", **tiled}),
        (ramp(64), {"compress": "deflate", "nodata": -1, "predictor": 3}),
        (cube[:1], {"bands": [palette]}),
        (cube[:3], {"compress": "jpeg", "photometric": "YCBCR", **tiled}),
        (ramp(64, "int16"), {"BIGTIFF": "YES", "bands": [scaled]}),
        (cube[:1], {"compress": "packbits", "bands": [masked]}),
        (ramp(64, "uint16"), {"compress": "zstd", **degrees}),
        (ramp(64, "float64"), {"compress": "lerc", "transform": turned(20, 6.0)}),
        (cube[:3], {"compress": "webp", **tiled}),
    ]
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
        made = [
            write(folder / f"{number}.tif", values, **more).read_bytes()
            for number, (values, more) in enumerate(files)
        ]
    return [*made, declared(20_000, 20_000, 1024), declared(3000, 3000)]


def mutated(seed, rng):
    """Return a file with one to four things changed that matter."""
    data = bytearray(seed)
    for _ in range(rng.integers(1, 5)):
        kind = rng.random()
        if kind < 0.5:
            _change_tag(data, rng)
        elif kind < 0.8:
            data[rng.integers(min(len(data), 700))] = rng.integers(256)
        elif kind < 0.95:
            data[rng.integers(len(data))] = rng.integers(256)
        else:
            del data[rng.integers(min(16, len(data) - 1), len(data)) :]
    return bytes(data)


def _change_tag(data, rng):
    """Give a tag of the first directory another type, number of values, or value."""
    big = data[2] == 43
    form, step, head = ("<Q", 20, 8) if big else ("<I", 12, 2)
    try:
        (start,) = struct.unpack_from(form, data, 8 if big else 4)
        (n,) = struct.unpack_from("<Q" if big else "<H", data, start)
        at = start + head + step * int(rng.integers(min(n, 60)))
        value = int(rng.choice(_NASTY)) if rng.random() < 0.8 else int(rng.integers(len(data)))
        match rng.integers(3):
            case 0:
                struct.pack_into("<H", data, at + 2, int(rng.integers(20)))
            case 1:
                struct.pack_into("<I", data, at + 4, value)
            case _:
                struct.pack_into("<I", data, at + (12 if big else 8), value)
    except (struct.error, ValueError):
        return  # an earlier change left no directory


def fuzz(n_inputs, first=0):
    """Read so many damaged files; input i is the same on every run."""
    tally = Tally()
    with tempfile.TemporaryDirectory(prefix="fieldmon-fuzz-") as folder:
        corpus = seeds(Path(folder))
    for number in range(first, first + n_inputs):
        rng = np.random.default_rng(number)
        data = mutated(corpus[number % len(corpus)], rng)
        door = (read_raster, read_backdrop)[number // len(corpus) % 2]
        options = RasterOptions(band="1") if rng.random() < 0.7 else None
        near = PLOT if rng.random() < 0.3 else None
        began = time.perf_counter()
        try:
            door(Upload("m.tif", data), options, near)
            tally.outcomes["came in"] += 1
        except FieldmonError as problem:
            tally.outcomes["refused"] += 1
            if not str(problem).endswith("."):
                tally.failures.append(f"input {number}: no sentence: {problem}")
        except Exception as wrong:  # noqa: BLE001 - that is what is looked for
            tally.failures.append(f"input {number}: {type(wrong).__name__}: {wrong}")
        took_s = time.perf_counter() - began
        tally.slowest_s = max(tally.slowest_s, took_s)
        if took_s > _SECONDS:
            tally.failures.append(f"input {number} took {took_s:.1f} s")
    return tally


def main():
    """Fuzz by command; end with 1 where anything failed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--inputs", type=int, default=2500)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    chosen = parser.parse_args()
    tally = fuzz(chosen.inputs, chosen.first)
    sys.stdout.write("\n".join([*tally.failures, str(tally), ""]))
    sys.exit(bool(tally.failures))


if __name__ == "__main__":
    main()
