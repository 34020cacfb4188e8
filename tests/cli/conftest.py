"""A command, run as a person does."""

import sys

import pytest

from fieldmon.cli.main import main
from tests.cli.estate import BEGINS, MITES, ZIP


@pytest.fixture
def run(monkeypatch, capsys, tmp_path):
    """Run a command in an empty folder; return exit code, output, complaints, files made."""
    monkeypatch.chdir(tmp_path)

    def go(*words):
        before = set(tmp_path.rglob("*"))
        monkeypatch.setattr(sys, "argv", ["fieldmon", *map(str, words)])
        code = 0
        try:
            main()
        except SystemExit as stop:
            code = stop.code or 0
        out, err = capsys.readouterr()
        return code, out, err, set(tmp_path.rglob("*")) - before

    return go


@pytest.fixture
def season(run, tmp_path):
    """Return the file of a season on the smallest plot that has just begun."""
    code, out, err, _ = run(
        *("init", "season.gpkg", ZIP, "--feature", "Nursery", "--observations", MITES),
        *("--begins", BEGINS, "--hours", "1"),
    )
    assert code == 0, err
    assert "Season begun" in out
    return tmp_path / "season.gpkg"
