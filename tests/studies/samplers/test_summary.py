"""What outcomes say: paired ratios, and sentences that fall whichever way they fall."""

from dataclasses import replace

import pytest

from fieldmon.studies.samplers.contenders import (
    ABOUT,
    ADAPTIVE,
    BOUNDS,
    CLAIRVOYANT,
    NAMES,
    TUNED,
    WORDED,
)
from fieldmon.studies.samplers.seasons import MEASURES, SeasonOutcome
from fieldmon.studies.samplers.summary import (
    by_scenario,
    means,
    ratio_lines,
    ratios,
    sentences,
    verdict,
)


def outcome(scenario, seed, contender, loss=10.0, days=5.0):
    return SeasonOutcome(scenario, seed, contender, loss, days, days, 100.0, 20.0, 50.0)


MADE = [
    outcome(scenario, seed, name, loss=10.0 + seed + 5.0 * (name != ADAPTIVE))
    for scenario in ("one", "other")
    for seed in range(4)
    for name in (ADAPTIVE, WORDED, TUNED, "naive")
]


def test_values_stand_by_scenario_and_contender_in_the_order_of_their_seeds():
    table = by_scenario(MADE[::-1], "infested_plant_days")
    assert set(table) == {"one", "other"}
    assert table["one"][ADAPTIVE].tolist() == [10.0, 11.0, 12.0, 13.0]
    assert set(table["one"]) == set(NAMES)
    assert not len(table["one"][CLAIRVOYANT])


def test_means_are_of_those_who_took_part():
    made = means(MADE)
    assert set(made) == set(MEASURES)
    assert made["infested_plant_days"]["other"] == {
        ADAPTIVE: 11.5, WORDED: 16.5, TUNED: 16.5, "naive": 16.5,
    }  # fmt: skip


def test_a_sampler_that_is_worse_is_called_worse():
    worse = [
        replace(o, infested_plant_days=99.0 if o.contender == ADAPTIVE else 10.0) for o in MADE
    ]
    said = " ".join(sentences(worse))
    assert "fewer in 0; geometric mean 9.90 x" in said
    assert f"More than 5 % worse than {WORDED} in: one; other." in said


def test_a_sampler_that_is_better_is_called_better():
    said = " ".join(sentences(MADE))
    assert f"against {TUNED}: at most half in 0 of 2 scenarios, fewer in 2" in said
    assert "worse than" not in said
    assert f"no later than {TUNED} in 2 of 2 scenarios." in said


def test_who_finds_half_later_is_named():
    late = [replace(o, d50=9.0) if (o.scenario, o.contender) == ("one", ADAPTIVE) else o
            for o in MADE]  # fmt: skip
    assert any(said.endswith("in 1 of 2 scenarios; later in one.") for said in sentences(late))


def test_inspections_per_find_are_compared():
    idle = [replace(o, inspected=500.0) if o.contender == ADAPTIVE else o for o in MADE]
    assert f"no more than {TUNED} in 0 of 2 scenarios" in sentences(idle)[-1]
    assert f"no more than {TUNED} in 2 of 2 scenarios" in sentences(MADE)[-1]


def test_adaptive_is_held_against_each_other_that_took_part_in_all_seasons():
    made = ratios(MADE)
    assert set(made["one"]) == {WORDED, TUNED, "naive"}
    assert made["one"][TUNED].value == pytest.approx(11.5 / 16.5)
    head, *lines = ratio_lines(MADE)
    assert WORDED in head
    assert [line.split()[0] for line in lines] == ["one", "other"]
    assert all(line.count("0.70 (") == 3 for line in lines)


def test_who_loses_least_is_said_first_and_where_that_is_sure():
    first, *against, few = verdict(MADE)
    assert first == "Fewest infested plant-days, of 2 scenarios: adaptive in 2."
    assert against[0].startswith(
        f"adaptive against {WORDED}: surely fewer in 2, surely more in 0, not sure in 0 "
    )
    assert few.startswith("With 4 seasons intervals come out too narrow.")
    better = [replace(o, infested_plant_days=1.0) if (o.scenario, o.contender) == ("one", TUNED)
              else o for o in MADE]  # fmt: skip
    first, _, tuned, *_ = verdict(better)
    assert (
        first == "Fewest infested plant-days, of 2 scenarios: adaptive in 1; dynamic, tuned in 1."
    )
    assert f"{TUNED}: surely fewer in 1, surely more in 1" in tuned
    many = [replace(o, seed=o.seed + 4 * k) for k in range(5) for o in MADE]
    assert not any("too narrow" in said for said in verdict(many))


def test_who_loses_as_few_is_named_too():
    def said(*alike):
        return verdict([replace(o, infested_plant_days=1.0 if o.contender in alike else 2.0)
                        if o.scenario == "one" else o for o in MADE])[0]  # fmt: skip

    head = "Fewest infested plant-days, of 2 scenarios: adaptive in 1; "
    assert said("naive", WORDED) == f"{head}{WORDED} and naive alike in 1."
    assert said() == f"{head}all alike in 1."
    one = [replace(o, infested_plant_days=3.0) for o in MADE if o.scenario == "one"]
    assert verdict(one)[0] == "Fewest infested plant-days, of 1 scenario: all alike in 1."


def test_a_bound_is_not_said_to_lose_least():
    bound = [outcome(scenario, 0, CLAIRVOYANT, loss=0.1) for scenario in ("one", "other")]
    assert verdict(MADE + bound)[0].endswith("adaptive in 2.")


def test_each_who_takes_part_is_explained():
    assert set(ABOUT) == set(NAMES)
    assert set(BOUNDS) < set(NAMES)


def test_ratios_stand_under_their_heads_however_long_a_name():
    long = [replace(o, scenario="a name " * 12) for o in MADE if o.scenario == "one"]
    head, line = ratio_lines(long)
    assert head.index(WORDED) + len(WORDED) == line.index("(", line.index("0.70")) + 11
