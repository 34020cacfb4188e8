"""A command, run as a person does."""

import shutil
import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

from fieldmon.cli.main import app, main
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


@pytest.fixture(scope="session")
def begun(tmp_path_factory):
    """Begin a season on the smallest plot by its command, once; return its file."""
    file = tmp_path_factory.mktemp("begun") / "season.gpkg"
    words = ["init", file, ZIP, "--feature", "Nursery", "--records", MITES]
    words += ["--begins", BEGINS, "--hours", "1"]
    with redirect_stdout(StringIO()) as said:
        app([str(word) for word in words], standalone_mode=False)
    assert f"Season begun in {file}: 61 of 76 records count, about " in said.getvalue()
    return file


@pytest.fixture
def season(begun, tmp_path):
    """Return the file of a season that has just begun, a copy for each test."""
    return Path(shutil.copy(begun, tmp_path / "season.gpkg"))
