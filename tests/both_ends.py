"""Who of two workers runs which file."""

from xdist.scheduler import LoadFileScheduling

#: what needs no compiled loop, and can be run while another process compiles
PLAIN = ("tests/app/words/", "tests/docs/", "tests/io/parse/", "tests/io/sandbox/",
         "tests/test_floors.py", "tests/test_rooms.py", "tests/test_words.py")  # fmt: skip


def in_order(items):
    """Sort tests, file by file: first those with a browser, which wait; last those of `PLAIN`."""
    drawn = {one.path for one in items if "browser" in getattr(one, "fixturenames", ())}
    items.sort(key=lambda one: (one.path not in drawn, one.nodeid.startswith(PLAIN)))


class BothEnds(LoadFileScheduling):
    """One worker takes files from the front of the queue, all others from its back.

    So one browser and one server do; what a room's loops compile to is mostly made by one worker;
    and what is long is begun first, so that no worker is left alone at the end.
    """

    def _assign_work_unit(self, node):
        if node.gateway.id != "gw0":
            self.workqueue.move_to_end(next(reversed(self.workqueue)), last=False)
        super()._assign_work_unit(node)
