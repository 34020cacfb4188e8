"""Records read out of tables that are written here, for the tests of all their parts."""

import numpy as np

from fieldmon.io.options import RecordOptions
from fieldmon.io.readers.places import Plants
from fieldmon.io.readers.records import records_of
from tests.io.tables_of_cells import table

ANY = RecordOptions()


def at(n, **columns):
    """Return a table of so many records, each at a place of its own."""
    return table(lon=[35.150123 + k / 1e4 for k in range(n)], lat=[30.360789] * n, **columns)


def read(options=ANY, **columns):
    n = len(next(iter(columns.values())))
    return records_of(at(n, **columns), options)


def vines(lon):
    """Return two plants, 1 and 2, of row 1."""
    return Plants(
        np.array([[lon, 45.0], [lon, 45.001]]), np.array(["1", "1"]), np.array(["1", "2"])
    )


def said(imported, severity):
    return "\n".join(message.sentence for message in imported.of(severity))
