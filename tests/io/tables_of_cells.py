"""Layers for tests, from lists of cells."""

import numpy as np

from fieldmon.io.formats.layer import Layer


def column(values):
    """Return values as a column of a layer."""
    cells = np.empty(len(values), dtype=object)
    cells[:] = values
    return cells


def cells(*values):
    """Return a column of these values."""
    return column(values)


def table(**columns):
    """Return a table; the names of its columns are those of the arguments."""
    return Layer("table", {name: column(values) for name, values in columns.items()})


def sentences(imported):
    """Return all that an import has to say, as one text."""
    return "\n".join(message.line() for message in getattr(imported, "messages", imported))
