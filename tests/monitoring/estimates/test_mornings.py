"""Mornings: the same whether worked out from the first, from those at hand, or from the file's."""

import io
import shutil
import sqlite3
import zlib
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from datetime import timedelta
from threading import Barrier

import numpy as np
import pytest

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates import day_figures, figures_of_day
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.estimates.mornings import (
    Mornings,
    _arrays_in,
    _packed,
    _unpacked,
    causes_until,
)
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.plot.layout import rectangle
from tests.monitoring.seasons import BEGINS, a_season, a_small_plot, some_results

LAST = 11


def found_on(day, season):
    plants = np.arange(12, dtype=np.int32) * 7 % len(season.plot.grid) + day % 5
    found = (plants % 4 == day % 4).astype(np.int8)
    return Inspections.of(plants, found, np.datetime64(BEGINS + timedelta(days=day), "D"))


@pytest.fixture(scope="module")
def long_season(tmp_path_factory):
    """Give a season of a stretch and another begun, recorded day by day by one at work."""
    season = a_season(tmp_path_factory.mktemp("long") / "season.gpkg", a_small_plot())
    season.plan(BEGINS)
    season.record(some_results(season, n=12, found=[2, 3, 4]), "monday.csv", "Ann")
    for day in range(2, LAST + 1):
        season.record(found_on(day, season), f"day {day}")
    return season.path


@pytest.fixture
def path(long_season, tmp_path):
    return shutil.copy(long_season, tmp_path / "season.gpkg")


def all_over(season):
    """Return the mornings of a season, each worked out from the first."""
    history = season.history
    morning, mornings = history.first_morning, []
    for day in range(LAST + 2):
        mornings.append(morning)
        morning = history.night_after(morning, day)
    return mornings


@pytest.fixture(scope="module")
def from_the_first(long_season):
    """Return the mornings of that season, worked out once."""
    return all_over(Season(long_season))


def kept(path):
    with closing(sqlite3.connect(path)) as db:
        return [day for (day,) in db.execute("SELECT day FROM mornings ORDER BY day")]


def change(path, statement, *values):
    with closing(sqlite3.connect(path)) as db:
        db.execute(statement, values)
        db.commit()


def the_same(one, other):
    return np.array_equal(one.chance, other.chance) and np.array_equal(
        one.pair_chance, other.pair_chance
    )


def of_day(season, day):
    return season._now().morning(day)


def test_the_file_keeps_the_first_the_newest_two_and_the_last_two_of_every_eighth(path):
    assert kept(path) == [0, 8, LAST - 1, LAST]


def test_mornings_from_the_file_are_those_from_the_first_to_the_last_bit(path, from_the_first):
    season = Season(path)
    for day, morning in enumerate(from_the_first):
        assert the_same(of_day(season, day), morning), day


def test_a_command_begins_at_the_morning_that_the_file_keeps(path, monkeypatch):
    nights = []
    slept = History.night_after
    monkeypatch.setattr(
        History, "night_after", lambda self, m, day: nights.append(day) or slept(self, m, day)
    )
    Season(path).status(BEGINS + timedelta(days=LAST))
    Season(path).status(BEGINS + timedelta(days=LAST - 1))
    assert nights == []
    Season(path).status(BEGINS + timedelta(days=LAST - 2))
    assert min(nights) == 8


def test_what_is_recorded_of_an_early_day_reaches_the_mornings_after_it(path):
    season = Season(path)
    before = season.status(BEGINS + timedelta(days=LAST))
    season.record(
        Inspections.of(np.array([3]), np.array([1]), np.datetime64(BEGINS + timedelta(days=4), "D"))
    )
    anew = all_over(season)
    for day in (4, 5, 8, LAST, LAST + 1):  # the last of each stretch: all
        assert the_same(of_day(Season(path), day), anew[day]), day
    assert Season(path).status(BEGINS + timedelta(days=LAST)) != before
    assert Season(path).verify() == ()
    assert kept(path) == [0, 8, LAST - 1, LAST]


def test_a_treatment_taken_back_leaves_the_mornings_of_before(path):
    season = Season(path)
    before = of_day(season, LAST)
    season.treat(BEGINS + timedelta(days=6), 0.9)
    assert not the_same(of_day(Season(path), LAST), before)
    season.undo()
    assert the_same(of_day(Season(path), LAST), before)


def test_a_kept_morning_that_is_not_what_it_was_is_worked_out_again(path, from_the_first):
    """Nor is the one before it taken, which is damaged in another way."""
    damages = ("chances = X'00'", "content = 'none'", "causes = 'none'", "chances = X''")
    for damage, day in zip(damages, (LAST, LAST - 1, 8, 0), strict=True):
        change(path, f"UPDATE mornings SET {damage} WHERE day = ?", day)  # noqa: S608
    assert the_same(of_day(Season(path), LAST), from_the_first[LAST])
    assert Season(path)._now().mornings.last_until(LAST) == 0


def test_a_kept_morning_that_is_pressed_is_not_unpacked(path):
    season = Season(path)
    first, kept_one = season.history.first_morning, _packed(of_day(season, LAST))
    assert the_same(_unpacked(first, kept_one), of_day(season, LAST))
    plain = zlib.decompress(kept_one)
    assert _unpacked(first, zlib.compress(plain, 9)) is None
    file = io.BytesIO()
    np.savez_compressed(file, **_arrays_in(kept_one))
    assert _unpacked(first, zlib.compress(file.getvalue(), 0)) is None


def test_a_plan_that_is_kept_already_keeps_the_mornings_of_a_new_version(
    recorded, tmp_path, monkeypatch
):
    from fieldmon.monitoring.estimates import mornings

    path, last = shutil.copy(recorded, tmp_path / "season.gpkg"), 2
    on = BEGINS + timedelta(days=last)
    route = Season(path).plan(on).route
    was = path.read_bytes()
    Season(path).plan(on)
    assert path.read_bytes() == was
    monkeypatch.setattr(mornings, "rules", lambda: "of another version")
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        Season(path).plan(on)  # waits for nobody
    assert Season(path)._now().mornings.last_until(last) == 0
    np.testing.assert_array_equal(Season(path).plan(on).route.plant, route.plant)
    assert Season(path)._now().mornings.last_until(last) == last
    assert Season(path).verify() == ()


def test_another_program_version_does_not_believe_the_kept_ones(path, monkeypatch):
    from fieldmon.monitoring.estimates import mornings

    monkeypatch.setattr(mornings, "rules", lambda: "of another version")
    contents = Season(path)._now()
    assert contents.mornings.last_until(LAST) == 0


@pytest.mark.parametrize(
    "damage",
    [
        "UPDATE days SET expected_left = 1 WHERE causes NOT NULL",
        "UPDATE days SET low = 0",
        "UPDATE days SET causes = 'none'",
        "UPDATE days SET causes = NULL",
    ],
)
def test_a_kept_estimate_is_believed_only_as_it_was_kept(path, damage):
    on = BEGINS + timedelta(days=LAST)
    before = Season(path).status(on).estimate
    change(path, damage)
    assert Season(path).status(on).estimate == before


def test_the_last_estimate_is_not_drawn_again(path, monkeypatch):
    from fieldmon.monitoring.estimates import still_infested

    before, draw, drawn = (
        Season(path).status(BEGINS + timedelta(days=LAST)).estimate,
        still_infested.estimate_of,
        [],
    )
    monkeypatch.setattr(
        still_infested, "estimate_of", lambda *args: drawn.append(args) or draw(*args)
    )
    assert Season(path).status(BEGINS + timedelta(days=LAST)).estimate == before
    assert len(drawn) == 1, "that of the first evening"
    Season(path).status(BEGINS + timedelta(days=LAST - 1))
    assert len(drawn) == 3


def test_few_mornings_of_a_long_season_are_at_hand(path, from_the_first):
    season = Season(path)
    mornings = Mornings(season.history)
    mornings.of(LAST)
    assert len(mornings.known) <= 2 + LAST // 8 + 8
    assert the_same(mornings.of(3), from_the_first[3])


def test_who_inspected_matters_where_they_find_as_much_as_they_are_said_to(path):
    history = Season(path).history
    n = len(history.inspections)
    by = [
        replace(history, inspections=replace(history.inspections, who=np.full(n, name, object)))
        for name in ("Ann", "Ben")
    ]
    assert causes_until(by[0], LAST) == causes_until(by[1], LAST)
    team = [
        replace(one, detection=np.full(n, told)) for one, told in zip(by, (0.9, 0.5), strict=True)
    ]
    assert causes_until(team[0], LAST) != causes_until(team[1], LAST)


def test_a_morning_of_another_plot_is_not_taken():
    first = TracedPairs.of(rectangle(4, 5), np.full(20, 0.1))
    kept = _packed(first.learn(np.array([3], np.int32), np.array([True]), Learning(0.8)))
    assert the_same(_unpacked(first, kept), _unpacked(first, kept))
    # as many plants, and other pairs
    assert _unpacked(TracedPairs.of(rectangle(2, 10), np.full(20, 0.1)), kept) is None


@pytest.mark.parametrize("treated", [True, False])
def test_a_kept_morning_goes_on_as_the_one_that_was_worked_out(treated):
    """Also where finds are left infested."""
    first, night = TracedPairs.of(rectangle(4, 5), np.full(20, 0.1)), Spread(0.3)
    learning = Learning(0.8, treated=treated)

    def a_day_later(morning, plants):
        found = np.asarray(plants) % 2 == 0
        return morning.learn(np.array(plants, np.int32), found, learning).overnight(night)

    morning = a_day_later(first, [3, 4, 9])
    kept = _unpacked(first, _packed(morning))
    assert kept.ancestry.left.any() == (not treated)
    assert the_same(a_day_later(kept, [5, 8]), a_day_later(morning, [5, 8]))


def test_a_morning_is_named_by_all_that_it_follows_from_and_by_nothing_after_it(path):
    history, day = replace(Season(path).history, detection=0.84), 9
    own = causes_until(history, day)
    n = len(history.grid)
    assert own == causes_until(replace(history), day)
    assert own != causes_until(history, day - 1) != causes_until(history, day + 1)

    def treated(on, plants=5, efficacy=0.8):
        return replace(history, treatments=(Treatment(on, np.arange(n) < plants, efficacy),))

    def looked(on, **more):
        done = history.inspections
        late = Inspections.of(np.array([1]), np.array([0]), history.date_of(on))
        until, after = history.until(on), done.take(slice(len(history.until(on)), None))
        return replace(history, inspections=until.and_those(replace(late, **more)).and_those(after))

    def timed(treated_s, looked_s):
        done, plants = looked(8, second=np.array([looked_s])), np.arange(n) < 5
        return replace(done, treatments=(Treatment(8, plants, 0.8, treated_s),))

    first = history.first_morning
    another = np.append(first.chance[:-1], first.chance[-1] / 2)
    causes = [
        treated(8), treated(8, plants=6), treated(8, efficacy=0.7), treated(7), looked(8),
        timed(30_000.0, 30_001.0), timed(30_000.0, 29_999.0), timed(30_001.0, 29_999.0),
        looked(8, plant=np.array([2])),
        looked(8, result=np.array([2])),
        looked(8, result=np.array([2]), notes=np.array(["gone"], object)),
        looked(8, result=np.array([1])), looked(7),
        replace(history, detection=0.7),
        replace(history, belief=replace(history.belief, treated=False)),
        replace(history, belief=replace(history.belief, spread=Spread(0.3))),
        replace(history, first_morning=TracedPairs.of(history.grid, another)),
    ]  # fmt: skip
    names = [causes_until(one, day) for one in causes]
    assert len({own, *names}) == len(names) + 1
    for nothing in (treated(9), looked(9), looked(12), treated(20)):
        assert causes_until(nothing, day) == own


def test_mornings_are_forgotten_from_the_day_on_that_changed(path):
    season = Season(path)
    season.status(BEGINS + timedelta(days=LAST))
    mornings = Mornings(season.history)
    for day in (3, 6, LAST):
        mornings.of(day)
    after = mornings.after_change(season.history, 6)
    assert after.last_until(LAST) == 6
    assert {*after.known} == {day for day in mornings.known if day <= 6}
    assert mornings.last_until(8) == max(day for day in mornings.known if day <= 8)


@pytest.mark.parametrize("days_before", [0, 9])
def test_figures_that_another_version_kept_are_worked_out_anew(path, monkeypatch, days_before):
    on = BEGINS + timedelta(days=LAST - days_before)
    true = Season(path).status(on).estimate
    change(path, "UPDATE days SET low = 0, expected_left = 1")
    assert figures_of_day.day_figures(Season(path), on).expected == 1.0
    monkeypatch.setattr(figures_of_day, "rules", lambda: "of another version")
    now = figures_of_day.day_figures(Season(path), on)
    assert (now.expected, now.low, now.high) == (true.expected, true.low, true.high)


def test_of_a_change_the_days_before_it_stay_figures_of_the_version_before(path):
    with closing(sqlite3.connect(path)) as db, db:
        day_figures.note_rules(db, "before", 0)
        day_figures.note_rules(db, "now", 7)
        assert [day_figures.holds(db, "now", day) for day in (6, 7)] == [False, True]
        day_figures.note_rules(db, "now", 12)
        day_figures.note_rules(db, "now", 3)
        assert [day_figures.holds(db, "now", day) for day in (2, 3, 12)] == [False, True, True]
        assert not day_figures.holds(db, "before", 12)


def test_a_season_of_a_named_pest_keeps_its_mornings_until_its_weather_is_another(tmp_path):
    days = np.arange("2026-04-01", "2026-05-01", dtype="datetime64[D]").astype("datetime64[s]")
    warm, warmer = (
        weather_of(days, DAY_S, temperature_c=np.full(len(days), t), zone="Asia/Jerusalem")
        for t in (20.0, 26.0)
    )
    path = tmp_path / "s.gpkg"
    season = a_season(path, a_small_plot(), pest=shipped_pest("green-peach-aphid"), weather=warm)
    season.record_all([(found_on(day, season), f"day {day}") for day in range(12)])
    assert kept(path) == [0, 8, 10, 11]
    anew = all_over(season)
    assert anew[11].cohorts.ages
    for day in (8, 11, 12):
        again = of_day(Season(path), day)
        assert the_same(again, anew[day]), day
        assert again.cohorts.ages == anew[day].cohorts.ages
    assert Season(path).verify() == ()
    season.change(replace(season.settings, weather=warmer), season.settings)
    assert not the_same(of_day(Season(path), 11), anew[11])
    assert the_same(of_day(Season(path), 11), all_over(season)[11])


def test_an_estimate_that_the_file_keeps_tells_of_plants_found_and_left(tmp_path):
    season = a_season(tmp_path / "s.gpkg", a_small_plot(), belief=BeliefSettings(treated=False))
    for day in range(3):
        season.record(found_on(day, season), f"day {day}")
    on = BEGINS + timedelta(days=2)
    said, again = (one.status(on).estimate for one in (season, Season(season.path)))
    assert said.found > 0
    assert again == said


def test_who_asks_while_a_morning_is_worked_out_waits_for_it(season, monkeypatch):
    with season.reading() as now:
        contents = now.contents
    nights, night, both = [], History.night_after, Barrier(2)

    def counted(*given):
        nights.append(given[-1])
        return night(*given)

    def asked(day):
        both.wait()
        return contents.morning(day)

    monkeypatch.setattr(History, "night_after", counted)
    with ThreadPoolExecutor(2) as windows:
        one, other = windows.map(asked, (4, 4))
    assert one is other
    assert nights == [0, 1, 2, 3]
