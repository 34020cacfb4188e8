"""Within a command Python seldom looks for cycles; what it finds there is thrown away as ever."""

import gc
import weakref

from fieldmon.cli.garbage_collection import cycles_seldom_looked_for


class Holds:
    """Something that holds itself."""

    def __init__(self):
        self.itself = self


def test_python_looks_as_often_as_before_once_a_command_is_over():
    before = gc.get_threshold()
    with cycles_seldom_looked_for():
        assert gc.get_threshold()[0] > before[0]
    assert gc.get_threshold() == before


def test_what_only_holds_itself_is_thrown_away_within_a_command():
    with cycles_seldom_looked_for():
        one = weakref.ref(Holds())
        # all that is kept counts, until there is so much that Python looks
        kept = [[] for _ in range(gc.get_threshold()[0] + 1)]
        assert one() is None, len(kept)
