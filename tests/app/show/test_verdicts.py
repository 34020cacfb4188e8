"""What a comparison came to, in words: never surer than its interval."""

import numpy as np
import pytest

from app.show import verdicts
from app.state.comparison import Outcome, Strategy
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.simulation.team_worth import marginal_gains
from tests.app.driving import apart

BEST, SECOND = Strategy("dynamic", 12.0, 40.0), Strategy("naive", 12.0, 40.0)


def outcome(strategy, losses, behind=None, found=(50.0, 60.0, 70.0)):
    return Outcome(
        strategy, summary_statistics(np.array(losses)), summary_statistics(np.array(found)),
        12.34, 7.0, None if behind is None else summary_statistics(np.array(behind)),
    )  # fmt: skip


def ranked(behind):
    best = [100.0, 110.0, 120.0]
    return [outcome(BEST, best), outcome(SECOND, np.add(best, behind), behind)]


def test_a_clear_winner_is_said_with_its_interval():
    said = apart(verdicts.sentence(ranked([40.0, 41.0, 42.0])))
    # the same share as in the table, of the same best
    assert said.startswith(
        "**Dynamic · 12 h · 40 s** is best: 110 infested plant-days. "
        "Naive · 12 h · 40 s has 37 % more"
    )
    assert "Naive · 12 h · 40 s" in said
    low, high = summary_statistics(np.array([40.0, 41.0, 42.0])).low, 43.48
    assert f"({low:,.0f} to {high:,.0f} plant-days more, 95 % interval)" in said


def test_where_the_interval_holds_nothing_nobody_is_called_better():
    said = verdicts.sentence(ranked([-5.0, 1.0, 10.0]))
    assert "not clearly better" in said
    assert verdicts.table(ranked([-5.0, 1.0, 10.0]))["verdict"].tolist() == [
        "★ best", "no clear difference"
    ]  # fmt: skip


@pytest.mark.parametrize("n", [1, 3])
def test_of_strategies_that_come_to_the_same_none_is_called_best(n):
    same = [outcome(BEST, [25.0] * n, found=[50.0] * n),
            outcome(SECOND, [25.0] * n, [0.0] * n, found=[50.0] * n)]  # fmt: skip
    said = apart(verdicts.sentence(same))
    assert said == (
        "**Dynamic · 12 h · 40 s, Naive · 12 h · 40 s** are even: 25 infested plant-days each."
    )
    worse = outcome(Strategy("bouncy", 12.0, 40.0), [30.0] * n, [5.0] * n, found=[50.0] * n)
    assert verdicts.table([*same, worse])["verdict"].tolist()[:2] == ["even", "even"]
    assert "even" not in verdicts.table([same[0], worse])["verdict"].tolist()


def test_a_verdict_stands_beside_its_strategy_where_a_narrow_panel_shows_it():
    assert list(verdicts.table(ranked([1.0, 2.0, 3.0])))[:2] == ["strategy", "verdict"]


def test_nobody_loses_less_than_nothing():
    table = verdicts.table([outcome(BEST, [1.0, 300.0, 2.0]), outcome(SECOND, [5.0], [30.0])])
    said = table["infested plant-days"].tolist()
    assert said[0].startswith("101 (0 to ")
    assert said[1] == "5", "one season has no interval"


def test_one_strategy_alone_is_not_called_best_of_others():
    assert verdicts.sentence(ranked([1.0, 2.0, 3.0])[:1]) == ""


def test_one_season_has_no_interval():
    table = verdicts.table([outcome(BEST, [100.0], found=[50.0]),
                            outcome(SECOND, [130.0], [30.0], [40.0])])  # fmt: skip
    assert table["verdict"].tolist() == ["★ best", "(one season: no interval)"]
    assert table["infested plant-days"].tolist() == ["100", "130"]


def test_of_one_season_no_interval_is_said():
    said = verdicts.sentence(
        [outcome(BEST, [100.0], found=(50.0,)), outcome(SECOND, [140.0], [40.0], found=(50.0,))]
    )
    assert said.startswith("One season so far: **Dynamic · 12 h · 40 s** is ahead of Naive")
    assert "interval" not in said


def test_the_table_says_by_how_much_in_percent_of_the_best():
    row = verdicts.table(ranked([40.0, 41.0, 42.0])).iloc[1]
    assert row["strategy"] == "Naive · 12 h · 40 s"
    assert row["verdict"].startswith("+37\u00a0% loss (+35 to +40)")
    assert row["inspected a day"] == "12.3\u00a0%"
    assert row["half found first on day"] == "7"


@pytest.mark.parametrize("found", [(99.0, 100.0, 98.0), (0.0, 1.0, 0.5)])
def test_an_interval_of_percent_stays_within_percent(found):
    (cell,) = verdicts.table([outcome(BEST, [1.0, 2.0, 3.0], found=found)])["found at the end"]
    low, high = cell.partition("(")[2].rstrip(")").split(" to ")
    assert 0 <= float(low) < float(high) <= 100


def test_each_further_robot_is_said_with_its_interval():
    losses = {1: [100.0, 110.0, 120.0], 2: [40.0, 52.0, 58.0], 3: [36.0, 48.0, 54.0]}
    gains = marginal_gains({k: np.array(values) for k, values in losses.items()})
    said = verdicts.robots_sentence(gains)
    assert said == (
        "A second robot would save 60 (55 to 65) infested plant-days; a third 4 (4 to 4)."
    )
    alone = verdicts.robots_sentence(gains[1:])
    assert alone == "3 robots instead of 2 would save 4 (4 to 4) infested plant-days."
    once = marginal_gains({1: np.array([5.0]), 2: np.array([3.0])})
    assert "no interval is known" in verdicts.robots_sentence(once)


def test_a_team_is_named_by_its_number():
    assert verdicts.name(Strategy("naive", 12.0, 40.0, 3)) == "3 × Naive · 12 h · 40 s"


def test_visits_days_apart_are_not_called_days():
    daily, apart = (
        verdicts.tables(ranked([1.0, 2.0, 3.0]), daily=daily) for daily in (True, False)
    )
    assert "inspected a day" in daily[1]
    assert "inspected a visit" in apart[1]
    assert [len(one.columns) for one in apart] == [len(one.columns) for one in daily]
