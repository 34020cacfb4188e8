"""Throw damaged files at the imports: ``python tests/fuzz.py --inputs 5000``.

Every input is one of the awkward files, or a raster, with bytes changed anywhere or its structure
changed where it hurts. Whatever comes in must lie on the earth; everything else must end in a
`FieldmonError`, in time, in memory, and without a file left anywhere.
"""

import argparse
import io
import json
import os
import re
import struct
import sys
import tempfile
import time
import traceback
import zipfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from fieldmon.errors import ChoiceNeeded, FieldmonError, FileProblem
from fieldmon.io import read as reading
from fieldmon.io.drawn_rows import parted
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.prepare import lay
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.sandbox import limits, process
from fieldmon.plot.plot import Plot
from tests import awkward

#: what the clock of the reading process allows on a busy machine, and what ending it may take
SECONDS = limits.PATIENCE * limits.READ_SECONDS + 3.0
_LARGEST_SEED = 400_000
_NASTY_NUMBERS = (0, -1, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
_NASTY_VALUES = (
    *(None, True, -1, 0, 1e308, -1e308, 1e-320, 10**400, "", "NaN", "\x00", "א" * 300, [], {}),
    *([[]], [[[]]], [None, None], ["x", "y"], {"type": "Point"}, "Polygon", "GeometryCollection"),
    *([1e9, 1e9], [181, 91], [35.15], [[35.15, 30.36]] * 3, "2026-02-30", "EPSG:999999"),
)
_NASTY_CELLS = (
    *("", "NaN", "inf", "-inf", "1e999", "9" * 400, "'", '"', '""', "\r", "\x00", "=1+1", "<5"),
    *("1,234,56", "07.16.5046", "91", "-181", "31.02.2026", "99999999", "0000-00-00", "\ufeff"),
    *("EPSG:0", "POINT (", "POINT (1e400 2)", "א" * 200, "35°99'99\"", "N N", "-", "10-", "1e5-2"),
)


class Seed(NamedTuple):
    """A file in parts: ``.shp``, ``.dbf``... where they come side by side."""

    name: str
    door: str
    parts: tuple[Upload, ...]
    options: Any = None


@dataclass
class Tally:
    """What became of all inputs."""

    outcomes: Counter = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)
    notable: list[str] = field(default_factory=list)
    slowest_s: float = 0.0
    slowest: str = "none"
    hardest_s: float = 0.0
    peak_bytes: int = 0

    def __str__(self) -> str:
        counts = ", ".join(f"{n} {what}" for what, n in self.outcomes.most_common())
        return (
            f"{self.outcomes.total()} inputs: {counts}; slowest {self.slowest_s:.1f} s "
            f"({self.slowest}), most working time {self.hardest_s:.1f} s, most memory "
            f"{self.peak_bytes / 1e6:.0f} MB, {len(self.failures)} failure(s)."
        )


# --- seeds -------------------------------------------------------------------------------------


def seeds(folder: Path) -> list[Seed]:
    """Return the awkward files that are small, and a raster."""
    made = []
    for number, case in enumerate(awkward.CASES):
        if "more_" in case.name or "bomb" in case.name:
            continue
        room = folder / str(number)
        room.mkdir()
        parts = _uploads(case.source(room))
        if sum(len(part.data) for part in parts) <= _LARGEST_SEED:
            made.append(Seed(case.name, case.door, parts, case.options))
            if case.door == "records":
                made.append(Seed(case.name, "reported", parts))
    return [*made, *(Seed("raster", door, (_raster(folder),)) for door in ("plots", "layers"))]


def _uploads(source: Any) -> tuple[Upload, ...]:
    if isinstance(source, Upload):
        return (source,)
    path = Path(source)
    if path.is_dir():
        parts = {f"{path.name}/{p.name}": p.read_bytes() for p in awkward.files(path)}
        return (awkward.zipped(parts),)
    beside = [path]
    if path.suffix in {".shp", ".tab", ".mif", ".csv"}:
        beside = list(path.parent.glob(f"{path.stem}.*"))
    elif path.name == "TASKDATA.XML":
        beside = list(path.parent.iterdir())
    return tuple(Upload(p.name, p.read_bytes()) for p in sorted(beside))


def _raster(folder: Path) -> Upload:
    import rasterio
    from rasterio.transform import from_origin

    path = folder / "ndvi.tif"
    band = np.linspace(0, 1, 64 * 48, dtype=np.float32).reshape(48, 64)
    form = {"driver": "GTiff", "width": 64, "height": 48, "count": 1, "dtype": "float32"}
    place = {"crs": "EPSG:2039", "transform": from_origin(214000, 474500, 1.0, 1.0)}
    with rasterio.open(path, "w", **form, **place, nodata=-1) as raster:
        raster.write(band, 1)
    return Upload("ndvi.tif", path.read_bytes())


# --- mutations ---------------------------------------------------------------------------------


def mutated(seed: Seed, rng: np.random.Generator) -> tuple[Upload, ...]:
    """Return the parts of a seed with one of them changed, once to four times."""
    parts = list(seed.parts)
    if len(parts) > 1 and rng.random() < 0.05:
        parts.pop(rng.integers(len(parts)))
    for _ in range(rng.integers(1, 5)):
        i = int(rng.integers(len(parts)))
        parts[i] = Upload(parts[i].name, _changed(parts[i].name, parts[i].data, rng))
    return tuple(parts)


def _changed(name: str, data: bytes, rng: np.random.Generator) -> bytes:
    by_structure = _structure(name, data)
    if by_structure is None or rng.random() < 0.4:
        return _bytes(data, rng)
    try:
        return by_structure(data, rng)
    except Exception:  # noqa: BLE001 - an earlier change broke the structure already
        return _bytes(data, rng)


def _structure(name: str, data: bytes):
    by_start = {b"P": _zip, b"{": _json, b"<": _xml}
    return by_start.get(data[:1]) or _BY_ENDING.get(Path(name).suffix.lower())


def _bytes(data: bytes, rng: np.random.Generator) -> bytes:
    if not data:
        return rng.bytes(16)
    at, end = sorted(int(i) for i in rng.integers(0, len(data) + 1, 2))
    end = min(end, at + 4096)
    noise = rng.bytes(int(rng.integers(1, 64)))
    return [
        _flipped(data, rng),
        data[:at],
        data[:at] + data[end:],
        data[:end] + data[at:end] * int(rng.integers(1, 20)) + data[end:],
        data[:at] + rng.bytes(end - at) + data[end:],
        data[:at] + noise + data[at:],
    ][rng.integers(6)]


def _flipped(data: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(data)
    for i in rng.integers(0, len(data), rng.integers(1, 9)):
        changed[i] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def _integers(data: bytes, rng: np.random.Generator) -> bytes:
    """Write an extreme number where lengths and counts stand: early, or aligned to four bytes."""
    changed = bytearray(data)
    for _ in range(rng.integers(1, 4)):
        most = 200 if rng.random() < 0.6 else len(data)
        at = int(rng.integers(0, max(1, min(most, len(data)) - 8))) & ~1
        value = int(rng.choice(_NASTY_NUMBERS))
        how = str(rng.choice(["<H", ">H", "<I", ">I", "<d", ">d"]))
        if how[1] == "d":
            value = float(rng.choice([np.nan, np.inf, -np.inf, 1e308, 1e-320, 35.15]))
        else:
            value &= 0xFFFF if how[1] == "H" else 0xFFFFFFFF
        struct.pack_into(how, changed, at, value)
    return bytes(changed)


def _pages(data: bytes, rng: np.random.Generator) -> bytes:
    """Change what SQLite keeps as text: names of tables, definitions, coordinate systems."""
    words = [m.span() for m in re.finditer(rb"[A-Za-z_ ]{6,}", data)]
    start, end = words[rng.integers(len(words))]
    other = data[slice(*words[rng.integers(len(words))])]
    return data[:start] + other[: end - start].ljust(end - start) + data[end:]


def _zip(data: bytes, rng: np.random.Generator) -> bytes:
    """Change a file inside, its name, how often it is there; or lie in the directory."""
    if rng.random() < 0.3:
        at = data.rindex(b"PK\x01\x02") + int(rng.integers(4, 46))
        return data[:at] + rng.bytes(4) + data[at + 4 :]
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = [(info.filename, archive.read(info)) for info in archive.infolist()]
    i = int(rng.integers(len(parts)))
    name, content = parts[i]
    how = rng.integers(4)
    if how == 0:
        names = ("../x.shp", "/x.dbf", "x" * 300 + ".shp", "plots.gdb/a00000001.gdbtable", "א.zip")
        parts[i] = (str(rng.choice(names)), content)
    elif how == 1:
        parts.append((f"other/{name}", content))
    else:
        parts[i] = (name, _changed(name, content, rng))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for one, inside in dict(parts).items():
            archive.writestr(one, inside)
    return packed.getvalue()


def _json(data: bytes, rng: np.random.Generator) -> bytes:
    root = json.loads(data)
    places: list[tuple[Any, Any]] = []
    stack = [root]
    while stack:
        node = stack.pop()
        inside = node.items() if isinstance(node, dict) else enumerate(node)
        for key, value in inside:
            places.append((node, key))
            if isinstance(value, dict | list):
                stack.append(value)
    node, key = places[rng.integers(len(places))]
    how = rng.integers(5)
    if how == 0:
        del node[key]
    elif how == 1:
        node[key] = [node[key]] * int(rng.integers(1, 50))
    elif how == 2:
        other, where = places[rng.integers(len(places))]
        node[key] = json.loads(json.dumps(other[where]))
    else:
        node[key] = _NASTY_VALUES[rng.integers(len(_NASTY_VALUES))]
    return json.dumps(root).encode()


def _xml(data: bytes, rng: np.random.Generator) -> bytes:
    """Drop, double or misname an element, or write another number or text."""
    pieces = re.split(rb"(<[^>]*>)", data)
    i = int(rng.integers(len(pieces)))
    how = rng.integers(4)
    if how == 0:
        pieces.pop(i)
    elif how == 1:
        pieces.insert(i, pieces[rng.integers(len(pieces))] * int(rng.integers(1, 30)))
    elif how == 2:
        pieces[i] = re.sub(rb"[\d.]+", lambda _: str(rng.choice(_NASTY_CELLS)).encode(), pieces[i])
    else:
        pieces[i] = str(rng.choice(_NASTY_CELLS)).encode()
    return b"".join(pieces)


def _table(data: bytes, rng: np.random.Generator) -> bytes:
    mark = max((b",", b";", b"\t"), key=data.count)
    rows = [line.split(mark) for line in data.split(b"\n")]
    row = rows[rng.integers(len(rows))]
    how = rng.integers(5)
    if how == 0:
        row.pop(int(rng.integers(len(row))))
    elif how == 1:
        rows.insert(0, row * int(rng.integers(1, 40)))
    elif how == 2:
        rows.extend([list(row)] * int(rng.integers(1, 200)))
    else:
        row[rng.integers(len(row))] = str(rng.choice(_NASTY_CELLS)).encode()
    return b"\n".join(mark.join(row) for row in rows)


def _lines(data: bytes, rng: np.random.Generator) -> bytes:
    """Drop, double or exchange lines of a text in lines, or write another number or word."""
    lines = data.split(b"\n")
    i, j = (int(k) for k in rng.integers(0, len(lines), 2))
    how = rng.integers(5)
    if how == 0:
        lines.pop(i)
    elif how == 1:
        lines[i:i] = lines[min(i, j) : max(i, j)][:50] * int(rng.integers(1, 10))
    elif how == 2:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        numbers = [m.span() for m in re.finditer(rb"[-+\d.]+", lines[i])] or [(0, len(lines[i]))]
        start, end = numbers[rng.integers(len(numbers))]
        cell = str(rng.choice(_NASTY_CELLS)).encode()
        lines[i] = lines[i][:start] + cell + lines[i][end:]
    return b"\n".join(lines)


_BINARY = (".shp", ".shx", ".dbf", ".tif", ".fgb", ".parquet", ".xls", ".dat", ".map", ".id")
_BY_ENDING = {
    **dict.fromkeys(_BINARY, _integers),
    **dict.fromkeys((".gpkg", ".sqlite"), _pages),
    **dict.fromkeys((".tab", ".mif", ".mid", ".dxf", ".prj"), _lines),
    ".csv": _table,
}


# --- one input ---------------------------------------------------------------------------------


#: everything that reads a file of plots, plants, lines, rows, blocks, records or inspections
DOORS = ("plots", "crews", "plants", "lines", "rows", "blocks", "records", "reported", "layers")
#: the doors of which another option than that of their seed is asked for
_OWN_OPTIONS = {"plots": PlotOptions, "blocks": PlotOptions}


def door_of(seed: Seed, rng: np.random.Generator) -> Seed:
    """Return the seed at its own door, with what its case chose or without, or at any other."""
    if rng.random() < 0.25:
        return seed._replace(door=str(rng.choice(DOORS)), options=None)
    return seed if rng.random() < 0.7 else seed._replace(options=None)


def read(seed: Seed, parts: tuple[Upload, ...]) -> str:
    """Return what became of an input; raise whatever is no answer for a person."""
    source = parts[0] if len(parts) == 1 else parts
    try:
        _through(seed, source)
    except ChoiceNeeded as asked:
        _check_question(seed, asked)
        return "asked about"
    except FileProblem as refused:
        if "reader crash" in str(refused):
            return "refused with the reader gone"
        return "refused by the clock" if "seconds of work" in str(refused) else "refused"
    except FieldmonError:
        return "refused"
    return "came in"


def _through(seed: Seed, source: Any) -> None:
    """Read through the seed's door, and look at what comes out."""
    if seed.door == "layers":
        reading.list_layers(source)
    elif seed.door == "reported":
        rows = reading.read_inspection_rows(source, seed.options or InspectionOptions()).value
        assert np.isfinite(rows.lonlat[~np.isnan(rows.lonlat).any(axis=1)]).all()
    elif seed.door == "records":
        places = awkward.NamedPlaces((awkward.HOME,), awkward.ROWS)
        options = seed.options or RecordOptions()
        _check_places(reading.read_records(source, options, None, places).value.lonlat)
    elif seed.door == "crews":
        _check_shapes(reading.read_crews(source).value[0])
    elif seed.door == "rows":
        rows = reading.read_rows(source).value
        _check_shapes(rows)
        _lay_along(rows)
    elif seed.door == "blocks":
        drawn = reading.read_blocks(source)
        for block in drawn.value.areas:
            assert block.area.is_valid
            _check_places(shapely.get_coordinates(block.area))
        _check_shapes(drawn.value.cuts)
        for field in parted((awkward.HOME,), drawn).value:
            lay(field)
    else:
        options = seed.options or _OWN_OPTIONS.get(seed.door, lambda: None)()
        _check_shapes(getattr(reading, f"read_{seed.door}")(source, options).value)


def _lay_along(rows: shapely.MultiLineString) -> None:
    """Lay plants along rows that came in, if they are on one plot and a few."""
    west, south, east, north = rows.bounds
    if len(rows.geoms) <= 200 and max(east - west, north - south) < 0.02:
        Plot.along("rows", rows)


def _check_question(seed: Seed, asked: ChoiceNeeded) -> None:
    """Hold that what a question offers can be chosen."""
    if asked.option in {"kind", "plots", "plants"}:
        return  # another file answers
    own = {"plots": PlotOptions, "crews": PlotOptions, "blocks": PlotOptions}
    options = {**own, "records": RecordOptions}.get(seed.door, InspectionOptions)()
    for choice in asked.choices[:5]:
        options.choose(asked.option, choice)


def _check_shapes(value: Any) -> None:
    if isinstance(value, tuple):
        for plot in value:
            assert plot.boundary.is_valid
            _check_places(shapely.get_coordinates(plot.boundary))
    else:
        _check_places(value.lonlat if hasattr(value, "lonlat") else shapely.get_coordinates(value))


def _check_places(lonlat: Any) -> None:
    assert np.isfinite(lonlat).all()
    assert (np.abs(lonlat[:, 0]) <= 360).all()
    assert (np.abs(lonlat[:, 1]) <= 90).all()


@contextmanager
def scratch() -> Iterator[Path]:
    """Make an empty world of files: nothing may be left in it."""
    before = Path.cwd(), dict(os.environ), tempfile.tempdir
    process.stop()
    with tempfile.TemporaryDirectory(prefix="fieldmon-fuzz-") as folder:
        rooms = {name: Path(folder) / name for name in ("seeds", "tmp", "home", "here")}
        for room in rooms.values():
            room.mkdir()
        os.environ |= {"TMPDIR": str(rooms["tmp"]), "HOME": str(rooms["home"])}
        tempfile.tempdir = str(rooms["tmp"])
        os.chdir(rooms["here"])
        try:
            yield Path(folder)
        finally:
            process.stop()
            os.chdir(before[0])
            os.environ.clear()
            os.environ.update(before[1])
            tempfile.tempdir = before[2]


def fuzz(n_inputs: int, first: int = 0, seconds: float = np.inf, step: int = 1) -> Tally:
    """Read so many damaged files, or as many as fit into the seconds; return what became of them.

    Input i is the same on every run: ``first=i, n_inputs=1`` repeats it. Few inputs come of files
    of more kinds where each is a `step` after the one before.
    """
    tally, began = Tally(), time.perf_counter()
    with scratch() as world:
        corpus = seeds(world / "seeds")
        for number in range(first, first + step * n_inputs, step):
            if time.perf_counter() - began > seconds:
                break
            rng = np.random.default_rng(number)
            seed = door_of(corpus[number % len(corpus)], rng)
            _one(number, seed, mutated(seed, rng), tally)
            if (number - first) % 500 == 499:
                so_far = f"{number - first + 1} of {n_inputs}, {len(tally.failures)} failure(s)\n"
                sys.stderr.write(so_far)
        process.stop()
        left = [p for room in ("tmp", "home", "here") for p in (world / room).rglob("*")]
        tally.failures += [f"a file was left: {path.name}" for path in left]
    if tally.peak_bytes > limits.MEMORY_BYTES:
        tally.failures.append(f"a reader took {limits.size(tally.peak_bytes)} of memory")
    return tally


def _one(number: int, seed: Seed, parts: tuple[Upload, ...], tally: Tally) -> None:
    began, worked_s = time.perf_counter(), _worked_s()
    try:
        became = read(seed, parts)
        tally.outcomes[became] += 1
        if became.startswith("refused "):
            tally.notable.append(f"input {number} ({seed.name}): {became}")
    except Exception as wrong:  # noqa: BLE001 - that is what is looked for
        tally.outcomes["failed"] += 1
        last = "".join(traceback.format_exception_only(wrong)).strip()
        tally.failures.append(f"input {number} ({seed.name}): {last[:300]}")
    took_s = time.perf_counter() - began
    tally.peak_bytes = max(tally.peak_bytes, *process.peaks_bytes(), 0)
    if took_s > tally.slowest_s:
        tally.slowest_s, tally.slowest = took_s, f"input {number}"
    spent = [now_s - worked_s.get(pid, 0.0) for pid, now_s in _worked_s().items()]
    tally.hardest_s = max(tally.hardest_s, *spent, 0.0)
    if max(spent, default=0.0) > limits.READ_SECONDS + 3.0:
        tally.failures.append(f"input {number} ({seed.name}) worked {max(spent):.1f} s")
    if took_s > SECONDS:
        tally.failures.append(f"input {number} ({seed.name}) took {took_s:.1f} s")


def _worked_s() -> dict[int, float]:
    """Return how long each waiting reader has worked so far, its start included."""
    return {one.pid: process._work(one.pid).worked_s for one in process._IDLE._readers}


def main() -> None:
    """Fuzz by command; end with 1 where anything failed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--inputs", type=int, default=5000)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    chosen = parser.parse_args()
    tally = fuzz(chosen.inputs, chosen.first)
    sys.stdout.write("\n".join([*tally.notable, *tally.failures, str(tally), ""]))
    sys.exit(bool(tally.failures))


if __name__ == "__main__":
    main()
