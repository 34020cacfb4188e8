"""The limits that people read are those that hold."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.sandbox import limits
from tests.paths import ROOT

PAGE = (ROOT / "docs" / "file_limits.md").read_text(encoding="utf-8")


def row(start):
    (line,) = [line for line in PAGE.splitlines() if line.startswith(f"| {start}")]
    return line.split("|")[2].strip()


def test_the_pages_state_every_limit_as_it_is():
    assert row("a file |") == limits.size(limits.FILE_BYTES)
    unpacked = limits.size(limits.UNPACKED_BYTES)
    ratio, above = limits.COMPRESSION_RATIO, limits.size(limits.RATIO_FROM_BYTES)
    assert row("all that") == f"{unpacked}, and {ratio} times its size where that is over {above}"
    assert row("files in an") == f"{limits.ARCHIVE_ENTRIES}; {limits.ARCHIVE_DEPTH}"
    n_features = f"{limits.FEATURES:,}".replace(",", " ")
    assert limits.FEATURES == limits.RECORDS == limits.CELL_CHARACTERS
    assert row("features or") == f"{n_features}; {limits.COLUMNS}; {n_features}"
    assert row("corners") == f"{limits.VERTICES:,}".replace(",", " ")
    memory = limits.size(limits.MEMORY_BYTES)
    seconds, patience_s = limits.READ_SECONDS, limits.READ_SECONDS * limits.PATIENCE
    assert row("reading:") == f"{seconds:g} s; {memory}"
    assert f"after {patience_s:g} s of real time, or after {seconds:g} s without any work" in PAGE


def test_a_limit_says_what_may_be_and_what_to_do():
    limits.check("columns", 1000, 1000, "mites.csv")
    with pytest.raises(FileProblem, match="1000 columns at most, but mites"):
        limits.check("columns", 1001, 1000, "mites.csv")
