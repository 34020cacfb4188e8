"""Paths that are no plain files, and numbers beyond all measure: a sentence, within seconds."""

import os
from pathlib import Path

import pytest

from tests.cli.estate import BEGINS, ZIP

HUGE = 10**23
NO_MISTAKE = "mistake of its own"

#: a file that one may open, whose content cannot be read
UNREADABLE = "/proc/self/mem"
needs_proc = pytest.mark.skipif(not Path(UNREADABLE).exists(), reason="a system without /proc")


@pytest.fixture
def pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe.gpkg")
    return "pipe.gpkg"


@pytest.mark.parametrize(
    "words",
    [
        ("plots", "{pipe}"),
        ("plan", "{pipe}"),
        ("plan", ZIP, "--feature", "Nursery", "--records", "{pipe}"),
        ("plan", "--plants", "{pipe}"),
        ("plan", ZIP, "--feature", "Nursery", "--paths", "{pipe}"),
        ("plan", ZIP, "--feature", "Nursery", "--risk", "{pipe}"),
    ],
    ids=lambda words: words[-2],
)
def test_a_pipe_is_no_file_and_is_not_waited_for(run, pipe, words):
    code, _, err, _ = run(*(word.format(pipe=pipe) for word in words))
    assert code == 2
    assert "must be a file or a folder, but it is a pipe, a device or the like" in err


def test_a_season_is_no_pipe(run, pipe):
    for command in (("status",), ("record", pipe), ("salvage", "-o", "o.gpkg")):
        code, _, err, _ = run(command[0], pipe, *command[1:])
        assert code == 2
        assert "but there is none" in err


def test_a_pipe_of_findings_is_not_waited_for(run, season, pipe):
    code, _, err, _ = run("record", season, pipe)
    assert code == 2
    assert "but it is a pipe" in err


@pytest.mark.parametrize("folder", ["/", "/proc", "/sys"])
@pytest.mark.skipif(not Path("/proc").exists(), reason="a system without /proc")
def test_a_folder_as_large_as_the_disk_is_refused_before_it_is_listed(run, folder):
    code, _, err, _ = run("plots", folder)
    assert code == 2
    assert NO_MISTAKE not in err
    assert " at most, but" in err or "nothing of the kind" in err


@needs_proc
def test_a_file_that_only_pretends_to_be_one_is_empty(run):
    code, _, err, _ = run("plots", UNREADABLE)
    assert code == 2
    assert "must hold something, but it is empty" in err


@needs_proc
def test_what_cannot_be_read_cannot_be_salvaged(run):
    code, _, err, made = run("salvage", UNREADABLE, "-o", "rescued.gpkg")
    assert code == 2
    assert "must be readable" in err
    assert not made


@needs_proc
def test_a_season_begins_only_where_one_can_write(run, season):
    code, _, err, _ = run("salvage", season, "-o", "/proc/rescued.gpkg")
    assert code == 2
    assert "must be a folder that can be written to" in err


def test_a_number_too_large_for_the_database_is_refused(run, season):
    code, _, err, _ = run("undo", season, "--inspection", HUGE)
    assert code == 2
    assert "--inspection must be a whole number from 1 to 2^63 - 1" in err
    assert NO_MISTAKE not in err


@pytest.mark.parametrize(
    "words",
    [
        ("plan", ZIP, "--feature", "Nursery", "--sampler", "bouncy", "--every", HUGE),
        ("init", "s.gpkg", ZIP, "--feature", "Nursery", "--sampler", "bouncy", "--every", HUGE),
    ],
    ids=lambda words: words[0],
)
def test_no_plot_has_so_many_plants(run, words):
    code, _, err, made = run(*words)
    assert code == 2
    assert "--every must be 10000000 at most" in err
    assert not made


def test_every_nth_needs_a_sampler_that_counts(run, season):
    for words in (("--every", 3), ("--sampler", "dynamic", "--every", 3)):
        code, _, err, _ = run("change", season, *words)
        assert code == 2
        assert "--every goes with a sampler that inspects every N-th (bouncy, snake" in err
    code, _, err, _ = run("change", season, "--sampler", "bouncy", "--every", 3)
    assert code == 0, err
    code, _, err, _ = run("plan", season, "--date", BEGINS, "-o", "r.csv")
    assert code == 0, err


def test_a_name_of_no_letters_is_refused_before_anybody_hears_of_it(run):
    code, _, err, _ = run("stand-in", "--manufacturer", "\udce4", "--serial", "-")
    assert code == 2
    assert "letters that can be printed" in err
