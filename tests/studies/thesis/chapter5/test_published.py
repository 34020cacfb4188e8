"""The figures that the text of chapter 5 gives, as kept, and what each is measured on."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SCENARIOS, SIZES_HA
from fieldmon.studies.thesis.chapter5.published import (
    FIGURES,
    MEASURES,
    PARTS,
    Case,
    cases_of,
)

BY_NAME = {(figure.part, figure.what): figure for figure in FIGURES}


def season(hectares=1.0, **more):
    """Return the runs of two seeds over four days, as far as a measure asks."""
    detection = np.array([[10.0, 50.0, 90.0, 100.0], [20.0, 40.0, 60.0, 80.0]]) / hectares
    days = {50.0: np.array([2.0, 3.0]), 80.0: np.array([3.0, 4.0]), 100.0: np.array([4.0, 5.0])}
    return SimpleNamespace(
        detection_pct=detection,
        end_pct=detection[:, -1],
        visited_a_day_pct=np.array([60.0, 61.0]),
        first_day=days.__getitem__,
        days_to=lambda level: days[level] * hectares,
        trial=SimpleNamespace(hectares=hectares),
        **more,
    )


@pytest.mark.parametrize(
    ("part", "what", "value"),
    [
        ("A", "Naive: visited a day, %", 67),
        ("A", "Dynamic: visited a day, %", 53),
        ("A", "Bouncy: day on which 100 % are found", 4),
        ("B", "Dynamic: detection at the end, %", 84),
        ("C", "Bouncy: detection at the end, %", 22),
        ("time", "40 s: detection on day 1, %", 32),
        ("detection", "40 %: detection at the end, %", 75),
        ("C", "abstract: Dynamic: detection at the end, 10 ha, %", 80),
    ],
)
def test_figures_are_those_of_the_text(part, what, value):
    figure = BY_NAME[part, what]
    assert (figure.value, figure.kind) == (value, "is")


def test_every_figure_is_there_once_in_a_part_that_is_played():
    assert len(BY_NAME) == len(FIGURES) == 49
    assert {figure.part for figure in FIGURES} == set(PARTS)
    assert {figure.kind for figure in FIGURES} == {"is", "least", "above"}


def test_a_figure_of_a_part_is_measured_on_seasons_that_the_part_plays():
    for figure in FIGURES:
        assert set(figure.cases) <= set(cases_of(figure.part)), figure.what
        trials = [case.trial(CALIBRATED) for case in figure.cases]
        assert len(trials) == len(figure.cases) >= 1


def test_orderings_and_the_abstract_are_looked_at_and_not_fitted():
    for figure in FIGURES:
        if figure.kind == "above" or figure.what.startswith("abstract"):
            assert not figure.fitted
    assert sum(figure.fitted for figure in FIGURES) == 27
    days = [figure for figure in FIGURES if figure.fitted and figure.step == 1.0]
    assert [figure.value for figure in days] == [2, 2, 4]
    assert all(figure.step in {1.0, 5.0} for figure in FIGURES)


def test_columns_with_several_values_are_several_seasons():
    fall = BY_NAME["size", "The fall between 7 and 14 ha is steeper than beyond, points a ha"]
    assert fall.cases == tuple(Case("dynamic", ha) for ha in (7.0, 14.0, 14.0, 20.0))
    least = BY_NAME["time", "least detection at the end at any time, %"]
    assert least.cases == tuple(Case("dynamic", 6.0, s) for s in (20.0, 25.0, 30.0, 35.0, 40.0))
    sure = BY_NAME["detection", "90 less 40 %: detection at the end, points"]
    assert sure.cases == tuple(Case("dynamic", 5.0, detection=rate) for rate in (0.9, 0.4))
    other = BY_NAME["B", "Naive finds more than bouncy by the end, points"]
    assert other.cases == (Case("naive", 5.0), Case("bouncy", 5.0))


def test_detection_is_said_to_fall_from_every_size_to_the_next():
    steps = [f for f in FIGURES if f.part == "size" and f.what.startswith("Dynamic finds more on")]
    pairs = [tuple(case.hectares for case in figure.cases) for figure in steps]
    assert pairs == list(pairwise(SIZES_HA))


def test_scenarios_have_the_thesis_s_sizes():
    sizes = {}
    for figure in FIGURES:
        sizes.setdefault(figure.part, set()).update(case.hectares for case in figure.cases)
    assert {part: sizes[part] for part in SCENARIOS} == {k: {v} for k, v in SCENARIOS.items()}


@pytest.mark.parametrize(
    ("name", "seasons", "values"),
    [
        ("end", [season()], [100, 80]),
        ("visited_a_day", [season()], [60, 61]),
        ("cleared", [season()], [4, 5]),
        ("day_1", [season()], [10, 20]),
        ("end_less", [season(), season(2.0)], [50, 40]),
        ("day_1_less", [season(), season(2.0)], [5, 10]),
        ("first_3_days_less", [season(), season(2.0)], [25, 20]),
        ("sooner_50", [season(), season(2.0)], [2, 3]),
        ("sooner_80", [season(), season(2.0)], [3, 4]),
        ("sooner_100", [season(), season(2.0)], [4, 5]),
        ("best_end", [season(2.0), season(), season(4.0)], [100, 80]),
        ("worst_end", [season(2.0), season(4.0), season()], [25, 20]),
        # 100 to 50 over 1 ha, then 25 to 12.5 over 4 ha; the other seed likewise
        ("fall", [season(1.0), season(2.0), season(4.0), season(8.0)], [46.875, 37.5]),
    ],
)
def test_a_measure_goes_seed_by_seed(name, seasons, values):
    np.testing.assert_allclose(MEASURES[name](*seasons), values)


def test_every_measure_is_asked_for():
    assert {figure.measure for figure in FIGURES} == set(MEASURES.values())
