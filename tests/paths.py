"""Where the tests find what lies in this repository and beside it."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SAMPLE_DATA = ROOT / "sample_data"
# real data and published figures that are no part of the repository
SHARED = ROOT.parent / "shared"
