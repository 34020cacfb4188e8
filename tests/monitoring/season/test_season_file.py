"""A season on disk: what comes back is what went in, and every day follows from it."""

from dataclasses import fields, replace
from datetime import time, timedelta

import numpy as np
import pandas as pd
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FieldmonError, FileProblem, SettingError
from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.monitoring import Application, KeptMessage, MonitoringSettings, Season
from fieldmon.monitoring.changes.earlier_settings import before_change
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.estimates.figures_of_day import progress
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.estimates.verifying import changed_maps
from fieldmon.monitoring.settings import settings_log
from fieldmon.pests.pest import Pest
from fieldmon.planning.members import TeamMember
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.monitoring.seasons import (
    BEGINS,
    ROBOT,
    Insects,
    a_plot,
    a_season,
    a_small_plot,
    on,
    some_records,
    some_results,
)


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
    assert np.array_equal(again.records.lonlat, records.lonlat)
    assert np.array_equal(again.records.day, records.day, equal_nan=True)
    assert np.array_equal(again.plot.aisles.travel.between_m, plot.aisles.travel.between_m)


def test_a_new_season_never_replaces_a_file(tmp_path):
    path = tmp_path / "season.gpkg"
    path.write_text("mine")
    with pytest.raises(FileProblem, match="never overwritten"):
        a_season(path)
    assert path.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", ["naive", "dynamic", "random"])
def test_days_on_disk_are_days_of_the_simulator(tmp_path, name):
    """The same insects, the same belief and the same stops, digit for digit."""
    robot = ROBOT.with_hours(0.8)
    season = a_season(tmp_path / "s.gpkg", a_small_plot(), sampler=name, robot=robot)
    settings, plot = season.settings, season.plot
    truth = Insects(season)
    start = Start(truth.infested, season.morning(BEGINS))
    simulator = SimulationSettings(n_days=3, spread=settings.belief.spread)
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
    assert len(season.history.inspections) > 60
    assert season.verify() == ()


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
    assert before_change(season) is None
    with pytest.raises(SettingError, match="there is none"):
        season.undo_change()
    first = replace(begun, robot=begun.robot.with_hours(2.0))
    second = replace(first, sampler="naive", robot=begun.robot.with_hours(3.0))
    season.record(some_results(season), "x")
    tomorrow = BEGINS + timedelta(days=1)
    planned = season.plan(tomorrow, keep=False).route.plant.tolist()
    season.change(first, begun)
    season.change(second, first)
    assert before_change(season) == first
    assert season.undo_change() == first
    assert Season(season.path).settings == first
    assert season.undo_change() == begun
    assert season.plan(tomorrow, keep=False).route.plant.tolist() == planned
    with pytest.raises(SettingError, match="there is none"):
        season.undo_change()
    season.change(second, begun)
    season.change(begun, second)  # back by hand: a change, too
    assert before_change(season) == second
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM settings WHERE name = 'robot'").fetchone() == (7,)


def test_a_map_made_otherwise_is_noticed(season):
    season.record(some_results(season), "x")
    assert season.verify() == ()
    with season.store.writing() as db:
        db.execute("UPDATE days SET digest = 'other'")
    assert len(season.verify()) == 1


def test_who_holds_mornings_to_their_digests_says_how_many_are_done(path):
    season, told = Season(path), []
    season.plan(BEGINS + timedelta(days=2))
    changed_maps(season, tell=lambda *done: told.append(done))
    with season.store.reading() as db:
        (n,) = db.execute("SELECT count(*) FROM days").fetchone()
    assert told == [(day, n) for day in range(1, n + 1)]
    assert n > 1


@pytest.mark.parametrize(
    "asked",
    [
        lambda season, on: season.advice(on),
        lambda season, _: season.assumed(),
        lambda season, on: season.cautions(on),
        lambda season, on: season.numbered(on),
        lambda season, on: season.effects(on),
        lambda season, on: season.forecast(on),
        lambda season, on: season.harvest_from(on),
        lambda season, on: season.kept_route(on),
        lambda season, _: last_date(season),
        lambda season, on: season.learnt(on),
        lambda season, _: changed_maps(season),
        progress,
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


@pytest.mark.parametrize("wrong", [
    {"plot": "vineyard.kml"}, {"plot": None}, {"records": [(35.15, 30.36)]},
    {"settings": {"begins": BEGINS}}, {"settings": None, "colour": "green"},
    {"settings": None, "begins": "tomorrow"}, {"robot": Robot(hours=7)},
])  # fmt: skip
def test_what_is_no_plot_no_records_or_no_settings_is_refused_and_nothing_is_written(
    tmp_path, wrong
):
    given = {"plot": a_plot(), "records": None, "settings": MonitoringSettings(BEGINS)}
    with pytest.raises(FieldmonError):
        Season.create(tmp_path / "season.gpkg", **(given | wrong))
    assert list(tmp_path.iterdir()) == []


def test_a_season_begins_today_on_the_plot_without_records_unless_told_otherwise(tmp_path):
    plot = a_plot()
    before = local_clock(plot.field).today()
    season = Season.create(tmp_path / "a.gpkg", plot, sampler="naive")
    assert season.settings.begins in (before, local_clock(plot.field).today())
    assert season.settings.sampler == "naive"
    other = Season.create(tmp_path / "b.gpkg", plot, Records.none(), season.settings)
    today = season.settings.begins
    assert np.array_equal(season.morning(today), other.morning(today))
    risk = np.full(len(plot.grid), 0.3)
    other = pd.Series(risk)[::-1]
    with pytest.raises(SettingError, match="in the plants' order"):
        Season.create(tmp_path / "c.gpkg", plot, settings=season.settings, risk=other)
    risk = other.sort_index()
    risky = Season.create(tmp_path / "c.gpkg", plot, settings=season.settings, risk=risk)
    assert (risky.morning(today) > season.morning(today)).all()
    assert np.array_equal(Season(risky.path).morning(today), risky.morning(today))


@pytest.mark.parametrize("used", ["record", "treat", "plan"])
def test_a_season_begins_on_another_day_only_before_anything_is_recorded_or_planned(season, used):
    first = season.settings
    later = replace(first, begins=BEGINS + timedelta(days=2))
    season.change(later, first)
    season.undo_change()
    season.change(later, first)
    if used == "record":
        season.record(some_results(season, 3, day=2))
    else:
        season.treat(later.begins, 0.5) if used == "treat" else season.plan(later.begins)
    said = (
        f"A season must begin when it began, on {later.begins}, once something was recorded or "
        f"planned: its days are counted from then. But it was to begin on {BEGINS}. Begin a new "
        "season, and record there what was found."
    )
    for change in (lambda: season.change(first, later), season.undo_change):
        with pytest.raises(SettingError) as refused:
            change()
        assert str(refused.value) == said
    assert season.settings == later
    season.change(replace(later, seed=5), later)
    assert season.verify() == ()


FAR = (TeamMember("Ann", ROBOT), TeamMember("Ben", ROBOT, gate=(35.5, 30.35)))
WIDE = replace(ROBOT, width_m=9.0)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"language": "xx"}, "A language must be one of en, he, ar, es, but it is 'xx'."),
        ({"team": FAR}, "Ben: The gate at 35.5, 30.35 .longitude, latitude. lies .* Correct it."),
        ({"robot": WIDE}, "^A robot's aisles must be as wide as it is, .* narrower robot"),
        ({"team": (FAR[0], TeamMember("Ben", WIDE))}, "^Ben: A robot's aisles must be as wide "),
    ],
)
def test_a_season_is_neither_begun_nor_changed_so_that_nobody_can_work(
    season, tmp_path, chosen, said
):
    path, first = tmp_path / "none.gpkg", season.settings
    with pytest.raises(SettingError, match=said):
        Season.create(path, season.plot, begins=BEGINS, **chosen)
    assert not path.exists()
    with pytest.raises(SettingError, match=said):
        season.change(replace(first, **chosen), first)
    with season.store.writing() as db:  # a later version keeps a language that this one lacks
        settings_log.change(db, replace(first, **chosen))
    season = Season(season.path)
    season.change(replace(season.settings, seed=5), season.settings)
    season.change(first, season.settings)
    with pytest.raises(SettingError, match=said):
        season.undo_change()
    assert season.settings == first


def test_settings_are_changed_by_settings_or_a_sentence(season):
    for settings, seen in ((None, season.settings), (season.settings, {"hours": 4})):
        with pytest.raises(SettingError, match="must be MonitoringSettings"):
            season.change(settings, seen)


def test_what_numpy_calls_a_number_and_texts_of_days_come_into_a_season_as_pythons_own(season):
    half = np.float32(0.5)
    plain = MonitoringSettings(
        BEGINS, time(7), Robot(hours=4), seed=3, prior=PriorSettings(background_chance=0.5),
        team=(TeamMember("Ann", gate=(35.15, 30.36), starts_s=0.5),), harvest=on(60),
    )  # fmt: skip
    same = MonitoringSettings(
        str(BEGINS), "07:00", Robot(hours=np.int64(4)), seed=np.int64(3),
        prior=PriorSettings(background_chance=half), harvest=np.datetime64(on(60)),
        team=[TeamMember("Ann", gate=np.array([35.15, 30.36]), starts_s=half)],
    )  # fmt: skip
    assert same == plain
    season.change(same, season.settings)
    season.treat(BEGINS, half, application=Application(
        "Soap", waiting_days=np.int64(3), irac_groups=["6"], began="06:00",
    ))  # fmt: skip
    again = Season(season.path)
    assert again.settings == plain
    (kept,) = again.treatments()
    assert kept.application == Application("Soap", None, waiting_days=3, irac_groups=("6",),
                                           began=time(6))  # fmt: skip


def test_a_season_of_the_library_takes_what_its_pest_says(tmp_path):
    pest = Pest("mite", detection=0.6)
    path = tmp_path / "s.gpkg"
    season = Season.create(path, a_plot(), begins=BEGINS, robot=ROBOT, pest=pest)
    assert season.settings.robot.detects == 0.6
    settings = season.settings
    season.change(replace(settings, pest=None), settings)
    assert season.settings.robot.detects == ROBOT.detects
