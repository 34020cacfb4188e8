"""The names of the samplers as values of an option."""

from __future__ import annotations

from enum import StrEnum

from fieldmon.samplers import COMPARED, SAMPLERS, USUAL

SamplerName = StrEnum(  # type: ignore[misc] # mypy wants to read the names here
    "SamplerName", {name.upper().replace("-", "_"): name for name in SAMPLERS}
)
SamplerName.__doc__ = "Who decides which plants come next."
USUAL_SAMPLER = SamplerName(USUAL)
COMPARED_SAMPLERS = tuple(SamplerName(name) for name in COMPARED)
