"""The columns of inspections stand once, for whatever carries them."""

from dataclasses import fields

import numpy as np
import pytest

from fieldmon.infestation.inspection_columns import BESIDE, COLUMNS, COUNT, IDENTIFYING
from fieldmon.infestation.inspections import Inspections


def test_inspections_have_the_columns_of_the_table_and_no_other():
    assert {one.name for one in fields(Inspections)} == {column.name for column in COLUMNS}
    assert len({column.kept for column in COLUMNS}) == len(COLUMNS)
    assert {*IDENTIFYING} | {*BESIDE} == {*COLUMNS}


@pytest.mark.parametrize("column", [COUNT, *BESIDE], ids=lambda column: column.name)
def test_what_is_said_comes_out_of_the_file_as_it_went_in_and_nothing_as_nothing(column):
    said = np.array(["webs", ""] if column.is_text else [0.25, np.nan], column.dtype)
    back = np.array([column.from_file(kept) for kept in column.to_file(said)], column.dtype)
    np.testing.assert_array_equal(back, said)
    np.testing.assert_array_equal([column.from_file(None)], [column.empty])
