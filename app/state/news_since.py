"""What changed of something since a browser asked last: the rest it has. No Streamlit in here."""

from __future__ import annotations

import json
import secrets
import threading
from collections import deque
from itertools import takewhile
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

# who asked so many changes ago is sent everything
_KEPT = 600


class NewsSince:
    """Hands out what changed since a number, which each answer has.

    An answer names what changed by its path (``robots.0.at``). Of a list, most of which grow, it
    says how many of its first entries are as they were, and what comes after these.

    Parameters
    ----------
    make
        Makes all of it as it is now, as JSON can hold it.
    """

    def __init__(self, make: Callable[[], dict[str, Any]]) -> None:
        self._make, self._lock = make, threading.Lock()
        # numbers of another process, or of another day, are none of ours
        self._number = secrets.randbits(40)
        self._flat: dict[str, Any] = {}
        self._changes: deque[tuple[int, dict[str, int]]] = deque(maxlen=_KEPT)

    def whole(self) -> dict[str, Any]:
        """Return everything, with its number."""
        with self._lock:
            return self._take() | {"number": self._number}

    def since(self, number: int | None) -> bytes:
        """Return as JSON what changed since a number; None, or one long ago: everything."""
        with self._lock:
            self._take()
            lists: dict[str, Any] = {}
            values: dict[str, Any] = {}
            changed = self._changed_since(number)
            of = dict.fromkeys(self._flat, 0) if changed is None else changed
            for path, same in of.items():
                now = self._flat[path]
                if isinstance(now, list):
                    lists[path] = [same, now[same:]]
                else:
                    values[path] = now
            answer = {"number": self._number, "lists": lists, "values": values}
            if changed is None:  # what it does not name is no more
                answer["whole"] = True
        return json.dumps(answer, separators=(",", ":")).encode()

    def _changed_since(self, number: int | None) -> dict[str, int] | None:
        """Return how many entries are as they were of what changed since; of values it is 0.

        None: nobody knows any more.
        """
        oldest = self._changes[0][0] - 1 if self._changes else self._number
        if number is None or not oldest <= number <= self._number:
            return None
        changed: dict[str, int] = {}
        for _, paths in takewhile(lambda one: one[0] > number, reversed(self._changes)):
            for path, same in paths.items():
                changed[path] = min(same, changed.get(path, same))
        return changed

    def _take(self) -> dict[str, Any]:
        """Take in what is now, and what changed of it."""
        now = self._make()
        flat, before = dict(_flat(now)), self._flat
        changed = {
            path: _same(before.get(path), value)
            for path, value in flat.items()
            if path not in before or before[path] != value
        }
        if before.keys() - flat.keys():  # who is to forget something is sent everything
            self._changes.clear()
            self._number += 1
        if changed:
            self._number += 1
            self._changes.append((self._number, changed))
        self._flat = flat
        return now


def _flat(now: Any, path: str = "") -> Iterator[tuple[str, Any]]:  # noqa: ANN401 - as JSON has it
    """Yield lists and values by their paths."""
    parts: dict[Any, Any] | None = now if isinstance(now, dict) else None
    if isinstance(now, list) and now and isinstance(now[0], dict):
        parts = dict(enumerate(now))
    if parts is None:
        yield path, now
        return
    for name, part in parts.items():
        yield from _flat(part, f"{path}.{name}" if path else str(name))


def _same(before: Any, now: Any) -> int:  # noqa: ANN401 - as above
    """Return how many of the first entries of a list are as before; of anything else 0."""
    if not isinstance(before, list) or not isinstance(now, list):
        return 0
    low, high = 0, min(len(before), len(now))
    if before[:high] == now[:high]:
        return high
    while low + 1 < high:  # the first `low` are the same, the first `high` are not
        middle = (low + high) // 2
        if before[low:middle] == now[low:middle]:
            low = middle
        else:
            high = middle
    return low
