"""Quotes in tables: one that is not closed takes in nothing unseen."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.parse.quotes import refuse_open_quote


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('a,b\n"c,1\nd,1\n', 2),
        ('a,b\n\n"c,1\n"d,1\n', 3),
        ('a,b\n"c\nd",1\nx,"1\ny,"2, 3"\n', 4),
        ('a,b\nc,"1', 2),
        ('a,b,c\n"c,1,"2, 3"\n', 2),
        ('"a,b\nc,1\n', 1),
    ],
)
def test_a_quote_that_takes_in_other_cells_is_refused_where_it_opens(text, line):
    with pytest.raises(FileProblem, match=rf"t\.csv, line {line}: a quote"):
        refuse_open_quote(text.splitlines(keepends=True), ",", "t.csv")


@pytest.mark.parametrize(
    "text", ['a,b\n"c\n\nd",1\n', 'a,b\n"c" d,1\n12" pipe,"""q"""\n', "", 'a,b\nc,"1"']
)
def test_a_quote_that_is_closed_and_a_mark_within_a_cell_are_left(text):
    refuse_open_quote(text.splitlines(keepends=True), ",", "t.csv")
