"""Methods beside each other: instances, walks, the table and the command."""

import csv

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.studies.routes.drive import Walker, driven
from fieldmon.studies.routes.heuristics import HEURISTICS, optimal_full_row
from fieldmon.studies.routes.instances import Instance, families, full_budget, read_matrix
from fieldmon.studies.routes.milp import solve
from fieldmon.studies.routes.study import EXACT, csv_text, run, sentences, table


def test_a_walk_across_a_row_or_away_from_home_is_no_walk():
    reward = np.ones((3, 3))
    good = Walker(3)
    good.excursion(1, 2)
    assert driven(good.home(), reward) == (6, 2.0)
    for bad in (
        [[0, 0], [0, 1]],
        [[0, 0], [0, 1], [1, 1], [1, 0], [0, 0]],
        [[0, 0], [2, 0], [0, 0]],
    ):
        with pytest.raises(ValueError, match="a walk must"):
            driven(np.array(bad), reward)
    inside = Walker(3)
    inside.along(2)
    with pytest.raises(ValueError, match="headlands"):
        inside.to_row(1)


def test_the_published_families_are_drawn_alike_from_a_seed():
    first, again, other = (list(families(seed)) for seed in (1, 1, 2))
    assert len(first) == 12
    for one, same, another in zip(first, again, other, strict=True):
        assert (one.reward == same.reward).all()
        assert (one.reward != another.reward).any()
    held = [np.sort(one.reward.ravel())[::-1] for one in first[:4]]
    top = [values[:50].sum() / values.sum() for values in held]
    assert top == sorted(top), "the higher the exponent, the more the best hold"


@pytest.mark.parametrize("name", HEURISTICS)
def test_a_heuristic_keeps_to_its_budget_and_takes_all_with_plenty(name):
    reward = np.random.default_rng(3).random((9, 6))
    for budget in range(0, 160, 9):
        assert driven(HEURISTICS[name](reward, budget), reward).steps <= budget
    assert driven(HEURISTICS[name](reward, 1000), reward).reward == pytest.approx(reward.sum())


def test_full_rows_are_chosen_best_by_trying_all():
    rng = np.random.default_rng(9)
    for _ in range(40):
        reward = rng.random((5, 3))
        budget = int(rng.integers(8, 40))
        held, best = reward.sum(axis=1), 0.0
        for chosen in range(1, 32):
            rows = [k for k in range(5) if chosen >> k & 1]
            passes = len(rows) + len(rows) % 2
            if 4 * passes + 2 * rows[-1] <= budget:
                best = max(best, held[rows].sum())
        found = driven(optimal_full_row(reward, budget), reward).reward
        assert found >= best - 1e-9


def test_a_small_program_is_proved():
    found = solve(np.array([[1.0, 5.0], [0.0, 7.0]]), 6, 20.0)
    # down the left headland, two plants deep, and back: six steps; 1 and 5 would be four
    assert found.reward == pytest.approx(7.0)
    assert found.bound == pytest.approx(7.0)
    assert found.proved


def test_a_table_names_every_method_and_its_bound():
    instance = read_matrix("1,0,3\n0,2,2\n", "tiny.csv")
    lines = list(run(instance, (0.5,), [*HEURISTICS, "MILP"]))
    rows = list(csv.DictReader(csv_text(lines).splitlines()))
    assert [row["method"] for row in rows] == [EXACT, *HEURISTICS, "MILP"]
    assert rows[0]["proved"] == "yes"
    assert float(rows[0]["reward"]) == float(rows[-1]["reward"]) == float(rows[-1]["bound"])
    assert int(rows[0]["budget"]) == full_budget(2, 3) // 2


def test_pyvrp_finds_a_walk_that_fits_and_is_no_better_than_the_exact_one():
    pytest.importorskip("pyvrp")
    reward = np.random.default_rng(4).random((6, 8)) ** 3
    exact, other = run(Instance("tiny", reward), (0.4,), ["PyVRP"], solver_s=1.0)
    assert other.method == "PyVRP"
    assert 0.5 * exact.reward < other.reward <= exact.reward + 1e-9
    assert other.cost <= other.budget


def test_the_table_for_people_says_by_how_much_the_exact_walk_exceeds_the_others():
    made = list(run(read_matrix("1,0,3\n0,2,2\n", "tiny.csv"), (0.3, 1.0), ["GR", "OFR"]))
    head, rule, first, last = table(made).splitlines()
    assert head.startswith(
        "| instance | budget | of all reward | seconds | more than the best | GR"
    )
    assert rule.count("---") == head.count("|") - 1
    assert first.startswith("| tiny.csv | 30% |")
    assert last.split(" | ")[2] == "100.0%"
    assert last.split(" | ")[4] == "0.0%"
    assert "tiny.csv, 100% of the full budget: 100.0% of all reward" in sentences(made)[1]


@pytest.mark.parametrize("text", ["", "1,2\n3\n", "1,x\n", "1,-2\n"])
def test_a_file_that_holds_no_matrix_is_refused(text):
    with pytest.raises(FileProblem, match="must hold"):
        read_matrix(text, "bad.csv")
