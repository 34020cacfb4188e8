"""What was found is recorded once, from each form and from files."""

import json
import shutil
import uuid
from datetime import date, time, timedelta
from pathlib import Path

import numpy as np
import pytest
import streamlit as st

from app.actions import contradicting, recording
from app.show import plant_history
from app.show.recorded_batches import GONE
from app.state import seasons_folder
from app.state.choices import WHOSE_DAY
from app.state.fresh_boxes import FreshBoxes
from app.words import texts
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.plot.grid import plant_numbers
from tests.app.actions.test_scouting import of_two
from tests.app.chosen import a_plot, in_season
from tests.app.driving import boxed, go, metric, opened, press, texts_of
from tests.monitoring.changes.test_outside_changes import moved_to, outside
from tests.monitoring.seasons import a_season


def test_one_plant_is_recorded_undone_or_gone(season_app, season):
    go(season_app, "record")
    boxed(season_app.number_input, "one_row").set_value(3)
    boxed(season_app.number_input, "one_plant").set_value(4)
    boxed(season_app.segmented_control, "one_result").set_value(1)
    send(season_app, "one")
    assert "1 recorded" in season_app.success[0].value
    (plant,) = season().history.inspections.plant
    numbered = season().plant_numbers
    assert (numbered.line[plant], numbered.number[plant]) == (3, 4)
    assert metric(go(season_app, "season"), "Found") == "1"
    go(season_app, "record")
    press(season_app, "Undo")
    assert metric(go(season_app, "season"), "Found") == "0"
    assert not len(season().history.inspections)
    go(season_app, "record")
    press(season_app, "Redo")
    assert season().history.inspections.plant.tolist() == [plant]
    # pulled out by now, and no treatment
    for name, value in {"one_row": 3, "one_plant": 5, "one_result": GONE}.items():
        season_app.session_state[key_of(season_app, name)] = value
    send(season_app, "one")
    assert "1 recorded" in season_app.success[0].value
    assert season().history.gone(0).nonzero()[0].tolist() == [
        season().history.inspections.plant[-1]
    ]
    assert season().treatments() == ()


@pytest.mark.parametrize("result", [CLEAN, SKIPPED, GONE])
def test_only_a_find_is_recorded_with_a_count_and_the_boxes_keep_what_is_refused(
    season_app, season, result
):
    go(season_app, "record")
    for name, value in {"one_row": 3, "one_plant": 5, "one_result": result, "one_count": 7}.items():
        season_app.session_state[key_of(season_app, name)] = value
    send(season_app, "one")
    (said,) = (one.value for one in season_app.error)
    word = "clean" if result == CLEAN else "skipped"
    assert f"Only a find has a count of pests, but result 1 is {word} and counts 7" in said
    assert not len(season().inspections)
    assert boxed(season_app.number_input, "one_count").value == 7


def test_in_a_team_who_inspected_or_treated_is_who_is_said_to_have(season_app, season):
    of_two(season)
    go(season_app, "record")
    route = boxed(season_app.number_input, "stops_done").key

    def say_one(plant, who=None, result=CLEAN):
        boxed(season_app.number_input, "one_row").set_value(3)
        boxed(season_app.number_input, "one_plant").set_value(plant)
        boxed(season_app.segmented_control, "one_result").set_value(result)
        if who is not None:
            next(one for one in season_app.selectbox if one.label == texts.INSPECTED_BY
                 and "one_plant" in one.key).set_value(who)  # fmt: skip
        send(season_app, "one")

    say_one(4)
    assert season().history.inspections.who.tolist() == [""]
    say_one(5, "Dan")
    say_one(6)  # who it was stays in the box until another is chosen
    assert season().history.inspections.who.tolist() == ["", "Dan", "Dan"]
    # what waits for a word is signed as it was brought
    say_one(6, "Ann", FOUND)
    press(season_app, "The new one holds")
    assert season().history.inspections.who.tolist() == ["", "Dan", "Ann"]
    season_app.button(key="undo 1").click().run()
    assert season().log()[-1].who == ""
    table = b"row,plant,result\n2,5,clean\n"
    boxed(season_app.file_uploader, "findings_file").upload("day.csv", table).run()
    season_app.button(key="record_file").click().run()
    assert season().history.inspections.who.tolist() == ["Dan", "Ann", ""]
    boxed(season_app.number_input, "efficacy").set_value(80)
    boxed(season_app.text_input, "product").set_value("Oil")
    send(season_app, "treatment")
    assert [one.application.operator for one in season().treatments()] == [""]
    # the stops are of the route of the one whose day is chosen above them
    season_app.segmented_control(key=WHOSE_DAY).set_value("Dan").run()
    box = boxed(season_app.number_input, "stops_done")
    assert box.key != route
    box.set_value(1)
    send(season_app, "route")
    assert season().history.inspections.who.tolist()[-1] == "Dan"
    assert season().batches()[0].who == "Dan"


def test_a_row_typed_that_may_be_another_by_its_name_is_refused_unless_it_was_tapped(season_named):
    app = opened(season_named.path.stem)
    go(app, "record")
    for name, value in {"one_row": "2", "one_plant": 5, "one_result": FOUND}.items():
        app.session_state[key_of(app, name)] = value
    send(app, "one")
    assert "2 may be any of rows 2–3 here" in app.error[0].value
    assert not len(season_named.history.inspections)
    app.session_state[key_of(app, "one_row").replace("one_row", "one_tapped")] = ("2", 5)
    send(app, "one")
    assert "1 recorded" in app.success[0].value
    (plant,) = season_named.history.inspections.plant
    assert season_named.plant_numbers.line[plant] == 2


def test_a_row_is_typed_by_its_name_and_a_plant_that_may_be_another_by_its_name_is_refused(
    season_named,
):
    app = opened(season_named.path.stem)
    go(app, "record")
    for plant, error in ((4, "4 may be any of plants 3–4 of row 1 · 5a here"), (5, None)):
        for name, value in {"one_row": "5A", "one_plant": plant, "one_result": FOUND}.items():
            app.session_state[key_of(app, name)] = value
        send(app, "one")
        assert [error in one.value for one in app.error] == ([True] if error else [])
    (plant,) = season_named.history.inspections.plant
    numbered = season_named.plant_numbers
    assert (numbered.line[plant], numbered.number[plant]) == (1, 5)
    # what was recorded, and what was undone, is called as it was typed
    go(app, "record")
    (recorded,) = [one for one in app.button if one.label == "Undo"]
    assert "row 1 · 5a, plant 5: found" in recorded.help
    recorded.click()
    app.run()
    assert "1 · 5a" in app.success[0].value


def expected(app):
    """Return the season's figure of what is still infested, as a number."""
    return float(metric(go(app, "season"), "Still infested").split(" ")[0])


def treated(app):
    go(app, "record")
    boxed(app.number_input, "efficacy").set_value(90)
    next(b for b in app.button if b.label == "Note the treatment").click()
    app.run()
    assert not app.error
    assert " · treatment" in texts_of(app)
    # it may be of a few rows: the line claims no plot
    assert "treatment of the plot" not in texts_of(app)


def test_a_treatment_lowers_what_is_expected_and_is_taken_back(season_app):
    before = expected(season_app)
    treated(season_app)
    assert expected(season_app) < 0.2 * before
    go(season_app, "record")
    press(season_app, "Undo")
    assert "undone" in texts_of(season_app)
    assert expected(season_app) == before


def file_recorded(app, table, name="found.csv"):
    """Record a file; return what is said of it."""
    boxed(app.file_uploader, "findings_file").upload(name, table).run()
    app.button(key="record_file").click().run()
    assert not app.exception
    (said,) = [*app.error, *app.warning, *app.success]
    return said.value


def test_what_fits_of_a_file_is_recorded_once_and_what_does_not_is_a_sentence_that_can_be_closed(
    season_app, season
):
    go(season_app, "record")
    for data, says in (
        (b"a,b\n1,2\n", "found.csv"),
        (b"row,number,found\n999,1,yes\n", "0 recorded"),
        (b"\x00\x01", "found.csv"),
        (b"row,number,found,date\n1,1,yes,2026-11-14\n2,3,no,2026-11-15\n",
         "Row 1, plant 1: The day must be of this season"),
    ):  # fmt: skip
        assert says in file_recorded(season_app, data)
        assert not season_app.success
    assert not len(season().history.inspections)
    table = b"row,number,found,count\n1,1,yes,3\n1,2,no,\n2,5,,\n"
    for says in ("2 recorded, 0 known", "0 recorded, 2 known"):
        assert says in file_recorded(season_app, table)
        assert season_app.success
    assert season().history.inspections.result.tolist() == [1, 0]
    said = file_recorded(season_app, b"row,number,found,count\n1,3,yes,3\n999,1,yes,\n")
    assert "1 recorded, 0 known" in said
    assert "1 was left out" in said
    assert season_app.warning
    press(season_app, texts.NOTICE_CLOSE)
    assert not season_app.warning
    said = file_recorded(season_app, b"row,number,date,found\n1,4,2026-11-16,yes\n1,5,,yes\n")
    assert "1 recorded, 0 known" in said
    assert "1 record has no date, as others have: left out." in said
    assert season_app.warning
    assert len(season().history.inspections) == 4
    # what a route file says that it finds reaches the season and its page
    for detects, says in ((30, "record 2 of rex.csv says '30'"), (0.3, "2 recorded")):
        table = f"row,number,found,who,detects\n2,1,yes,Rex,0.3\n2,2,no,Rex,{detects}\n".encode()
        assert says in file_recorded(season_app, table, "rex.csv")
    assert season().history.detections.tolist()[-2:] == [0.3, 0.3]
    go(season_app, "season")
    assert "2 inspections find 30 % of what is there, as was said with them" in texts_of(season_app)


def test_words_that_say_neither_and_other_plots_are_asked_about_in_a_file_too(season_app, season):
    go(season_app, "record")
    lines = "Gate,1,1,si algo", "Gate,1,2,yes", "Pond,1,3,yes", 'Pond,1,4,"no, none"'
    table = "\n".join(["plot,row,number,found", *lines]).encode()
    boxed(season_app.file_uploader, "findings_file").upload("found.csv", table).run()
    season_app.button(key="record_file").click().run()
    assert "1 recorded, 0 known" in season_app.warning[0].value

    def asked():
        words = [one.key for one in season_app.get("button_group")]
        return {key.rpartition(" ")[2]: key for key in words if (key or "").startswith("word ")}

    season_app.session_state[asked()["algo"]] = FOUND
    season_app.session_state[asked()["none"]] = CLEAN
    press(season_app, texts.WORDS_TAKE)
    assert not asked()
    press(season_app, "They are of this plot")
    press(season_app, "Take back: No column names the plot")
    press(season_app, "They are of this plot")
    season_app.button(key="record_file").click().run()
    assert "3 recorded, 1 known" in season_app.success[0].value
    plants = plant_numbers(season().plot.grid, season().history.inspections.plant).number.tolist()
    result = season().history.inspections.result.tolist()
    assert sorted(zip(plants, result, strict=True)) == [(1, 1), (2, 1), (3, 1), (4, 0)]


def test_what_qgis_corrected_and_added_in_a_copy_comes_in_by_uploading_it(
    season_app, season, tmp_path
):
    record_clean(season(), date(2026, 11, 16), 4)
    copy = shutil.copy(season().path, tmp_path / "copy.gpkg")
    outside(copy, "UPDATE inspections SET result = 'found' WHERE fid = 1",
            "DELETE FROM inspections WHERE fid = 2")  # fmt: skip
    first, second = season().history.inspections.plant[:2].tolist()
    go(season_app, "record")
    data = Path(copy).read_bytes()

    def brought():
        boxed(season_app.file_uploader, "findings_file").upload("copy.gpkg", data).run()

    brought()
    season_app.button(key="record_file").click().run()
    assert "must have an author" in season_app.error[0].value
    assert len(season().history.inspections) == 4
    for corrections in (2, 0):
        brought()
        boxed(season_app.text_input, "corrected_by").set_value("Ann").run()
        season_app.button(key="record_file").click().run()
        assert f"{corrections} corrections taken" in season_app.success[0].value
        assert "0 recorded, 2 known" in season_app.success[0].value
    kept = season()
    assert kept.history.inspections.plant.tolist().count(second) == 0
    assert kept.history.states(0)[first] == FOUND
    assert kept.batches()[0].who == "Ann"
    assert kept.verify() == ()
    # another result of that plant and day, the other way
    clean = int(kept.history.inspections.plant[-1])
    copy = shutil.copy(kept.path, tmp_path / "copy.gpkg")
    outside(copy, moved_to(kept.plot.grid.lonlat([clean])[0]))
    data = Path(copy).read_bytes()
    brought()
    boxed(season_app.text_input, "corrected_by").set_value("Ann").run()
    season_app.button(key="record_file").click().run()
    assert "Corrections must not contradict" in season_app.error[0].value
    season_app.button(key="correct_both").click().run()
    assert "1 correction taken" in season_app.success[0].value


def test_days_in_the_app_give_the_digits_of_the_same_days_without_it(season_app, season, tmp_path):
    mine = season()
    twin = Season.create(tmp_path / "twin.gpkg", mine.plot, mine.records, mine.settings)
    for day in (16, 17):
        on = date(2026, 11, day)
        season_app.date_input(key="day Gate 2026").set_value(on).run()
        go(season_app, "record")
        boxed(season_app.number_input, "stops_done").set_value(30)
        send(season_app, "route")
        record_clean(twin, on, 30)
        kept = season()
        assert kept.morning(on).tolist() == twin.morning(on).tolist()
        assert kept.evening(on).tolist() == twin.evening(on).tolist()
        rest = [one.plan(on, keep=False).route.plant.tolist() for one in (kept, twin)]
        assert rest[0] == rest[1]
    go(season_app, "today")
    assert "30 plants inspected" in texts_of(season_app)
    assert "Plants expected to be still infested: " in texts_of(season_app)


def record_clean(project, on, n):
    plants = project.plan(on, keep=False).route.plant[:n]
    project.record(Inspections.of(plants, np.zeros(n, np.int8), np.datetime64(on)), "twin")


def key_of(app, name):
    """Return the key of a box that the driver of tests does not know."""
    return next(
        key for key in app.session_state._state.filtered_state if key.startswith(f"{name} ")
    )


def send(app, form):
    """Press the button of some boxes."""
    app.button(key="treat" if form == "treatment" else f"record_{form}").click().run()
    assert not app.exception


def test_what_is_typed_before_the_page_of_another_day_is_there_is_of_that_day(season_app):
    go(season_app, "record")
    row, day = key_of(season_app, "one_row"), season_app.date_input[0].value
    season_app.session_state[row] = 2
    season_app.run()
    season_app.date_input[0].set_value(day + timedelta(days=1)).run()
    season_app.session_state[row] = 7  # from the box still in view
    season_app.run()
    assert (boxed(season_app.number_input, "one_row").value, season_app.error.len) == (7, 0)
    assert "boxes of **Tue 17 Nov** now" in season_app.info[0].value
    boxed(season_app.number_input, "one_row").set_value(8).run()
    assert not season_app.info, "it was looked at"
    season_app.date_input[0].set_value(day).run()
    assert boxed(season_app.number_input, "one_row").value == 2
    assert not season_app.info


def test_enter_and_a_click_on_an_untouched_form_record_nothing_and_one_on_marks_these_stops_alone(
    season_app, season
):
    go(season_app, "record")
    boxes = [*season_app.number_input, *season_app.text_input]
    assert not [box.key for box in boxes if box.proto.form_id], "a form may be sent by Enter"
    before = season().revision
    for form in ("route", "one", "treatment"):
        send(season_app, form)
        assert "must be said" in season_app.error[0].value
        assert season().revision == before
    route = season().plan(date(2026, 11, 16), keep=False).route.plant
    season_app.session_state[key_of(season_app, "marks")] = {
        "edited_rows": {4: {"found": True}}, "added_rows": [], "deleted_rows": []
    }  # fmt: skip
    send(season_app, "route")
    done = season().history.inspections
    assert done.plant.tolist() == [route[4]]
    assert done.result.tolist() == [1]


def said(app):
    """Return what the boxes for what was found hold, and the marks of the route."""
    one = [boxed(app.number_input, name).value for name in ("one_row", "one_plant", "one_count")]
    result = boxed(app.segmented_control, "one_result").value
    marks = app.session_state[key_of(app, "marks")]["edited_rows"]
    return [*one, result, boxed(app.number_input, "stops_done").value, marks]


EMPTY = [None, None, None, None, None, {}]


def fill(app):
    """Say of the day what was found, and record nothing of it yet."""
    marks = {"edited_rows": {4: {"found": True}}, "added_rows": [], "deleted_rows": []}
    one = {"one_row": 3, "one_plant": 4, "one_count": 7, "one_result": FOUND}
    for name, value in {**one, "stops_done": 5, "marks": marks}.items():
        app.session_state[key_of(app, name)] = value
    app.run()
    assert None not in said(app)


def test_what_was_recorded_does_not_stay_in_the_boxes_and_what_was_not_does(season_app, season):
    go(season_app, "record")
    fill(season_app)
    for form, of in (("route", slice(4, None)), ("one", slice(4))):
        send(season_app, form)
        assert season_app.success[0].value
        assert said(season_app)[of] == EMPTY[of]
        if form == "route":
            assert said(season_app)[:4] == [3, 4, 7, FOUND], "of the other form"
        n = len(season().history.inspections)
        send(season_app, form)
        assert "must be said" in season_app.error[0].value
        assert len(season().history.inspections) == n, "a second click records nothing"


def test_another_day_and_another_season_have_empty_boxes(season_app, season, seasons_folder):
    season().plan(date(2026, 11, 16))
    shutil.copy(seasons_folder / "Gate 2026.gpkg", seasons_folder / "Other 2026.gpkg")
    go(season_app, "record")
    fill(season_app)
    boxed(season_app.file_uploader, "findings_file").upload("a.csv", b"row,plant,found\n1,1,1\n")
    boxed(season_app.number_input, "efficacy").set_value(80)
    boxed(season_app.text_input, "product").set_value("soap")
    season_app.run()
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 17)).run()
    assert said(season_app) == EMPTY
    assert boxed(season_app.file_uploader, "findings_file").value is None
    assert boxed(season_app.number_input, "efficacy").value is None
    assert not boxed(season_app.text_input, "product").value
    fill(season_app)
    season_app.selectbox(key="season").set_value("Other 2026").run()
    assert season_app.query_params["season"] in ("Other 2026", ["Other 2026"])
    assert said(season_app) == EMPTY


@pytest.mark.usefixtures("session")
def test_a_plant_tapped_has_no_result_yet(tmp_path):
    choices = in_season(a_season(tmp_path / "a.gpkg"))
    boxes = FreshBoxes("one_plant", choices)
    boxes.put("one_result", FOUND)
    recording.take_plant(choices, "plants-state", 0)
    assert (boxes.said("one_row"), boxes.said("one_plant")) == (1, 1)
    assert boxes.said("one_tapped") == (1, 1)
    assert boxes.said("one_result") is None


@pytest.mark.usefixtures("session")
def test_of_a_plant_with_two_faces_the_one_tapped_is_recorded_and_none_is_guessed(tmp_path):
    choices = in_season(a_season(tmp_path / "a.gpkg", plot=a_plot(faces=2)))
    boxes, (first, second) = FreshBoxes("one_plant", choices), (0, choices.plot.grid.twin[0])
    for face, plant in ((1, first), (2, second)):
        recording.take_plant(choices, "plants-state", plant)
        assert boxes.said("one_face") == face
        assert recording._plant_typed(choices) == plant
        assert plant_history.tapped(choices) == (plant,)
    boxes.put("one_face", None)
    boxes.put("one_result", FOUND)
    recording._record_one(choices)
    assert not len(choices.season.history.inspections)
    boxes.put("one_face", 2)
    recording._record_one(choices)
    assert choices.season.history.inspections.plant.tolist() == [second]


def test_what_two_people_said_otherwise_is_shown_with_who_said_it(season_app, season):
    plant, day = np.array([7]), np.datetime64("2026-11-16")
    season().record(Inspections.of(plant, np.array([1]), day), "", "Ann")
    season().record(Inspections.of(plant, np.array([0]), day), "", "Ben", confirmed=True)
    for room in ("today", "record", "season"):
        go(season_app, room)
        (shown,) = [one.value for one in season_app.info if "Said otherwise" in one.value]
        assert "Ann" in shown
        assert "Ben" in shown
        assert "plant 8" in shown


def test_which_of_two_results_of_a_plant_holds_is_said_there_and_the_rest_stays(season_app, season):
    plants, day = np.array([6, 7, 8]), np.datetime64("2026-11-16")
    season().record(Inspections.of(plants, np.array([0, 1, 0]), day), "", "Ann")
    season().record(Inspections.of(plants[1:2], np.array([0]), day), "", "Ben", confirmed=True)
    go(season_app, "record")
    press(season_app, "Clean holds")
    assert "1 result taken back" in season_app.success[0].value
    assert not [one for one in season_app.info if "Said otherwise" in one.value]
    left = season().inspections
    assert sorted(zip(left.plant.tolist(), left.result.tolist(), left.who, strict=True)) == [
        (6, 0, "Ann"), (7, 0, "Ben"), (8, 0, "Ann")
    ]  # fmt: skip


def test_what_a_phone_saved_as_not_sent_is_recorded_by_uploading_it(season_app, season):
    on = season().settings.begins
    one = {"id": str(uuid.UUID(int=1)), "at": f"{on}T06:00:00Z", "plant": 3, "result": "found"}
    name = {"season": season().path.stem, "who": "Ann"}
    data = json.dumps({"kind": "fieldmon findings", "findings": [one | name], "photos": []})
    go(season_app, "record")
    boxed(season_app.file_uploader, "findings_file").upload("rescue.json", data.encode()).run()
    season_app.button(key="record_file").click().run()
    assert "1 recorded" in season_app.success[0].value
    seen = season().history.inspections
    assert (seen.plant.tolist(), seen.who.tolist()) == ([3], ["Ann"])


def reloaded(app, **more):
    """Return a new session at the address at which this one stands."""
    words = {**app.query_params, **more}
    return go(opened(**{k: v[0] if isinstance(v, list) else v for k, v in words.items()}), "record")


def test_what_was_not_recorded_yet_is_there_again_after_a_reload(season_app, season):
    go(season_app, "record")
    boxed(season_app.text_input, "product").set_value("soap")
    boxed(season_app.get("time_input"), "treat began").set_value(time(7, 30))
    fill(season_app)
    filled = said(season_app)[:5]
    again = reloaded(season_app, season="Gate 2026")
    assert not again.exception
    assert said(again)[:5] == filled
    assert again.session_state[key_of(again, "marked")] == [5]
    assert boxed(again.text_input, "product").value == "soap"
    assert boxed(again.get("time_input"), "treat began").value == time(7, 30)
    send(again, "route")
    assert season().history.inspections.result.tolist().count(FOUND) == 1
    assert said(again)[4] is None
    assert said(go(go(again, "season"), "record"))[:4] == filled[:4], "and on another page"
    later = reloaded(again, season="Gate 2026", day="2026-11-17")
    assert said(later)[:5] == EMPTY[:5]


def test_a_name_of_nobody_in_the_team_is_typed_in_a_box_that_is_taken_when_it_is_left(
    season_app, season
):
    of_two(season)
    go(season_app, "record")
    box = boxed(season_app.selectbox, "who")
    assert not box.proto.accept_new_options, "such a list loses what is left without Enter"
    box.select("Another name ...").run()
    boxed(season_app.number_input, "one_row").set_value(3)
    boxed(season_app.number_input, "one_plant").set_value(4)
    boxed(season_app.segmented_control, "one_result").set_value(CLEAN)
    send(season_app, "one")
    assert "Type who inspected" in season_app.error[0].value
    boxed(season_app.text_input, "who_else").set_value(" Eva ")
    send(season_app, "one")
    assert season().history.inspections.who.tolist() == ["Eva"]
    assert boxed(season_app.text_input, "who_else").value == " Eva "


def broken_off(monkeypatch, typed=None):
    """Let the next run of Record be broken off before its buttons, as by what is typed then."""
    shown, breaks = contradicting.ask_about_contradictions, [True]

    def ask(choices):
        if breaks:
            breaks.clear()
            if typed is not None:
                typed()
            st.rerun()
        shown(choices)

    monkeypatch.setattr(contradicting, "ask_about_contradictions", ask)


def test_a_press_is_carried_out_though_what_is_typed_next_breaks_its_run_off(
    season_app, season, monkeypatch
):
    def type_next():
        st.session_state[row] = 5

    go(season_app, "record")
    for n, more in enumerate((None, type_next), 1):
        row = key_of(season_app, "one_row")
        for name, value in {"one_row": 3, "one_plant": 3 + n, "one_result": FOUND}.items():
            season_app.session_state[key_of(season_app, name)] = value
        with monkeypatch.context() as patch:
            broken_off(patch, more)
            send(season_app, "one")
        plant = season().history.inspections.plant[-1]
        numbered = season().plant_numbers
        assert len(season().history.inspections) == n
        assert (numbered.line[plant], numbered.number[plant]) == (3, 3 + n)
        assert boxed(season_app.number_input, "one_row").value == (5 if more else None)
        assert boxed(season_app.number_input, "one_plant").value is None
    boxed(season_app.number_input, "efficacy").set_value(90)
    with monkeypatch.context() as patch:
        broken_off(patch)
        send(season_app, "treatment")
    assert len(season().treatments()) == 1
    boxed(season_app.number_input, "stops_done").set_value(3)
    broken_off(monkeypatch)
    send(season_app, "route")
    assert len(season().history.inspections) == 5


def test_what_is_recorded_into_a_season_that_was_renamed_meanwhile_is_said_not_to_be_kept(
    season_app, season
):
    go(season_app, "record")
    for name, value in {"one_row": 3, "one_plant": 4, "one_result": FOUND}.items():
        season_app.session_state[key_of(season_app, name)] = value
    season_app.run()
    seasons_folder.rename("Gate 2026", "Kumeu 2")
    season_app.button(key="record_one").click().run()
    name, new = "\u2068Gate 2026\u2069", "\u2068Kumeu 2\u2069"
    for _ in range(2):
        (said,) = season_app.error
        assert said.value == texts.SEASON_RENAMED_UNKEPT.format(name=name, new=new)
        season_app.run()
    seasons_folder.rename("Kumeu 2", "Gate 2026")
    season_app.run()
    assert not season_app.error
    assert not len(season().history.inspections)
    seasons_folder.rename("Gate 2026", "Kumeu 2")
    season_app.run()
    (said,) = season_app.error
    assert said.value == texts.SEASON_RENAMED.format(name=name, new=new)
    # off the list it has no name to choose
    seasons_folder.set_aside("Kumeu 2")
    season_app.run()
    (said,) = season_app.error
    assert said.value == texts.SEASON_GONE.format(name=name)
