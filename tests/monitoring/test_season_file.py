"""A season on disk: what comes back is what went in, and every day follows from it."""

from dataclasses import fields, replace
from datetime import date, time, timedelta

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FileProblem, ObservationError, SettingError
from fieldmon.infestation.inspections import FOUND, SKIPPED, Inspections
from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from fieldmon.monitoring.history import BeliefSettings
from fieldmon.monitoring.transactions import Store
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SeasonSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.monitoring.seasons import (
    BEGINS,
    ROBOT,
    Insects,
    a_plot,
    a_season,
    some_records,
    some_results,
)


@pytest.fixture
def season(tmp_path):
    return a_season(tmp_path / "season.gpkg")


def on(day):
    return BEGINS + timedelta(days=day)


def test_a_season_comes_back_bit_for_bit(tmp_path):
    plot = a_plot(faces=2)
    records = some_records(plot)
    settings = MonitoringSettings(
        BEGINS,
        starts=time(5, 30),
        robot=ROBOT,
        sampler="snake",
        sampler_settings={"every": 2},
        seed=9,
    )
    said = KeptMessage(
        "mites.csv", "guessed", "row 3", "A date was read as day-month.", "--date-order"
    )
    Season.create(tmp_path / "s.gpkg", plot, records, settings, [said])
    again = Season(tmp_path / "s.gpkg")
    assert again.settings == settings
    assert again.messages() == (said,)
    for name in (each.name for each in fields(plot.grid)):
        value, other = getattr(plot.grid, name), getattr(again.plot.grid, name)
        same = np.array_equal(value, other) if isinstance(value, np.ndarray) else value == other
        assert same, name
    assert again.plot.field.boundary == plot.field.boundary
    assert again.plot.field.name == "מטע Paran"
    assert again.plot.field.gate == plot.field.gate
    assert np.array_equal(again.observations.lonlat, records.lonlat)
    assert np.array_equal(again.observations.day, records.day, equal_nan=True)
    assert np.array_equal(again.plot.aisles.travel.between_m, plot.aisles.travel.between_m)


def test_a_new_season_never_replaces_a_file(tmp_path):
    path = tmp_path / "season.gpkg"
    path.write_text("mine")
    with pytest.raises(FileProblem, match="never overwritten"):
        a_season(path)
    assert path.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", ["naive", "bouncy", "dynamic", "random"])
def test_ten_days_on_disk_are_ten_days_of_the_simulator(tmp_path, name):
    """The same insects, the same belief and the same stops, digit for digit."""
    season = a_season(tmp_path / "s.gpkg", sampler=name)
    settings, plot = season.settings, season.plot
    truth = Insects(season)
    start = Start(truth.infested, season.morning(BEGINS))
    simulator = SeasonSettings(n_days=10, spread=settings.belief.spread)
    simulated = simulated_days(
        plot.aisles, settings.robot, sampler(name), start, simulator, RandomStreams(settings.seed)
    )
    for day in simulated:
        today = Season(season.path)  # as on a new morning
        assert np.array_equal(today.morning(on(day.number)), day.chance)
        # re-planned after every find, as the simulator's sampler does within its day
        results = truth.look(day.number, day.work.plant)
        assert np.array_equal(results.result == FOUND, day.work.found)
        if not day.work.found.any():
            assert np.array_equal(today.plan(on(day.number)).route.plant, day.work.plant)
        today.record(results, "robot")
    assert len(season.history.inspections) > 200
    assert season.verify() == ()


def test_the_same_results_twice_change_nothing(season):
    results = some_results(season, found=[1])
    first = season.record(results, "monday.csv", "Ann")
    before = season.path.read_bytes()
    again = season.record(results, "monday.csv", "Ann")
    assert (first.new, first.known) == (5, 0)
    assert (again.new, again.known, again.batch) == (0, 5, None)
    assert len(season.history.inspections) == 5
    assert len(season.batches()) == 1
    assert len(season.path.read_bytes()) == len(before)


def test_what_was_not_inspected_stays_unknown(season):
    results = some_results(season)
    season.record(results, "half a day")
    states = season.history.states(0)
    assert (states[results.plant] == 0).all()
    assert (np.delete(states, results.plant) == -1).all()


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


def test_undoing_a_batch_gives_back_the_state_before_and_deletes_nothing(season):
    season.record(some_results(season), "first")
    before, plan_before = season.evening(BEGINS), season.plan(BEGINS, keep=False).route.plant
    season.record(some_results(season, found=[0, 2]), "second", "Ann")
    assert not np.array_equal(season.evening(BEGINS), before)
    assert "5 findings from second" in season.undo()
    assert np.array_equal(season.evening(BEGINS), before)
    assert np.array_equal(season.plan(BEGINS, keep=False).route.plant, plan_before)
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM inspections").fetchone() == (10,)
    assert [batch.undone for batch in season.batches()] == [True, False]


def test_what_was_undone_can_be_recorded_again(season):
    results = some_results(season, found=[3])
    season.record(results, "x")
    season.undo()
    assert season.record(results, "x").new == 5


def test_one_inspection_can_be_undone(season):
    results = some_results(season, found=[0])
    season.record(results, "x")
    with season.store.reading() as db:
        (fid,) = db.execute("SELECT fid FROM inspections WHERE result = 'found'").fetchone()
    assert "found" in season.undo(inspection=fid)
    assert len(season.history.inspections) == 4
    assert season.status(BEGINS).found == 0


def test_there_must_be_something_to_undo(season):
    with pytest.raises(SettingError, match="nothing"):
        season.undo()
    with pytest.raises(SettingError, match="inspection 7"):
        season.undo(inspection=7)


def test_planning_half_way_starts_where_the_robot_stands_with_the_hours_that_are_left(season):
    whole = season.plan(BEGINS)
    results = some_results(season, n=8)
    season.record(results, "the morning")
    rest = season.plan(BEGINS)
    assert rest.scene.at == results.plant[-1]
    gone_s = whole.route.arrive_s[7] + ROBOT.visit_s
    assert rest.scene.seconds_left == pytest.approx(ROBOT.day_s - gone_s, abs=1e-6)
    assert not np.isin(rest.route.plant, results.plant).any()
    later = season.plan(BEGINS, time(7, 15))
    assert later.scene.seconds_left == ROBOT.day_s - 75 * 60
    assert len(later.route) < len(rest.route)
    with season.store.reading() as db:
        kept = db.execute("SELECT day, revision, starts FROM routes ORDER BY fid").fetchall()
    assert [(day, revision) for day, revision, _ in kept] == [(0, 1), (0, 2), (0, 3)]
    assert kept[2][2] == "2026-04-06T07:15:00"


def test_the_time_of_the_last_result_is_the_time_of_day(season):
    results = some_results(season, n=3)
    timed = Inspections.of(
        results.plant, results.result, results.date[0], second=np.array([22000.0, 21700.0, 21900.0])
    )
    season.record(timed, "phone")
    rest = season.plan(BEGINS)
    assert rest.scene.at == results.plant[0]  # the one inspected last, not the one listed last
    assert rest.scene.seconds_left == ROBOT.day_s - 400.0


def test_a_plant_that_could_not_be_inspected_is_left_alone_today_and_comes_back(season):
    results = some_results(season, n=2)
    season.record(Inspections.of(results.plant[:1], np.array([0]), results.date[0]), "phone")
    before = season.evening(BEGINS)[results.plant[1]]
    season.record(Inspections.of(results.plant[1:], np.array([SKIPPED]), results.date[0]), "phone")
    assert season.evening(BEGINS)[results.plant[1]] == before
    assert season.history.states(0)[results.plant[1]] == -1
    assert results.plant[1] not in season.plan(BEGINS).route.plant
    assert season.history.last_inspected(0)[results.plant[1]] == -1


def test_planning_twice_keeps_one_route(season):
    one, other = season.plan(BEGINS), season.plan(BEGINS)
    assert np.array_equal(one.route.plant, other.route.plant)
    assert np.array_equal(season.kept_route(BEGINS), one.route.plant)
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM routes").fetchone() == (1,)


def test_nights_pass_on_days_on_which_nobody_works(season):
    season.record(some_results(season, found=[0]), "x")
    assert season.morning(on(5)).sum() > season.morning(on(1)).sum()


def test_a_spraying_lowers_the_chance_where_it_was(season):
    season.record(some_results(season, found=[0]), "x")
    before = season.evening(BEGINS)
    west = MultiPolygon([box(35.14, 30.35, 35.15041, 30.37)])
    season.treat(BEGINS, 0.8, west, "soap")
    after = season.evening(BEGINS)
    inside = season.plot.grid.lonlat()[:, 0] < 35.15041
    assert after[inside] == pytest.approx(np.maximum(before[inside] * 0.2, 1e-6))
    assert np.array_equal(after[~inside], before[~inside])
    assert season.treat(BEGINS, 0.8, west, "soap").new == 0
    season.undo()
    assert np.array_equal(season.evening(BEGINS), before)


@pytest.mark.parametrize(
    ("area", "efficacy", "says"),
    [(box(35.2, 30.3, 35.3, 30.4), 0.5, "holds none"), (box(35, 30, 36, 31), 1.5, "efficacy")],
)
def test_an_impossible_spraying_is_a_sentence(season, area, efficacy, says):
    with pytest.raises(SettingError, match=says):
        season.treat(BEGINS, efficacy, MultiPolygon([area]))
    assert season.batches() == ()


def test_finds_that_are_only_flagged_stay_infested(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    results = some_results(season, found=[0])
    season.record(results, "x")
    assert season.evening(BEGINS)[results.plant[0]] > 0.99
    status = season.status(BEGINS)
    assert status.found == 1
    assert status.estimate.expected < season.evening(BEGINS).sum() - 0.9  # found is not out there


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


def test_settings_can_be_changed_and_the_old_ones_stay_in_the_file(season):
    seen = season.settings
    season.record(some_results(season), "x")
    season.change(MonitoringSettings(BEGINS, robot=ROBOT.with_hours(2.0), sampler="naive"), seen)
    assert Season(season.path).settings.sampler == "naive"
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM settings WHERE name = 'robot'").fetchone() == (2,)
    with pytest.raises(FileProblem, match="another window"):
        season.change(MonitoringSettings(BEGINS, sampler="bouncy"), seen)
    assert season.settings.sampler == "naive"


def test_changes_are_taken_back_one_after_the_other_and_nothing_is_deleted(season):
    begun = season.settings
    assert season.before_change() is None
    with pytest.raises(SettingError, match="there is none"):
        season.undo_change()
    first = replace(begun, robot=begun.robot.with_hours(2.0))
    second = replace(first, sampler="naive", robot=begun.robot.with_hours(3.0))
    season.record(some_results(season), "x")
    tomorrow = BEGINS + timedelta(days=1)
    planned = season.plan(tomorrow, keep=False).route.plant.tolist()
    season.change(first, begun)
    season.change(second, first)
    assert season.before_change() == first
    assert season.undo_change() == first
    assert Season(season.path).settings == first
    assert season.undo_change() == begun
    assert season.plan(tomorrow, keep=False).route.plant.tolist() == planned
    with pytest.raises(SettingError, match="there is none"):
        season.undo_change()
    season.change(second, begun)
    season.change(begun, second)  # back by hand
    assert season.before_change() is None
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM settings WHERE name = 'robot'").fetchone() == (7,)


def test_a_treatment_is_undone(season):
    before = season.evening(BEGINS)
    season.treat(BEGINS, 0.5)
    assert season.evening(BEGINS) == pytest.approx(before / 2)
    season.undo()
    assert np.array_equal(season.evening(BEGINS), before)
    assert [(batch.kind, batch.undone) for batch in season.batches()] == [("treatment", True)]


@pytest.mark.parametrize(
    ("plant", "result", "day", "columns", "says"),
    [
        (99_999, 0, "2026-04-06", {}, "from another plot"),
        (-1, 0, "2026-04-06", {}, "from another plot"),
        (3, 7, "2026-04-06", {}, "clean, found, skipped"),
        (3, 0, "NaT", {}, "must have a date"),
        (3, 0, "2026-04-05", {}, "began on 2026-04-06"),
        (3, 0, "2036-04-05", {}, "lasts"),
        (3, 0, "2026-04-06", {"count": np.array([-2.0])}, "0 or more"),
        (3, 0, "2026-04-06", {"second": np.array([90_000.0])}, "within its day"),
        (3, 0, "2026-04-06", {"count": np.array([1.0, 2.0])}, "must have 1 entries"),
    ],
)
def test_results_that_do_not_fit_are_a_sentence_and_leave_no_trace(
    season, plant, result, day, columns, says
):
    with pytest.raises((ObservationError, SettingError), match=says):
        season.record(
            Inspections.of(np.array([plant]), np.array([result]), np.datetime64(day), **columns),
            "x",
        )
    assert season.batches() == ()
    assert len(season.history.inspections) == 0


def test_two_windows_see_each_others_work(season):
    other = Season(season.path)
    other.record(some_results(other, found=[0]), "other")
    assert season.status(BEGINS).found == 1
    season.record(some_results(season), "mine")
    assert len(other.history.inspections) == 10


def test_a_map_made_otherwise_is_noticed(season):
    season.record(some_results(season), "x")
    assert season.verify() == ()
    with season.store.writing() as db:
        db.execute("UPDATE days SET digest = 'other'")
    assert len(season.verify()) == 1


def test_a_date_of_no_season_is_a_sentence(season):
    with pytest.raises(SettingError, match="began on 2026-04-06"):
        season.plan(date(2026, 4, 1))


def test_findings_that_come_late_change_every_day_after_them(season):
    for day in (0, 2, 4):
        season.record(some_results(season, day=day), f"day {day}")
    late = some_results(season, n=3, day=1, found=[0])
    season.record(late, "found in a drawer")
    assert season.verify() == ()
    with season.store.reading() as db:
        rows = db.execute("SELECT day, inspected, found FROM days ORDER BY day").fetchall()
    assert rows == [(0, 5, 0), (1, 3, 1), (2, 5, 0), (4, 5, 0)]


@pytest.mark.parametrize(
    "asked",
    [
        lambda season, on: season.advice(on),
        lambda season, _: season.assumed(),
        lambda season, on: season.cautions(on),
        lambda season, on: season.contradicting(on),
        lambda season, on: season.effects(on),
        lambda season, on: season.forecast(on),
        lambda season, on: season.harvest_from(on),
        lambda season, on: season.kept_route(on),
        lambda season, _: season.last_date(),
        lambda season, on: season.learnt(on),
        lambda season, _: season.other_maps(),
        lambda season, on: season.progress(on),
        lambda season, on: season.scene(on),
        lambda season, on: season.status(on),
        lambda season, on: season.verdict(on, 0.1),
    ],
)
def test_what_a_season_answers_is_of_one_moment_others_may_write_between_two(
    recorded, monkeypatch, asked
):
    season, moments = Season(recorded), []
    reading = Store.reading
    monkeypatch.setattr(Store, "reading", lambda self: moments.append(self) or reading(self))
    asked(season, BEGINS)
    assert len(moments) == 1
