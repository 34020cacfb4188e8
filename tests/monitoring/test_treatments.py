"""Treatments in a season's file: once each, and out again as the belief takes them."""

import numpy as np
from shapely import MultiPolygon, box

from fieldmon.monitoring import treatments
from fieldmon.monitoring.history import Treatment

AREA = MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)])
SOAP = Treatment(2, np.arange(20) < 17, 0.8)


def test_a_treatment_is_kept_once(db):
    assert treatments.store(db, SOAP, (AREA, "2026-04-08", "soap"), 1) == 1
    assert treatments.store(db, SOAP, (AREA, "2026-04-08", "soap"), 2) == 0
    assert treatments.store(db, SOAP, (AREA, "2026-04-08", "oil"), 3) == 1


def test_it_has_the_digest_that_season_files_hold(db):
    treatments.store(db, SOAP, (AREA, "2026-04-08", "soap"), 1)
    kept = db.execute("SELECT digest, plants, date FROM treatments").fetchone()
    assert kept == ("410c0159e3772ce58f85be04", 17, "2026-04-08")


def test_those_that_count_come_back_with_the_plants_in_their_area(db):
    treatments.store(db, SOAP, (AREA, "2026-04-08", "soap"), 1)
    treatments.store(db, SOAP, (AREA, "2026-04-08", "oil"), 2)
    db.execute("UPDATE treatments SET undone = 1 WHERE batch = 2")
    areas = []
    (again,) = treatments.load(db, lambda area: areas.append(area) or SOAP.plants)
    assert (again.day, again.efficacy) == (2, 0.8)
    assert again.plants is SOAP.plants
    assert [area.equals(AREA) for area in areas] == [True]
