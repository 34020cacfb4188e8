"""Who may be in which aisle: of several robots on a plot no two are in one at once."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class AisleKeeper:
    """Gives aisles to robots, each aisle to one at a time; may be asked from several threads.

    Who waits for an aisle holds none, so that nobody waits for ever.

    Examples
    --------
    >>> keeper = AisleKeeper()
    >>> keeper.enter("a", [3]), keeper.enter("b", [3, 4]), keeper.enter("b", [4])
    (True, False, True)
    >>> keeper.keep_only("a", [])
    >>> keeper.enter("b", [3])
    True
    """

    def __init__(self) -> None:
        self._holder: dict[int, str] = {}
        self._over: set[str] = set()
        self._lock = threading.Lock()

    def __repr__(self) -> str:
        """Say how many aisles are held."""
        return f"<AisleKeeper: {len(self._holder)} held>"

    def enter(self, who: str, aisles: Iterable[int]) -> bool:
        """Give somebody all of some aisles, besides those it has, or none of them."""
        wanted = set(aisles)
        with self._lock:
            if any(self._holder.get(aisle, who) != who for aisle in wanted):
                return False
            self._holder.update(dict.fromkeys(wanted, who))
            return True

    def keep_only(self, who: str, aisles: Iterable[int]) -> None:
        """Take from somebody all aisles but these."""
        kept = set(aisles)
        with self._lock:
            self._holder = {a: w for a, w in self._holder.items() if w != who or a in kept}

    def end(self, who: str) -> None:
        """Say that somebody moves no more today: what it holds stays taken."""
        with self._lock:
            self._over.add(who)

    def blocked(self, who: str, aisles: Iterable[int]) -> bool:
        """Tell whether one of some aisles is another's who moves no more today."""
        with self._lock:
            return any(self._holder.get(a, who) in self._over - {who} for a in aisles)
