"""A raster opened in the reading process: where it lies, and its bands."""

from __future__ import annotations

import math
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rasterio
from rasterio._err import CPLE_BaseError
from rasterio.errors import RasterioError

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.signatures import FileKind
from fieldmon.io.import_report import ImportMessage, seen
from fieldmon.io.options import source_name
from fieldmon.io.parse.crs import (
    Transformation,
    ask_for_crs,
    code_of,
    system,
    transformation_from,
)
from fieldmon.io.rasters.values import Affine, map_xy
from fieldmon.io.sandbox import limits
from fieldmon.io.sandbox.unpack import choose_member, members
from fieldmon.io.sandbox.workroom import Workroom

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pyproj
    from numpy.typing import NDArray
    from rasterio.io import DatasetReader

    from fieldmon.io.options import Source
    from fieldmon.io.rasters.values import RasterOptions

    Float = NDArray[np.float64]
    Bounds = tuple[float, float, float, float]

# GDAL's cache counts against the limit on memory
_CACHE_BYTES = 64_000_000
_MOST_TEXT = 20_000
_UNREADABLE = (RasterioError, CPLE_BaseError, ValueError, OSError, OverflowError)


@dataclass(frozen=True, eq=False)
class OpenRaster:
    """A raster that is open, and where it lies."""

    tif: DatasetReader
    name: str
    to_map: Affine
    crs: pyproj.CRS
    transformation: Transformation
    messages: tuple[ImportMessage, ...]


@contextmanager
def open_raster(folder: str, source: Source, options: RasterOptions) -> Iterator[OpenRaster]:
    """Open the one raster of a source; whatever GDAL says against it becomes a `FileProblem`."""
    room = Workroom(Path(folder))
    found = members(source, room)
    rasters = tuple(member for member in found if member.kind is FileKind.RASTER)
    if not rasters:
        raise FileProblem(
            worded(
                "{source_name} must be a GeoTIFF, but it is not. Choose one.",
                source_name=source_name(source),
            )
        )
    member = choose_member(rasters, options.member, source_name(source))
    path = room.stage(member)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # affine 3's, and a raster without a place is ours to say
        try:
            # this driver alone: no other reads what a stranger calls .tif
            with (
                rasterio.Env(GDAL_CACHEMAX=_CACHE_BYTES),
                rasterio.open(path, driver="GTiff", sharing=False) as tif,
            ):
                yield _placed(tif, path, member.name, options)
        except _UNREADABLE as bad:
            raise FileProblem(
                worded(
                    "{name} must be a whole GeoTIFF, but it cannot be read "
                    "({short}). Export or download it again.",
                    name=member.name,
                    short=_short(bad),
                )
            ) from bad


def _placed(tif: DatasetReader, path: Path, name: str, options: RasterOptions) -> OpenRaster:
    _check_shape(tif, name)
    to_map = _to_map(tif, name)
    size = np.array([[tif.width / 2, tif.height / 2]])
    middle = map_xy(to_map, size)[0]
    crs, messages = _system(tif, path, to_map, options)
    if crs.is_geographic and 180.0 < middle[0] <= 360.0:  # counted eastward all around the earth
        to_map = (*to_map[:2], to_map[2] - 360.0, *to_map[3:])
        middle = map_xy(to_map, size)[0]
        messages.append(
            seen(worded("Longitudes beyond 180 degrees were read as west of Greenwich."))
        )
    if crs.is_geographic and (abs(middle[0]) > 180 or abs(middle[1]) > 90):
        raise ask_for_crs(
            middle[None],
            options,
            worded(
                "{name} says {name_2}, in degrees, but it lies nowhere so.",
                name=name,
                name_2=crs.name,
            ),
        )
    through = transformation_from(crs, (float(middle[0]), float(middle[1])))
    if not np.isfinite(through.lonlat(middle[None])).all():
        raise FileProblem(
            worded(
                "{name} must lie where {system} is defined, but it does not. "
                "Name the right coordinate system.",
                name=name,
                system=crs.name,
            )
        )
    said = (*messages, *_about_lines(to_map), *through.messages())
    return OpenRaster(tif, name, to_map, crs, through, said)


def _about_lines(to_map: Affine) -> list[ImportMessage]:
    """Return what to say of lines of pixels that do not run eastward, the first in the north."""
    a, b, _, d, e, _ = to_map
    if abs(b) > 1e-6 * abs(a) or abs(d) > 1e-6 * abs(e):
        said = worded(
            "The raster is turned by {turn:.4g} degrees; positions follow it.",
            turn=math.degrees(math.atan2(d, a)),
        )
    elif e > 0:
        said = worded("The raster's first line lies in the south; positions follow it.")
    else:
        return []
    return [seen(said)]


def _check_shape(tif: DatasetReader, name: str) -> None:
    if tif.count == 0:
        raise FileProblem(
            worded("{name} must hold a band of values, but it holds none.", name=name)
        )
    limits.check("bands", tif.count, limits.BANDS, name)
    if any(np.dtype(kind).kind == "c" for kind in tif.dtypes):
        raise FileProblem(
            worded(
                "{name} must hold plain numbers, but it holds complex ones "
                "(radar?). Make a raster of plain numbers from it.",
                name=name,
            )
        )
    high, wide = tif.block_shapes[0]
    pixel_bytes = sum(np.dtype(kind).itemsize for kind in tif.dtypes)
    if high * wide * pixel_bytes > limits.BLOCK_BYTES:
        raise FileProblem(
            worded(
                "A raster must be cut into tiles or strips of {size} at most, "
                "but those of {name} have {has}. Save it as a Cloud "
                "Optimised GeoTIFF.",
                size=limits.size(limits.BLOCK_BYTES),
                name=name,
                has=limits.size(high * wide * pixel_bytes),
            )
        )


def _to_map(tif: DatasetReader, name: str) -> Affine:
    """Return where the pixels lie; refuse a raster that does not say."""
    if tif.transform.is_identity:
        if tif.gcps[0] or tif.rpcs is not None:
            raise FileProblem(
                worded(
                    "{name} must say where its pixels lie, but it only holds "
                    'control points. Rectify it first ("warp" in a GIS).',
                    name=name,
                )
            )
        raise FileProblem(
            worded(
                "{name} must say where on the earth it lies, but it is a "
                "picture without a position. Georeference it in a GIS, or "
                "bring its world file (.tfw) along.",
                name=name,
            )
        )
    to_map: Affine = tuple(float(number) for number in tif.transform[:6])  # type: ignore[assignment]
    a, b, _, d, e, _ = to_map
    sides = math.hypot(a, d) * math.hypot(b, e)
    if not (
        np.isfinite(to_map).all() and 0.0 < sides < np.inf and abs(a * e - b * d) > 1e-6 * sides
    ):
        raise FileProblem(
            worded(
                "The pixels of {name} must cover some ground, but its "
                "georeference says they do not ({names}). Georeference it "
                "again.",
                name=name,
                names=", ".join(f"{number:.6g}" for number in to_map),
            )
        )
    return to_map


def _system(
    tif: DatasetReader, path: Path, to_map: Affine, options: RasterOptions
) -> tuple[pyproj.CRS, list[ImportMessage]]:
    if options.crs is not None:
        chosen = system(options.crs)
        return chosen, [
            seen(
                worded(
                    "Read in {name} ({code}), as chosen.",
                    name=chosen.name,
                    code=code_of(chosen),
                )
            )
        ]
    beside = path.with_suffix(".prj")
    for text, where in ((_own(tif), None), (_text(beside), "the .prj file beside it")):
        try:
            crs = system(text) if text else None
        except ChoiceNeeded:
            crs = None
        if crs is not None and (crs.is_geographic or crs.is_projected):
            said = (
                []
                if where is None
                else [seen(worded("The coordinate system was taken from {where}.", where=where))]
            )
            return crs, said
    ends = map_xy(to_map, np.array([[0.0, 0.0], [tif.width, tif.height]]))
    raise ask_for_crs(ends, options, worded("The raster does not say its coordinate system."))


def _own(tif: DatasetReader) -> str:
    return tif.crs.to_wkt() if tif.crs else ""


def _text(path: Path) -> str:
    if not path.exists():
        return ""
    with path.open("rb") as file:
        return file.read(_MOST_TEXT).decode("utf-8", "replace")


def band_named(opened: OpenRaster, wanted: str) -> int:
    """Return the number of the band that is named; raise `ChoiceNeeded` where there is none."""
    tif = opened.tif
    text = wanted.strip()
    if text in tif.descriptions:
        return int(tif.descriptions.index(text)) + 1
    if text.isdecimal() and 1 <= int(text) <= tif.count:
        return int(text)
    raise ChoiceNeeded(
        worded(
            "{name} holds the bands 1 to {count}, but {wanted!r} was asked "
            "for. Choose one of them.",
            name=opened.name,
            count=tif.count,
            wanted=wanted,
        ),
        "band",
        tuple(str(b) for b in range(1, tif.count + 1)),
    )


def _short(bad: BaseException) -> str:
    text = " ".join(str(bad).split()) or type(bad).__name__
    return text if len(text) < 160 else f"{text[:157]}..."
