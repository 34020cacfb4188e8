"""Treatments of two copies: once each, whatever labels added, and said where nobody knows."""

import random
import shutil
from dataclasses import replace
from datetime import timedelta
from itertools import combinations, permutations
from unittest import mock

import numpy as np
import pytest

from fieldmon.decisions.labels import ProductLabel
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting import batches, undone_batches
from fieldmon.monitoring.merging.merge import merge_copies
from fieldmon.monitoring.treating import treatments
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.monitoring.treating.treatments import TreatedPlace
from fieldmon.plot import local_clock
from tests.monitoring.merging.copies import (
    FIRST,
    GRID,
    PAIRS,
    PLOT,
    SPRAYED,
    content,
    copied,
    copies_of,
    merge,
)
from tests.monitoring.seasons import BEGINS


@pytest.mark.parametrize("first", ["here", "there"])
@pytest.mark.parametrize("way", ["here", "there"])
def test_a_spraying_that_both_recorded_counts_once_with_the_stricter_of_what_labels_added(
    path, other, tmp_path, first, way
):
    third = Season(shutil.copy(path, tmp_path / "third.gpkg"))  # nothing but what was said
    here, there = Season(path), Season(other)
    here.keep_labels([ProductLabel("Acarol", waiting_days=7, reentry_hours=24.0)])
    there.keep_labels(
        [ProductLabel("Acarol", waiting_days=14, reentry_hours=12.0, irac_groups=("6",))]
    )
    for one in (here, there) if first == "here" else (there, here):
        one.treat(BEGINS, 0.5, application=SPRAYED)
    third.treat(BEGINS, 0.5, application=SPRAYED)
    third.treat(BEGINS, 0.5, application=replace(SPRAYED, operator="Ben"))
    season, copy = (here, there) if way == "here" else (there, here)
    evening = season.evening(BEGINS)
    done = season.merge(copy)
    waits, hours = ((7, 14), (24, 12)) if way == "here" else ((14, 7), (12, 24))
    group = "none here, 6 there" if way == "here" else "6 here, none there"
    assert done.treatments == 0
    said = (
        f"The treatment with Acarol on {BEGINS} was recorded in both, and labels added different "
        f"values: waiting days {waits[0]} here, {waits[1]} there, re-entry hours {hours[0]} here, "
        f"{hours[1]} there, group {group}. It counts once; the longer waits and all groups hold."
    )
    assert done.contradictions[1:] == (said,)
    np.testing.assert_array_equal(season.evening(BEGINS), evening)
    strictest = replace(SPRAYED, waiting_days=14, reentry_hours=24.0, irac_groups=("6",))
    assert [one.application for one in season.treatments()] == [strictest]
    n = len(season.log())
    again = season.merge(copy)
    assert (again.contradictions, again.treatments, len(season.log())) == ((), 0, n)
    copy.merge(season)
    assert [one.application for one in copy.treatments()] == [strictest]
    assert season.merge(third).treatments == 1
    bens = replace(SPRAYED, operator="Ben")
    assert [one.application for one in season.treatments()] == [strictest, bens]
    assert (season.verify(), copy.verify()) == ((), ())
    left = [replace(SPRAYED, waiting_days=7, reentry_hours=24.0),
            replace(SPRAYED, waiting_days=14, reentry_hours=12.0, irac_groups=("6",))]  # fmt: skip
    assert "still" in copy.undo(copy.treatments()[0].batch)
    assert [one.application for one in copy.treatments()] == left[first == "here" :][:1]
    assert "still" not in copy.undo(copy.treatments()[0].batch)
    assert copy.treatments() == ()
    assert copy.verify() == ()


@pytest.mark.parametrize("said", [None, 3])
@pytest.mark.parametrize("noted", [True, False])
def test_treatments_of_which_nobody_knows_whether_they_are_one_both_count_and_are_listed(
    said, noted
):
    one, other = copies_of(2)
    sprayed(one, 0, SPRAYED, {"waiting_days": 7}, noted=noted)
    if said is None:
        sprayed(other, 1, SPRAYED, {"waiting_days": 14})
    else:
        sprayed(other, 1, replace(SPRAYED, waiting_days=said), {})
    ours = copied(one)
    done = merge_copies(ours, other)
    if noted and said is None:
        assert "It counts once" in done.merged.contradictions[0]
        assert counting(ours) == [(1, 7)]
        return
    why = "" if noted else " (an earlier version did not note whether a label added that)"
    doubt = (
        f"Treatments with Acarol on {BEGINS}, batches 1 and 2, say the same but for waiting days "
        f"7 here, {said or 14} there{why}. Both count; if they are one, undo a batch."
    )
    assert done.merged.contradictions == (doubt,)
    assert done.merged.treatments == 1
    assert counting(ours) == [(1, 7), (2, said or 14)]
    assert merge_copies(ours, other).merged.contradictions == ()


@pytest.mark.parametrize(
    ("efficacy", "said"),
    [
        (0.7, SPRAYED),
        (0.5, replace(SPRAYED, operator="Paco")),
        (0.5, Application("acarol ")),
    ],
)
def test_two_treatments_of_one_day_and_product_of_the_same_plants_are_named(
    path, other, efficacy, said
):
    here, there = Season(path), Season(other)
    here.treat(BEGINS, 0.5, application=SPRAYED)
    there.treat(BEGINS, efficacy, application=said)
    there.treat(BEGINS, 0.5, application=replace(SPRAYED, product="Oil"))
    there.treat(BEGINS + timedelta(days=1), 0.5, application=SPRAYED)
    done = here.merge(there)
    n = len(here.plot.grid)
    twice = (
        f"Two treatments of {n} plants with Acarol on {BEGINS}: batches 2 and 3. Both count; undo "
        "one if it was the same."
    )
    assert done.contradictions[-1] == twice
    assert [one for one in done.contradictions if one.startswith("Two treatments")] == [twice]
    assert len(here.treatments()) == 4
    assert here.merge(there).contradictions == ()


def test_two_treatments_of_other_plants_are_not_named(path, other):
    here, there = Season(path), Season(other)
    n = len(here.plot.grid)
    here.treat(BEGINS, 0.5, application=SPRAYED, plants=np.arange(n) < 5)
    there.treat(BEGINS, 0.7, application=SPRAYED, plants=np.arange(n) > 4)
    assert not [one for one in here.merge(there).contradictions if "Two treatments" in one]


def test_what_an_earlier_version_recorded_is_known_by_all_its_values():
    one, other = copies_of(2)
    sprayed(one, 0, SPRAYED, {"waiting_days": 7}, noted=False)
    sprayed(other, 1, SPRAYED, {"waiting_days": 7})
    assert merge_copies(one, other).merged.contradictions == ()
    assert counting(one) == [(1, 7)]


@pytest.mark.parametrize("first", range(0, PAIRS // 2, 20))
def test_treatments_of_three_copies_come_out_the_same_in_every_order(first):
    """250 times three with FIELDMON_MERGES=500."""
    for seed in range(first, min(first + 20, PAIRS // 2)):
        rng = random.Random(seed)
        copies = copies_of(3)
        moments = iter(rng.sample(range(100), 12))
        for db in copies:
            for _ in range(rng.randrange(1, 4)):
                said = replace(SPRAYED, waiting_days=rng.choice((None, None, None, 7)))
                filled = {} if said.waiting_days else {"waiting_days": rng.choice((7, 14))}
                filled |= rng.choice(({}, {"reentry_hours": 12.0}))
                sprayed(db, next(moments), said, filled, noted=rng.random() < 0.8)
            if rng.random() < 0.3:
                undone_batches.undo(db, None)
        outcomes = []
        for order in permutations(copies):
            ours = copied(order[0])
            for each in order[1:]:
                before = treatments.counting(ours)
                applied = [*before, *treatments.counting(each)]
                done = merge(ours, each)
                n_new, known = done.merged.treatments, frozenset().union(*before)
                now = frozenset().union(*treatments.counting(ours))
                assert any(done.gone) == any(marks.isdisjoint(now) for marks in applied)
                assert n_new == sum(not marks & known for marks in treatments.counting(ours))
            rows = content(ours)["treatments"]
            for each in order:
                assert merge(ours, each).merged.contradictions == ()
            assert content(ours)["treatments"] == rows
            marks = treatments.counting(ours)
            assert not any(a & b for a, b in combinations(marks, 2))
            live = treatments._rows(ours, "undone <> 1")
            assert all(any(treatments.known_by(row) & one for one in marks) for row in live)
            assert treatments.not_what_they_say(ours) == []
            # undoing leaves what merging would leave
            number = live[0]["batch"] if live else None
            if number is not None:
                undone_batches.undo(ours, number)
                undone = content(ours)["treatments"]
                merge(ours, order[0])
                assert content(ours)["treatments"] == undone
            outcomes.append(rows)
            ours.close()
        assert all(rows == outcomes[0] for rows in outcomes)
        for db in copies:
            db.close()


def sprayed(db, at, said, filled, *, noted=True):
    """Record a spraying of which a label filled in something; earlier versions noted none of it."""
    now = FIRST + timedelta(minutes=at)
    with mock.patch.object(local_clock, "utc_now", return_value=now):
        batch = batches.begin(db, "treatment", said.product, said.operator)
    place = TreatedPlace(PLOT.field.boundary, np.ones(len(GRID), bool), 0.5)
    whole = place, BEGINS, replace(said, **filled)
    treatment = Treatment(0, place.plants, 0.5)
    new = treatments.store(db, treatment, whole, batch, local_clock.LocalClock("UTC"), filled)
    batches.end(db, batch, new)
    if new and not noted:
        row = treatments._rows(db, f"batch = {batch}")[0] | {"by_label": None}
        undone = "UPDATE treatments SET by_label = NULL, digest = ? WHERE batch = ?"
        db.execute(undone, (treatments.digest_of(row), batch))


def counting(db):
    return db.execute("SELECT batch, waiting_days FROM treatments WHERE undone = 0").fetchall()
