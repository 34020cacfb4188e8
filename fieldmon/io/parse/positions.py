"""Where the features or records of a layer are, in whichever way it says so."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyproj
import shapely
from pyproj.exceptions import CRSError

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import WGS84, Layer, text
from fieldmon.io.import_report import (
    ImportMessage,
    Remedy,
    doubtful,
    dropped,
    guessed,
    repaired,
    seen,
)
from fieldmon.io.options import RecordOptions
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.degrees import (
    all_degrees,
    halves,
    is_dotted,
    is_lettered,
    positions_in_cells,
)
from fieldmon.io.parse.geometry import geometry_kinds
from fieldmon.io.parse.georeference import few_unplaceable, place, written
from fieldmon.io.parse.named_positions import placed_by_name
from fieldmon.io.parse.utm_zones import stated_zone
from fieldmon.io.parse.values import is_missing, numbers, plain_numbers
from fieldmon.io.readers.places import NamedPlaces, PlacedByName

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import ReadOptions

#: coordinates rounded to more than this cannot tell neighbouring plants apart, whatever their
#: spacing is
_COARSE_M = 1.5


@dataclass(frozen=True, eq=False)
class LocatedFeatures:
    """The features of a layer that have a position.

    Parameters
    ----------
    layer
        Those features.
    lonlat
        ``(n, 2)`` degrees.
    accuracy_m
        ``(n,)`` what the way of writing positions leaves open; NaN where that is nothing.
    messages
        What was found on the way.
    plot
        ``(n,)`` name of the plot that each is on by its own words; None where they name none.
    unread
        What was left out because nobody can read where it is.
    step_m
        To which positions are rounded; 0 where they are not.
    by_name
        Whether they name where they are, and give no position.
    """

    layer: Layer
    lonlat: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    messages: tuple[ImportMessage, ...]
    plot: NDArray[np.str_] | None = None
    unread: Unread | None = None
    step_m: float = 0.0
    by_name: bool = False


def located(
    layer: Layer, options: ReadOptions, places: NamedPlaces | None = None
) -> LocatedFeatures:
    """Return the features of a layer that have a position, or name a place that has one."""
    if isinstance(options, RecordOptions) and options.place == "plant":
        return _kept(layer, placed_by_name(layer, options, places or NamedPlaces()))
    if layer.geometry is not None:
        return _points(layer, options)
    way = _way(layer, options)
    if way is not None:
        return _by_coordinates(layer, options, *way)
    return _kept(layer, placed_by_name(layer, options, places or NamedPlaces()))


def _points(layer: Layer, options: ReadOptions) -> LocatedFeatures:
    geometry = layer.geometry
    areas, lines, points = geometry_kinds(np.asarray(geometry))
    if geometry is None or not points.any():
        raise FileProblem(
            worded(
                "{file} must hold points, but it holds {areas} {areas:area|areas} and {lines} "
                "{lines:line|lines}. "
                "Choose another file or layer.",
                file=layer.name,
                areas=int(areas.sum()),
                lines=int(lines.sum()),
            )
        )
    messages, unread = [], None
    others = len(layer) - int(points.sum())
    if others:
        messages.append(
            dropped(
                worded(
                    "{n} {n:feature|features} that {n:is|are} no {n:point was|points were} "
                    "left out.",
                    n=others,
                )
            )
        )
    single, index = shapely.get_parts(geometry[points], return_index=True)
    xy, of = shapely.get_coordinates(single), np.flatnonzero(points)[index]
    named, said = stated_zone(layer.take(of), xy, options, layer.crs)
    crs = layer.crs or named
    wrong = few_unplaceable(xy, crs, options)
    if wrong.any():
        at = {int(of[k]): written(xy[k]) for k in np.flatnonzero(wrong)}
        unread = Unread(len(at), 0, 0, at)
        messages += unread.messages()
    kept = layer.take(of[~wrong])
    placed = place(xy[~wrong], crs, options)
    accuracy, coarse = _rounding(placed.step_m, len(kept))
    found = (*messages, *said, *placed.messages, *coarse)
    return LocatedFeatures(
        kept, placed.lonlat, accuracy, found, unread=unread, step_m=placed.step_m
    )


def _way(layer: Layer, options: ReadOptions) -> tuple[str, tuple[str, ...]] | None:
    """Return how a table gives positions, and in which columns; None where it gives none."""
    by_hand = {role for role, _ in options.columns}

    def named(*roles: str) -> tuple[str, ...]:
        return tuple(n for r in roles if (n := options.column(r) or find(r, layer.columns)))

    degrees, metres, together = named("lon", "lat"), named("x", "y"), named("position")
    if len(metres) == 2 and by_hand & {"x", "y"}:
        return "metres", metres
    if len(degrees) == 2 and "position" not in by_hand:
        return "degrees", degrees
    if together and ("position" in by_hand or _holds_pairs(layer, together[0])):
        return "together", together
    if len(metres) == 2 and not _are_numbers_of_plants(layer, metres):
        return "metres", metres
    return None


def _holds_pairs(layer: Layer, name: str) -> bool:
    some = [text(v) for v in layer.column(name)[:50] if not is_missing(v)]
    # what a dotted notation means is asked later
    return bool(some) and bool(np.isfinite(positions_in_cells(some, "dm").values).any())


def _are_numbers_of_plants(layer: Layer, names: tuple[str, ...]) -> bool:
    """Return whether x and y are small whole numbers: places in a grid, not on the earth."""
    xy = np.stack([numbers(layer.column(name)) for name in names], axis=1)
    xy = xy[np.isfinite(xy).all(axis=1)]
    return len(xy) > 0 and bool(((xy == np.round(xy)) & (xy >= 0) & (xy < 2000)).all())


def _by_coordinates(
    layer: Layer, options: ReadOptions, how: str, names: tuple[str, ...]
) -> LocatedFeatures:
    shown = ", ".join(repr(name) for name in names)  # in a sentence of any language
    xy, crs, messages = _coordinates(layer, options, how, names)
    stated, more = _stated_crs(layer, options)
    if stated is None and how == "metres":
        stated, said = stated_zone(layer, xy, options)
        more += said
    there = _finite(xy)
    there[there] = ~few_unplaceable(xy[there], stated or crs, options)
    unread = Unread.of(layer, names, there)
    if unread.n_dotted * 2 > len(layer) - unread.n_empty:
        raise unread.ask()
    if not there.any():
        raise FileProblem(
            worded(
                "{shown} of {name} must hold positions, but not one "
                "record has any{seen_in}. Correct them or name other columns.",
                shown=shown,
                name=layer.name,
                seen_in=unread.shown(),
            )
            + unread.of_letter_o()
        )
    messages += unread.messages()
    placed = place(xy[there], stated or crs, options)
    accuracy, coarse = _rounding(placed.step_m, int(there.sum()))
    found = (seen(worded("Positions were read from {shown}.", shown=shown)), *messages, *more)
    return LocatedFeatures(
        layer.take(np.flatnonzero(there)),
        placed.lonlat,
        accuracy,
        (*found, *placed.messages, *coarse),
        unread=unread,
        step_m=placed.step_m,
    )


def _finite(xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.asarray(np.isfinite(xy).all(axis=1), dtype=bool)


def _coordinates(
    layer: Layer, options: ReadOptions, how: str, names: tuple[str, ...]
) -> tuple[NDArray[np.float64], str | None, list[ImportMessage]]:
    """Return what the columns hold ``(n, 2)``, its coordinate system if that is sure, messages."""
    columns = [layer.column(name) for name in names]
    if how == "metres":
        return np.stack([numbers(c, options.decimal) for c in columns], axis=1), None, []
    if how == "together":
        read = positions_in_cells([text(v) for v in columns[0]], options.degrees)
        return read.values, WGS84, _order_of(read.is_certain or options.swap_axes, names[0])
    read_as = partial(all_degrees, decimal=options.decimal, how=options.degrees)
    xy = np.stack([read_as(c) for c in columns], axis=1)
    if _letters_are_crossed(layer, names):
        said = worded("Longitudes stood in the column of latitudes; exchanged.")
        return xy[:, ::-1], WGS84, [repaired(said)]
    return xy, WGS84, []


def _letters_are_crossed(layer: Layer, names: tuple[str, ...]) -> bool:
    columns = [layer.column(name) for name in names]
    if any(plain_numbers(column) is not None for column in columns):
        return False
    lon, lat = ([text(v) for v in column] for column in columns)
    crossed = is_lettered(lon, "NS") or is_lettered(lat, "EW")
    return crossed and not is_lettered(lon, "EW") and not is_lettered(lat, "NS")


def _order_of(is_certain: bool, name: str) -> list[ImportMessage]:  # noqa: FBT001 - one caller
    if is_certain:
        return []
    return [
        guessed(
            worded("Both coordinates stand in one column; they were read as latitude, longitude."),
            name,
            Remedy("swap_axes", "yes", worded("Read as longitude, latitude")),
        )
    ]


class Unread(NamedTuple):
    """Records whose position cannot be read: how many, those written as 35.26.33, and which."""

    n: int
    n_empty: int
    n_dotted: int
    written: dict[int, str]

    @classmethod
    def of(cls, layer: Layer, names: tuple[str, ...], there: NDArray[np.bool_]) -> Unread:
        """Return the records of a table that are not `there`, with what stands in its columns."""
        records = np.flatnonzero(~there)
        columns = [[text(v) for v in layer.column(name)[records]] for name in names]
        n_empty = n_dotted = 0
        at: dict[int, str] = {}
        for i, cells in zip(records.tolist(), zip(*columns, strict=True), strict=True):
            if all(is_missing(cell) for cell in cells):
                n_empty += 1
                continue
            n_dotted += any(is_dotted(c) for cell in cells for c in (cell, *(halves(cell) or ())))
            at[i] = " / ".join(cells)
        return cls(len(records), n_empty, n_dotted, at)

    def shown(self) -> str:
        """Return some of them, to end a sentence with."""
        some = [f"{at!r} in record {record + 1}" for record, at in self.written.items()][:_SHOWN]
        return f", for instance {', '.join(some)}" if some else ""

    def of_letter_o(self) -> str:
        """Return what to say of the letter O beside degrees, if it is in all that is written."""
        beside = re.compile(r"[\d'\"″′]\s*O\b|\bO\s*\d")
        if not self.written or not all(map(beside.search, self.written.values())):
            return ""
        said = worded("O can mean west (oeste, ouest) or east (Ost): write W or E.")
        return f" {said}"

    def ask(self) -> ChoiceNeeded:
        """Return the question what two points mean."""
        return ChoiceNeeded(
            worded(
                "{n_dotted} {n_dotted:record gives|records give} degrees with two points{shown}. "
                "35.26.33 can mean degrees, minutes and seconds (degrees=dms) "
                "or degrees and minutes with decimals (degrees=dm). Choose "
                "one.",
                n_dotted=self.n_dotted,
                shown=self.shown(),
            ),
            "degrees",
            ("dms", "dm"),
        )

    def messages(self) -> list[ImportMessage]:
        """Return what to say of them; nothing where there are none."""
        if not self.n:
            return []
        said = worded(
            "{n} {n:record|records} without a usable position {n:was|were} left out{shown}.",
            n=self.n,
            shown=self.shown(),
        )
        if not self.n_dotted:
            return [dropped(said)]
        many = worded(
            "{said} {n_dotted} of them have two points, as 35.26.33.",
            said=said,
            n_dotted=self.n_dotted,
        )
        label = worded("Read them as degrees, minutes and seconds")
        return [dropped(many, remedy=Remedy("degrees", "dms", label, ("dm",)))]


_SHOWN = 3


def _stated_crs(layer: Layer, options: ReadOptions) -> tuple[str | None, list[ImportMessage]]:
    """Return the coordinate system that a column of the table states for all of its records."""
    name = options.column("crs") or find("crs", layer.columns)
    if name is None or options.crs is not None:
        return None, []
    stated = {text(v) for v in layer.column(name) if not is_missing(v)}
    if name == find("date", layer.columns) and not any(map(_known_system, sorted(stated)[:20])):
        return None, []  # Datum: the day in German, the system in English
    if len(stated) > 1:
        raise ChoiceNeeded(
            worded(
                "All records must be in one coordinate system, but column {name!r} names {n}: "
                "{names}. Choose the records of one of them.",
                name=name,
                n=len(stated),
                names=", ".join(sorted(stated)[:5]),
            ),
            "where",
            tuple(f"{name}={value}" for value in sorted(stated)),
        )
    for value in stated:
        known = _known_system(value)
        if known is None:
            said = worded(
                "It names the coordinate system {value!r}, which is not known.", value=value
            )
            return None, [doubtful(said, name)]
        return known, [
            seen(worded("Column {name!r} names the coordinate system {crs}.", name=name, crs=value))
        ]
    return None, []


def _known_system(value: str) -> str | None:
    known = f"EPSG:{value}" if re.fullmatch(r"\d{4,6}", value) else value
    try:
        pyproj.CRS.from_user_input(known)
    except CRSError:
        return None
    return known


def _kept(layer: Layer, named: PlacedByName) -> LocatedFeatures:
    there = _finite(named.lonlat)
    if not there.any():
        said = " ".join(message.sentence for message in named.messages)
        raise FileProblem(
            worded(
                "Records of {name} must name places that are known, but none does. {said}",
                name=layer.name,
                said=said,
            )
        )
    return LocatedFeatures(
        layer.take(np.flatnonzero(there)),
        named.lonlat[there],
        named.accuracy_m[there],
        named.messages,
        None if named.plot is None else named.plot[there],
        by_name=True,
    )


def _rounding(step_m: float, n: int) -> tuple[NDArray[np.float64], list[ImportMessage]]:
    """Return the accuracy that rounding leaves ``(n,)``, and a doubt where that is too little."""
    if step_m <= _COARSE_M:
        return np.full(n, np.nan), []
    return np.full(n, step_m / np.sqrt(6)), [  # both axes, each even over the step
        doubtful(
            worded(
                "Coordinates are rounded to about {step}: too coarse to name a plant. "
                "They are used with that accuracy.",
                step=distance_figure(step_m),
            )
        )
    ]
