"""Who was where before entry was allowed: known once both are recorded, in whichever order."""

from dataclasses import replace
from datetime import time

import numpy as np
import pytest

from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import CLEAN, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.cautions import RulesToKeep
from fieldmon.monitoring.treating.early_entries import early_entries
from tests.monitoring.seasons import on
from tests.monitoring.treating.test_cautions import EAST, treated

H = 3600.0


class Trees:
    """Plants in no rows."""

    in_rows = False

    def __len__(self):
        return 20

    def vines_of(self, plants):
        return plants


def inspected(day, plants, second=np.nan, who="Ana", result=CLEAN):
    k = len(plants)
    return Inspections.of(
        np.array(plants), np.full(k, result), np.datetime64(on(day)),
        second=np.full(k, second), who=np.full(k, who, object),
    )  # fmt: skip


def found(one, seen, until=30, labels=()):
    rules = RulesToKeep(tuple(labels), None, time(6))
    return [each.sentence for each in early_entries([one], rules, seen, Trees(), on(until))]


EVENING = treated(0, EAST, began=time(18), ended=time(19, 30), reentry_hours=24.0)


@pytest.mark.parametrize(
    ("day", "second", "when"),
    [
        (0, 17.9 * H, None), (0, 18 * H, "at 18:00"), (1, 6 * H, "at 06:00"),
        (1, np.nan, "(no time noted)"), (1, 19.5 * H, None), (0, np.nan, None), (2, np.nan, None),
    ],
)  # fmt: skip
def test_who_was_at_a_treated_plant_from_its_begin_until_entry_is_named(day, second, when):
    said = (
        f"Ana was at 2 plants on {on(day)} {when}, where Acarol was applied on {on(0)}: entry was "
        f"allowed from 19:30 on {on(1)}."
    )
    assert found(EVENING, inspected(day, [3, 4, 15], second)) == ([said] if when else [])


def test_each_person_is_named_with_the_times_and_nobody_is_after_the_day_asked_for():
    seen = inspected(1, [3], 6 * H).and_those(inspected(1, [4], 7 * H, result=SKIPPED))
    seen = seen.and_those(inspected(1, [5], 8 * H, who=""))
    ana, somebody = sorted(found(EVENING, seen))
    assert ana.startswith(f"Ana was at 2 plants on {on(1)} from 06:00 to 07:00, where Acarol")
    assert somebody.startswith(f"Somebody was at 1 plant on {on(1)} at 08:00, where Acarol")
    assert found(EVENING, seen, until=0) == []


def test_a_label_counts_and_without_a_wait_nothing_is_said():
    plain = replace(EVENING, application=replace(EVENING.application, reentry_hours=None))
    seen = inspected(1, [3], 6 * H)
    assert found(plain, seen) == []
    assert len(found(plain, seen, labels=[ProductLabel("Acarol", reentry_hours=12.0)])) == 1


@pytest.mark.parametrize("first", ["inspected", "treated"])
def test_a_season_says_so_whichever_was_recorded_first(season, first):
    plants = np.flatnonzero(season.plant_numbers.line == 1)
    said = Application("Acarol", began=time(18), ended=time(19, 30), reentry_hours=24.0)
    steps = [
        lambda: season.record(inspected(1, plants[:3], 6 * H), "day.csv", "Ana"),
        lambda: season.treat(on(0), 0.5, application=said, plants=season.plant_numbers.line <= 2),
    ]
    for step in steps if first == "inspected" else steps[::-1]:
        step()
    (told,) = (one for one in Season(season.path).cautions(on(1)) if one.kind == "entered")
    assert told.sentence == (
        f"Ana was at 3 plants in row 1 on {on(1)} at 06:00, where Acarol was applied on {on(0)}: "
        f"entry was allowed from 19:30 on {on(1)}."
    )
    (own,) = (one for one in season.cautions(on(0), because_of=told.batch) if one.kind == "entered")
    assert own == told
    assert [one.kind for one in season.cautions(on(9))] == ["entered", "harvest"]
