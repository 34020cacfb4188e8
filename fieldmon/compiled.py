"""How inner loops are compiled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numba as nb

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., object]")

# numba's own stubs leave `_nrt` out
_BARE: dict[str, Any] = {"cache": True, "error_model": "numpy", "_nrt": False}


def loop(function: F) -> F:
    """Compile a function that makes no arrays of its own, but works in those it is handed.

    Such a loop counts no references to arrays: a tuple of seven arrays handed from function to
    function would cost some fifty atomic additions a step, ten times the work proper. Divisions
    by zero follow IEEE 754, for the same reason: a loop that cannot raise needs no way out.
    """
    compiled: F = nb.njit(nogil=True, **_BARE)(function)
    return compiled


def inlined(function: F) -> F:
    """Compile a function likewise, to be copied into the loops that call it."""
    compiled: F = nb.njit(forceinline=True, **_BARE)(function)
    return compiled
