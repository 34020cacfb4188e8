"""Which scenarios the beginnings of their names mean."""

from dataclasses import dataclass

import pytest

from fieldmon.cli.scenario_names import beginning_so
from fieldmon.errors import SettingError


@dataclass
class Named:
    name: str


KNOWN = [Named("A, clusters"), Named("B, clusters"), Named("B, edge")]


def test_a_beginning_means_all_that_begin_so():
    assert beginning_so(["B"], KNOWN) == KNOWN[1:]
    assert beginning_so(["B, e", "A"], KNOWN) == [KNOWN[0], KNOWN[2]]


def test_where_none_begins_so_the_likest_are_named_first():
    with pytest.raises(SettingError) as refused:
        beginning_so(["B, field", "Z"], KNOWN, ", and more with --full")
    assert str(refused.value) == (
        '--scenario must be how a scenario\'s name begins, but none begins with "B, field" or '
        '"Z". There are 3, for instance "B, clusters", "B, edge", "A, clusters", and more with '
        "--full."
    )
