"""What a season knows follows from what was recorded."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.figures_of_day import flagged
from fieldmon.monitoring.estimates.what_was_told import earlier_season_note
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.pests.weather import weather_of
from fieldmon.planning.skips import left_out_in_words
from tests.monitoring.seasons import BEGINS, a_season, clock_on, on, some_results


def test_a_find_raises_its_neighbours_and_a_clean_look_lowers(season):
    grid, find, clean = season.plot.grid, 100, 300
    (start, plant), on_day = grid.adjacent, np.datetime64(BEGINS, "D")
    beside_find, beside_clean = (plant[start[one] : start[one + 1]] for one in (find, clean))
    before = season.evening(BEGINS)
    season.record(Inspections.of(np.array([clean]), np.array([0]), on_day), "first")
    between = season.evening(BEGINS)
    assert between[clean] < before[clean]
    assert (between[beside_clean] <= before[beside_clean]).all()
    season.record(Inspections.of(np.array([find]), np.array([FOUND]), on_day), "second")
    after = season.evening(BEGINS)
    assert (after[beside_find] > 2 * between[beside_find]).all()
    assert after[find] < 1e-3  # treated


def test_the_evening_and_the_next_morning_tell_the_same_of_many_finds(season):
    """As many are found as nobody expected, and then nothing is inspected."""
    season.record(some_results(season, n=60, found=range(0, 60, 2)), "x")
    evening, next_evening, after = (season.status(on(day)) for day in range(3))
    assert next_evening.estimate.expected == pytest.approx(evening.estimate.expected, rel=0.2)
    assert after.estimate.expected == pytest.approx(next_evening.estimate.expected, rel=0.35)
    assert season.evening(on(0)).sum() == pytest.approx(evening.estimate.expected)
    ahead = season.forecast(on(0))
    assert ahead.expected[0] == evening.estimate.expected
    assert (ahead.low[0], ahead.high[0]) == (evening.estimate.low, evening.estimate.high)
    start = [
        {one.name: one for one in told.learnt}["infested at the start"]
        for told in (evening, next_evening)
    ]
    assert start[0].value == pytest.approx(start[1].value, rel=0.1)
    # what was found on the first day was there
    assert start[0].low >= 30


def _infested_at_start(season, day):
    return {one.name: one for one in season.learnt(on(day))}["infested at the start"]


def _ever_infested(season, day):
    now = season.status(on(day))
    return [now.found + n for n in (now.estimate.expected, now.estimate.low, now.estimate.high)]


@pytest.mark.parametrize("treated", [True, False], ids=["treated", "flagged"])
def test_on_the_first_day_those_at_the_start_are_those_found_and_those_left(tmp_path, treated):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=treated))
    season.record(some_results(season, n=100, found=range(0, 90, 10)), "x")
    start = _infested_at_start(season, 0)
    assert (start.value, start.low, start.high) == tuple(_ever_infested(season, 0))
    assert ("infested at the start", *_ever_infested(season, 0)) in _learnt_in_the_file(season)


def _learnt_in_the_file(season):
    with season.store.reading() as db:
        return db.execute("SELECT name, value, low, high FROM learnt").fetchall()


def test_what_a_treatment_ended_was_infested_at_the_start_all_the_same(season):
    season.record(some_results(season, n=100, found=range(9)), "x")
    before = _infested_at_start(season, 0)
    season.treat(on(0), 1.0)
    assert _infested_at_start(season, 0).value > 0.9 * before.value > _ever_infested(season, 0)[0]


def test_days_on_which_nobody_inspects_come_as_the_forecast_had_them(season):
    season.record(some_results(season, n=60, found=list(range(30))), "x")
    season.record(some_results(season, n=20, day=1, found=[3]), "y")
    ahead = season.forecast(on(1))
    came = [season.status(on(1 + night)).estimate for night in range(15)]
    assert [one.expected for one in came] == pytest.approx(ahead.expected, rel=1e-3)
    # and as doubtful, to a plant or two
    assert [one.low for one in came] == pytest.approx(ahead.low, abs=1)
    assert [one.high for one in came] == pytest.approx(ahead.high, rel=0.03, abs=1)
    assert np.all(np.diff([one.low for one in came]) >= 0)
    wide = ahead.high / np.maximum(ahead.low, 1.0)
    assert np.all(np.diff(ahead.expected) > 0.0)
    # the upper end comes near all there are
    assert np.all(wide[1:] >= 0.85 * wide[0])


def test_after_months_the_number_is_as_doubtful_as_tomorrows(season):
    season.record(some_results(season, n=60, found=list(range(30))), "x")
    day = on(120)
    now, ahead = season.status(day).estimate, season.forecast(day)
    assert now.expected > 0.7 * len(season.plot.grid)
    assert ahead.low[1] == pytest.approx(now.low, rel=0.25)
    assert now.low < 0.5 * now.expected


def test_until_something_is_inspected_no_day_tells_more_of_the_start(season):
    def start(day):
        return {one.name: one for one in season.learnt(on(day))}["infested at the start"]

    first, now = start(0), season.status(on(0)).estimate
    assert (first.value, first.low, first.high) == (now.expected, now.low, now.high)
    assert [start(day) for day in (3, 12)] == [first, first]
    season.record(some_results(season, n=20, day=12, found=[3]), "x")
    assert start(12) != first


def test_of_the_first_morning_a_day_without_results_says_what_the_evening_before_it_said(season):
    season.record(some_results(season, n=100, found=range(0, 90, 10)), "x")
    first = _infested_at_start(season, 0)
    assert _infested_at_start(season, 4) == first
    skipped = Inspections.of([200], [SKIPPED], np.datetime64(on(4)))
    season.record(skipped, "y")
    assert _infested_at_start(season, 4) == first
    season.record(Inspections.of([201], [CLEAN], np.datetime64(on(4))), "z")
    now = _infested_at_start(season, 4)
    assert now != first
    ends = [(one.value, one.low, one.high) for one in (now, first)]
    assert ends[0] == pytest.approx(ends[1], rel=0.02), "one plant of 101"


def test_a_forecast_of_a_past_day_says_which_weather_was_measured(tmp_path):
    days = np.arange(12) * 86_400 + np.datetime64(BEGINS, "s")
    warm, later = np.full(12, 20.0), np.arange(12) >= 9
    weather = weather_of(days, 86_400, temperature_c=warm, forecast=later)
    season = a_season(tmp_path / "s.gpkg", pest=shipped_pest("spider-mite"), weather=weather)
    said = "by the weather measured for 8 nights and forecast for 3 nights, then the usual"
    assert season.forecast(on(1)).basis() == said


def test_finds_that_are_only_flagged_stay_infested(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    results = some_results(season, found=[0])
    season.record(results, "x")
    assert season.evening(BEGINS)[results.plant[0]] > 0.99
    status = season.status(BEGINS)
    assert status.found == 1
    assert status.estimate.expected < season.evening(BEGINS).sum() - 0.9  # found is not out there
    assert status.flagged == flagged(season, BEGINS) > 0.99
    now = season.forecast(BEGINS).expected[0]
    assert status.estimate.expected + status.flagged == pytest.approx(now)


def test_what_was_found_and_flagged_is_left_out_of_plans_until_it_may_be_clean(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    results = some_results(season, n=30, found=range(20))
    season.record(results, "x")
    found, grid = results.plant[:20], season.plot.grid
    tomorrow = season.plan(on(1))
    assert not set(found.tolist()) & set(tomorrow.route.plant.tolist())
    (said,) = left_out_in_words(tomorrow.scene, tomorrow.route)
    assert said == "Left out of this plan: 20 plants found and only flagged."
    season.treat(on(1), 0.7, plants=np.isin(np.arange(len(grid)), found[:15]))
    assert np.flatnonzero(season.scene(on(2)).flagged).tolist() == sorted(found[15:].tolist())


def test_the_status_counts(season):
    season.record(some_results(season, n=6, found=[0, 1]), "x")
    season.record(some_results(season, n=4, day=2), "y")
    status = season.status(on(2))
    assert (status.day, status.inspected_today, status.found_today) == (2, 4, 0)
    assert status.found == 2
    assert status.plants == len(season.plot.grid)
    assert status.estimate.low <= status.estimate.expected <= status.estimate.high
    assert status.detection_pct == pytest.approx(100 * 2 / (2 + status.estimate.expected))
    rows = season.plot.grid.row
    done = season.history.inspections
    assert status.days_since[rows[done.plant[-1]]] == 0
    assert np.isnan(status.days_since).sum() == season.plot.grid.n_rows - len(
        set(rows[done.plant].tolist())
    )


def test_advice_is_asked_with_settings_or_a_sentence(season):
    with pytest.raises(SettingError, match=r"must be AdviceSettings, but it is 0\.05"):
        season.advice(BEGINS, 0.05)


def test_a_season_begins_with_what_an_earlier_one_learnt_and_keeps_it(tmp_path, monkeypatch):
    last = a_season(tmp_path / "last.gpkg")
    last.record(some_results(last, n=40, found=range(12)), "x")
    clock_on(monkeypatch, 0)
    last.plan(on(2))  # only ahead
    earlier = last.as_earlier()
    with pytest.raises(SettingError, match=f"begins on {BEGINS}, but that on .* until {BEGINS}"):
        a_season(tmp_path / "s.gpkg", belief=BeliefSettings(earlier=earlier))
    assert not (tmp_path / "s.gpkg").exists()
    earlier = replace(earlier, until=on(-1))
    alone = a_season(tmp_path / "alone.gpkg")
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(earlier=earlier))
    again = Season(season.path)
    assert again.settings.belief.earlier == earlier
    assert earlier_season_note(again) == earlier.sentence(earlier.believed)
    assert earlier_season_note(alone) is None
    assert np.array_equal(season.morning(BEGINS), alone.morning(BEGINS))  # the same plants
    told, other = ({each.name: each.value for each in one.learnt(BEGINS)} for one in (again, alone))
    assert told["jumps beyond neighbours"] != other["jumps beyond neighbours"]
    season.record(some_results(season, n=20, found=[0]), "y")
    assert Season(season.path).verify() == ()


def test_a_season_in_which_nothing_was_inspected_or_traced_teaches_nothing(tmp_path):
    unseen = a_season(tmp_path / "unseen.gpkg")
    with pytest.raises(SettingError, match=r"unseen\.gpkg nothing was inspected"):
        unseen.as_earlier()
    near = a_season(tmp_path / "near.gpkg", belief=BeliefSettings(traces=False))
    near.record(some_results(near, n=4), "x")
    with pytest.raises(SettingError, match="traced to neighbours only"):
        near.as_earlier()


@pytest.mark.parametrize(
    "given",
    [
        lambda season: season.morning(BEGINS),
        lambda season: season.evening(BEGINS),
        lambda season: season.scene(BEGINS).chance,
        lambda season: season.scene(BEGINS).pair_chance,
    ],
)
def test_who_changes_chances_that_were_given_changes_nothing_for_others(season, given):
    planned = season.plan(BEGINS, keep=False).route.plant
    given(season)[:] = 0.0
    assert season.plan(BEGINS, keep=False).route.plant.tolist() == planned.tolist()
    assert season.evening(BEGINS).max() > 0.0


def test_nobody_changes_the_chances_of_a_plan(season):
    with pytest.raises(ValueError, match="read-only"):
        season.plan(BEGINS, keep=False).chance[:] = 0.0


def test_a_day_is_planned_by_the_map_that_is_told_of_it(season):
    season.record(some_results(season, n=20, found=[3]), "x")
    route = season.plan(BEGINS, keep=False).route
    told = season.evening(BEGINS)
    assert route.expected_visible == pytest.approx(told[route.plant].sum())  # nothing hides there
    assert route.expected_visible < told.sum()
