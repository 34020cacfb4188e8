"""What may be tried."""

import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED
from fieldmon.studies.thesis.chapter4.trial import (
    TABLE_ROWS,
    NoPriorTrial,
    Prose,
    ThesisStrategy,
    table_viewpoints,
)
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

A = SCENARIOS["A"]


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: ThesisStrategy(8), "1 to 7, but it is 8"),
        (lambda: ThesisStrategy(1, 2), r"N must be 1 to 1 in algorithm 1 \(snake, every plant\)"),
        (lambda: ThesisStrategy(2, 0), "N must be 1 to 50 in algorithm 2"),
        (lambda: Prose(turn_90_s=-1), "turn_90_s must be 0 s or more, but it is -1"),
        (
            lambda: NoPriorTrial(A, ThesisStrategy(1), 4),
            "Viewpoints must be 1, 2 or 3, but there are 4",
        ),
        (
            lambda: NoPriorTrial(A, ThesisStrategy(1), severity=1.1),
            "Severity must be in 0..1, but it is 1.1",
        ),
        (
            lambda: NoPriorTrial(A, ThesisStrategy(2, 50)),
            "below the 50 vines of a row, but it is 50",
        ),
        (lambda: NoPriorTrial(A, ThesisStrategy(7, 2)), "Algorithm 7 has no listing"),
    ],
)
def test_impossible_trials_are_refused_with_a_sentence(make, sentence):
    with pytest.raises(SettingError, match=sentence):
        make()


def test_the_tables_give_snakes_three_viewpoints_and_neighbors_one_unless_put_right():
    listed = {table_viewpoints(s, AS_PUBLISHED) for s in TABLE_ROWS if s.neighbor}
    assert listed == {1}
    right = AS_PUBLISHED.without("unequal_viewpoints")
    assert {table_viewpoints(s, right) for s in TABLE_ROWS} == {3}
