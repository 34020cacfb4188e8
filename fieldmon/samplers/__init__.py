"""The samplers: who decides which plants come next.

`SAMPLERS` names them, `sampler` makes one; `base` says all that a sampler may know.
"""

from fieldmon.samplers.registry import (
    COMPARED,
    EVERY,
    SAMPLERS,
    USUAL_SAMPLER,
    SamplerKind,
    kind_of,
    of_equal_times,
    sampler,
    sampler_maker,
    sampler_or_name,
    sampler_with,
)

__all__ = [
    "COMPARED",
    "EVERY",
    "SAMPLERS",
    "USUAL_SAMPLER",
    "SamplerKind",
    "kind_of",
    "of_equal_times",
    "sampler",
    "sampler_maker",
    "sampler_or_name",
    "sampler_with",
]
