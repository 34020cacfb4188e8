"""Whether one robot counts its messages, or two do under one name."""

from __future__ import annotations

# a count goes on by one; some may be lost on the way
_SKIPS = 5
# so many changes from one count to the other are two robots; so many on by one alone are one again
_TWO, _ONE = 6, 30


class HeaderCount:
    """Follows the header ids of one kind of messages under a serial number.

    A robot that is begun anew counts from the first, and what it sends twice or late is passed by:
    two robots are two counts that both go on, in turn.

    Examples
    --------
    >>> from fieldmon.drive.vda5050.header_count import HeaderCount
    >>> count = HeaderCount()
    >>> for k in range(10):
    ...     count.take(500 + k)
    ...     count.take(1 + k)
    >>> count.are_two
    True
    """

    def __init__(self) -> None:
        self._counts: list[int] = []
        self._changes = self._alone = 0

    def __repr__(self) -> str:
        """Say where it is."""
        return f"<HeaderCount at {' and '.join(map(str, self._counts))}>"

    @property
    def are_two(self) -> bool:
        """Tell whether two robots speak."""
        return self._changes >= _TWO

    def take(self, number: int) -> None:
        """Take the next message's number."""
        for k, last in enumerate(self._counts):
            if last < number <= last + _SKIPS:
                self._counts = [number, *self._counts[:k], *self._counts[k + 1 :]]
                self._changes += k
                self._alone = 0 if k else self._alone + 1
                if self._alone >= _ONE:
                    self._changes = 0
                return
        if number not in self._counts:
            self._counts = [number, *self._counts[:1]]
