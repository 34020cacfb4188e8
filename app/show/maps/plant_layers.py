"""The plants on a map, whatever their number; finds told by shape too."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from pydeck import Layer

from fieldmon.io.writers.day_file import faces
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.projection import M_PER_DEGREE

from ...words import texts
from ...words.language import number
from .colours import FOUND
from .deck import ArraysLayer

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.plot.grid import PlantGrid

    from .colours import Colour, Shade

    #: sentences, and which of them holds for each plant ``(n,)``
    Known = tuple[tuple[str, ...], NDArray[np.integer]]

# of the least spacing: how far each of two faces is drawn from the middle of its plant, how large
_FACE_OFF, _FACE_SIZE = 0.25, 0.6
# plots are not changed once laid; where their plants are goes when they do
_PLACES: WeakKeyDictionary[PlantGrid, bytes] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class PlantNotes:
    """What is said of a plant that is pointed at, beside its row and number.

    Parameters
    ----------
    chance
        ``(n,)`` chances to say, or None.
    by_rank
        A sentence for each rank of the shade; none: nothing is said.
    known
        What is known of plants, in sentences.
    level
        How far all chances may be off together, or None; each plant's interval is worked out
        where it is shown.
    """

    chance: NDArray[np.float64] | None = None
    by_rank: tuple[str, ...] = ()
    known: Known | None = None
    level: LevelRange | None = None


def plants(
    grid: PlantGrid, shade: Shade, notes: PlantNotes | None = None, name: str = "plants"
) -> Layer:
    """Return the plants: from near a point each, from far one picture (the browser knows when)."""
    notes = notes or PlantNotes()
    arrays = {"places": _places(grid), "ranks": shade.rank.tobytes()}
    tips: dict[str, object] = {"text": texts.TIP_PLANT if grid.in_rows else texts.TIP_ALONE}
    if grid.row_names:
        tips["rows"] = grid.line_signs
    if notes.chance is not None:
        arrays["values"] = notes.chance.astype("<f4").tobytes()
        tips["values"] = texts.TIP_CHANCE
        tips |= {"least": texts.TIP_LEAST, "most": texts.TIP_MOST}
        tips["half"] = texts.IN_PERCENT.format(value=number(50.0, ".1f"))
        if notes.level is not None and notes.level.low < notes.level.high:
            tips["between"] = texts.TIP_CHANCE_BETWEEN
            tips["odds"] = [float(f"{end:.5g}") for end in (notes.level.low, notes.level.high)]
    elif notes.by_rank:
        tips["ranks"] = list(notes.by_rank)
    if notes.known is not None:
        sentences, which = notes.known
        arrays["notes"] = which.astype("<u2").tobytes()
        tips["notes"] = list(sentences)
    if grid.has_faces:
        tips["faces"] = texts.TIP_FACE
    return ArraysLayer(
        "PlantsLayer", arrays, id=name, table=shade.table.tolist(), tips=tips,
        radius=0.4 * _size_m(grid), apart=min(grid.plant_spacing_m, grid.row_spacing_m),
    )  # fmt: skip


def drawn_at(grid: PlantGrid, plants: NDArray[np.integer] | None = None) -> NDArray[np.float64]:
    """Return where plants are drawn ``(k, 2)``, lon/lat: each of two faces towards its own aisle.

    So each is seen and can be pointed at: both have one place.
    """
    if not grid.has_faces:
        return grid.lonlat(plants)
    which = np.arange(len(grid)) if plants is None else plants
    middle = grid.xy_m[which]
    away = grid.stop_m[which] - middle
    away /= np.maximum(np.hypot(*away.T), 1e-6)[:, None]
    off_m = _FACE_OFF * min(grid.plant_spacing_m, grid.row_spacing_m) * (grid.twin[which] >= 0)
    return grid.frame.lonlat(middle + off_m[:, None] * away)


def _size_m(grid: PlantGrid) -> float:
    """Return the room that each plant has on the map, across."""
    least_m = min(grid.plant_spacing_m, grid.row_spacing_m)
    return least_m * (_FACE_SIZE if grid.has_faces else 1.0)


def _places(grid: PlantGrid) -> bytes:
    """Return where plants are, as `map_view/src/store.js` reads it."""
    if grid not in _PLACES:
        lonlat = drawn_at(grid)
        first = lonlat[0]
        numbered = plant_numbers(grid, np.arange(len(grid)))
        step = max(grid.plant_spacing_m, grid.row_spacing_m) / M_PER_DEGREE
        head = np.array([len(grid), *first, step, grid.has_faces, 0.0], "<f8")
        offsets = (lonlat - first).T.astype("<f4")
        face = [faces(grid, np.arange(len(grid)))] if grid.has_faces else []
        names = np.stack([numbered.line, numbered.number, *face]).astype("<i4")
        _PLACES[grid] = head.tobytes() + offsets.tobytes() + names.tobytes()
    return _PLACES[grid]


def finds(grid: PlantGrid, state: NDArray[np.int8]) -> list[Layer]:
    """Return a dark ring with a pale rim round each find: told by shape, not by colour alone.

    Where finds stand close, the rings run together, but none covers a find.
    """
    here = np.round(drawn_at(grid, np.flatnonzero(state == 1)), 7).tolist()
    least_m = _size_m(grid)
    rings = [
        _ring(f"finds{k}", here, 0.55 * least_m, (colour, pixels))
        for k, (colour, pixels) in enumerate([((255, 255, 255), 4.5), ((20, 0, 0), 2.0)])
    ]
    dots = Layer(
        "ScatterplotLayer", [{"p": p} for p in here], id="found", get_position="p",
        get_fill_color=list(FOUND), get_radius=0.4 * least_m, radius_min_pixels=2,
    )  # fmt: skip
    return [*rings, dots]


def recorded(grid: PlantGrid, which: NDArray[np.bool_]) -> list[Layer]:
    """Return a red ring round each find of which records of before the season alone tell."""
    here = np.round(drawn_at(grid, np.flatnonzero(which)), 7).tolist()
    size_m = 0.55 * _size_m(grid)
    return [_ring("finds-recorded", here, size_m, (FOUND, 2.0))] if here else []


def chosen(grid: PlantGrid, plant: int) -> list[Layer]:
    """Return a broad yellow ring with a dark rim round the plant whose history is shown."""
    here = np.round(drawn_at(grid, np.array([plant])), 7).tolist()
    size = 0.9 * _size_m(grid)
    return [
        _ring(f"chosen{k}", here, size, pen, 9.0)
        for k, pen in enumerate([((40, 30, 0), 6.5), ((255, 190, 0), 4.0)])
    ]


def picked(grid: PlantGrid, which: NDArray[np.integer]) -> Layer:
    """Return a thin bright ring round plants that are selected."""
    here = np.round(drawn_at(grid, which), 7).tolist()
    size = 0.7 * _size_m(grid)
    return _ring("picked", here, size, ((0, 190, 255), 2.5), 5.0)


def _ring(
    name: str,
    places: list[list[float]],
    size_m: float,
    pen: tuple[Colour, float],
    least_px: float = 4.5,
) -> Layer:
    colour, pixels = pen
    return Layer(
        "ScatterplotLayer", [{"p": p} for p in places], id=name, get_position="p",
        get_radius=size_m, radius_min_pixels=least_px, filled=False, stroked=True,
        get_line_color=list(colour), line_width_min_pixels=pixels, get_line_width=0.05,
    )  # fmt: skip
