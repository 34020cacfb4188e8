"""What is brought to a season is held to what is recorded of the same plants and days."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import ContradictionError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring.inspecting.contradictions import (
    contradicting,
    contradiction_lines,
    contradictions,
    said_before,
)
from fieldmon.plot.layout import rectangle
from tests.monitoring.seasons import BEGINS, a_season

DAY, NEXT = np.datetime64("2026-04-06"), np.datetime64("2026-04-07")


def results(*pairs, on=DAY, **columns):
    plant, result = np.array(pairs, int).reshape(-1, 2).T
    return Inspections.of(plant, result, on, **columns)


def test_clean_against_found_contradicts_in_both_directions_and_on_the_same_day_only():
    held = results((3, FOUND), (4, CLEAN), (5, FOUND))
    brought = results((3, CLEAN), (4, FOUND), (5, FOUND), (6, CLEAN))
    found = contradictions(brought, held)
    assert found.which.tolist() == [0, 1]
    assert found.plant.tolist() == [3, 4]
    assert found.recorded.tolist() == [FOUND, CLEAN]
    assert found.brought.tolist() == [CLEAN, FOUND]
    assert not len(contradictions(results((3, CLEAN), on=NEXT), held))


def test_a_plant_that_could_not_be_inspected_contradicts_nothing():
    assert not len(contradictions(results((3, SKIPPED)), results((3, FOUND))))
    assert not len(contradictions(results((3, FOUND)), results((3, SKIPPED))))


def test_what_two_copies_begin_with_hides_no_contradiction_after_it():
    common = [(1, FOUND), (2, CLEAN), (3, SKIPPED)]
    held = results(*common, (4, CLEAN), (6, FOUND))
    brought = results(*common, (6, CLEAN), (1, CLEAN), (4, FOUND), (3, FOUND))
    found = contradictions(brought, held)
    assert (found.which.tolist(), found.plant.tolist()) == ([3, 4, 5], [6, 1, 4])
    assert len(contradictions(held, held)) == len(contradictions(results(), held)) == 0


def test_what_was_confirmed_once_is_no_news():
    held = results((3, FOUND), (3, CLEAN))
    assert not len(contradictions(results((3, CLEAN)), held))


def test_one_file_contradicts_itself_as_two_files_contradict_each_other():
    both = [(3, FOUND), (4, CLEAN), (3, CLEAN), (3, SKIPPED), (3, FOUND), (4, CLEAN)]
    found = contradictions(results(*both), results())
    assert (found.which.tolist(), found.recorded.tolist()) == ([2], [FOUND])
    for cut in range(1, len(both)):
        held = results(*both[:cut])
        n = len(contradictions(held, results())) + len(contradictions(results(*both[cut:]), held))
        assert n == 1
    apart = results((3, FOUND)).and_those(results((3, CLEAN), on=NEXT))
    assert not len(contradictions(apart, results()))


def test_whatever_is_of_the_plant_and_day_of_a_contradiction_is_told_on_either_side():
    brought = results((3, CLEAN), (3, CLEAN), (4, CLEAN), (5, CLEAN))
    found = contradictions(brought, results((3, FOUND)))
    assert found.concerns(brought).tolist() == [True, True, False, False]
    assert not found.both_brought(brought)
    brought = brought.and_those(results((4, FOUND))).and_those(results((5, FOUND), on=NEXT))
    found = contradictions(brought, results((3, FOUND)))
    assert found.concerns(brought).tolist() == [True, True, True, False, True, False]
    assert found.both_brought(brought)
    # one that says both, of which the other is recorded
    brought = results((3, FOUND), (3, CLEAN))
    assert contradictions(brought, results((3, FOUND))).both_brought(brought)


def test_what_is_brought_at_once_is_not_said_to_be_recorded():
    grid = rectangle(1, 9)
    both, held = results((3, FOUND), (3, CLEAN)), results((4, CLEAN))
    with pytest.raises(ContradictionError, match="brought as found and as clean") as told:
        contradictions(both, held).refuse(grid)
    assert "recorded" not in str(told.value)
    found = contradictions(both.and_those(results((4, FOUND))), held)
    assert found.together.tolist() == [True, False]
    assert "recorded as clean, now found" in found.sentences(grid)[1]


def test_rows_are_called_as_the_file_of_the_plot_calls_them():
    names, called = np.array(["1", "5A", "Top"]), np.array([1, 101, 102])
    grid = replace(
        rectangle(3, 4), line_named=names, line_called=np.stack([called, called], axis=1)
    )
    (said,) = contradictions(results((6, CLEAN)), results((6, FOUND))).sentences(grid)
    assert said == "Row 101 · 5A, plant 3 on 2026-04-06: recorded as found, now clean."
    with pytest.raises(ContradictionError, match="1 of them contradicts it: Row 101 · 5A, plant 3"):
        contradictions(results((6, CLEAN)), results((6, FOUND))).refuse(grid)


@pytest.fixture
def season(tmp_path):
    return a_season(tmp_path / "s.gpkg")


def test_a_season_takes_no_contradiction_that_nobody_confirmed(season):
    season.record(results(*((k, FOUND) for k in range(7))), "taps")
    before, morning = season.revision, season.morning(BEGINS).tolist()
    clean = results(*((k, CLEAN) for k in range(7)), (20, CLEAN))
    with pytest.raises(ContradictionError, match=r"7 of them contradict it: Row 1, plant 1 on"):
        season.record(clean, "route table")
    assert season.revision == before
    assert season.morning(BEGINS).tolist() == morning
    assert season.record(clean, "route table", confirmed=True).new == 8
    assert season.record(clean, "route table").new == 0


def test_a_route_filled_in_after_its_stops_were_tapped_counts_once(season):
    taps = results((3, FOUND), (4, CLEAN), second=np.array([25_000.0, 25_060.0]))
    season.record(taps, "scout mode")
    belief = season.evening(BEGINS)
    done = season.record(results((3, FOUND), (4, CLEAN)), "route.csv")
    assert (done.new, done.known) == (0, 2)
    assert season.evening(BEGINS).tolist() == belief.tolist()
    counted = results((3, FOUND), count=np.array([12.0]))
    assert not said_before(counted, taps).any()
    assert said_before(results((3, FOUND), (3, CLEAN), (9, FOUND)), taps).tolist() == [
        True, False, False
    ]  # fmt: skip


def test_a_clean_plant_with_a_count_of_zero_says_no_more_than_a_clean_plant(season):
    season.record(results((3, CLEAN)), "taps")
    belief = season.evening(BEGINS)
    zero = results((3, CLEAN), count=np.array([0.0]))
    assert season.record(zero, "route.csv").new == 0
    assert season.evening(BEGINS).tolist() == belief.tolist()


def test_a_find_with_a_count_of_zero_is_the_find_that_nobody_counted(season):
    """Old seasons hold such finds, and their own tables bring them back without the zero."""
    taps = results((3, FOUND), count=np.array([0.0]), second=np.array([25_000.0]))
    season.record_all([(taps, "phone")])
    again = results((3, FOUND), second=np.array([25_000.2]))
    assert season.record(again, "inspections.csv").new == 0
    later = results((3, FOUND), second=np.array([25_001.0]))
    assert season.record(later, "inspections.csv").new == 1


@pytest.mark.parametrize("seed", range(40))
def test_each_result_is_held_to_all_that_is_recorded_of_its_plant_and_day(seed):
    """The rules read out, one result after another."""
    rng = np.random.default_rng(seed)

    def some(n):
        days = np.sort(rng.integers(0, 2, n)) + np.datetime64("2026-04-06")
        noted = {
            name: np.where(rng.random(n) < 0.5, np.nan, value)
            for name, value in (("second", 30.0), ("count", rng.choice([0.0, 2.0], n)))
        }
        return Inspections.of(rng.integers(0, 4, n), rng.integers(0, 3, n), days, **noted)

    held = some(rng.integers(0, 9))
    brought = some(rng.integers(0, 9))
    if rng.random() < 0.5:  # as of two copies of a season
        brought = held.take(slice(0, rng.integers(0, len(held) + 1))).and_those(brought)

    def told(inspections):
        columns = (inspections.plant, inspections.date, inspections.result)
        return list(zip(*(column.tolist() for column in columns), strict=True))

    of_key = {}
    for plant, day, result in told(held):
        of_key.setdefault((plant, day), []).append(result)
    wanted = []
    for k, (plant, day, result) in enumerate(told(brought)):
        before = [*told(held), *told(brought)[:k]]
        seen = {r for p, d, r in before if (p, d) == (plant, day) and r != SKIPPED}
        if result != SKIPPED and seen and result not in seen:
            wanted.append((k, plant, day, min(seen), result))
    said = contradictions(brought, held)
    columns = (said.which, said.plant, said.date, said.recorded, said.brought)
    assert list(zip(*(column.tolist() for column in columns), strict=True)) == wanted
    assert len(said) == len(wanted)
    at = set(zip(told(held), np.nan_to_num(held.second, nan=-1.0).tolist(), strict=True))
    known = [
        not count > 0 and (one[2] in of_key.get(one[:2], ()) if second < 0 else (one, second) in at)
        for one, second, count in zip(
            told(brought), np.nan_to_num(brought.second, nan=-1.0), brought.count, strict=True
        )
    ]
    assert said_before(brought, held).tolist() == known
    both = [
        one for one in told(held)
        if one[2] != SKIPPED and {CLEAN, FOUND} <= set(of_key[one[:2]])
    ]  # fmt: skip
    assert told(contradicting(held)) == sorted(both, key=lambda one: one[0])


def test_who_says_what_of_a_plant_is_said_plant_by_plant():
    who = np.array(["Ann", "", "Ben"], object)
    held = Inspections.of(
        np.array([6, 2, 6]), np.array([1, 0, 0]), np.datetime64("2026-04-06"), who=who
    )
    also = Inspections.of(np.array([2]), np.array([1]), np.datetime64("2026-04-06"))
    said = contradiction_lines(held.and_those(also), rectangle(2, 5), str.upper)
    assert said == ("Row 1, plant 3: clean, found", "Row 2, plant 2: found (ANN), clean (BEN)")


@pytest.mark.parametrize("n", [1, 5, 6])
def test_the_first_five_contradictions_are_named_and_more_are_counted(n):
    grid = rectangle(1, 9)
    held = Inspections.of(np.arange(9), np.full(9, CLEAN), np.datetime64("2026-04-06"))
    brought = Inspections.of(np.arange(n), np.full(n, FOUND), np.datetime64("2026-04-06"))
    with pytest.raises(ContradictionError) as told:
        contradictions(brought, held).refuse(grid)
    said = "contradicts" if n == 1 else "contradict"
    assert f"but {n} of them {said} it" in str(told.value)
    named = [f"Row 1, plant {k + 1} on 2026-04-06: recorded as clean, now found." for k in range(n)]
    assert [one in str(told.value) for one in named] == [k < 5 for k in range(n)]
    assert (" ... " in str(told.value)) == (n > 5)
