"""What is assumed of a plot's insects unless a person says otherwise, in boxes of any page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.infestation.prior_settings import PriorSettings
from fieldmon.planning.assumptions import assumed_by
from fieldmon.plot.assumed import Assumed

from . import widget_memory

if TYPE_CHECKING:
    from fieldmon.plot.plot import Plot

    from .choices import Choices

#: the box for the chance of a plant of which nothing is known, percent
BACKGROUND = "background_pct"


def prior() -> PriorSettings:
    """Return how records become chances, as far as a person said so."""
    percent = widget_memory.value(BACKGROUND)
    return PriorSettings() if percent is None else PriorSettings(background_chance=percent / 100)


def of(choices: Choices) -> tuple[Assumed, ...]:
    """Return what the figures of a day rest on though nobody said it."""
    if choices.season is not None:
        made = choices.season.assumed(choices.season.planned_by(choices.on))
    else:
        made = assumed_by(choices.plot.assumed, choices.prior, choices.robot, choices.plot.grid)
    usual, prior = PriorSettings(), choices.prior
    if (prior.edge_chance, prior.path_chance) == (usual.edge_chance, usual.path_chance):
        made = (*made, Assumed("edge_chance", prior.edge_chance))
    return (*made, *_of_gate(choices.plot))


def _of_gate(plot: Plot) -> tuple[Assumed, ...]:
    return (Assumed("gate", 1.0),) if plot.field.gate is None else ()
