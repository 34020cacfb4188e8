"""Inspections as a file tells them are handed over without what reads files."""

import subprocess
import sys

HEAVY = ("numba", "scipy", "pandas", "pyogrio", "pyarrow")


def test_a_table_of_results_is_read_without_what_lays_out_rows_or_opens_maps():
    """Its reading process is started anew by every command: each of these takes it long to load."""
    said = "import sys, fieldmon.io.sandbox.tasks; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", said], capture_output=True, text=True, check=True
    ).stdout.split()
    assert not set(HEAVY) & set(loaded)
