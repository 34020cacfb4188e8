"""The comparison of teams as a page."""

from dataclasses import replace

from fieldmon.studies.teams.report import charts, of_sizes, report_html
from fieldmon.studies.teams.summary import rows
from tests.studies.teams.test_summary import outcomes


def test_the_report_draws_every_scenario_and_says_every_sentence():
    made = rows([*outcomes(), *outcomes(name="5 ha spread 30% to one ef01")], 25)
    page = report_html(made)
    assert page.count("<svg") == len(charts(made)) == 2
    assert page.count("A second robot would save") == 4
    assert ">nan" not in page


def test_sizes_are_drawn_by_the_hectares_a_robot_has():
    other = [
        replace(one, scenario="4 ha", hectares=4.0, infested_plant_days=90.0) for one in outcomes()
    ]
    (chart,) = of_sizes(rows([*outcomes(), *other], 25))
    assert "hectares a robot" in chart
    assert "10% a night" in chart
    assert of_sizes(rows(outcomes(), 25)) == []


def test_of_one_season_there_is_a_line_without_a_band():
    (chart,) = charts(rows(outcomes((1,)), 25))
    assert "nan" not in chart
