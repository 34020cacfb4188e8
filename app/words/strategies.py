"""What samplers and strategies are called. No Streamlit in here."""

from __future__ import annotations

from fieldmon.samplers import kind_of

from . import texts


def sampler_name(sampler: str) -> str:
    """Return a sampler's name without its description."""
    return _parts(sampler)[0]


def sampler_does(sampler: str, every: float | None = None) -> str:
    """Return what a sampler does, without its name; with another N (`every`) than usual."""
    does, usual = _parts(sampler)[1], kind_of(sampler).every
    if every is None or every == usual:
        return does
    return texts.SAMPLER_EVERY.format(does=does, every=every, usual=usual)


def _parts(sampler: str) -> tuple[str, str]:
    """Return name and description; of one that has no equal times, as the library has them."""
    if sampler not in texts.SAMPLERS:
        kind = kind_of(sampler)
        return kind.title, kind.does
    name, _, does = texts.SAMPLERS[sampler].partition(": ")
    return name, does


def strategy_name(sampler: str, hours: float, inspection_s: float, robots: int = 1) -> str:
    """Return what to call a strategy: a sampler, its hours a day, its seconds at a plant."""
    alone = texts.STRATEGY_NAME.format(
        sampler=sampler_name(sampler), hours=hours, seconds=inspection_s
    )
    return alone if robots == 1 else texts.STRATEGY_TEAM.format(robots=robots, strategy=alone)
