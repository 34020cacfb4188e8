"""The names of the samplers, without the samplers: a command's help must not wait for them."""

from __future__ import annotations

from enum import StrEnum


class SamplerName(StrEnum):
    """Who decides which plants come next."""

    NAIVE = "naive"
    BOUNCY = "bouncy"
    DYNAMIC = "dynamic"
    ADAPTIVE = "adaptive"
    ADAPTIVE_LOOKS = "adaptive-looks"
    SNAKE = "snake"
    SNAKE_RANDOM = "snake-random"
    NEIGHBOR = "neighbor"
    NEIGHBOR_RANDOM = "neighbor-random"
    RANDOM = "random"
