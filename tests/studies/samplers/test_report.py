"""The study of samplers as a page: every mean in its place, every name a text."""

import numpy as np
import pytest

from fieldmon.compute.wording import estimate
from fieldmon.studies.outcome_table import outcomes_from
from fieldmon.studies.samplers.calibration import Calibration, _percent
from fieldmon.studies.samplers.calibration import report_html as beliefs_html
from fieldmon.studies.samplers.contenders import NAMES
from fieldmon.studies.samplers.report import report_html
from fieldmon.studies.samplers.seasons import MEASURES, SeasonOutcome
from fieldmon.studies.samplers.summary import means, sentences
from tests.pages import HOSTILE, Page, held


def outcomes(scenarios, seeds=3):
    """Return outcomes of numbers that are all different."""
    values = iter(np.random.default_rng(5).uniform(1, 30_000, 10_000).round(3).tolist())
    return [
        SeasonOutcome(scenario, seed, who, *(next(values) for _ in MEASURES))
        for scenario in scenarios
        for seed in range(seeds)
        for who in NAMES
    ]


@pytest.fixture(scope="module")
def made():
    return outcomes(["A, spread 10%", "B, spread 30%"])


def test_every_mean_stands_under_its_measure_scenario_and_sampler(made):
    page = Page(report_html(made))
    assert len(page.tables) == len(MEASURES)
    for table, (_, scenarios) in zip(page.tables, means(made).items(), strict=True):
        heads, *rows = table
        assert heads == ["scenario", *NAMES]
        assert [row[0] for row in rows] == list(scenarios)
        for name, *shown in rows:
            assert shown == [estimate(scenarios[name][who]) for who in NAMES]


def test_what_was_found_is_said_in_sentences_over_a_chart_a_rival(made):
    page = Page(report_html(made))
    said = sentences(made)
    assert page.items[: len(said)] == said
    assert [item.split(":")[0] for item in page.items[len(said) :]] == list(NAMES)
    assert len(page.all("line", "even")) == len(page.all("svg"))
    rivals = len(page.all("svg"))
    assert rivals == 4
    assert len(page.all("circle")) == 2 * rivals  # a dot a scenario and chart
    assert "3 simulated seasons of 25 days a scenario" in page.text
    assert page.headings[0] == "Samplers compared"
    assert page.runs == page.asks_for == []


def test_names_of_scenarios_in_a_table_that_is_gone_on_with_are_texts():
    head = "cell,seed,who,infested_plant_days,d50,d80,inspected,found,visited_pct"
    quoted = ['"' + text.replace('"', '""') + '"' for text in HOSTILE]
    lines = [
        f'{scenario},{k},"{who}",1,2,3,4,5,6'
        for scenario in quoted
        for k in (0, 1)
        for who in NAMES
    ]
    text = "\n".join([head, *lines])
    page = held(report_html(outcomes_from(text, "samplers.csv", SeasonOutcome)))
    assert [row[0] for row in page.tables[0][1:]] == list(HOSTILE)


def a_calibration(seed):
    rng = np.random.default_rng(seed)
    said, was, count = rng.random(9), rng.random(9), rng.integers(10, 90, 9)
    clean = (rng.random(6), rng.random(6), np.array([0, 3, 0, 1, 2, 0]))
    return Calibration(said, was, count, *rng.random(6).tolist(), *clean, 0.0123, 6)


def test_every_score_of_a_belief_stands_in_its_row():
    made = {"pairs": a_calibration(1), "ensemble": a_calibration(2)}
    page = Page(beliefs_html(made, "B, for a test"))
    (_, *rows), *reliability = page.tables
    for (name, c), row in zip(made.items(), rows, strict=True):
        scores = [f"{c.brier:.5f}", f"{c.log_score:.4f}", f"{c.suspicious_log_score:.4f}"]
        held = [_percent(c.covered), _percent(c.half_covered)]
        assert row[: len(scores) + 1] == [name, *scores]
        assert set(held) <= set(row)
        assert row[-1] == "12"
    assert len(reliability) == len(made)
    assert "B, for a test" in page.text
    assert page.runs == page.asks_for == []


def test_a_chart_of_beliefs_shows_chances_that_came_up_often_enough():
    made = {"pairs": a_calibration(1)}
    plants, clean = Page(beliefs_html(made, "about")).all("polyline")[1::2]
    assert len(plants["points"].split()) == np.count_nonzero(made["pairs"].count >= 50)
    assert len(clean["points"].split()) == 3


def test_names_of_beliefs_are_texts():
    made = {text: a_calibration(k) for k, text in enumerate(HOSTILE)}
    page = held(beliefs_html(made, " ".join(HOSTILE)))
    assert [row[0] for row in page.tables[0][1:]] == list(HOSTILE)


def test_of_few_plants_it_says_how_many_were_so_and_of_few_seasons_that_shares_are_rough():
    c = a_calibration(1)
    c.said[:2], c.was[:2], c.count[:2] = (0.0006, 0.2753), (0.0, 2 / 7), (51_459, 7)
    _, reliability = Page(beliefs_html({"pairs": c}, "about", 2)).tables
    assert reliability[1:3] == [["0.06 %", "0 %", "51,459"], ["28 %", "2 of 7", "7"]]
    rough = [" 2 seasons these shares" in beliefs_html({"pairs": c}, "", k) for k in (2, 20)]
    assert rough == [True, False]


@pytest.mark.parametrize(
    ("share", "said"),
    [(0.0, "0 %"), (0.00061, "0.061 %"), (0.0149, "1.5 %"), (0.75, "75 %"), (float("nan"), "-")],
)
def test_shares_are_in_percent_with_two_digits(share, said):
    assert _percent(share) == said
