"""How inner loops are compiled."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numba as nb
from numba.core import event

from fieldmon.compute.jit_progress import FIRST_USE

if TYPE_CHECKING:
    from collections.abc import Callable

F = TypeVar("F", bound="Callable[..., object]")

# nothing here is called from C; numba's own stubs leave the last two out
_BARE: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "_nrt": False,
    "no_cfunc_wrapper": True,
}
_NOT_FOR_PYTHON = _BARE | {"no_cpython_wrapper": True}


class _Compiling(event.Listener):
    """Hears of every loop that was not found compiled."""

    def on_start(self, _: object) -> None:
        """Pass it on."""
        FIRST_USE.began()

    def on_end(self, _: object) -> None:
        """Pass it on."""
        FIRST_USE.ended()


event.register("numba:compile", _Compiling())  # type: ignore[no-untyped-call]


def loop(function: F) -> F:
    """Compile a function that makes no arrays of its own, but works in those it is handed.

    Such a loop counts no references to arrays: a tuple of seven arrays handed from function to
    function would cost some fifty atomic additions a step, ten times the work proper. Divisions
    by zero follow IEEE 754, for the same reason: a loop that cannot raise needs no way out.
    """
    compiled: F = nb.njit(nogil=True, **_BARE)(function)
    return compiled


def part(function: F) -> F:
    """Compile a function likewise that only other loops call.

    What Python would need to call it is left out (it would crash), which is nearly half of what a
    small function takes to compile.
    """
    compiled: F = nb.njit(**_NOT_FOR_PYTHON)(function)
    return compiled


def inlined(function: F) -> F:
    """Compile a function likewise, to be copied into the loops that call it."""
    # copied as machine code; as numba's own it would be worked through again in every loop
    compiled: F = nb.njit(forceinline=True, **_BARE)(function)
    return compiled
