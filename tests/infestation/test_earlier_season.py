"""What an earlier season learnt is believed at first, and is soon outweighed."""

from dataclasses import asdict, replace
from datetime import date

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.ancestry.origins import (
    AT_START,
    AT_START_ELSEWHERE,
    BY_ADJACENT,
    JUMPED,
    N_ORIGINS,
    OVERLOOKED,
    OriginCounts,
)
from fieldmon.infestation.earlier_season import Believed, EarlierSeason, earlier_from
from fieldmon.infestation.learnt import learnt_from
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle
from tests.infestation.tracing.traced_maps import mid_season

GRID = rectangle(9, 9)
FIRST = TracedPairs.of(GRID, np.full(81, 0.02))
BELIEVED = Believed.of(GRID, "", 0.02, 0.84)


def earlier(found=2.0, expected=4.0, stands=(0.0, -1.0, -2.0, -4.0), believed=BELIEVED):
    counts = OriginCounts(np.full(N_ORIGINS, found), np.full(N_ORIGINS, expected))
    evening = replace(FIRST, counts=counts, evidence=np.array(stands))
    return EarlierSeason.of(evening, believed, "Gate", date(2025, 11, 30))


def detection_of(belief):
    return learnt_from(belief, 0.84)[0]


def test_what_was_learnt_counts_half():
    begun = earlier().begin(FIRST, BELIEVED)
    assert begun.counts.found[OVERLOOKED] == 1.0
    assert begun.counts.expected[OVERLOOKED] == 2.0
    assert begun.evidence.tolist() == [0.0, -0.5, -1.0, -2.0]
    assert detection_of(FIRST).value < detection_of(begun).value < 0.9


def test_however_many_finds_it_had_it_counts_as_two_of_an_origin():
    begun = earlier(900.0, 300.0).begin(FIRST, BELIEVED)
    assert begun.counts.found[JUMPED] == pytest.approx(2.0)
    assert begun.counts.found[JUMPED] / begun.counts.expected[JUMPED] == pytest.approx(3.0)


def test_how_many_were_infested_at_its_start_is_not_carried_over():
    begun = earlier().begin(FIRST, BELIEVED)
    assert not begun.counts.found[[AT_START, AT_START_ELSEWHERE]].any()
    assert not begun.counts.expected[[AT_START, AT_START_ELSEWHERE]].any()
    assert np.array_equal(begun.chance, FIRST.chance)


@pytest.mark.parametrize(
    ("believed", "left_out", "kept", "anew"),
    [
        (replace(BELIEVED, detection=0.5), OVERLOOKED, BY_ADJACENT, "detection"),
        (replace(BELIEVED, rate_per_day=0.3), BY_ADJACENT, OVERLOOKED, "neighbours, jumps"),
        (replace(BELIEVED, row_m=2 * BELIEVED.row_m), JUMPED, BY_ADJACENT, "jumps"),
    ],
)
def test_what_is_told_otherwise_is_learnt_anew(believed, left_out, kept, anew):
    one = earlier()
    begun = one.begin(FIRST, believed)
    assert begun.counts.expected[left_out] == 0.0 < begun.counts.expected[kept]
    assert one.sentence(believed).endswith(f"{anew}.")


def test_of_another_pest_nothing_counts_and_that_is_said():
    mites = replace(BELIEVED, pest="spider-mite")
    assert earlier().begin(FIRST, mites) is FIRST
    assert earlier().sentence(mites).endswith("it was of another pest.")


@pytest.mark.parametrize("pest", ["", "mite"])
def test_before_anything_is_inspected_those_at_the_start_are_those_there_now(pest):
    """Whatever another season taught: they are the same plants, with the same interval."""
    first = FIRST.of_pest(Pest(pest)) if pest else FIRST
    for begun in (first, earlier(believed=replace(BELIEVED, pest=pest)).begin(
        first, replace(BELIEVED, pest=pest)
    )):  # fmt: skip
        now = estimate_of(GRID, begun)
        start = {one.name: one for one in learnt_from(begun, 0.84)}["infested at the start"]
        assert (start.value, start.low, start.high) == pytest.approx(
            (now.expected, now.low, now.high)
        )
    assert begun.counts.expected.any()


def test_where_seasons_are_alike_the_sentence_has_no_but():
    said = earlier().sentence(BELIEVED)
    assert said == (
        "Begun with what was learnt on Gate until 2025-11-30, which counts little against this "
        "season's finds."
    )


@pytest.mark.parametrize("seed", range(3))
def test_what_a_season_learnt_moves_the_next_one_toward_it(seed):
    """Each number of the new first morning lies between the old first one and what was learnt."""
    evening = mid_season(seed)
    grid = evening.grid
    first, believed = TracedPairs.of(grid, evening.chance), Believed.of(grid, "", 0.02, 0.84)
    begun = EarlierSeason.of(evening, believed, "x", date(2025, 1, 1)).begin(first, believed)
    scales = [one.counts.scale[BY_ADJACENT:AT_START_ELSEWHERE] for one in (first, begun, evening)]
    low, high = np.minimum(scales[0], scales[2]), np.maximum(scales[0], scales[2])
    assert ((low - 1e-12 <= scales[1]) & (scales[1] <= high + 1e-12)).all()
    ends = sorted((first.jumps, evening.jumps))
    assert ends[0] - 1e-12 <= begun.jumps <= ends[1] + 1e-12
    assert begun.latency.likely.tolist() == first.latency.likely.tolist()


def test_a_season_of_a_season_counts_a_quarter():
    second = replace(earlier().begin(FIRST, BELIEVED))
    third = EarlierSeason.of(second, BELIEVED, "Gate", date(2026, 1, 1))
    assert third.found[OVERLOOKED] == 0.5


def test_it_comes_back_from_plain_values():
    plain = asdict(earlier())
    plain["until"] = plain["until"].isoformat()
    assert earlier_from(plain) == earlier()
    assert earlier_from(None) is None


@pytest.mark.parametrize("wrong", [(1.0,), (float("nan"),) * 4])
def test_what_is_no_such_thing_is_a_sentence(wrong):
    with pytest.raises(SettingError, match=r"must be 4 numbers \(stands\)"):
        replace(earlier(), stands=wrong)
