"""A treatment lowers chances where it was, and is undone like findings."""

from dataclasses import replace
from datetime import time

import numpy as np
import pandas as pd
import pyogrio
import pytest
import shapely
from pyproj import Geod
from shapely import MultiPolygon, box

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.decisions.zones import outlines, whole_plot
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Application
from fieldmon.monitoring.estimates.verifying import check_against_log
from tests.monitoring.seasons import BEGINS, on, some_results


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


def test_a_treatment_is_undone(season):
    before = season.evening(BEGINS)
    season.treat(BEGINS, 0.5)
    assert season.evening(BEGINS) == pytest.approx(before / 2)
    season.undo()
    assert np.array_equal(season.evening(BEGINS), before)
    assert [(batch.kind, batch.undone) for batch in season.batches()] == [("treatment", True)]


def test_numbers_of_plants_are_not_taken_for_which_were_treated(season):
    n = len(season.plot.grid)
    for plants in (np.arange(n), np.ones(n)):
        with pytest.raises(SettingError, match="mask of treated plants must hold True or False"):
            season.treat(BEGINS, 0.5, plants=plants)
    assert season.treatments() == ()
    season.treat(BEGINS, 0.5, plants=np.isin(np.arange(n), [1, 2, 3]))
    (treated,) = season.treatments()
    assert np.flatnonzero(treated.place.plants).tolist() == [1, 2, 3]


LABEL = ProductLabel(
    "Acarol", waiting_days=7, reentry_hours=12.0, irac_groups=("6", "28"), max_uses=1
)
SAID = Application(
    "acarol", Dose(0.5, "l/ha"), 400.0, "Ann", "mites on 3 %", began=time(22, 30),
    ended=time(1, 15), machinery="knapsack", crop="vine", pest="mite", authorised_by="Dr Bo",
    active_ingredient="abc", weather="2 m/s",
)  # fmt: skip


def read(season, layer="treatments"):
    """Return what a GIS reads of a layer, row by row, without what is empty."""
    frame = pyogrio.read_dataframe(season.path, layer=layer)
    return [
        {k: v for k, v in row.items() if not (np.isscalar(v) and pd.isna(v)) and v is not None}
        for row in frame.to_dict("records")
    ]


def geodesic_ha(shape):
    area_m2, _ = Geod(ellps="WGS84").geometry_area_perimeter(shapely.orient_polygons(shape))
    return area_m2 / 1e4


def test_each_field_of_a_treatment_is_read_by_a_gis_as_it_was_said(season):
    season.keep_labels([LABEL])
    area = MultiPolygon([box(35.14, 30.3602, 35.1504, 30.3605)])
    made = season.treat(on(2), 0.75, area, application=SAID)
    assert (made.new, made.known) == (1, 0)
    (row,) = read(season)
    assert row.pop("geometry").equals(area)
    sprayed_ha = row.pop("area_ha")
    assert str(row.pop("date"))[:10] == "2026-04-08"
    inside = shapely.contains_xy(area, season.plot.grid.lonlat())
    assert len(row.pop("digest")) == 24
    assert row == {
        "day": 2, "efficacy": 0.75, "product": "acarol", "plants": inside.sum(), "undone": 0,
        "batch": made.batch, "dose": 0.5, "unit": "l/ha", "water_l_ha": 400.0,
        "operator": "Ann", "reason": "mites on 3 %", "waiting_days": 7, "reentry_hours": 12.0,
        "irac_groups": "6+28", "began": "2026-04-08T22:30:00+03:00",
        "ended": "2026-04-09T01:15:00+03:00", "zone": "Asia/Jerusalem", "machinery": "knapsack",
        "crop": "vine", "pest": "mite", "authorised_by": "Dr Bo", "active_ingredient": "abc",
        "weather": "2 m/s", "by_label": "waiting_days+reentry_hours+irac_groups",
    }  # fmt: skip
    (kept,) = season.treatments()
    assert kept.application == replace(
        SAID, waiting_days=7, reentry_hours=12.0, irac_groups=("6", "28")
    )
    assert kept.place.plants.tolist() == inside.tolist()
    assert (kept.day, kept.on, kept.efficacy, kept.number) == (2, on(2), 0.75, 1)
    grid = season.plot.grid
    each_m2 = grid.row_spacing_m * grid.plant_spacing_m
    assert kept.place.area_ha == sprayed_ha == pytest.approx(inside.sum() * each_m2 / 1e4, abs=1e-4)
    assert not kept.place.by_plant
    entry = season.log()[-1]
    assert (entry.kind, entry.who) == ("treated", "Ann")
    assert entry.what["batch"] == made.batch
    assert (entry.what["date"], entry.what["efficacy"]) == ("2026-04-08", 0.75)
    assert f"acarol 0.5 l/ha on {kept.place.area_ha:.3g} ha, {inside.sum()} plants" in str(
        entry.sentence()
    )
    again = season.treat(on(2), 0.75, area, application=SAID)
    assert (again.batch, again.new, again.known) == (None, 0, 1)
    assert season.log()[-1] == entry
    assert len(season.batches()) == 1


def test_what_is_recorded_again_is_known_whatever_the_label_says_by_then(season):
    said = Application("Acarol", operator="Ann")
    assert season.treat(BEGINS, 0.5, application=said).new == 1
    for days in (7, 14):
        season.keep_labels([ProductLabel("Acarol", waiting_days=days)])
        assert season.treat(BEGINS, 0.5, application=said).known == 1
    season.undo()
    season.treat(BEGINS, 0.5, application=said)
    (kept,) = season.treatments()
    assert kept.application.waiting_days == 14
    assert season.treat(BEGINS, 0.5, application=kept.application).known == 1
    season.keep_labels([])
    for other in (replace(said, waiting_days=7), replace(said, operator="Ben")):
        assert season.treat(BEGINS, 0.5, application=other).new == 1
    assert check_against_log(season) == ()


def test_a_product_named_beside_the_application_is_its_own_with_the_waits_of_its_label(season):
    season.keep_labels([LABEL])
    season.treat(BEGINS, 0.9, product="Acarol", application=Application(operator="Bo"))
    season.treat(on(1), 0.9, product="ACAROL", application=Application("Acarol"))
    with pytest.raises(SettingError, match="one product, but it is with 'Soap', and its applicat"):
        season.treat(on(2), 0.9, product="Soap", application=Application("Acarol"))
    kept = [one.application for one in season.treatments()]
    assert [(one.product, one.operator) for one in kept] == [("Acarol", "Bo"), ("Acarol", "")]
    assert {(one.waiting_days, one.reentry_hours) for one in kept} == {(7, 12.0)}


def test_of_a_product_that_is_asked_about_the_wait_is_not_that_of_one_sprayed_that_day(season):
    every = np.ones(len(season.plot.grid), bool)
    season.treat(BEGINS, 0.9, application=Application("Acarol", waiting_days=7))
    asked = season.cautions_if_treated(BEGINS, "Acarol", every)
    (said,) = (one.sentence for one in asked if one.kind == "harvest")
    assert said.startswith("If Acarol is sprayed here, how long to wait until harvest is not known")
    assert not [one for one in season.cautions(BEGINS) if one.kind == "harvest"]
    season.keep_labels([ProductLabel("Acarol", waiting_days=7)])
    asked = season.cautions_if_treated(BEGINS, "Acarol", every)
    assert "harvest" not in {one.kind for one in asked}


def test_the_same_plants_are_the_same_area_whichever_way_they_were_named(season):
    grid = season.plot.grid
    every = np.ones(len(grid), bool)
    zones = whole_plot(grid, np.full(len(grid), 0.1))
    season.treat(on(0), 0.5)
    season.treat(on(1), 0.5, outlines(grid, zones)[0])
    season.treat(on(2), 0.5, plants=every)
    (area_ha,) = {one.place.area_ha for one in season.treatments()}
    assert area_ha == pytest.approx(zones.m2 / 1e4, abs=1e-4)
    boundary_ha = geodesic_ha(season.plot.field.boundary)
    assert area_ha < boundary_ha  # headlands are not sprayed


def test_plants_treated_one_by_one_are_these_and_their_ground_is_the_outline(season):
    grid = season.plot.grid
    plants = np.zeros(len(grid), bool)
    plants[[3, 4, 40]] = True
    with pytest.raises(SettingError, match="of an area or of plants"):
        season.treat(BEGINS, 0.5, season.plot.field.boundary, plants=plants)
    with pytest.raises(SettingError, match=f"each of the {len(grid)} plants, but it is of 5"):
        season.treat(BEGINS, 0.5, plants=plants[:5])
    with pytest.raises(SettingError, match="holds none"):
        season.treat(BEGINS, 0.5, plants=plants & False)
    assert season.batches() == ()
    season.treat(BEGINS, 0.5, plants=plants)
    (kept,) = season.treatments()
    assert kept.place.by_plant
    assert np.flatnonzero(kept.place.plants).tolist() == [3, 4, 40]
    assert kept.place.area_ha == pytest.approx(geodesic_ha(kept.place.area), rel=1e-3, abs=1e-4)
    assert shapely.contains_xy(kept.place.area, grid.lonlat()[plants]).all()


def test_how_well_a_product_works_is_what_the_season_learnt_where_nobody_says(season):
    plants = np.arange(60)
    for day, result in ((0, FOUND), (4, CLEAN)):
        season.record(Inspections.of(plants, np.full(60, result), np.datetime64(on(day))))
        if day == 0:
            with pytest.raises(SettingError, match="after a treatment with soap"):
                season.treat(on(2), product="soap")
            season.treat(on(2), 0.6, product="soap")
    (told,) = season.effects(on(4))
    assert told.cured_of == 60
    assert season.effects(on(1)) == ()
    season.treat(on(5), product="Soap")
    assert season.treatments()[-1].efficacy == pytest.approx(told.efficacy)
    assert told.efficacy > 0.85
    with pytest.raises(SettingError, match="a product that nobody named"):
        season.treat(on(5))


def test_cautions_and_harvest_are_of_treatments_up_to_the_day(season):
    season.change(replace(season.settings, harvest=on(12)), season.settings)
    assert season.keep_labels([LABEL], "table.csv", "Bo") == 1
    assert season.labels() == (LABEL,)
    for day in (2, 6):
        season.treat(on(day), 0.9, application=Application("Acarol", ended=time(9)))
    assert [one.kind for one in season.cautions(on(1))] == []
    assert season.harvest_from(on(1)) is None
    assert {one.kind for one in season.cautions(on(2))} == {"entry"}
    assert {one.kind for one in season.cautions(on(6))} == {"harvest", "entry", "uses"}
    first, one = season.harvest_from(on(5))
    assert (first, one.day) == (on(10), 2)
    first, one = season.harvest_from(on(6))
    assert (first, one.day) == (on(14), 6)
    season.treat(on(15), 0.9, product="Oil")
    first, one = season.harvest_from(on(15))
    assert (first, one.day) == (None, 15)
    assert season.harvest_from(on(14))[0] == on(14)


def test_a_group_that_the_label_filled_in_follows_the_newest_table(season):
    """The table named another group at first: three uses in a row are warned of all the same."""
    duo = ProductLabel("Duo", irac_groups=("6",))
    season.keep_labels([duo])
    for day, said in enumerate(((), (), ("6",))):
        season.treat(on(day), 0.5, application=Application("Duo", irac_groups=said))
    season.keep_labels([replace(duo, irac_groups=("28",))])
    season.treat(on(3), 0.5, application=Application("Duo"))
    told = [one.sentence for one in season.cautions(on(3)) if one.kind == "group"]
    assert len(told) == 1
    assert "Use 3 of mode-of-action group 6 in a row" in told[0]
    season.undo(season.treatments()[2].batch)  # of which somebody said the group
    told = [one.sentence for one in season.cautions(on(3)) if one.kind == "group"]
    assert len(told) == 1
    assert "Use 3 of mode-of-action group 28 in a row" in told[0]
