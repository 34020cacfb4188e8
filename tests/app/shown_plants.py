"""Plants on a map as the browser reads them: bytes under addresses, taken apart again."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class ShownPlants:
    """Places ``(n, 2)`` lon/lat, rows and numbers in them, ranks, colours; chances or None."""

    lonlat: np.ndarray
    row: np.ndarray
    number: np.ndarray
    rank: np.ndarray
    colour: np.ndarray
    chance: np.ndarray | None

    def __len__(self):
        return len(self.rank)

    def of_colour(self, colour):
        """Return which plants have a colour, whatever its opacity."""
        return np.flatnonzero((self.colour[:, :3] == colour).all(axis=1))


def shown_plants(arrays, table, faces=1):
    """Return plants of so many faces by their arrays (bytes by name) and the colours of ranks."""
    places = arrays["places"]
    n, *first = np.frombuffer(places, "<f8", 3)
    n = int(n)
    offsets = np.frombuffer(places, "<f4", 2 * n, 48).reshape(2, n).T
    row, number = np.frombuffer(places, "<i4", 2 * n, 48 + 8 * n).reshape(2, n)
    rank = np.frombuffer(arrays["ranks"], np.uint8)
    chance = np.frombuffer(arrays["values"], "<f4") if "values" in arrays else None
    assert len(places) == 48 + (16 if faces == 1 else 20) * n
    assert len(rank) == n
    return ShownPlants(first + offsets, row, number, rank, np.array(table, np.uint8)[rank], chance)


def plants_in(layer, faces=1):
    """Return the plants of a layer that is not sent yet."""
    return shown_plants(layer.arrays, layer.table, faces)
