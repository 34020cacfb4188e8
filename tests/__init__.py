"""Tests of fieldmon."""

import os
import sys

# tests start some hundred processes: what these and other workers import is made into bytecode
# once, whatever the environment says; before anything is imported, Hypothesis among it
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
