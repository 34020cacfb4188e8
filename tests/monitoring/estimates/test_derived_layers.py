"""Layers that follow from the causes say what the season says."""

from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPoint, Point, buffer

from fieldmon.infestation.hotspots import hot_spots
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates import derived_layers
from fieldmon.monitoring.estimates.derived_layers import STATES, map_digest, spot_area
from fieldmon.monitoring.file.geopackage import geometry
from tests.monitoring.seasons import BEGINS, a_plot


@pytest.fixture
def season(path):
    return Season(path)


def rows(season, sql):
    with season.store.reading() as db:
        return db.execute(sql).fetchall()


# a map of seven chances as the first versions stored its digest
def test_a_chance_map_has_the_digest_that_season_files_hold():
    assert map_digest(np.linspace(0, 1, 7)) == "e4567b30a0e5fe5fdf6b7e36"


@given(st.integers(0, 6), st.floats(1e-8, 1e-2))
def test_another_map_has_another_digest_but_not_for_its_last_bits(k, more):
    chance = np.linspace(0.1, 0.9, 7)
    other, same = chance.copy(), chance.copy()
    other[k] += more
    same[k] += 1e-13
    assert map_digest(other) != map_digest(chance) == map_digest(same)


def test_the_state_of_every_plant_is_that_of_the_season(season):
    kept = rows(season, "SELECT chance, state, last_inspected FROM plant_state ORDER BY fid")
    chance, state, last = zip(*kept, strict=True)
    assert chance == pytest.approx(season.evening(BEGINS), abs=1e-6)
    states = season.history.states(0)
    assert list(state) == [STATES[code] for code in states.tolist()]
    assert state.count(STATES[-1]) == len(states) - season.status(BEGINS).inspected
    assert (season.history.known(0) != states).any()  # records of before are no inspection
    assert [on is not None for on in last] == (states >= 0).tolist()
    assert {on for on in last if on} == {"2026-04-06"}


def test_each_day_is_kept_with_its_figures_and_the_digest_of_its_morning(season):
    (day,) = rows(season, "SELECT day, date, inspected, found, digest FROM days")
    assert day == (0, "2026-04-06", 12, 3, map_digest(season.morning(BEGINS)))


def cluster(season):
    grid = season.plot.grid
    near = np.argsort(np.hypot(*(grid.xy_m - grid.xy_m[200]).T))[:9]
    found = np.full(9, FOUND)
    clean = np.setdiff1d(np.arange(0, len(grid), 2), near)
    season.record(Inspections.of(near, found, np.datetime64(BEGINS)), "cluster", confirmed=True)
    season.record(
        Inspections.of(clean, np.zeros(len(clean), int), np.datetime64(BEGINS)),
        "clean",
        confirmed=True,
    )
    return near


def test_hot_spots_are_areas_that_hold_their_plants(season):
    near = cluster(season)
    spots = hot_spots(season.plot.grid, season.history.states(0))
    assert len(spots) >= 1
    kept = rows(season, "SELECT geom, found, inspected, plants FROM hot_spots ORDER BY spot")
    assert [row[1:] for row in kept] == list(
        zip(spots.found.tolist(), spots.inspected.tolist(), spots.plants.tolist(), strict=True)
    )
    lonlat = season.plot.grid.lonlat(near[:3])
    assert all(geometry(kept[0][0]).contains(Point(p)) for p in lonlat)
    whole = spot_area(season.plot, spots, 0)
    assert geometry(kept[0][0]).equals(whole)


def test_a_hot_spots_ground_is_what_lies_around_each_of_its_plants(season):
    cluster(season)
    grid = season.plot.grid
    spots = hot_spots(grid, season.history.states(0))
    own, row_m = grid.xy_m[spots.of_plant == 0], grid.row_spacing_m
    # circles around plants, which takes a hundred times as long for a spot of a thousand
    circles = buffer(buffer(MultiPoint(own), 1.5 * row_m, quad_segs=16), -row_m, quad_segs=16)
    ground = grid.frame.geometry_m(spot_area(season.plot, spots, 0))
    assert ground.buffer(0.1 * row_m).covers(circles)
    assert circles.buffer(0.1 * row_m).covers(ground)


def test_a_gap_in_a_row_is_no_ground_of_a_hot_spot(season):
    grid = season.plot.grid
    row = np.arange(*grid.row_start[:2])
    ends = np.concatenate([row[:3], row[-3:]])
    at = np.split(grid.xy_m[ends], 2)
    middle = Point(grid.xy_m[row].mean(axis=0))
    apart = derived_layers._ground_around(np.concatenate(at).tobytes(), (0, 3), grid.row_spacing_m)
    assert not apart.covers(middle)
    assert (
        derived_layers._adjacent_to_next(grid, ends).tolist() == [True] * 2 + [False] + [True] * 2
    )


@pytest.fixture
def written(monkeypatch):
    """Return the plants whose rows are written."""
    plants, refresh = [], derived_layers.refresh

    def watched(db, *given):
        db.create_function("written", 1, plants.append)
        for event in ("INSERT", "UPDATE"):
            db.execute(
                f"CREATE TEMP TRIGGER IF NOT EXISTS told_{event} AFTER {event} ON main.plant_state "
                "BEGIN SELECT written(new.fid); END"
            )
        return refresh(db, *given)

    monkeypatch.setattr(derived_layers, "refresh", watched)
    return plants


@pytest.fixture
def statements(monkeypatch):
    """Return the statements that write what is known of plants."""
    said, refresh = [], derived_layers.refresh

    def watched(db, *given):
        db.set_trace_callback(said.append)
        newest = refresh(db, *given)
        db.set_trace_callback(None)
        said[:] = [sql for sql in said if "plant_state" in sql and not sql.startswith("SELECT")]
        return newest

    monkeypatch.setattr(derived_layers, "refresh", watched)
    return said


def test_a_tap_writes_only_the_plants_of_which_something_else_is_known(season, written):
    cluster(season)
    written.clear()
    plant = np.flatnonzero(season.history.states(0) < 0)[:1]
    season.record(Inspections.of(plant, np.array([SKIPPED]), BEGINS), "nothing was learnt")
    assert written == []
    season.record(Inspections.of(plant, np.array([CLEAN]), BEGINS), "a tap")
    assert plant[0] + 1 in written
    assert 1 <= len({*written}) < len(a_plot().grid)


def test_a_night_that_changes_all_chances_is_written_by_few_statements(season, statements):
    sql, night = "SELECT chance FROM plant_state ORDER BY fid", date(2026, 4, 8)
    before = rows(season, sql)
    season.plan(night)
    after = rows(season, sql)
    assert [chance for (chance,) in after] == np.round(season.evening(night), 6).tolist()
    assert sum(one != other for one, other in zip(before, after, strict=True)) > 200
    assert 1 <= len(statements) < 9


def test_a_rebuilt_file_says_the_same(season):
    sql = "SELECT fid, chance, state, last_inspected, hot_spot FROM plant_state ORDER BY fid"
    before = rows(season, sql), rows(season, "SELECT * FROM days")
    with season.store.writing() as db:
        db.execute("DELETE FROM plant_state")
        db.execute("DELETE FROM days")
    season.rebuild()
    after = rows(season, sql), rows(season, "SELECT * FROM days")
    assert after[0] == before[0]
    assert [row[1:] for row in after[1]] == [row[1:] for row in before[1]]


def test_what_the_inspections_tell_is_kept_with_its_intervals(season):
    kept = rows(season, "SELECT name, value, low, high FROM learnt ORDER BY fid")
    assert kept == [(one.name, one.value, one.low, one.high) for one in season.learnt(BEGINS)]
    assert len(kept) == 6
