"""A raster opened in the reading process: where it lies, its bands, and what is read of it."""

from __future__ import annotations

import math
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import rasterio
from rasterio._err import CPLE_BaseError
from rasterio.enums import MaskFlags, Resampling
from rasterio.errors import RasterioError
from rasterio.windows import Window

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.signatures import FileKind
from fieldmon.io.import_report import ImportMessage, Remedy, guessed, seen
from fieldmon.io.options import source_name
from fieldmon.io.parse.crs import (
    Transformation,
    ask_for_crs,
    code_of,
    km_between,
    system,
    transformation_from,
)
from fieldmon.io.rasters.values import Affine, map_xy, pixel_xy, projected
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
# about a plot, this much more of the raster is read: of its size, and metres
_MARGIN = 0.25
_MARGIN_M = 30.0
#: at the equator
M_PER_DEGREE = 111_320.0
# what people write for no value and forget to declare
_SENTINELS = (-9999.0, -99999.0, -32768.0, -999999.0)
_HUGE = 1e30
_MOST_TEXT = 20_000
_UNREADABLE = (RasterioError, CPLE_BaseError, ValueError, OSError, OverflowError)


class RasterPart(NamedTuple):
    """The part of a raster that is read, and the pixels ``(h, w)`` it is read to."""

    window: Window
    shape: tuple[int, int]

    @property
    def step(self) -> float:
        """Return how many pixels of the file become one."""
        return float(max(self.window.width / self.shape[1], self.window.height / self.shape[0]))

    def to_map(self, of_file: Affine) -> Affine:
        """Return where the pixels lie that were read."""
        a, b, _, d, e, _ = of_file
        x, y = map_xy(of_file, np.array([[self.window.col_off, self.window.row_off]]))[0]
        wide = self.window.width / self.shape[1]
        high = self.window.height / self.shape[0]
        return (a * wide, b * high, float(x), d * wide, e * high, float(y))


@dataclass(frozen=True, eq=False)
class OpenRaster:
    """A raster that is open, and where it lies."""

    tif: DatasetReader
    name: str
    to_map: Affine
    crs: pyproj.CRS
    transformation: Transformation
    messages: tuple[ImportMessage, ...]


@dataclass(frozen=True, eq=False)
class ReadPixels:
    """What was read of a raster.

    Parameters
    ----------
    values
        ``(bands, h, w)`` as they are stored.
    missing
        ``(h, w)`` whether a pixel has no value.
    messages
        What the raster is, how much of it was read, and what was seen on the way.
    """

    values: NDArray[Any]
    missing: NDArray[np.bool_]
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
    a, b, _, d, e, _ = to_map
    if abs(b) > 1e-6 * abs(a) or abs(d) > 1e-6 * abs(e):
        turn = math.degrees(math.atan2(d, a))
        messages.append(
            seen(
                worded(
                    "The raster is turned by {turn:.4g} degrees; positions follow it.", turn=turn
                )
            )
        )
    elif e > 0:
        messages.append(
            seen(worded("The raster's first line lies in the south; positions follow it."))
        )
    return OpenRaster(tif, name, to_map, crs, through, (*messages, *through.messages()))


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


def part_of(opened: OpenRaster, bounds: Bounds | None, most: int, n_bands: int = 1) -> RasterPart:
    """Return what is read: within bounds or all, not more pixels than `most`."""
    window = _window(opened, bounds)
    step = max(1.0, math.sqrt(window.width * window.height / most))
    high = max(1, int(window.height / step))
    wide = max(1, min(int(window.width / step), most // high))
    shape = (min(high, most // wide), wide)
    # GDAL decodes the smallest overview that is fine enough, or the raster itself
    overview = max((o for o in opened.tif.overviews(1) if o <= step), default=1)
    pixel_bytes = sum(np.dtype(kind).itemsize for kind in opened.tif.dtypes)
    decoded = window.width * window.height / overview**2 * max(pixel_bytes, n_bands)
    if decoded > limits.RASTER_BYTES:
        raise FileProblem(
            worded(
                "{size} of a raster may be read at most, but {name} ({width} "
                "x {height} pixels) would take {has}. Cut it to the plot, "
                "or save it as a Cloud Optimised GeoTIFF, which holds smaller "
                "copies of itself.",
                size=limits.size(limits.RASTER_BYTES),
                name=opened.name,
                width=opened.tif.width,
                height=opened.tif.height,
                has=limits.size(decoded),
            )
        )
    return RasterPart(window, shape)


def _window(opened: OpenRaster, bounds: Bounds | None) -> Window:
    whole = Window(0, 0, opened.tif.width, opened.tif.height)
    if bounds is None:
        return whole
    places = pixel_xy(opened.to_map, projected(opened.transformation, _around(bounds)))
    places = places[np.isfinite(places).all(axis=1)]
    if len(places):
        low = np.clip(np.floor(places.min(axis=0)), 0, (whole.width, whole.height)).astype(int)
        high = np.clip(np.ceil(places.max(axis=0)), 0, (whole.width, whole.height)).astype(int)
        if (high > low).all():
            return Window(*(int(n) for n in (*low, *(high - low))))
    middle = opened.transformation.lonlat(
        map_xy(opened.to_map, np.array([[whole.width / 2, whole.height / 2]]))
    )[0]
    plot = ((bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2)
    away = km_between(plot, (float(middle[0]), float(middle[1])))
    raise FileProblem(
        worded(
            "{name} must lie on the plot, at least in part, but its middle is "
            "{away:.3g} km away, at {value:.4f}, {lat:.4f}. Choose another "
            "raster, or name its right coordinate system.",
            name=opened.name,
            away=away,
            value=middle[0],
            lat=middle[1],
        )
    )


def _around(bounds: Bounds) -> Float:
    """Return points along a box about the bounds, ``(n, 2)`` degrees."""
    west, south, east, north = bounds
    degrees = _MARGIN_M / M_PER_DEGREE
    by_lat = max((north - south) * _MARGIN, degrees)
    by_lon = max((east - west) * _MARGIN, degrees / max(math.cos(math.radians(south)), 0.01))
    steps = np.linspace(0.0, 1.0, 9)
    lon, lat = np.meshgrid(
        west - by_lon + steps * (east - west + 2 * by_lon),
        south - by_lat + steps * (north - south + 2 * by_lat),
    )
    return np.stack([lon.ravel(), np.clip(lat.ravel(), -90, 90)], axis=1)


def _without_value(
    opened: OpenRaster,
    bands: tuple[int, ...],
    part: RasterPart,
    raw: NDArray[Any],
    nodata: str | None,
) -> tuple[NDArray[np.bool_], list[ImportMessage]]:
    """Return which pixels ``(h, w)`` hold no value, by the file's word or by what was chosen."""
    if nodata == "none":
        return np.zeros(part.shape, bool), []
    # black may be declared as nodata, but a pixel is missing only where all colours are
    missing = np.ones(part.shape, bool)
    for band in bands:
        if MaskFlags.all_valid in opened.tif.mask_flag_enums[band - 1]:
            missing[:] = False
            break
        missing &= opened.tif.read_masks(band, window=part.window, out_shape=part.shape) == 0
    if nodata is not None:
        return missing | (raw == float(nodata)).all(axis=0), []
    declared = [opened.tif.nodatavals[band - 1] for band in bands]
    found = [] if any(value is not None for value in declared) else _undeclared(raw, missing)
    return missing, found


def _undeclared(raw: NDArray[Any], missing: NDArray[np.bool_]) -> list[ImportMessage]:
    """Take out what looks like an undeclared nodata value, and say so."""
    if raw.dtype.kind not in "if":
        return []
    huge = np.zeros(raw.shape, bool)
    if raw.dtype.kind == "f":
        np.greater(np.abs(raw), _HUGE, out=huge)
    sentinels = [n for n in _SENTINELS if (raw == n).any()]
    odd = huge.all(axis=0) | np.logical_or.reduce([(raw == n).all(axis=0) for n in sentinels])
    odd &= ~missing
    if not odd.any():
        return []
    missing |= odd
    what = ", ".join([*(f"{n:g}" for n in sentinels), *(["beyond 1e30"] if huge.any() else [])])
    return [
        guessed(
            worded(
                "Values of {what} were taken as no value, although the raster "
                "declares none ({value:.3g} % of the pixels read).",
                what=what,
                value=100 * odd.mean(),
            ),
            remedy=Remedy("nodata", "none", worded("They are values")),
        )
    ]


def read_pixels(
    opened: OpenRaster,
    bands: tuple[int, ...],
    part: RasterPart,
    options: RasterOptions,
    resampling: Resampling = Resampling.nearest,
) -> ReadPixels:
    """Return a part of some bands."""
    values = opened.tif.read(
        bands, window=part.window, out_shape=(len(bands), *part.shape), resampling=resampling
    )
    missing, said = _without_value(opened, bands, part, values, options.nodata)
    messages = (_what_was_read(opened, bands, part), *opened.messages, *said)
    return ReadPixels(values, missing, messages)


def _what_was_read(opened: OpenRaster, bands: tuple[int, ...], part: RasterPart) -> ImportMessage:
    """Return what the raster is, and how much of it was read."""
    tif = opened.tif
    window = part.window
    middle = np.array([window.col_off + window.width / 2, window.row_off + window.height / 2])
    ends = opened.transformation.lonlat(
        map_xy(opened.to_map, middle + np.array([[0.0, 0.0], [1.0, 0.0]]))
    )
    metres = 1000 * km_between(*((float(lon), float(lat)) for lon, lat in ends))
    listed = f"band{'s' if len(bands) > 1 else ''} {', '.join(map(str, bands))} of {tif.count}"
    shrunk = f"; read at every {part.step:.3g}th pixel" if part.step > 1.001 else ""
    return seen(
        worded(
            "{name}: {listed} ({value}), {width} x {height} pixels of {metres:.3g} m{shrunk}.",
            name=opened.name,
            listed=listed,
            value=tif.dtypes[bands[0] - 1],
            width=tif.width,
            height=tif.height,
            metres=metres,
            shrunk=shrunk,
        )
    )


def _short(bad: BaseException) -> str:
    text = " ".join(str(bad).split()) or type(bad).__name__
    return text if len(text) < 160 else f"{text[:157]}..."
