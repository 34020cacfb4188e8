"""A season that QGIS has open is three files; what lies beside it is taken in only if it fits."""

import shutil
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from itertools import takewhile
from multiprocessing import get_context
from time import sleep

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season
from fieldmon.monitoring.file.journals import _is_of_the_last_transaction, _reaches
from tests.monitoring.changes.test_transactions import a_view_instead
from tests.monitoring.open_elsewhere import as_qgis, beside, left_by_a_crash
from tests.monitoring.seasons import a_plot, a_season, state, three_results


@pytest.fixture(autouse=True)
def opened_once():
    """Let files be opened for each thing that is done, as programs without pages do."""


def test_what_another_program_left_beside_the_season_is_taken_in_and_the_file_is_one_again(
    path, tmp_path
):
    crashed = left_by_a_crash(path, tmp_path / "crashed")
    season = Season(crashed)
    assert "from QGIS" in season.history.inspections.notes.tolist()
    assert season.store.doubt is None
    season.record(three_results(), "x")
    assert beside(crashed) == ["season.gpkg"]
    with closing(sqlite3.connect(crashed)) as db:
        assert db.execute("PRAGMA journal_mode").fetchone() == ("delete",)


def test_a_view_that_never_ends_is_not_read_with_changes_beside_it_either(path, tmp_path):
    a_view_instead(path, "fieldmon")
    crashed = left_by_a_crash(path, tmp_path / "crashed")
    opened = get_context("fork").Process(target=refused, args=(crashed,))
    opened.start()
    opened.join(20)
    ended, _ = opened.exitcode, opened.kill()
    assert ended == 0


def refused(path):
    with pytest.raises(FileProblem, match="must belong together"):
        Season(path)


def test_while_another_program_has_the_season_open_both_go_on(path):
    with closing(as_qgis(path)) as qgis:
        Season(path).record(three_results(), "x")
        assert qgis.execute("SELECT count(*) FROM inspections").fetchone() == (15,)
    Season(path).record(three_results(on=1), "y")
    assert beside(path) == ["season.gpkg"]
    assert state(path) == 18


def test_another_program_that_is_writing_is_waited_for_though_it_keeps_the_season_open(path):
    season = Season(path)
    with closing(as_qgis(path)) as qgis, ThreadPoolExecutor(1) as beside:
        qgis.execute("BEGIN IMMEDIATE")
        qgis.execute("UPDATE gpkg_contents SET description = 'QGIS was here'")
        ours = beside.submit(season.record, three_results(), "x")
        sleep(1.0)
        assert not ours.done()
        qgis.execute("COMMIT")
        ours.result()
    assert len(Season(path).history.inspections) == 15


def test_a_season_whose_changes_lie_elsewhere_says_so_until_it_is_written_again(path, tmp_path):
    crashed = left_by_a_crash(path, tmp_path / "crashed")
    crashed.with_name("season.gpkg-wal").unlink()
    season = Season(crashed)
    (doubt,) = season.verify()
    assert "cannot be told" in doubt
    assert "bring season.gpkg-wal too" in doubt
    assert len(season.history.inspections) == 12
    season.record(three_results(), "x")
    assert Season(crashed).verify() == ()


@pytest.mark.parametrize("begun_here", [False, True])
def test_a_season_that_another_program_closed_where_it_lies_is_not_doubted(
    path, tmp_path, begun_here
):
    if begun_here:
        path.unlink()
        a_season(path)
    else:
        Season(path).record(three_results(), "x")
    with closing(as_qgis(path)) as qgis:
        qgis.execute("UPDATE gpkg_contents SET description = 'QGIS was here'")
    assert beside(path) == ["season.gpkg"]
    assert path.read_bytes()[18:20] == b"\2\2"  # its mark
    assert Season(path).verify() == ()
    copy = shutil.copy(path, tmp_path / "copy.gpkg")
    assert len(Season(copy).verify()) == 1
    renamed = path.rename(tmp_path / "renamed.gpkg")
    assert Season(renamed).verify() == ()


@pytest.mark.parametrize("kind", ["of another season", "of an earlier day", "beside a closed file"])
def test_changes_that_are_not_its_own_are_never_taken_in(path, tmp_path, kind):
    before = shutil.copy(path, tmp_path / "before.gpkg")
    if kind == "of another season":
        before = a_season(tmp_path / "other.gpkg", a_plot(width=0.0012)).path
    else:
        for on in range(1, 8):  # the file went on; what lies beside it is of before
            Season(path).record(three_results(on=on), "x")
    wal = left_by_a_crash(before, tmp_path / "crashed").with_name(f"{before.name}-wal")
    if kind != "beside a closed file":
        with closing(as_qgis(path)):
            open_file = shutil.copy(path, tmp_path / "open.gpkg")
        shutil.copy(open_file, path)
    shutil.copy(wal, path.with_name("season.gpkg-wal"))
    data = path.read_bytes()
    with pytest.raises(FileProblem, match="must belong together, but they do not"):
        Season(path)
    assert path.read_bytes() == data
    path.with_name("season.gpkg-wal").unlink()
    assert len(Season(path).history.inspections) >= 12


def broken_off(path, folder):
    """Copy a season as it stands when its machine stops in the midst of a transaction."""
    folder.mkdir()
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.execute("PRAGMA cache_size = 2")  # pages go to the disk before the transaction ends
        db.execute("BEGIN")
        db.execute("UPDATE fieldmon SET value = value + 1 WHERE key = 'revision'")
        db.execute("UPDATE plants SET number = number + 1")
        journal = path.with_name(f"{path.name}-journal")
        shutil.copy(journal, folder / "season.gpkg-journal")
        shutil.copy(path, folder / "season.gpkg")
        db.execute("ROLLBACK")
    return folder / "season.gpkg"


def test_a_transaction_that_broke_off_is_undone_by_its_own_journal(path, tmp_path):
    broken = broken_off(path, tmp_path / "broken")
    assert broken.read_bytes() != path.read_bytes()
    season = Season(broken)
    assert len(season.history.inspections) == 12
    assert season.verify() == ()
    assert beside(broken) == ["season.gpkg"]


@pytest.mark.parametrize("kind", ["of another season", "of an earlier day"])
def test_a_journal_that_is_not_its_own_is_never_taken_for_it(path, tmp_path, kind):
    before = shutil.copy(path, tmp_path / "before.gpkg")
    if kind == "of another season":
        before = a_season(tmp_path / "other.gpkg", a_plot(width=0.0012)).path
    else:
        for on in range(1, 4):
            Season(path).record(three_results(on=on), "x")
    broken_off(before, tmp_path / "broken")
    foreign = path.with_name("season.gpkg-journal")
    shutil.copy(tmp_path / "broken" / "season.gpkg-journal", foreign)
    data = path.read_bytes()
    with pytest.raises(FileProblem, match="must belong together, but they do not"):
        Season(path)
    assert path.read_bytes() == data
    foreign.unlink()
    assert len(Season(path).history.inspections) >= 12


def test_while_another_program_writes_its_journal_is_left_alone(path):
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.execute("BEGIN IMMEDIATE")
        db.execute("UPDATE fieldmon SET value = value WHERE key = 'revision'")
        assert len(Season(path).history.inspections) == 12
        db.execute("ROLLBACK")


def test_a_page_behind_the_files_last_that_is_not_in_the_log_is_missed():
    def log(*frames):
        size, salts = 512, b"saltsalt"
        head = bytes(8) + size.to_bytes(4) + bytes(4) + salts + bytes(8)
        parts = [
            page.to_bytes(4) + ends.to_bytes(4) + salts + bytes(8) + bytes(size)
            for page, ends in frames
        ]
        return head + b"".join(parts)

    # a season of four pages grew to six
    assert _reaches(log((2, 0), (5, 0), (6, 6)), 4)
    assert not _reaches(log((2, 0), (5, 6)), 4)
    assert not _reaches(log((2, 0), (6, 6)), 4)
    # what no transaction ended does not count
    assert _reaches(log((2, 4), (5, 0)), 4)
    assert not _reaches(log((2, 3)), 4)


def frames(*pages, size=512, salts=b"saltsalt"):
    """Return a log of frames: the page of each, how long the file is where it ends, its salts."""
    head = bytes(8) + size.to_bytes(4) + bytes(4) + salts + bytes(8)
    parts = [
        page.to_bytes(4) + ends.to_bytes(4) + mark + bytes(8) + bytes(size)
        for page, ends, mark in ((*one, salts)[:3] for one in pages)
    ]
    return head + b"".join(parts)


def test_a_log_reaches_if_each_new_page_came_in_a_transaction_that_ended():
    """By the words of the format: of frames before a torn or foreign one, up to the last commit."""
    rng = np.random.default_rng(1)
    outcomes = []
    for _ in range(600):
        drawn = [
            (int(rng.integers(1, 7)), int(rng.choice([0, 0, 3, 4, 5, 2])),
             b"saltsalt" if rng.random() < 0.9 else b"other---")
            for _ in range(rng.integers(0, 7))
        ]  # fmt: skip
        size = int(rng.choice([512, 1024]))
        log = frames(*drawn, size=size)
        if rng.random() < 0.3 and drawn:
            log, drawn = log[: -int(rng.integers(1, size + 24))], drawn[:-1]
        counting = list(takewhile(lambda one: one[2] == b"saltsalt", drawn))
        ends = [k for k, one in enumerate(counting) if one[1]]
        kept = counting[: ends[-1] + 1] if ends else []
        length = kept[-1][1] if kept else 3
        pages = {1, 2, 3} | {page for page, *_ in kept}
        outcomes.append(length >= 3 and all(page in pages for page in range(1, length + 1)))
        assert _reaches(log, 3) == outcomes[-1], drawn
    assert 100 < sum(outcomes) < 500


@pytest.mark.parametrize("size", [512, 4096, 65536])
@pytest.mark.parametrize("sector", [512, 4096])
@pytest.mark.parametrize(("counted", "own"), [(6, False), (7, True), (8, True), (9, False)])
def test_a_journal_is_of_the_last_transaction_if_the_file_counts_one_more_at_most(
    size, sector, counted, own
):
    """The page of the first may stand anywhere in it; where it is not, nothing of it changed."""
    head = bytearray(100)
    head[16:18] = (1 if size == 65536 else size).to_bytes(2)
    head[24:28] = (8).to_bytes(4)
    start = bytearray(sector)
    start[20:24] = sector.to_bytes(4)

    def kept(number, page=b""):
        return number.to_bytes(4) + page.ljust(size, b"\0") + bytes(4)

    first = kept(1, bytes(24) + counted.to_bytes(4))
    for pages in (first, kept(3) + first, kept(2) + first + kept(9)):
        assert _is_of_the_last_transaction(head, start + pages) == own
    assert _is_of_the_last_transaction(head, start + kept(2) + kept(3))
    assert _is_of_the_last_transaction(head, start)
