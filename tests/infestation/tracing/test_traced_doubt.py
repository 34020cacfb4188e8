"""How far off the number may be that a traced map expects."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.ancestry.origins import (
    AT_START,
    AT_START_ELSEWHERE,
    BY_ADJACENT,
    N_ORIGINS,
    OriginCounts,
)
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from tests.infestation.tracing.traced_maps import FLAT, GRID, LEARNING, QUIET, mid_season


def test_the_number_infested_is_as_sure_as_what_origins_bring_and_as_groups_are_large():
    belief = mid_season()
    # as many were there at the start as was told
    found, expected = belief.counts.found.copy(), belief.counts.expected.copy()
    found[[AT_START, AT_START_ELSEWHERE]] = expected[[AT_START, AT_START_ELSEWHERE]]
    belief = replace(belief, counts=OriginCounts(found, expected))
    brought = (belief.chance @ belief.shares).astype(np.float64)
    total, beside = brought.sum(), brought[BY_ADJACENT]
    # what came from neighbours came from where those did, in proportion
    brought *= total / (total - beside)
    brought[BY_ADJACENT] = beside
    origins = np.sqrt(((brought * belief.counts.doubt) ** 2).sum()) / total
    sent = belief.unseen @ belief.chance / total
    group = 2.0 * belief.jumps * belief.beyond.sum() * sent / total
    assert belief.doubt == pytest.approx(np.hypot(origins, np.sqrt(group)), rel=1e-5)
    # offspring as an origin of its own
    alone = (belief.chance @ belief.shares * belief.counts.doubt / total).astype(np.float64)
    assert belief.doubt_of_rates == pytest.approx(np.sqrt((alone**2).sum() + group), rel=1e-5)
    # twelve plots of the like are as sure as one by its origins, and groups matter less
    assert belief.doubt > origins


@pytest.mark.parametrize("beside", [0.0, 0.3, 0.9])
def test_offspring_is_no_surer_than_what_it_came_from(beside):
    belief = mid_season()
    shares = np.zeros_like(belief.shares)
    shares[:, AT_START], shares[:, BY_ADJACENT] = 1.0 - beside, beside
    # how many come from neighbours is well known, how many were there at the start is not
    found = np.zeros(N_ORIGINS)
    found[BY_ADJACENT] = 1e9
    counts = OriginCounts(found, found)
    doubted = replace(belief, shares=shares, counts=counts, unseen=np.zeros(len(belief.chance)))
    assert doubted.doubt == pytest.approx(counts.doubt[AT_START], rel=1e-4)


def test_once_it_is_told_who_infested_whom_the_number_is_in_less_doubt():
    belief, plants = TracedPairs.of(GRID, FLAT), np.arange(40, dtype=np.int32)
    belief = replace(belief, others=())  # no heavier infestation is thought of
    idle, evening = belief.overnight(QUIET), belief.learn(plants, plants == 7, LEARNING)
    for untold in (belief, idle, evening):
        assert untold.doubt == replace(untold, ancestry=None).doubt
    for told in (evening.in_hindsight(QUIET), evening.overnight(QUIET)):
        assert told.doubt == pytest.approx(0.85 * replace(told, ancestry=None).doubt)


def test_as_far_as_more_were_there_at_the_start_than_was_told_the_number_is_in_doubt():
    belief, nothing, doubts = mid_season(), np.zeros(N_ORIGINS), []
    for times in (0.2, 0.5, 1.0, 2.0, 4.0, 16.0):
        found, expected = nothing.copy(), nothing.copy()
        found[[AT_START, AT_START_ELSEWHERE]] = 100.0
        expected[[AT_START, AT_START_ELSEWHERE]] = 101.0 / times - 1.0
        doubts.append(replace(belief, counts=OriginCounts(found, expected)).doubt)
    # nothing else is known better or worse
    assert doubts[0] == doubts[1] == doubts[2]
    assert doubts[2] < doubts[3] < doubts[4] < doubts[5]
