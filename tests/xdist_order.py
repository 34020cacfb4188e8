"""Who of several workers runs which file."""

from xdist.scheduler import LoadFileScheduling

#: what needs no compiled loop, and can be run while another process compiles
PLAIN = ("tests/app/words/", "tests/docs/", "tests/io/parse/", "tests/io/sandbox/",
         "tests/test_floors.py", "tests/test_rooms.py", "tests/test_words.py")  # fmt: skip

#: what plans days in these rooms, for a minute or more: it is begun next
LONG = ("tests/app/words/test_languages.py", "tests/docs/test_examples.py")

#: whose files share what takes long to make: one worker runs them all
TOGETHER = ("tests/studies/thesis/chapter4/",)


#: memory that a worker may come to take, with what it starts
WORKER_BYTES = 1.5e9


def workers(cores, free_bytes):
    """Return how many workers there should be: one more than cores, where memory allows.

    One waits for its browser, others for servers or the disk. Each further worker imports and
    loads what the others have, too.
    """
    return max(1, min(cores + 1, int(free_bytes // WORKER_BYTES)))


def in_order(items):
    """Sort tests, file by file: first those with a browser, which wait; last `LONG` and `PLAIN`."""
    drawn = {one.path for one in items if "browser" in getattr(one, "fixturenames", ())}
    items.sort(key=lambda one: (one.path not in drawn, _from_back(one.nodeid)))


def _from_back(nodeid):
    if nodeid.startswith(LONG):
        return 1
    return 2 if nodeid.startswith(PLAIN) else 0


class Numbered(list):
    """Tests as a worker collected them, of which each knows its number."""

    def __init__(self, tests):
        super().__init__(tests)
        self.number = {one: k for k, one in enumerate(tests)}

    def index(self, one):
        """Return a test's number, without a look at those before it."""
        return self.number[one]


class BothEnds(LoadFileScheduling):
    """One worker takes files from the front of the queue, all others from its back.

    So one browser and one server do; what a room's loops compile to is mostly made by one worker;
    and what is long is begun first, so that no worker is left alone at the end.

    A test that crashes its worker fails once, and the others of its file are run by another.
    """

    def _split_scope(self, nodeid):
        room = next((one for one in TOGETHER if nodeid.startswith(one)), None)
        return room or super()._split_scope(nodeid)

    def _assign_work_unit(self, node):
        if node.gateway.id != "gw0":
            self.workqueue.move_to_end(next(reversed(self.workqueue)), last=False)
        super()._assign_work_unit(node)

    def _reschedule(self, node):
        """Give a worker so much that it goes on: it begins a test once it knows the next one."""
        if node not in self.registered_collections:  # it comes for work once it has collected
            return
        super()._reschedule(node)
        while not node.shutting_down and self._pending_of(self.assigned_work[node]) < 2:
            super()._reschedule(node)

    def add_node_collection(self, node, collection):
        """Keep what a worker collected; none if others collected otherwise."""
        super().add_node_collection(node, collection)
        if node in self.registered_collections:
            self.registered_collections[node] = Numbered(collection)

    def mark_test_complete(self, node, item_index, duration=0):
        """Forget a file that is done: what is left is counted twice after each test."""
        super().mark_test_complete(node, item_index, duration)
        file = self._split_scope(self.registered_collections[node][item_index])
        if all(self.assigned_work[node][file].values()):
            del self.assigned_work[node][file]

    def remove_node(self, node):
        """Give what a worker left to others, without the test at which it crashed: return that."""
        files, self.assigned_work[node] = self.assigned_work[node], {}
        super().remove_node(node)
        crashed = None
        for file, tests in files.items():
            for test, is_done in tests.items():
                if crashed is None and not is_done:
                    crashed, tests[test] = test, True
            if not all(tests.values()):
                self.workqueue[file] = tests
        for other in self.nodes:
            self._reschedule(other)
        return crashed
