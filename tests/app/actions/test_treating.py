"""A treatment with all that a record asks, and the harvest it has to wait for."""

from datetime import date

import numpy as np
import pytest

from app.words import texts
from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.io.writers.treatment_map import treatment_map_bytes
from fieldmon.monitoring.estimates.last_days import default_date
from tests.app.chosen import in_season
from tests.app.driving import apart, boxed, go, press, texts_of


def noted(app, **said):
    go(app, "record")
    boxed(app.number_input, "efficacy").set_value(80)
    boxed(app.text_input, "product").set_value("Acarol")
    for key, value in said.items():
        box = app.number_input if isinstance(value, (int, float)) else app.text_input
        # a number keeps the unit of area in which it was typed
        boxed(box, f"treat {key} ha" if key == "water" else f"treat {key}").set_value(value)
    next(b for b in app.button if b.label == "Note the treatment").click()
    app.run()


def test_what_a_record_asks_is_kept_and_what_to_beware_of_is_said(season_app, season):
    begins = season().settings.begins
    go(season_app, "record")
    table = b"product,waiting days,re-entry hours\nAcarol,7,12\n"
    boxed(season_app.file_uploader, "labels_file").upload("labels.csv", table, "text/csv")
    season_app.run()
    press(season_app, "Take these labels")
    assert "1 label is kept" in season_app.success[0].value
    assert season().labels() == (ProductLabel("Acarol", waiting_days=7, reentry_hours=12.0),)
    season_app.date_input(key="harvest None").set_value(begins)
    season_app.run()
    assert season().settings.harvest == begins
    noted(
        season_app,
        dose=0.5,
        unit="l/ha",
        water=800,
        operator="Ann",
        reason="mites",
        days=3,
        active_ingredient="fenpyroximate",
        weather="18 °C, 2 m/s",
    )
    assert not season_app.error
    said = next(one.value for one in season_app.warning if "Treatment noted" in one.value)
    assert "Treatment noted." in said
    assert "the label's counts" in said
    assert "is too soon after Acarol" in said
    (one,) = season().treatments()
    assert (str(one.application.dose), one.application.operator) == ("0.5 l/ha", "Ann")
    assert one.application.active_ingredient == "fenpyroximate"
    assert one.application.water_l_ha == 800.0
    assert one.application.weather == "18 °C, 2 m/s"
    assert (one.application.waiting_days, one.application.reentry_hours) == (3, 12.0)
    page = texts_of(go(season_app, "season"))
    assert "harvest is allowed from" in page
    assert isinstance(one.entered_waits.harvest_from, date)
    warned = " ".join(one.value for one in season_app.warning)
    assert "is too soon after Acarol" in warned
    assert "where Acarol was applied" in " ".join(w.value for w in go(season_app, "today").warning)


def test_water_is_noted_by_the_area_in_which_the_plot_is_said(season_app, season):
    go(season_app, "record")
    season_app.selectbox(key="area").set_value("dunam").run()
    boxed(season_app.number_input, "efficacy").set_value(80)
    water = boxed(season_app.number_input, "treat water dunam")
    assert water.label == "Water, l/dunam"
    water.set_value(80)
    press(season_app, "Note the treatment")
    assert not season_app.error
    (one,) = season().treatments()
    assert one.application.water_l_ha == 800.0


def test_a_dose_stands_beside_its_unit_which_is_asked_for_and_an_efficacy_is_no_share(
    season_app, season
):
    go(season_app, "record")
    kinds = {"number_input", "text_input", "time_input"}
    boxes = [one.key for one in season_app.main if one.type in kinds]
    boxes = [key.split(" treatment ")[0] for key in boxes if key and " treatment " in key]
    at = boxes.index("treat dose")
    assert boxes[at : at + 2] == ["treat dose", "treat unit"]
    began = boxes.index("treat began")
    assert boxes[began : began + 2] == ["treat began", "treat ended"]
    noted(season_app, dose=0.5)
    assert "must have a number and a unit" in season_app.error[0].value
    # a command takes a share: here it would be hardly any
    boxed(season_app.number_input, "efficacy").set_value(0.8)
    boxed(season_app.text_input, "treat unit").set_value("l/ha")
    press(season_app, "Note the treatment")
    assert "Give 80 for 80 %" in apart(season_app.error[0].value)
    assert season().treatments() == ()


def part_noted(app, **boxes):
    """Note a treatment of what the boxes say."""
    boxed(app.number_input, "efficacy").set_value(80)
    if "rows" in boxes:
        boxed(app.text_input, "treat rows").set_value(boxes["rows"])
    press(app, "Note the treatment")


def test_a_treatment_of_rows_or_of_what_is_selected_on_the_map_is_of_those_plants(
    season_app, season
):
    go(season_app, "record")
    part_noted(season_app, rows="5-12")
    assert not season_app.error
    (one,) = season().treatments()
    assert set(season().plant_numbers.line[one.place.plants].tolist()) == set(range(5, 13))
    noted = f"Treatment noted, of {one.place.plants.sum():,}"
    assert any(one.value.startswith(noted) for one in season_app.warning)
    part_noted(season_app, rows="5-400")
    assert "row 400 is named" in season_app.error[0].value
    assert len(season().treatments()) == 1
    part_noted(season_app, rows="")
    assert season().treatments()[-1].place.plants.all(), "without a word it is the whole plot"
    some = (3, 4, 700)
    season_app.session_state["plants picked"] = in_season(season()).laid, some
    season_app.run()
    assert "3 plants" in boxed(season_app.checkbox, "treat selected").label
    part_noted(season_app, rows="12")
    assert "two of them are said" in season_app.error[0].value
    part_noted(season_app, rows="")
    assert tuple(season().treatments()[-1].place.plants.nonzero()[0].tolist()) == some
    # the next one is of the whole plot again, unless something is selected
    assert not [box for box in season_app.checkbox if "treat selected" in (box.key or "")]


@pytest.mark.parametrize("page", ["record", "decide"])
def test_a_treatment_of_a_file_is_of_its_area_whatever_the_zones_are_now(season_app, season, page):
    advice = season().advice(default_date(season()))
    data = treatment_map_bytes(advice.treatment_map(season().plot.field), "zones.geojson")
    season().record(Inspections.of([0], [FOUND], np.datetime64(default_date(season()))))
    go(season_app, page)
    boxed(season_app.file_uploader, "treat file").upload("zones.geojson", data, "text/plain")
    if page == "record":
        part_noted(season_app, rows="12")
        assert "two of them are said" in season_app.error[0].value
        part_noted(season_app, rows="")
    else:
        part_noted(season_app)
    assert not season_app.exception
    (one,) = season().treatments()
    assert 0 < advice.sprayed.sum() < advice.sprayed.size
    assert one.place.plants.tolist() == advice.sprayed.tolist()
    part_noted(season_app)
    assert season().treatments()[-1].place.plants.sum() != advice.sprayed.sum(), "it is emptied"


@pytest.mark.parametrize("page", ["record", "season"])
def test_the_wait_of_a_treatment_is_said_in_one_step_where_no_day_of_harvest_is_named(
    season_app, season, page
):
    kept = season()
    kept.treat(kept.settings.begins, 0.8, product="Acarol")
    go(season_app, page)
    press(season_app, texts.WAIT_BUTTON)
    assert season_app.error[0].value == texts.WAIT_UNSAID
    assert season().labels() == (), "not known is no 0"
    box = boxed(season_app.number_input, "wait")
    assert "Acarol" in box.label
    assert box.value is None
    box.set_value(7)
    press(season_app, texts.WAIT_BUTTON)
    assert "How long to wait from" in season_app.success[0].value
    assert [(one.product, one.waiting_days) for one in season().labels()] == [("Acarol", 7)]
    assert texts.WAIT_BUTTON not in [one.label for one in season_app.button]
    assert "harvest is allowed from" in texts_of(go(season_app, "season"))
