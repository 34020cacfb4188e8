"""The command as a whole."""

import subprocess
import sys


def test_help_is_there_at_once_and_teaches():
    command = [sys.executable, "-X", "importtime", "-m", "fieldmon.cli", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "fieldmon plan estate.zip" in done.stdout
    for heavy in ("numba", "geopandas", "shapely", "numpy", "streamlit", "pandas"):
        assert f" {heavy}\n" not in done.stderr
