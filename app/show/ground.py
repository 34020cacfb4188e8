"""The ground under the plot, as every map of it shows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest

from ..state import cached, ground, map_tiles, web_maps
from ..state.kept_ground import GroundPicture, GroundTiles
from .maps import ground_layers

if TYPE_CHECKING:
    from pydeck import Layer

    from fieldmon.monitoring import Season

    from ..state.choices import Choices


@dataclass(frozen=True, eq=False)
class GroundShown:
    """What lies under the plants.

    Parameters
    ----------
    layers
        From below to above.
    credit
        Whom to name on the map; empty: nobody.
    is_picture
        Whether it may be dark, light and of any colour: what is drawn on it then needs a rim.
    worker
        Where the browser finds what may ask the map's server; empty: it is asked for nothing.
    """

    layers: tuple[Layer, ...] = ()
    credit: str = ""
    is_picture: bool = False
    worker: str = ""


def of(choices: Choices) -> GroundShown:
    """Return what lies under a plot: a map that was agreed to, and on it what was brought."""
    world, made = of_world(choices.season), ground.of(choices)
    layers, credits_ = [*world.layers], [world.credit]
    if isinstance(made, GroundTiles):
        address = map_tiles.SHELF.publish(made.tiles)
        layers += cached.layers(address, lambda: [ground_layers.tiles(address, made.tiles)])
        credits_.append(made.tiles.credit)
    elif isinstance(made, GroundPicture):
        layers += _picture(made, dark=choices.dark)
    is_picture = world.is_picture or (
        made is not None and not (isinstance(made, GroundPicture) and made.is_relief)
    )
    return GroundShown(tuple(layers), " · ".join(filter(None, credits_)), is_picture, world.worker)


def of_world(season: Season | None) -> GroundShown:
    """Return the map of the world that was agreed to, for a season or for this session."""
    agreed = ground.agreement(season)
    if agreed is None:
        return GroundShown()
    layers = cached.layers(
        f"ground {agreed}",
        lambda: [ground_layers.web_map(agreed.address, web_maps.LAST_ZOOM)],
    )
    worker = web_maps.ASKED.worker(agreed.address)
    return GroundShown(tuple(layers), agreed.credit, is_picture=True, worker=worker)


def _picture(made: GroundPicture, *, dark: bool) -> list[Layer]:
    key = f"ground {digest(made.picture.image)} {made.picture.corners_lonlat.tolist()}"
    return cached.layers(
        f"{key} {made.is_relief} {dark}",
        lambda: [ground_layers.picture(made.picture, is_relief=made.is_relief, dark=dark)],
    )
