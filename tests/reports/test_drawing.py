"""A drawing is parts in order."""

import numpy as np

from fieldmon.reports.drawing import (
    Areas,
    Bitmap,
    Discs,
    Drawing,
    Lettering,
    Segments,
    Strokes,
)


def test_a_drawing_s_words_are_those_of_its_letterings_in_order():
    parts = (Lettering(0, 0, "one"), Discs(np.zeros((1, 2)), 1.0), Lettering(0, 0, "two"))
    assert Drawing(10, 10, parts).words() == ["one", "two"]


def test_a_drawing_that_is_turned_begins_at_the_right_and_twice_turned_is_as_it_was():
    line = np.array([[1.0, 2.0], [4.0, 5.0]])
    parts = (
        Lettering(1.0, 2.0, "one"), Strokes((line,), (0, 0, 0), 1.0), Areas((line,)),
        Discs(line, 1.0), Segments(np.array([[1.0, 2.0, 4.0, 5.0]]), (0, 0, 0), 1.0),
        Bitmap(1.0, 2.0, 3.0, 4.0, b""), Lettering(5.0, 2.0, "two", anchor="middle"),
    )  # fmt: skip
    turned = Drawing(10.0, 10.0, parts).turned()
    one, strokes, areas, discs, segments, bitmap, two = turned.parts
    assert (one.x, one.y, one.anchor) == (9.0, 2.0, "end")
    assert (two.x, two.anchor) == (5.0, "middle")
    for places in (strokes.lines[0], areas.rings[0], discs.places, segments.ends.reshape(2, 2)):
        assert places.tolist() == [[9.0, 2.0], [6.0, 5.0]]
    assert bitmap.x == 6.0
    assert turned.turned().parts[0] == parts[0]
