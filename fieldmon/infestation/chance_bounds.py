"""The bounds of what may be believed: of a chance, and of the chance of both of two plants."""

from __future__ import annotations

from fieldmon.compute.jit import inlined

#: no plant is ever taken as certainly clean or certainly infested: evidence must be able to undo it
LEAST_CHANCE, MOST_CHANCE = 1e-6, 1.0 - 1e-6
#: a plant with more was found and left where it is, or told to be infested
KNOWN = 0.99
#: a plant found and treated has no more than that
AS_GOOD_AS_CLEAN = 2.0 * LEAST_CHANCE


# round the loops of a lattice the same news arrives twice: no plant settles its neighbour more
_MOST_DEPENDENCE = 0.9


@inlined
def lesser(a: float, b: float) -> float:
    """Return the lesser of two numbers: as `min`, which looks out for NaN and so is slower."""
    return a if a < b else b  # noqa: FURB136 - see above


@inlined
def greater(a: float, b: float) -> float:
    """Return the greater of two numbers, likewise."""
    return a if a > b else b  # noqa: FURB136 - see above


@inlined
def bounded_chance(chance: float) -> float:
    """Return a chance that evidence can undo."""
    return lesser(greater(chance, LEAST_CHANCE), MOST_CHANCE)


@inlined
def bounded_pair_chance(pair_chance: float, p: float, q: float) -> float:
    """Return the chance of both of two plants, within what their own chances p and q allow."""
    independent = p * q
    most = independent + _MOST_DEPENDENCE * (lesser(p, q) - independent)
    return greater(lesser(pair_chance, most), greater(p + q - 1.0, 0.0))
