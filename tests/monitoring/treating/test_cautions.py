"""What to beware of after treatments: the third use in a row, and not the second."""

from dataclasses import replace
from datetime import date, time, timedelta

import numpy as np
import pytest

from fieldmon.compute.wording import counted
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.monitoring.treating import cautions as module
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.cautions import (
    RulesToKeep,
    because_of,
    cautions,
    groups,
    harvest_from,
    harvest_unsaid,
)
from fieldmon.monitoring.treating.treatments import KeptTreatment, TreatedPlace
from fieldmon.monitoring.treating.waiting_periods import end_of
from fieldmon.plot.local_clock import LocalClock

BEGINS, CLOCK, ALL = date(2026, 4, 6), LocalClock("Asia/Jerusalem"), np.ones(20, bool)
EAST, WEST = np.arange(20) < 12, np.arange(20) >= 8
LABEL = ProductLabel("Acarol", max_dose=Dose(0.5, "l/ha"), waiting_days=7, reentry_hours=12.0,
                     irac_groups=("6",), max_uses=2)  # fmt: skip


def treated(day, plants=ALL, **said):
    on = BEGINS + timedelta(day)
    said = Application(**({"product": "Acarol", "ended": time(9)} | said))
    return KeptTreatment(
        day + 1, day + 1, day, on, TreatedPlace(None, plants, 1.0), 0.8, said,
        end_of(CLOCK, on, said.ended), CLOCK,
    )  # fmt: skip


def every(treatments, labels=(), harvest=None, on=30):
    rules = RulesToKeep(tuple(labels), harvest, time(6))
    return cautions(treatments, rules, BEGINS + timedelta(on))


def found(treatments, labels=(), harvest=None, on=30):
    """Return what is warned of; waits that nobody said only where a day of harvest is given."""
    said = every(treatments, labels, harvest, on)
    return tuple(one for one in said if harvest or one.kind != "harvest")


def kinds(*args, **more):
    return [(one.kind, one.batch) for one in found(*args, **more)]


@pytest.mark.parametrize(("days", "warned"), [(6, False), (7, False), (8, True)])
def test_a_harvest_is_too_soon_until_the_first_day_after_the_wait(days, warned):
    # over on the 14th at 09:00 with 8 days, so the 15th is the first whole day; 13th with 7, 14th
    said = kinds([treated(0, waiting_days=days)], harvest=date(2026, 4, 14))
    assert said == ([("harvest", 1)] if warned else [])
    day, one = harvest_from([treated(0, waiting_days=days)], ())
    assert (day, one.batch) == (date(2026, 4, 7 + days), 1)


def test_a_wait_that_nobody_said_is_asked_for_whether_or_not_a_day_of_harvest_is_known():
    late, wanted = treated(20), date(2026, 4, 14)
    assert kinds([treated(0), late], harvest=wanted) == [("harvest", 21), ("harvest", 1)]
    after, before = (one.sentence for one in found([treated(0), late], harvest=wanted))
    how_long = "How long to wait from Acarol on"
    assert before.startswith(f"{how_long} 2026-04-06 until the harvest on 2026-04-14 was not said.")
    assert after.startswith(f"{how_long} 2026-04-26 until harvest was not said.")
    (said,) = every([treated(0)])
    assert (said.kind, said.batch) == ("harvest", 1)
    look = "Look at its label, and say it as it stands there."
    assert said.sentence == f"{how_long} 2026-04-06 until harvest was not said. {look}"
    assert every([treated(0, waiting_days=0)]) == every([treated(0)], [LABEL]) == ()


@pytest.mark.parametrize("unsaid", [0, 4, 20])
def test_no_day_of_harvest_is_named_where_a_wait_was_not_said_whenever_that_was(unsaid):
    known, other = treated(4, waiting_days=3), treated(unsaid, product="soap")
    first, one = harvest_from([known, other], ())
    assert (first, one) == (None, other)
    first, one = harvest_from([known, replace(other, application=Application("Acarol"))], [LABEL])
    assert first is not None
    assert harvest_from([], ()) is None
    assert harvest_unsaid(other) == (
        "From when on harvest is allowed is not known: how long to wait from soap on "
        f"{other.on} was not said."
    )


@pytest.mark.parametrize(("on", "warned"), [(0, True), (1, True), (2, False)])
def test_entry_is_warned_of_until_the_work_of_a_day_begins_after_it(on, warned):
    one = treated(0, reentry_hours=24.0)
    (said,) = found([one], on=on) or [None]
    assert (said is not None) == warned
    if said:
        assert said.sentence == (
            "Do not enter before 09:00 on 2026-04-07 where Acarol was applied on 2026-04-06."
        )


def test_the_third_use_of_a_group_in_a_row_is_warned_of_and_not_the_second():
    three = [treated(day, irac_groups=("6",)) for day in (0, 3, 6)]
    assert kinds(three[:2]) == []
    assert kinds(three) == [("group", 7)]
    assert "Use 3 of mode-of-action group 6 in a row on 20 plants" in found(three)[0].sentence


@pytest.mark.parametrize(
    ("between", "warned"), [(("28",), False), (("4A", "6"), True), ((), True), (("6A",), False)]
)
def test_another_group_between_ends_the_row_and_an_unknown_one_does_not(between, warned):
    days = [treated(0, irac_groups=("6",)), treated(2, irac_groups=between),
            treated(4, irac_groups=("6",)), treated(6, irac_groups=("6",))]  # fmt: skip
    assert (("group", 7) in kinds(days)) == warned


def test_a_row_of_uses_is_of_plants_and_not_of_the_plot():
    zones = [treated(0, EAST, irac_groups=("6",)), treated(2, WEST, irac_groups=("6",)),
             treated(4, EAST, irac_groups=("6",))]  # fmt: skip
    (one,) = found(zones)
    assert "on 4 plants" in one.sentence


@pytest.mark.parametrize("said", [True, False])
def test_groups_that_a_label_filled_in_follow_the_table_and_those_that_people_said_do_not(said):
    two = [replace(treated(day, irac_groups=("6",)), groups_said=said) for day in (0, 3)]
    now = replace(LABEL, irac_groups=("28",), max_uses=None)
    last = treated(6, irac_groups=("28",))
    assert groups(two[0], now) == (("6",) if said else ("6", "28"))
    assert groups(replace(two[0], application=Application("Acarol")), now) == ("28",)
    assert kinds([*two, last], [now]) == ([] if said else [("group", 7)])


def test_what_ends_after_midnight_is_of_the_day_on_which_it_began():
    night = treated(0, began=time(22), ended=time(2))
    early, late = treated(1, ended=time(1)), replace(treated(1, ended=time(9)), batch=9)
    night = replace(night, ended=end_of(CLOCK, BEGINS + timedelta(1), time(2)))
    in_order = sorted([night, early, late], key=lambda one: one.ended)
    assert in_order[1] is night
    # two days of its group, and three uses
    assert kinds(in_order, [LABEL]) == [("uses", 9)]


def test_a_mixture_of_a_tank_is_one_use_of_each_of_its_groups():
    mixed = [treated(day, irac_groups=(group,)) for day in (0, 3, 6) for group in ("6", "28")]
    assert kinds(mixed) == [("group", 7), ("group", 7)]
    assert kinds(mixed[:4]) == []


@pytest.mark.parametrize(
    ("dose", "water", "said"),
    [
        (Dose(0.5, "l/ha"), None, None), (Dose(0.51, "l/ha"), None, "more than its label"),
        (Dose(60, "ml/dunam"), None, "more than its label"), (Dose(0.1, "%"), 400.0, None),
        (Dose(0.1, "%"), None, "cannot be compared"),
        (Dose(1, "kg/ha"), None, "cannot be compared"),
    ],
)  # fmt: skip
def test_a_dose_above_the_label_is_warned_of(dose, water, said):
    told = found([treated(0, dose=dose, water_l_ha=water)], [LABEL])
    assert [one.kind for one in told] == ([] if said is None else ["dose"])
    assert all(said in one.sentence for one in told)


def test_of_two_labels_the_one_in_water_counts_where_it_is_stricter():
    labels = [replace(LABEL, crop="vine"), replace(LABEL, crop="rose", max_dose=Dose(0.1, "%"))]
    (told,) = found([treated(0, dose=Dose(0.4, "l/ha"), water_l_ha=300.0)], labels)
    assert told.sentence.endswith("is more than its label allows, 0.1 %.")


def test_more_uses_than_the_label_allows_are_warned_of_where_they_overlap():
    other = ("28",)
    uses = [treated(0, irac_groups=other), treated(0, EAST, irac_groups=other)]
    uses += [treated(3, EAST), treated(5, WEST)]
    (one,) = found(uses, [LABEL])
    assert (one.kind, one.batch) == ("uses", 6)
    assert (
        "Use 3 in this season on 4 plants: Acarol on 2026-04-11. Its label allows 2."
        in one.sentence
    )


@pytest.mark.parametrize(
    ("ends", "zones", "warned"),
    [
        ([time(9), time(11), time(13)], [ALL, ALL, ALL], ["Use 3 in", "Use 2 in"]),
        ([None, None], [ALL, EAST], ["Use 2 in this season on 12 plants"]),
        ([time(9), time(9)], [ALL, EAST], []),
        ([time(9), time(11)], [EAST, ~EAST], []),
    ],
    ids=["three times", "nobody said when", "one spraying", "two zones"],
)
def test_a_plant_treated_again_on_a_day_is_another_use(ends, zones, warned):
    once = replace(LABEL, max_uses=1)
    done = [
        replace(treated(0, zone, ended=end), batch=k)
        for k, (end, zone) in enumerate(zip(ends, zones, strict=True))
    ]
    said = [one.sentence for one in found(done, [once]) if one.kind == "uses"]
    assert len(said) == len(warned)
    assert all(one.startswith(use) for one, use in zip(said, warned, strict=True))
    assert all(one.endswith("Its label allows 1.") for one in said)


def test_uses_of_a_product_are_counted_however_the_lines_of_its_label_write_it():
    lines = [replace(LABEL, crop="grapes"), replace(LABEL, product=" acarol", crop="pepper")]
    uses = [treated(0, crop="grapes"), treated(3, crop="pepper"), treated(5, crop="grapes")]
    assert ("uses", 6) in kinds(uses, lines)


def test_a_wait_shorter_than_the_labels_is_said_and_the_labels_counts():
    short = treated(0, waiting_days=3, reentry_hours=4.0)
    assert kinds([short], [LABEL]) == [("waiting", 1), ("waiting", 1)]
    assert harvest_from([short], [LABEL])[0] == date(2026, 4, 14)
    assert harvest_from([treated(0, waiting_days=9)], [LABEL])[0] == date(2026, 4, 16)


def test_a_product_without_a_label_is_said_where_there_is_a_table():
    assert kinds([treated(0, product="soap")], [LABEL]) == [("label", 1)]
    assert kinds([treated(0, product="soap")]) == []
    assert kinds([treated(0, product="")], [LABEL]) == []


def test_a_label_for_a_crop_or_pest_that_is_written_otherwise_is_named_and_its_strictest_counts():
    lines = [replace(LABEL, crop="pepper", pest="spider mites"),
             replace(LABEL, crop="rose", max_uses=1)]  # fmt: skip
    said = {"crop": "pimiento", "pest": "araña roja", "dose": Dose(0.6, "l/ha"),
            "waiting_days": 3}  # fmt: skip
    told = found([treated(0, **said), treated(4, **said)], lines)
    kinds_ = ["dose", "dose", "uses", "waiting", "waiting", "label", "label"]
    assert [one.kind for one in told] == kinds_
    assert told[-1].sentence == (
        "The label of Acarol in the season's table is for pepper / spider mites, rose, but the "
        "treatment on 2026-04-06 says pimiento / araña roja. Until both are written alike, the "
        "strictest line of Acarol counts."
    )
    assert kinds([treated(0, crop="Pepper ", pest="spider  Mites")], lines) == []


@pytest.mark.parametrize(
    ("second", "warned"),
    [
        ({"product": "acarol ", "reentry_hours": 6.0}, True),
        ({"plants": np.arange(20) >= 12}, False),
        ({"product": "oil"}, False),
    ],
)
def test_one_spraying_that_may_be_recorded_twice_is_said_on_its_day(second, warned):
    again = replace(treated(3, **second), number=9, batch=9)
    done = [treated(3, EAST), again]
    said = [one for one in found(done, on=3) if one.kind == "twice"]
    assert [one.batch for one in said] == [9] * warned
    if warned:
        assert said[0].sentence == (
            "Two treatments of 12 plants with Acarol on 2026-04-09: batches 4 and 9. Both count; "
            "undo one if it was the same."
        )
    assert not [one for one in found(done, on=4) if one.kind == "twice"]
    of_second = because_of(done, 9, RulesToKeep((), None, time(6)), BEGINS + timedelta(30))
    assert [one.kind for one in of_second if one.kind == "twice"] == ["twice"] * warned
    later = [*done, replace(treated(7, product="soap"), number=12, batch=12)]
    of_later = because_of(later, 12, RulesToKeep((), None, time(6)), BEGINS + timedelta(30))
    assert "twice" not in {one.kind for one in of_later}, "it is of others"


def test_what_comes_after_the_day_is_not_looked_at():
    assert kinds([treated(9, dose=Dose(9, "l/ha"))], [LABEL], on=8) == []


def test_the_most_urgent_comes_first_and_of_one_kind_that_of_the_last_treatment():
    done = [
        treated(0, waiting_days=3, reentry_hours=4.0, irac_groups=("6",)),
        treated(2, waiting_days=12, dose=Dose(9, "l/ha"), irac_groups=("6",)),
        treated(4, product="soap"), treated(6, product="oil", reentry_hours=48.0),
        treated(7, reentry_hours=30.0, irac_groups=("6",)),
    ]  # fmt: skip
    assert kinds(done, [LABEL], harvest=date(2026, 4, 14), on=8) == [
        ("entry", 8), ("entry", 7), ("harvest", 8), ("harvest", 3), ("harvest", 7), ("harvest", 5),
        ("dose", 3), ("uses", 8), ("group", 8), ("waiting", 1), ("waiting", 1), ("label", 7),
        ("label", 5),
    ]  # fmt: skip


@pytest.mark.parametrize("seed", range(10))
def test_rows_of_uses_are_those_that_each_plant_alone_had(seed):
    """The rule read out for each plant: days on which a group known was used, one after another."""
    rng = np.random.default_rng(seed)
    known = [(), ("6",), ("28",), ("6", "28"), ("4A",)]
    done = [
        treated(int(day), rng.random(20) < 0.6, product="",
                irac_groups=known[rng.choice(5, p=[0.1, 0.5, 0.1, 0.25, 0.05])])
        for day in sorted(rng.integers(0, 9, 11))
    ]  # fmt: skip
    done = [replace(one, batch=k) for k, one in enumerate(done)]
    wanted = []
    for one in done:
        for group in one.application.irac_groups:
            uses = np.zeros(20, int)
            for plant in np.flatnonzero(one.place.plants):
                for day in range(one.day, -1, -1):
                    that_day = [
                        g for t in done if t.day == day and t.place.plants[plant]
                        for g in t.application.irac_groups
                    ]  # fmt: skip
                    if that_day and group not in that_day:
                        break
                    uses[plant] += group in that_day
            for n in np.unique(uses[uses > 2]):
                plants = counted(int(np.count_nonzero(uses == n)), "plant")
                use = f"Use {n} of mode-of-action group {group} in a row on {plants}: "
                wanted.append((one.batch, use))
    told = [(one.batch, one.sentence) for one in found(done)[::-1] if one.kind == "group"]
    assert len(told) == len(wanted) > 0
    for (batch, sentence), (number, said) in zip(told, wanted, strict=True):
        assert batch == number
        assert sentence.startswith(said)


@pytest.mark.parametrize("seed", range(6))
def test_uses_of_a_season_are_the_times_at_which_each_plant_had_the_product(seed):
    rng = np.random.default_rng(seed)
    names = ["Acarol", "ACAROL", "soap"]
    done = [
        treated(int(day), rng.random(20) < 0.5, product=names[rng.integers(0, 3)],
                ended=time(int(rng.integers(9, 11))))
        for day in sorted(rng.integers(0, 8, 9))
    ]  # fmt: skip
    done = [replace(one, batch=k) for k, one in enumerate(done)]
    label = ProductLabel("acarol", max_uses=2)
    wanted = []
    for at, one in enumerate(done):
        if one.application.product == "soap":
            continue
        same = [t for t in done[: at + 1] if t.application.product != "soap"]
        uses = np.array([
            len({(t.day, t.application.ended) for t in same if t.place.plants[p]})
            for p in range(20)
        ])  # fmt: skip
        uses = uses * one.place.plants
        for n in np.unique(uses[uses > 2]):
            plants = counted(int(np.count_nonzero(uses == n)), "plant")
            wanted.append((one.batch, f"Use {n} in this season on {plants}: "))
    told = [(one.batch, one.sentence) for one in found(done, [label])[::-1] if one.kind == "uses"]
    assert [batch for batch, _ in told] == [batch for batch, _ in wanted]
    assert all(s.startswith(said) for (_, s), (_, said) in zip(told, wanted, strict=True))


def test_a_treatment_entered_late_is_warned_of_with_what_it_adds_to_later_ones(monkeypatch):
    asked, label_of = [], module.label_of
    monkeypatch.setattr(module, "label_of", lambda *of: asked.append(1) or label_of(*of))
    rules = RulesToKeep((LABEL,), BEGINS + timedelta(6), time(6))
    late, others = treated(1), [treated(0), treated(5), treated(9)]
    said = because_of([late, *others], late.batch, rules, late.on)
    assert [(one.kind, one.batch) for one in said] == [
        ("entry", 2), ("harvest", 2), ("uses", 10), ("uses", 6), ("group", 10), ("group", 6)
    ]  # fmt: skip
    assert "Use 3 of mode-of-action group 6" in said[-1].sentence
    assert len(asked) == 4, "each label is looked up once"
    assert because_of([late, *others], late.batch, rules, BEGINS)[0].kind == "uses", "not done yet"
    alone = treated(1, product="Neem", irac_groups=("UN",))
    assert because_of([alone, *others], alone.batch, rules, alone.on) == every(
        [alone], [LABEL], rules.harvest, 1
    )
