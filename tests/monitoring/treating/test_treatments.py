"""Treatments in a season's file: once each, and out again as the belief takes them."""

from dataclasses import replace
from datetime import UTC, date, datetime, time

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.decisions.doses import Dose
from fieldmon.monitoring.treating import treatments
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.monitoring.treating.treatments import TreatedPlace
from fieldmon.plot.local_clock import LocalClock

AREA = MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)])
SOAP = Treatment(2, np.arange(20) < 17, 0.8)
PLACE = TreatedPlace(AREA, SOAP.plants, 0.5)
ON = date(2026, 4, 8)
CLOCK = LocalClock("Asia/Jerusalem")
FULL = Application(
    "Acarol", Dose(0.5, "l/ha"), 800.0, "Ann", "mites on 6 % of the plants", 3, 12.0, ("4A", "28"),
    time(22, 30), time(1, 15), "boom, 12 m", "tomato", "spider mites", "Dr Levi",
)  # fmt: skip


def store(db, what="soap", batch=1, place=PLACE, treatment=SOAP):
    said = what if isinstance(what, Application) else Application(what)
    return treatments.store(db, treatment, (place, ON, said), batch, CLOCK)


def kept(db):
    return treatments.kept(db, lambda _: SOAP.plants, CLOCK)


def test_a_treatment_is_kept_once(db):
    assert store(db) == 1
    assert store(db, batch=2) == 0
    assert store(db, "oil", 3) == 1
    assert store(db, FULL, 4) == 1
    assert store(db, FULL, 5) == 0
    assert store(db, replace(FULL, operator="Ben"), 6) == 1


def test_it_has_the_digest_that_season_files_hold(db):
    store(db)
    row = db.execute("SELECT digest, plants, date FROM treatments").fetchone()
    assert row == ("410c0159e3772ce58f85be04", 17, "2026-04-08")


def test_those_that_count_come_back_with_the_plants_in_their_area(db):
    store(db)
    store(db, "oil", 2)
    db.execute("UPDATE treatments SET undone = 1 WHERE batch = 2")
    areas = []
    (again,) = treatments.load(db, lambda area: areas.append(area) or SOAP.plants)
    assert (again.day, again.efficacy) == (2, 0.8)
    assert again.plants is SOAP.plants
    assert [area.equals(AREA) for area in areas] == [True]


def test_all_that_was_said_of_an_application_comes_back(db):
    store(db, FULL)
    (again,) = kept(db)
    assert again.application == FULL
    assert (again.on, again.day, again.batch, again.place.area_ha) == (ON, 2, 1, 0.5)
    assert db.execute("SELECT began, ended, zone FROM treatments").fetchone() == (
        "2026-04-08T22:30:00+03:00", "2026-04-09T01:15:00+03:00", "Asia/Jerusalem",
    )  # fmt: skip
    # past midnight: the wait begins on the day after
    assert again.ended == datetime(2026, 4, 8, 22, 15, tzinfo=UTC)
    assert again.entered_waits.harvest_from == date(2026, 4, 13)
    assert again.entered_waits.entry_from == datetime(2026, 4, 9, 13, 15)


def test_without_a_time_it_ended_at_the_end_of_its_day(db):
    store(db, Application("soap", waiting_days=1))
    (again,) = kept(db)
    assert again.ended == datetime(2026, 4, 8, 21, tzinfo=UTC)
    assert again.entered_waits.harvest_from == date(2026, 4, 10)


def test_plants_treated_one_by_one_are_those_whatever_stands_in_the_outline(db):
    few = np.arange(20) % 5 == 0
    place = TreatedPlace(AREA, few, 0.01, by_plant=True)
    store(db, place=place, treatment=Treatment(2, few, 0.8))
    (again,) = kept(db)
    assert np.array_equal(again.place.plants, few)
    assert again.place.by_plant


@pytest.mark.parametrize(
    ("column", "other"),
    [
        ("dose", 9.0), ("waiting_days", 1), ("irac_groups", "6"), ("reason", "none"),
        ("ended", "2026-04-08T01:15:00+03:00"), ("efficacy", 0.1), ("product", "other"),
        ("by_label", "waiting_days"), ("by_label", None),
    ],
)  # fmt: skip
def test_a_row_that_says_otherwise_than_its_digest_is_named(db, column, other):
    store(db, FULL)
    store(db, "soap", 2)
    assert treatments.not_what_they_say(db) == []
    db.execute(f"UPDATE treatments SET {column} = ? WHERE fid = 1", (other,))  # noqa: S608
    assert treatments.not_what_they_say(db) == [1]


def test_the_log_says_what_where_and_how_much():
    assert treatments.in_words(PLACE, FULL, "row 3") == (
        "Acarol 0.5 l/ha on 0.5 ha, 17 plants, row 3"
    )
    assert treatments.in_words(PLACE, Application(), "the whole plot") == (
        "a product that nobody named on 0.5 ha, 17 plants, the whole plot"
    )
    single = TreatedPlace(None, np.arange(20) == 3, 0.00025)
    said = treatments.in_words(single, Application("Solo"), "1 plant in row 3")
    assert said == "Solo on 2.5 m², 1 plant in row 3"
