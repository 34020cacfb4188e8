"""Files of tests are shared out from both ends; a crashed worker costs the test it crashed at."""

from types import SimpleNamespace

import pytest
from xdist.scheduler import loadscope

from tests.paths import ROOT
from tests.xdist_order import LONG, PLAIN, TOGETHER, BothEnds, in_order, workers

FILES = {"drawn.py": 3, "one.py": 1, "two.py": 2, "long.py": 4}
TESTS = [f"{file}::{k}" for file, n in FILES.items() for k in range(n)]


@pytest.mark.parametrize(
    ("cores", "free_gb", "n"), [(2, 20, 3), (2, 4, 2), (1, 0.5, 1), (16, 100, 17), (16, 12, 8)]
)
def test_there_are_more_workers_than_cores_where_memory_allows(cores, free_gb, n):
    assert workers(cores, free_gb * 1e9) == n


def test_what_waits_comes_first_and_last_what_compiles_nothing():
    names = ["docs/test_docs.py", "docs/test_examples.py", "app/words/test_units.py", "plot/a.py"]
    tests = [item(f"tests/{name}") for name in names]
    tests.append(item("tests/zones.py", fixturenames=["page", "browser"]))
    in_order(tests)
    order = ["zones.py", "plot/a.py", names[1], names[0], names[2]]
    assert [one.nodeid.split("::")[0] for one in tests] == [f"tests/{name}" for name in order]


def item(file, fixturenames=()):
    return SimpleNamespace(path=file, nodeid=f"{file}::test", fixturenames=fixturenames)


def test_what_is_named_there_is_there():
    assert [one for one in (*PLAIN, *LONG, *TOGETHER) if not (ROOT / one).exists()] == []


class Worker:
    """Stands for a worker: as xdist's, it begins a test once it knows the next, or that none is."""

    def __init__(self, name):
        self.gateway, self.shutting_down, self.tests = SimpleNamespace(id=name), False, []

    def send_runtest_some(self, numbers):
        self.tests += numbers

    def shutdown(self):
        self.shutting_down = True

    def next_test(self):
        """Return the test that it runs now, or None: it waits, or is done."""
        if len(self.tests) > 1 or (self.tests and self.shutting_down):
            return self.tests[0]
        return None


@pytest.fixture
def two(monkeypatch):
    """Return two workers and who shares out the tests, after they have collected."""
    monkeypatch.setattr(loadscope, "parse_tx_spec_config", lambda _: ["popen"] * 2)
    config = SimpleNamespace(option=SimpleNamespace(loadscopereorder=False))
    shares, workers = BothEnds(config), [Worker("gw0"), Worker("gw1")]
    for one in workers:
        joins(shares, one)
    shares.schedule()
    return shares, workers


def joins(shares, worker):
    shares.add_node(worker)
    shares.add_node_collection(worker, TESTS)


def work(shares, workers, crashes_at=None):
    """Let workers run one test each in turn until none can; return the tests in that order."""
    done = []
    while ready := [one for one in workers if one.next_test() is not None]:
        for one in ready:
            test = one.next_test()
            if TESTS[test] == crashes_at:
                return done
            one.tests.pop(0)
            shares.mark_test_complete(one, test)
            done.append(TESTS[test])
    return done


def test_one_takes_files_from_the_front_and_the_others_from_the_back(two):
    shares, (first, other) = two
    assert [TESTS[first.tests[0]], TESTS[other.tests[0]]] == ["drawn.py::0", "long.py::0"]
    assert sorted(work(shares, [first, other])) == sorted(TESTS)
    assert shares.tests_finished
    assert shares.assigned_work == {first: {}, other: {}}, "what is done is not counted again"


@pytest.mark.parametrize("crashes_at", TESTS)
def test_a_test_that_crashes_its_worker_is_not_run_again_and_all_others_are(two, crashes_at):
    shares, workers = two
    done = work(shares, workers, crashes_at)
    (crashed,) = (w for w in workers if w.tests and TESTS[w.tests[0]] == crashes_at)
    workers.remove(crashed)
    assert shares.remove_node(crashed) == crashes_at
    new = Worker("gw2")
    shares.add_node(new)  # while it collects, the other goes on
    done += work(shares, workers)
    shares.add_node_collection(new, TESTS)
    shares.schedule()
    done += work(shares, [*workers, new])
    assert sorted([*done, crashes_at]) == sorted(TESTS)
    assert shares.tests_finished


def test_a_worker_that_ends_in_peace_leaves_nothing(two):
    shares, workers = two
    work(shares, workers)
    assert [shares.remove_node(one) for one in workers] == [None, None]
    assert not shares.has_pending
