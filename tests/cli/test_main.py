"""The command as a whole."""

import subprocess
import sys
from importlib.metadata import version


def test_help_is_there_at_once_and_teaches():
    command = [sys.executable, "-X", "importtime", "-m", "fieldmon", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "fieldmon plan estate.zip" in done.stdout
    for heavy in ("numba", "geopandas", "shapely", "numpy", "streamlit", "pandas"):
        assert f" {heavy}\n" not in done.stderr


def test_version_is_said():
    command = [sys.executable, "-m", "fieldmon", "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == f"fieldmon {version('fieldmon')}\n"
