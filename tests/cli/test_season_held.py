"""A season that another program holds: every command says so in time, and counts meanwhile."""

import sqlite3
import sys
from contextlib import closing
from time import monotonic

import pytest

from fieldmon.cli import progress
from fieldmon.monitoring.changes import transactions
from fieldmon.monitoring.file import connections

COMMANDS = {
    "plan": (),
    "status": (),
    "record": ("taps.csv",),
    "undo": (),
    "treat": ("--efficacy", "0.5"),
    "change": ("--hours", "2"),
    "report": ("-o", "report.html"),
    "correct": ("--who", "Ann"),
    "merge": ("other.gpkg",),
    "backup": ("-o", "copy.gpkg"),
}


@pytest.fixture
def held(season, tmp_path):
    """Hold a season as a backup program does that locks it."""
    (tmp_path / "taps.csv").write_text("plant,result\n1,clean\n", "utf-8")
    (tmp_path / "other.gpkg").write_bytes(season.read_bytes())
    with closing(sqlite3.connect(season, isolation_level=None)) as other:
        other.execute("BEGIN EXCLUSIVE")
        yield season


def test_every_command_says_who_keeps_it_waiting_within_its_patience(run, held, monkeypatch):
    assert connections._PATIENCE_S + transactions._GLANCE_S <= 31.0
    monkeypatch.setattr(connections, "_PATIENCE_S", 0.3)
    monkeypatch.setattr(transactions, "_GLANCE_S", 0.1)
    for command, words in COMMANDS.items():
        began = monotonic()
        code, _, err, made = run(command, held, *words)
        assert (code, made) == (2, set()), command
        assert "another program has held it" in err, command
        # not the half minute of who heeds no patience, on a machine that others keep busy
        assert monotonic() - began < 25.0, command


def test_the_seconds_are_counted_on_the_screen_while_it_waits(run, held, monkeypatch):
    monkeypatch.setattr(connections, "_PATIENCE_S", 2.0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(progress, "_SILENT_S", 0.0)
    _, _, err, _ = run("status", held)
    assert err.count("Working, ") >= 2
