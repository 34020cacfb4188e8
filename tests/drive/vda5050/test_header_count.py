"""Two robots under one name count in turn; one that begins anew, repeats or is late does not."""

import pytest

from fieldmon.drive.vda5050.header_count import HeaderCount


def told(numbers):
    count = HeaderCount()
    for one in numbers:
        count.take(one)
    return count.are_two


@pytest.mark.parametrize(
    ("numbers", "are_two"),
    [
        (range(1, 50), False),
        ([one for k in range(20) for one in (500 + k, 1 + k)], True),
        ([*range(500, 530), *range(1, 30)], False),  # begun anew
        ([one for k in range(1, 30) for one in (k, k)], False),  # each twice
        ([1, 2, 3, 4, 1, 2, 3, 4, 5, 6, 3, 4, 5, 6, 7, 8], False),  # sent again from before
        ([one for k in range(20) for one in (500 + k, 1 + k)] + [*range(520, 560)], False),
    ],
)
def test_two_counts_that_both_go_on_are_two_robots(numbers, are_two):
    assert told(numbers) is are_two
