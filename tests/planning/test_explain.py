"""What a day's stops are for, in words."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.planning.explain import explain
from fieldmon.planning.workday import Workday, plan_work
from fieldmon.plot.layout import rectangle
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER
from tests.scenes import scene_on

GRID = rectangle(40, 30)


def day(last=NEVER, today=12, hours=3.0):
    last_inspected = np.full(len(GRID), NEVER, np.int32)
    last_inspected[:] = last
    return replace(scene_on(GRID, hours=hours, last_inspected=last_inspected), day=today)


def counts(said):
    return sum(int(re.match(r"\d+", sentence).group()) for sentence in said)


def test_every_stop_is_told_once():
    scene = day()
    work = plan_work(scene, Adaptive())
    finds = work.plant[[3, len(work) // 2]].astype(np.int32)
    assert counts(explain(scene, work)) == len(work)
    assert counts(explain(scene, work, finds, ["Monday", "Tuesday"])) == len(work)


def test_stops_near_a_find_are_told_by_its_day_row_and_plant():
    scene = day()
    work = plan_work(scene, Adaptive())
    find = work.plant[:1].astype(np.int32)
    said, of_date = (explain(scene, work, find, [when])[0] for when in ("Tuesday", "22 Nov"))
    row, number = int(find[0]) // 30 + 1, int(find[0]) % 30 + 1
    place = f"in row {row}, plant {number}"
    assert re.fullmatch(rf"\d+ plants? around Tuesday's find {place}\.", said)
    assert re.fullmatch(rf"\d+ plants? around the find of 22 Nov {place}\.", of_date)


def test_many_finds_are_told_together_the_most_plants_first():
    scene = day()
    work = plan_work(scene, Adaptive())
    finds = work.plant[::4].astype(np.int32)
    said = explain(scene, work, finds)
    assert counts(said) == len(work)
    around = [int(s.split()[0]) for s in said if "around the find in row" in s]
    assert len(around) == 5
    assert around == sorted(around, reverse=True)
    assert re.fullmatch(r"\d+ plants around \d+ other finds\.", said[5])


def test_rows_are_told_by_how_long_they_were_not_inspected():
    never = explain(day(), plan_work(day(), Adaptive()))
    assert all(sentence.endswith("never inspected yet.") for sentence in never)
    scene = day(last=3)
    said = explain(scene, plan_work(scene, Adaptive()))
    assert all("not inspected for 9 days" in s for s in said)


def test_up_to_six_blocks_of_rows_are_told_each_and_more_as_one():
    """Rows two apart are one block, three apart two."""
    for n, expected in ((1, 1), (6, 6), (7, 1)):
        rows = 5 * np.arange(n)
        plants = np.concatenate([30 * rows + 3, 30 * (rows + 2) + 4]).astype(np.int32)
        arrive_s = 60.0 * np.arange(len(plants))
        found, ones = np.zeros(len(plants), np.bool_), np.ones(len(plants))
        said = explain(day(), Workday(plants, arrive_s, found, 40 * ones, ones, 0.0))
        assert len(said) == expected
        assert counts(said) == 2 * n
        low, high = (1, 5 * n - 2) if expected == 1 else (1, 3)
        assert said[0].split(": ")[0].endswith(f"in rows {low} to {high}")


def test_rows_beside_each_other_are_one_block_whatever_they_are_called():
    called = np.arange(40) + 1
    called[[5, 6]] = 101, 30
    names = np.where(called > 100, "5A", called.astype(np.str_))
    grid = replace(GRID, line_called=np.stack([called, called], axis=1), line_named=names)
    plants = np.array([30 * 4 + 3, 30 * 5 + 3, 30 * 6 + 3], np.int32)
    work = Workday(
        plants, 60.0 * np.arange(3), np.zeros(3, np.bool_), np.full(3, 40.0), np.ones(3), 0.0
    )
    scene = day()
    scene = replace(scene, aisles=replace(scene.aisles, grid=grid))
    (said,) = explain(scene, work)
    assert said.split(": ")[0].endswith("in rows 5 to 30, 101 · 5A")


def test_a_day_without_stops_says_so():
    scene = day(hours=0.001)
    assert explain(scene, plan_work(scene, Adaptive())) == [
        "No plant can be reached in the hours left."
    ]


def test_plants_of_which_records_speak_are_not_called_never_inspected():
    scene = day()
    work = plan_work(scene, Adaptive())
    recorded = np.zeros(len(GRID), bool)
    recorded[work.plant[::2]] = True
    said = explain(scene, work, recorded=recorded)
    known = sum(int(n) for s in said for n in re.findall(r"(\d+) known from records only", s))
    never = sum(int(n) for s in said for n in re.findall(r"(\d+) never inspected yet", s))
    assert known == len(work.plant[::2])
    assert known + never == len(work)
    recorded[:] = True
    assert not [s for s in explain(scene, work, recorded=recorded) if "never" in s]


@pytest.mark.parametrize("seed", range(5))
def test_a_block_says_for_how_long_and_how_many_never_by_counting_plant_by_plant(seed):
    """Of a row or of rows; days since half were inspected; those of records apart."""
    rng = np.random.default_rng(seed)
    row = 4 if seed % 2 else None
    plants = rng.permutation(np.arange(120, 150) if row else np.arange(90, 210))[:25]
    plants = plants.astype(np.int32)
    last = np.where(rng.random(len(GRID)) < 0.2 * seed, NEVER, rng.integers(1, 30, len(GRID)))
    recorded = rng.random(len(GRID)) < (0.5 if seed > 2 else 0.0)
    scene = replace(scene_on(GRID, last_inspected=last.astype(np.int32)), day=40)
    ones = np.ones(25)
    (said,) = explain(scene, Workday(plants, ones, ones > 2, ones, ones, 0.0), recorded=recorded)
    since = [40 - last[p] for p in plants if last[p] != NEVER]
    known = sum(last[p] == NEVER and recorded[p] for p in plants)
    never = sum(last[p] == NEVER and not recorded[p] for p in plants)
    parts = [f"not inspected for {round(np.median(since))} days"]
    if known or never:
        parts = [f"{len(since)} {parts[0]}"]
    parts += [f"{known} known from records only"] if known else []
    parts += [f"{never} never inspected yet"] if never else []
    rows = plants // 30 + 1
    where = f"in row {rows[0]}" if row else f"in rows {rows.min()} to {rows.max()}"
    expected = f"25 plants {where}: {', '.join(parts)}."
    assert said == expected


@pytest.mark.parametrize("n_finds", [1, 2, 6, 7, 9])
def test_plants_are_around_the_nearest_find_within_three_rows_and_up_to_six_finds_are_told(n_finds):
    scene = day()
    finds = (30 * 4 * np.arange(n_finds) + 10).astype(np.int32)
    metres = np.hypot(*(GRID.xy_m[:, None] - GRID.xy_m[finds]).transpose(2, 0, 1))
    reach_m = 3.0 * max(GRID.row_spacing_m, GRID.plant_spacing_m)
    plants = np.random.default_rng(n_finds).permutation(len(GRID))[:400].astype(np.int32)
    ones = np.ones(400)
    said = explain(scene, Workday(plants, ones, ones > 2, ones, ones, 0.0), finds)
    nearest = metres[plants].argmin(axis=1)
    around = np.bincount(nearest[metres[plants].min(axis=1) < reach_m], minlength=n_finds)
    most_first = np.argsort(-around, kind="stable")
    told = most_first if n_finds <= 6 else most_first[:5]
    for find, sentence in zip(told, said, strict=False):
        plural = "s" if around[find] != 1 else ""
        assert sentence == (
            f"{around[find]} plant{plural} around the find in row {4 * find + 1}, plant 11."
        )
    if n_finds > 6:
        left = around.sum() - around[told].sum()
        assert said[5] == f"{left} plants around {n_finds - 5} other finds."
    assert counts(said) == 400
