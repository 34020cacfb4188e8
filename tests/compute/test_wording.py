"""Numbers of things as they are said."""

import pytest

from fieldmon.compute.wording import counted


@pytest.mark.parametrize(
    ("number", "said"), [(0, "0 plants"), (1, "1 plant"), (2, "2 plants"), (1001, "1001 plants")]
)
def test_one_thing_stands_alone_and_any_other_number_is_several(number, said):
    assert counted(number, "plant") == said
