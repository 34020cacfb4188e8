"""Passes between the ends of rows, and a walk that drives each of them once."""

from __future__ import annotations

#: an end of a row: the row's number, and which end
Node = tuple[int, int]


class Passes:
    """What is to be driven, as edges between nodes; two nodes may be joined several times."""

    def __init__(self) -> None:
        self._ways: dict[Node, list[tuple[Node, list[bool]]]] = {}

    def link(self, a: Node, b: Node, passes: int) -> None:
        """Let the way between two nodes be driven so many times more."""
        for _ in range(passes):
            driven = [False]
            self._ways.setdefault(a, []).append((b, driven))
            self._ways.setdefault(b, []).append((a, driven))

    def walk(self, start: Node) -> list[Node]:
        """Return the nodes of a walk from a node that drives every pass once, and use them up.

        There is one where all passes hang together and at most the start and one other node have
        an odd number of them (Hierholzer 1873).
        """
        stack, path = [start], []
        while stack:
            ways = self._ways.get(stack[-1], [])
            while ways and ways[-1][1][0]:
                ways.pop()
            if ways:
                to, driven = ways.pop()
                driven[0] = True
                stack.append(to)
            else:
                path.append(stack.pop())
        return path[::-1]
