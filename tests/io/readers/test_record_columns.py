"""A table by what its columns hold: told, recognised by their names, or offered."""

import numpy as np

from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.record_columns import RecordColumns
from tests.io.tables_of_cells import table


def of(options=None, **columns):
    return RecordColumns(table(**columns), options or RecordOptions())


def test_a_role_is_read_from_the_column_told_and_else_from_that_recognised():
    columns = {"count": ["1", "2"], "mites": ["3", ""]}
    assert of(**columns).named("count") == "count"
    told = of(RecordOptions(columns=(("count", "mites"),)), **columns)
    assert told.named("count") == "mites"
    np.testing.assert_array_equal(told.numbers("count"), [3.0, np.nan])
    nothing = of(mites=["3", ""])
    assert np.isnan(nothing.numbers("leaves")).all()
    assert nothing.texts("stage").tolist() == ["", ""]


def test_columns_of_unknown_names_are_offered_for_what_their_cells_could_be():
    columns = of(count=["1", "1"], alpha=["x", "y"], beta=["x", "z"], gamma=["", ""])
    assert columns.fitting(lambda cells: "x" in cells) == ["alpha", "beta"]
    offer = columns.offer("date", lambda cells: "x" in cells)
    assert (offer.value, offer.others) == ("date=alpha", ("date=beta",))
    assert columns.offer("date", lambda cells: "q" in cells) is None
