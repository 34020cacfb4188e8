"""Tables of dataclasses as CSV."""

import csv
import io
import math
from dataclasses import dataclass

from hypothesis import given
from hypothesis import strategies as st

from fieldmon.studies.tidy_csv import csv_text


@dataclass(frozen=True)
class Entry:
    name: str
    value: float
    count: int = 3


@given(st.lists(st.builds(Entry, st.text(alphabet="ab,\"' é"), st.floats(), st.integers())))
def test_every_entry_is_read_back_to_six_digits(entries):
    rows = list(csv.DictReader(io.StringIO(csv_text(entries), newline="")))
    assert len(rows) == len(entries)
    for row, entry in zip(rows, entries, strict=True):
        assert row["name"] == entry.name
        assert int(row["count"]) == entry.count
        if math.isnan(entry.value):
            assert row["value"] == ""
        else:
            assert math.isclose(float(row["value"]), entry.value, rel_tol=1e-5, abs_tol=0.0)


def test_columns_are_fields_and_no_entries_are_an_empty_file():
    assert csv_text([Entry("a", 0.1)]) == "name,value,count\na,0.1,3\n"
    assert csv_text([]) == ""
