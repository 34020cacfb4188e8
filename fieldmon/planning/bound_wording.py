"""What a route holds and what no other can exceed, in a sentence."""

from __future__ import annotations

import math
import warnings

from fieldmon.compute.wording import digits_of_estimate, figure, worded

#: gaps up to this are none, but for rounding
PROVED = 1e-6
#: of a smaller share, figures rounded as they are would say more
_SMALL = 0.01


def sound_bound(held: float, bound: float) -> float:
    """Return a bound no less than what a route holds: sums of the same may be rounded otherwise.

    A route that holds more by over a millionth proves that the bound is none: that is a fault of
    ours, of which is warned, and nothing is known, which is infinite.
    """
    if _is_false(held, bound):
        warnings.warn(
            f"A bound must be no less than what any route holds, but it is {bound:.9g} where one "
            f"holds {held:.9g}: a fault of fieldmon, please report it.",
            RuntimeWarning,
            stacklevel=2,
        )
        return math.inf
    return max(bound, held)


def _is_false(held: float, bound: float) -> bool:
    return bound < held * (1.0 - PROVED)


def share_above(held: float, bound: float) -> float:
    """Return by how much a bound is above what is held, as a share.

    Infinite where nothing is held, and where the bound is false, which proves nothing.
    """
    if _is_false(held, bound):
        return math.inf
    if bound <= held:
        return 0.0
    return bound / held - 1.0 if held > 0.0 else math.inf


#: what a route may hold
FINDS, REWARD = worded("finds"), worded("reward")


def bound_sentence(held: float, bound: float, what: str = FINDS, routes: str = "route") -> str:
    """Return what a route is expected to hold and what no other can exceed.

    The bound and the share are rounded up: no route exceeds what is said.

    Examples
    --------
    >>> bound_sentence(42.31, 42.97)
    '42 finds expected; no route of these hours can expect more than 43 (1.6 %).'
    >>> bound_sentence(20.0, 20.0)
    '20 finds expected; no route of these hours can expect more.'
    """
    said = _of_route(held, bound, what)
    return said if routes == "route" else said.replace("no route", f"no {routes}", 1)


def _of_route(held: float, bound: float, what: str) -> str:
    gap = share_above(held, bound)
    if math.isinf(bound) or _is_false(held, bound):
        return worded(
            "{held} {what} expected; what other routes can expect at most is not known.",
            held=figure(held, f",.{_digits(held)}f"), what=what,
        )  # fmt: skip
    digits = _digits_for(held, bound, gap)
    values = {"held": figure(held, f",.{digits}f"), "what": what}
    most = figure(_up(bound, digits), f",.{digits}f")
    if gap <= PROVED:
        return worded("{held} {what} expected; no route of these hours can expect more.", **values)
    if not math.isfinite(gap):
        return worded(
            "{held} {what} expected; no route of these hours can expect more than "
            "{bound}.", **values, bound=most,
        )  # fmt: skip
    share = _up(100.0 * gap, 1)
    if gap < _SMALL:
        return worded(
            "{held} {what} expected; no route of these hours can expect over {share:.1f} % more.",
            **values, share=share,
        )  # fmt: skip
    return worded(
        "{held} {what} expected; no route of these hours can expect more than "
        "{bound} ({share:.1f} %).", **values, bound=most, share=share,
    )  # fmt: skip


def _digits_for(held: float, bound: float, gap: float) -> int:
    """Return decimals as of any estimate; more where the two figures would belie their share."""
    digits = _digits(held or bound)
    if not _SMALL <= gap < math.inf:
        return digits
    while _up(bound, digits) > round(held, digits) * (1.0 + 2.0 * gap):
        digits += 1
    return digits


def _digits(value: float) -> int:
    """Return decimals as of any estimate, but below one for two digits."""
    if 0.0 < value < 1.0:
        return 1 - math.floor(math.log10(value))
    return digits_of_estimate(value)


def _up(value: float, digits: int) -> float:
    """Return a number rounded up to so many decimals, but for what is mere rounding of sums."""
    scale = 10.0**digits
    return math.ceil(value * scale * (1.0 - 1e-9)) / scale
