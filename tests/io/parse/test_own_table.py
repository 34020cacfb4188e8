"""Tables that people write themselves: in any common dialect, and refused where they are torn."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.parse.own_table import own_table


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_lines_are_told_by_where_they_stand_and_short_ones_are_filled_up(mark):
    lines = ["# mine", "name,level,", "", " a ,1,,,", "# more", '"b', 'c"', ",,"]
    table = own_table("\r\n".join(lines).replace(",", mark), "t.csv")
    assert table.columns == ("name", "level", "")
    assert table.lines == (
        ("t.csv, line 4", {"name": "a", "level": "1", "": ""}),
        ("t.csv, line 7", {"name": "b c", "level": "", "": ""}),
    )
    assert own_table("", "t.csv") == ((), ())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name,level\na,0,05\n", "line 2 has 3 cells, but there are 2 columns"),
        ("name,level,Level\na,1,2\n", "two columns are called level"),
        ("name,level\n" + "x" * 1_000_001, "must be a text table"),
        ('name,level\na,1\n"b,1\nc,1\n', "line 3: a quote that opens here must be closed"),
    ],
)
def test_a_table_that_could_mean_two_things_is_refused(text, said):
    with pytest.raises(FileProblem, match=f"t.csv.*{said}"):
        own_table(text, "t.csv")
