"""Damaged files end in sentences; the long run is ``python tests/fuzz.py``."""

import time
from pathlib import Path

import numpy as np
import pytest

from fieldmon.io import read
from fieldmon.io.options import Upload
from fieldmon.io.sandbox import process
from tests import fuzz
from tests.thorough import times


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    """Return the whole files, made once."""
    return fuzz.seeds(tmp_path_factory.mktemp("corpus"))


@pytest.mark.timeout(900)
def test_damaged_files_leave_only_sentences(corpus, monkeypatch):
    n = times(30, 2000)
    monkeypatch.setattr(fuzz, "seeds", lambda _: corpus)
    tally = fuzz.fuzz(n, step=max(len(corpus) // n, 1))
    assert tally.failures == []
    assert tally.outcomes.total() == n
    assert tally.outcomes["refused"] > 0
    assert tally.outcomes["came in"] > 0


def test_every_structure_is_changed_and_the_same_number_gives_the_same_file(corpus):
    endings = {part.name.rpartition(".")[2] for seed in corpus for part in seed.parts}
    assert {"shp", "dbf", "zip", "geojson", "csv", "kml", "tif", "gpkg", "xlsx"} <= endings
    assert {"xls", "ods", "tab", "map", "dxf", "sqlite", "XML", "gml", "prj"} <= endings
    for number, seed in enumerate(corpus[::6]):
        once, again = (fuzz.mutated(seed, np.random.default_rng(number)) for _ in range(2))
        assert once == again


@pytest.mark.parametrize(
    ("does", "failure"),
    [
        (lambda *_: 1 / 0, "ZeroDivisionError"),
        (lambda *_: str(Path("left.txt").write_text("here")), "a file was left: left.txt"),
    ],
)
def test_the_fuzzer_notices_what_it_looks_for(monkeypatch, does, failure):
    monkeypatch.setattr(fuzz, "seeds", lambda _: [fuzz.Seed("one", "plots", (GOOD,))])
    monkeypatch.setattr(fuzz, "read", does)
    (said,) = fuzz.fuzz(1).failures
    assert failure in said


GOOD = Upload("p.csv", b"lon,lat\n35.15,30.36\n35.16,30.36\n35.16,30.37\n")


def test_a_reader_that_hangs_or_crashes_is_ended_and_the_next_file_is_read():
    for task, number, said in (("time:sleep", 20, "within"), ("os:_exit", 1, "crash")):
        with pytest.raises(fuzz.FileProblem, match=said):
            process.call(task, number, seconds=0.5)
    assert len(read.read_plots(GOOD).value) == 1


def test_a_reader_started_ahead_has_loaded_what_reads():
    loaded = "'fieldmon.io.sandbox.tasks' in __import__('sys').modules"
    process.stop()
    assert not process.call("builtins:eval", loaded)
    process.stop()
    process.warm()
    assert process.call("builtins:eval", loaded)


def test_a_reader_that_fills_the_memory_is_stopped():
    with pytest.raises(fuzz.FileProblem, match="of memory at most"):
        process.call("numpy:ones", 400_000_000)


def test_a_reader_has_no_drivers_that_lead_elsewhere():
    drivers = set(process.call("pyogrio:list_drivers"))
    assert "GPKG" in drivers
    assert not drivers & {"OGR_VRT", "WFS", "OAPIF", "HTTP", "CSW", "Elasticsearch", "GPSBabel"}


def test_a_reader_counts_its_own_work_where_the_system_tells_nobody(monkeypatch):
    monkeypatch.setattr(process, "_work", lambda _: process._Work(0.0, waits_for_its_turn=True))
    with pytest.raises(fuzz.FileProblem, match="10 seconds of work"):
        process.call("math:factorial", 3_000_000, seconds=0.1)
    assert len(read.read_plots(GOOD).value) == 1


class Process:
    pid = 0

    def kill(self):
        self.killed_at = time.monotonic()


@pytest.mark.parametrize(
    ("waits", "at_least_s"),
    [(False, 0.05), (True, 1.5)],
    ids=["one that sleeps", "one kept from working by others"],
)
def test_a_reader_is_given_patience(monkeypatch, waits, at_least_s):
    monkeypatch.setattr(process, "_work", lambda _: process._Work(0.0, waits))
    began, running = time.monotonic(), Process()
    clock = process._Clock(running, 0.05)
    clock.run()
    assert clock.is_late
    assert running.killed_at - began >= at_least_s
