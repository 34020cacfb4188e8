"""The study of verdicts: what each contender answers, and the sums."""

import pytest

from fieldmon.decisions.sequential import WaldPlan
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.pests.pest import Pest
from fieldmon.studies.verdicts import until_verdict
from fieldmon.studies.verdicts.until_verdict import (
    CONTENDERS,
    DECIDE,
    W_FIXED,
    Question,
    answers,
    fixed_inspections,
    summaries,
)


@pytest.fixture(scope="module")
def answered():
    question = Question("clusters")
    return [one for seed in range(3) for one in answers(question, seed)]


def test_every_contender_answers_and_the_same_seed_gives_the_same(answered):
    assert [one.contender for one in answered[: len(CONTENDERS)]] == list(
        dict.fromkeys(one.contender for one in answered)
    )
    assert {one.contender for one in answered} == set(CONTENDERS)
    assert answers(Question("clusters"), 1) == [one for one in answered if one.seed == 1]


def test_a_verdict_is_right_where_the_truth_is_on_its_side(monkeypatch):
    verdicts = ("treat", "do not treat", "inspect more")
    monkeypatch.setattr(
        until_verdict, "_ANSWERS", {one: lambda *_, one=one: (one, 1) for one in verdicts}
    )
    told = [answers(Question("clusters"), seed) for seed in range(6)]
    treating_pays = [each[0].share >= 1.0 for each in told]
    assert {*treating_pays} == {True, False}
    for each, pays in zip(told, treating_pays, strict=True):
        assert [one.right for one in each] == [pays, not pays, False]


def test_the_whole_w_is_as_long_as_its_two_levels_need(answered):
    """By the normal law: (z (s1 + s2) / (p2 - p1))^2."""
    assert fixed_inspections(WaldPlan(0.025, 0.1)) == 61
    assert {one.looks for one in answered if one.contender == W_FIXED} == {74.0}


def test_sums_are_means_over_seeds_and_over_the_whole_w(answered):
    of = {one.contender: one for one in summaries(answered)}
    assert of[W_FIXED].of_w == 1.0
    mine = [one.looks for one in answered if one.contender == DECIDE]
    assert of[DECIDE].looks == pytest.approx(sum(mine) / 3)
    with pytest.raises(SettingError, match="an outcome or more"):
        summaries([])


def test_a_pest_is_asked_about_as_it_is_seen(answered):
    """One seen as by the thesis's table changes no answer; a whole W is longer for a shy one."""
    alike = answers(Question("clusters", pest_in_weather=PestInWeather(Pest("alike"))), 1)
    assert [(a.looks, a.verdict) for a in alike] == [
        (a.looks, a.verdict) for a in answered if a.seed == 1
    ]
    (shy, *_) = answers(
        Question("clusters", pest_in_weather=PestInWeather(Pest("shy", detection=0.3))), 1
    )
    assert "shy" in shy.question
    assert shy.contender == alike[0].contender == W_FIXED
    assert shy.looks > alike[0].looks
