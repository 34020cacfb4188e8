"""A column with dates in both orders is doubted, in records and in findings; any other is not."""

import numpy as np
import pytest

from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload
from fieldmon.io.parse.values import dates
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.readers.mixed_dates import mixed_dates
from fieldmon.plot.layout import rectangle

BOTH = ["18/11/2026", "11/15/2026", "11/06/2026"]


@pytest.mark.parametrize(("column", "doubts"), [(BOTH, 1), (BOTH[:1], 0), (BOTH[1:], 0), ([], 0)])
def test_it_is_said_with_how_many_could_be_either(column, doubts):
    said = mixed_dates(dates(np.array(column, object)), "date")
    assert len(said) == doubts
    for one in said:
        assert one.severity == Severity.DOUBTFUL
        assert "1 that could be either were read day first" in one.sentence


def test_findings_say_so_too():
    lines = "".join(f"{k + 1},yes,{day}\n" for k, day in enumerate(BOTH))
    file = Upload("found.csv", f"plant,found,date\n{lines}".encode())
    read = read_inspections(file, rectangle(2, 5), None)
    assert any("could be either" in message.sentence for message in read.messages)
