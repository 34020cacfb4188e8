"""Rings that do not end where they begin are closed, and what cannot be understood is said."""

import struct

import numpy as np
from shapely import box

from fieldmon.io.formats.wkb import shapes, understood
from fieldmon.io.import_report import Severity

SQUARE = box(0, 0, 2, 2)


def wkb(*corners):
    points = b"".join(struct.pack("<dd", *corner) for corner in corners)
    return struct.pack("<BIII", 1, 3, 1, len(corners)) + points


def cells(*values):
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column


def read(*values):
    return shapes(cells(*values))


def test_good_shapes_and_missing_ones_say_nothing():
    geometry, messages = read(SQUARE.wkb, None)
    assert geometry[0].equals(SQUARE)
    assert geometry[1] is None
    assert messages == []


def test_a_ring_is_closed_by_a_straight_line_and_counted():
    geometry, (said,) = read(wkb((0, 0), (2, 0), (2, 2), (0, 2)), SQUARE.wkb)
    assert geometry[0].equals(SQUARE)
    assert said.severity == Severity.REPAIRED
    assert "The outline of 1 feature did not end where it began" in said.sentence


def test_what_is_no_ring_is_left_out_and_named():
    geometry, (said,) = read(SQUARE.wkb, wkb((0, 0)))
    assert geometry[1] is None
    assert (said.severity, said.feature) == (Severity.DROPPED, "feature 2")


def test_shapes_in_bytes_and_in_text_are_understood_and_mended_alike():
    as_bytes = cells(SQUARE.wkb, None, wkb((0, 0), (2, 0), (2, 2), (0, 2)), None, None, wkb((0, 0)))
    opened = "POLYGON ((0 0, 2 0, 2 2, 0 2))"
    as_text = cells(None, SQUARE.wkt, None, opened, None, None)
    geometry, mended = understood(as_bytes, as_text)
    assert [one is not None and one.equals(SQUARE) for one in geometry] == [True] * 4 + [False] * 2
    assert mended.tolist() == [False, False, True, True, False, False]
