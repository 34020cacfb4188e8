"""What a day's map shows: plants in three shades, route, hot spots, records; each made once."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.infestation.inspections import SKIPPED
from fieldmon.monitoring.estimates.plant_states import NO_LONGER

from ..state import cached, chosen_day
from ..words import language, texts
from . import field_map
from .map_view import Frames, MapContent, Switch
from .maps import colours, labels, legends, marks, plan_layers, plant_layers, route_layers
from .maps.plant_layers import PlantNotes
from .recorded_batches import GONE

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from pydeck import Layer

    from fieldmon.planning.route import Route

    from ..state.choices import Choices
    from .maps.plant_layers import Known

#: the layers of each switch
LAYERS_OF_SWITCH = {
    "route": ("casing", "route", "arrows"),
    "hot": ("hot", "hot-edge"),
    "treated": ("treated", "treated-edge"),
    "records": ("records",),
    "numbers": (),
    "rows": ("row-lines",),
    "before": ("rows-before", "boundary-before"),
    "plan": ("headland", "rows-ground", "aisles", "no-go", "hatch"),
}
# more days than these are a film in steps of several
_FRAMES = 60
# what was treated is shown for so many days, that of the treatment being the first
_TREATED_DAYS = 14
_FINDS = ("finds-recorded", "finds0", "finds1", "found")


def day_map(
    choices: Choices, *, above: list[Layer] | None = None,
    first: str = "chance", off: tuple[str, ...] = ("records",),
) -> MapContent:  # fmt: skip
    """Return the map of the chosen day; `first` names the shade that is on before any is chosen."""
    driven = chosen_day.route(choices)
    route = driven.route
    shades = shaded(choices, first)
    layers = [
        *plan(choices),
        *treated(choices),
        *marks.with_hot(plants(choices), _hot_layers(choices)),
        *route_of(choices, route),
        gate(choices),
        *records(choices),
        *(above or []),
    ]
    of_route = _route_key(choices, route)
    play = cached.written(
        f"play {of_route} {driven.begins}", lambda: route_layers.playback(route, driven.begins)
    )
    if play is not None:
        play = {**play, "key": f"{language.current()} {choices.revision} {of_route}"}
    return MapContent(
        **field_map.of_plot(choices, len(route)), layers=layers,
        switches=switches(layers, off, ("numbers", "rows")), shades=shades,
        legend=legend(choices), play=play,
        labels=[*cached.written(f"stops {of_route}", lambda: labels.stops(route)), *words(choices)],
    )  # fmt: skip


def season_frames(choices: Choices) -> Frames | None:
    """Return the season's days, evenly chosen where there are very many; None: there is but one."""
    if choices.season is None:
        return None
    days = chosen_day.season_days(choices)
    if len(days) < 2:
        return None
    kept = np.unique(np.linspace(0, len(days) - 1, min(len(days), _FRAMES)).round().astype(int))
    days = [days[k] for k in kept.tolist()]
    at = [replace(choices, day=day) for day in days]
    now_known = f"{choices.revision} {digest(days)}"  # days may have come since they were listed
    key = f"{language.current()} {choices.key} {now_known} {choices.day} {choices.dark}"
    names = tuple(choices.units.said_day(day) for day in days)
    now = int(np.searchsorted(days, choices.day))
    shown = cached.frames(key, lambda: [marks.with_hot(_plants(one), _hot(one)) for one in at])
    return Frames(key, names, tuple(shown), min(now, len(days) - 1))


def shaded(choices: Choices, first: str = "chance") -> tuple[Switch, ...]:
    """Return the three ways to shade plants, the first one on."""
    own = {"chance": ("plants-chance",), "state": ("plants-state", *_FINDS), "age": ("plants-age",)}
    names = sorted(own, key=lambda name: name != first)
    if choices.season is None:
        names.remove("age")
    return tuple(Switch(name, texts.SHADES[name], own[name]) for name in names)


def switches(
    layers: list[Layer], off: tuple[str, ...] = (), written: tuple[str, ...] = ("rows",)
) -> tuple[Switch, ...]:  # fmt: skip
    """Return the switches of the layers that there are, and of the labels that are `written`."""
    there = {layer.id for layer in layers}
    return tuple(
        Switch(name, texts.MAP_LAYERS[name], ids, name not in off)
        for name, ids in LAYERS_OF_SWITCH.items()
        if there.intersection(ids) or name in written
    )


def legend(choices: Choices) -> list[legends.LegendPart]:
    """Return the legend of a day's map; the browser leaves out what has no switch."""
    dark, (state, recorded) = choices.dark, chosen_day.states_apart(choices)
    not_inspected = (state < 0) & (chosen_day.not_inspected(choices) > 0)
    few = {"recorded": bool(recorded.any()), "not_inspected": bool(not_inspected.any())}
    return [legends.by_chance(dark=dark), legends.by_state(**few),
            legends.by_age(dark=dark), *legends.signs(dark=dark), legends.gate(),
            *legends.plan(choices.plot.field, dark=dark)]  # fmt: skip


def treated(choices: Choices) -> list[Layer]:
    """Return what was treated lately, up to the chosen day; made once."""
    season = choices.season
    if season is None:
        return []

    def make() -> list[Layer]:
        since = choices.on - timedelta(days=_TREATED_DAYS)
        done = [one for one in season.treatments() if since < one.on <= choices.on]
        return marks.treated(done, choices.plot.field, choices.units, dark=choices.dark)

    shown = f"{choices.key} {choices.revision} {choices.day} {choices.dark} {choices.units}"
    return cached.layers(f"treated {shown}", make)


def plan(choices: Choices) -> list[Layer]:
    """Return the plot as a plan, below its plants; made once."""
    plot, dark = choices.plot, choices.dark
    return cached.layers(
        f"plan {choices.key} {dark}", lambda: plan_layers.plan(plot.grid, plot.field, dark=dark)
    )


def gate(choices: Choices) -> Layer:
    """Return the ring of the gate; made once."""
    return cached.layers(
        f"gate {choices.key}", lambda: [route_layers.gate(choices.plot.aisles)]
    )[0]  # fmt: skip


def records(choices: Choices) -> list[Layer]:
    """Return the records on the map; made once."""
    dark = choices.dark
    return cached.layers(
        f"records {choices.key} {dark}", lambda: marks.records(choices.records, dark=dark)
    )


def words(choices: Choices) -> list[labels.Label]:
    """Return what is written on a plan, the most important first; made once."""
    plot = choices.plot

    def make() -> list[labels.Label]:
        return [*labels.places(plot), *labels.rows(plot.grid), *labels.blocks(plot.grid)]

    return cached.written(f"words {choices.key}", make)


def plants(choices: Choices) -> list[Layer]:
    """Return the plants in all shades, made once for what is known of them."""
    key = f"plants {choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(key, partial(_plants, choices))


def _plants(choices: Choices) -> list[Layer]:
    grid = choices.plot.grid
    chance, (state, recorded) = chosen_day.chance(choices), chosen_day.states_apart(choices)
    known = _known(choices, chosen_day.states(choices))
    level = chosen_day.level_range(choices)
    by_chance = colours.by_chance(chance, dark=choices.dark)
    ages = []
    if choices.season is not None:
        by_age = colours.by_age(chosen_day.ages(choices), dark=choices.dark)
        ages = [plant_layers.plants(grid, by_age, PlantNotes(known=known), "plants-age")]
    notes = PlantNotes(chance, known=known, level=level)
    return [
        plant_layers.plants(grid, by_chance, notes, "plants-chance"),
        *ages,
        *in_states(choices, state, known),
        *plant_layers.recorded(grid, recorded),
    ]


def _known(choices: Choices, state: NDArray[np.int8]) -> Known:
    """Return what is known of plants in sentences, and which of them holds for each."""
    looks = finds = np.zeros(len(state), np.int64)
    if choices.season is not None:
        looks, finds = chosen_day.counts(choices)
    why = chosen_day.not_inspected(choices).astype(np.int64)
    ages = np.maximum(chosen_day.ages(choices), -1)
    # one number a plant: sorting those is a hundred times as fast as sorting rows of four
    known = ((((finds << 12) + looks << 20) + ages + 1 << 2) + state << 2) + why
    # what else differs between plants that were never looked at is not said
    _, first, which = np.unique(
        np.where(state < 0, -1 - why, known), return_index=True, return_inverse=True
    )
    several = np.stack([state, ages, looks, finds], axis=1)[first].tolist()
    said = zip(several, why[first].tolist(), strict=True)
    return tuple(_said_last(_said(*one), one[0], last) for one, last in said), which


def _said_last(said: str, state: int, why: int) -> str:
    """Return what is known of a plant, and why it was not inspected since, if it could not be."""
    if not why:
        return said
    later = texts.RESULTS_OF[GONE] if why == NO_LONGER else texts.HISTORY_RESULTS[SKIPPED]
    return later if state < 0 else texts.TIP_THEN.format(said=said, later=later)


def _said(state: int, age: int, looks: int, finds: int) -> str:
    if state < 0:
        return texts.TIP_NEVER
    result = texts.HISTORY_RESULTS[state]
    seen = texts.TIP_SEEN_TODAY if age == 0 else texts.TIP_SEEN_BEFORE
    said = result if age < 0 else seen.format(result=result, n=age)
    if looks > 1:
        said += texts.TIP_LOOKS.format(n=looks)
    if finds > 1:
        said += texts.TIP_FINDS.format(n=finds)
    return said


def in_states(choices: Choices, state: NDArray[np.int8], known: Known | None = None) -> list[Layer]:
    """Return plants shaded by their state, and the rings of finds."""
    grid, names = choices.plot.grid, texts.LEGEND_STATES
    said = tuple(texts.TIP_STATE.format(state=names[name]) for name in ("never", "clean", "found"))
    notes = PlantNotes(known=known) if known else PlantNotes(by_rank=said)
    not_inspected = chosen_day.not_inspected(choices) > 0 if known else None
    shade = colours.by_state(state, not_inspected)
    return [
        plant_layers.plants(grid, shade, notes, "plants-state"),
        *plant_layers.finds(grid, state),
    ]


def route_of(choices: Choices, route: Route) -> list[Layer]:
    """Return the route's layers, made once."""
    return cached.layers(
        _route_key(choices, route), partial(route_layers.route, route, dark=choices.dark)
    )


def _route_key(choices: Choices, route: Route) -> str:
    """Return a key of what is drawn: results may have come since the route was planned."""
    drawn = digest(route.plant, route.line_m, route.line_stop, route.line_s, route.leave_s)
    return f"route {choices.key} {choices.day} {choices.dark} {drawn}"


def _hot_layers(choices: Choices) -> list[Layer]:
    key = f"{choices.key} {choices.revision} {choices.day} {choices.dark}"
    return cached.layers(f"hot {key}", partial(_hot, choices))


def _hot(choices: Choices) -> list[Layer]:
    return marks.hot(choices.plot.grid, chosen_day.hot_spots(choices), dark=choices.dark)
