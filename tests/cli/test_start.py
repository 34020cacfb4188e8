"""Ctrl-C before the command line is even read."""

import subprocess
import sys

import pytest

from fieldmon.cli.stopped import STOPPED, STOPPED_CODE

_STOPS = """
import runpy, sys
class Stops:
    def find_spec(self, name, *_):
        if name == {name!r}:
            raise KeyboardInterrupt
sys.meta_path.insert(0, Stops())
sys.argv = ["fieldmon", "--help"]
runpy.run_module("fieldmon", run_name="__main__")
"""


@pytest.mark.parametrize("name", ["typer", "fieldmon.cli.main", "fieldmon.cli.treat"])
def test_who_stops_a_command_while_it_is_imported_reads_a_sentence(name):
    code = _STOPS.format(name=name)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.stderr, done.returncode) == (f"{STOPPED}\n", STOPPED_CODE)
