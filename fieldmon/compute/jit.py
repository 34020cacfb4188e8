"""How inner loops are compiled."""

from __future__ import annotations

import logging
import os
import time
from contextlib import suppress
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING, Any, TypeVar

import numba as nb
from numba.core import event, types
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.dispatcher import Dispatcher

from fieldmon.compute.jit_progress import FIRST_USE

try:
    import fcntl
except ImportError:  # on Windows every process compiles for itself
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

F = TypeVar("F", bound="Callable[..., object]")


# nothing here is called from C; numba's own stubs leave the last two out
_BARE: dict[str, Any] = {
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

    def on_end(self, ended: Any) -> None:  # noqa: ANN401 - numba has no types
        """Pass it on; a loop that could not be compiled will not be kept either."""
        FIRST_USE.ended()
        loop = ended.data["dispatcher"]
        loops = loop._cache  # noqa: SLF001 - as `kept` sets it
        if isinstance(loops, _KeptLoops) and tuple(ended.data["args"]) not in loop.overloads:
            loops.end_turn()


event.register("numba:compile", _Compiling())  # type: ignore[no-untyped-call]


class _Turns:
    """Files of whose loops this process compiles one, while all others wait for it."""

    #: who waits longer compiles, too: the other may hang
    most_s = 120.0

    def __init__(self) -> None:
        self._held: dict[str, tuple[int, int]] = {}

    def take(self, file: str) -> None:
        """Wait until no other process compiles loops of this file."""
        descriptor, depth = self._held.get(file, (-1, 0))
        if depth == 0 and fcntl is not None:
            with suppress(OSError):
                descriptor = os.open(file, os.O_RDONLY)
                began = time.monotonic()
                while not _locked(descriptor) and time.monotonic() < began + self.most_s:
                    time.sleep(0.02)
                FIRST_USE.waited(time.monotonic() - began)
        self._held[file] = descriptor, depth + 1

    def end(self, file: str) -> None:
        """Let others go on, once this was called as often as `take`."""
        descriptor, depth = self._held.pop(file, (-1, 0))
        if depth > 1:
            self._held[file] = descriptor, depth - 1
        elif descriptor >= 0:
            os.close(descriptor)


def _locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


_TURNS = _Turns()


class _KeptLoops(FunctionCache):
    """What numba keeps of a loop on disk; what cannot be loaded of it is compiled anew.

    Processes that need the same loop at the same time compile it once.

    Numba's own raises what unpickling raises: for files that were cut short, and for those of an
    earlier version, where a named tuple that the loop takes had another name. And it looks at the
    loop's own source only: one whose callee in another file has changed would run as it was.
    """

    _looked = False

    def load_overload(self, sig: object, target_context: object) -> object:
        """Return the loop for these types, or None: it is to be compiled."""
        if not self._looked:  # only now are all it calls defined
            self._looked = True
            self._cache_file = IndexDataCacheFile(  # type: ignore[no-untyped-call]
                self._cache_path, self._impl.filename_base, _stamps(self._py_func)
            )
        found = self._loaded(sig, target_context)
        if found is None:
            _TURNS.take(self._file)
            found = self._loaded(sig, target_context)
            if found is not None:
                self.end_turn()
        return found

    def save_overload(self, sig: object, data: object) -> None:
        """Keep a loop that was compiled; others who wait for it can load it."""
        try:
            super().save_overload(sig, data)  # type: ignore[no-untyped-call]
        finally:
            self.end_turn()

    def end_turn(self) -> None:
        """Let other processes compile the loops of this file."""
        _TURNS.end(self._file)

    @property
    def _file(self) -> str:
        return str(self._py_func.__code__.co_filename)

    def _loaded(self, sig: object, target_context: object) -> object:
        try:
            return super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]
        except Exception as unloadable:  # noqa: BLE001 - a damaged pickle may raise anything
            _say_once(unloadable)
            self._forget()
            return None

    def _forget(self) -> None:
        """Begin the loop's files anew; leave them alone where nothing can be written."""
        self.disable()  # type: ignore[no-untyped-call]
        with suppress(OSError):
            self.flush()  # type: ignore[no-untyped-call]
            self.enable()  # type: ignore[no-untyped-call]


def _stamps(function: FunctionType) -> tuple[tuple[str, float, int], ...]:
    """Return name, time and size of the files of a loop and of all loops that it calls."""
    waiting, seen = [function], {function}
    while waiting:
        caller = waiting.pop()
        for name in caller.__code__.co_names:
            called = getattr(caller.__globals__.get(name), "py_func", None)
            if isinstance(called, FunctionType) and called not in seen:
                seen.add(called)
                waiting.append(called)
    files = sorted({Path(loop.__code__.co_filename) for loop in seen})
    stats = [(file.name, file.stat()) for file in files if file.exists()]
    return tuple((name, stat.st_mtime, stat.st_size) for name, stat in stats)


_SAID: list[str] = []


def _say_once(unloadable: Exception) -> None:
    if not _SAID:
        _SAID.append(
            "Compiled loops that were kept on this machine cannot be loaded and are compiled anew, "
            f"once: they are damaged or of another version ({unloadable})."
        )
        logging.getLogger("fieldmon").warning(_SAID[0])


def kept(function: F) -> F:
    """Keep on disk what numba makes of a function (``@kept`` above its decorator)."""
    made: Any = function
    if isinstance(made, Dispatcher):  # it is not where numba is told to compile nothing
        loops = _KeptLoops(made.py_func)  # type: ignore[no-untyped-call]
        setattr(made, "_cache", loops)  # noqa: B010 - as numba's own enable_caching does
    return function


def _any_of(kind: Any) -> Any:  # noqa: ANN401 - numba's types have hardly any
    """Return the type of any number for that of a constant, and the widest of signed integers."""
    if isinstance(kind, types.Tuple | types.UniTuple):
        return types.BaseTuple.from_types([_any_of(part) for part in kind.types])  # type: ignore[no-untyped-call]
    plain: Any = types.unliteral(kind)  # type: ignore[no-untyped-call]
    return types.int64 if isinstance(plain, types.Integer) and plain.minval < 0 else plain


def _compiled(function: F, **options: Any) -> F:  # noqa: ANN401 - numba's own
    """Compile a function, for any number where a loop that calls it gives a constant.

    Numba would compile it once for each 0, 1 or -1 in a call, and for all that it calls with it.
    """
    compiled: F = nb.njit(**options)(function)
    made: Any = compiled
    if isinstance(made, Dispatcher):
        as_given = made.get_call_template

        def for_any(given: Sequence[object], named: dict[str, object]) -> object:
            by_name = {name: _any_of(kind) for name, kind in named.items()}
            return as_given([_any_of(kind) for kind in given], by_name)

        setattr(made, "get_call_template", for_any)  # noqa: B010 - numba calls it as it types a call
    return kept(compiled)


def routine(function: F) -> F:
    """Compile a function that may make arrays of its own."""
    return _compiled(function, nogil=True, no_cfunc_wrapper=True)


def loop(function: F) -> F:
    """Compile a function that makes no arrays of its own, but works in those it is handed.

    Such a loop counts no references to arrays: a tuple of seven arrays handed from function to
    function would cost some fifty atomic additions a step, ten times the work proper. Divisions
    by zero follow IEEE 754, for the same reason: a loop that cannot raise needs no way out.
    """
    return _compiled(function, nogil=True, **_BARE)


def inner_loop(function: F) -> F:
    """Compile a function likewise that only other loops call.

    What Python would need to call it is left out (it would crash), which is nearly half of what a
    small function takes to compile.
    """
    return _compiled(function, **_NOT_FOR_PYTHON)


def inlined(function: F) -> F:
    """Compile a function as `loop` does, to be copied into the loops that call it."""
    # copied as machine code; as numba's own it would be worked through again in every loop
    return _compiled(function, forceinline=True, **_BARE)


def inner_inlined(function: F) -> F:
    """Compile a function as `inner_loop` does, to be copied likewise."""
    return _compiled(function, forceinline=True, **_NOT_FOR_PYTHON)
