"""What contradicts is shown, waits for a word, and is settled."""

import shutil
from datetime import date

import numpy as np

from app.state import unconfirmed
from app.state.unconfirmed import Unconfirmed
from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.plot.grid import plant_at
from tests.app.actions.test_recording import reloaded, send
from tests.app.driving import boxed, go, plot_name, texts_of


def contradicted(app, season, n=4):
    """Record finds, then say of the same plants and one more that they are clean."""
    season().plan(date(2026, 11, 16))
    plants = season().kept_route(date(2026, 11, 16))[:n]
    season().record(Inspections.of(plants, np.ones(n, int), np.datetime64("2026-11-16")), "file")
    go(app, "record")
    said_clean(app, n)
    assert len(season().history.inspections) == n, "nothing is added silently"


def said_clean(app, n):
    """Say of those plants and one more that they are clean."""
    boxed(app.number_input, "stops_done").set_value(n + 1)
    send(app, "route")
    assert f"{n} results from route table contradict" in app.warning[0].value
    assert "recorded as found, now clean" in texts_of(app)


def test_what_contradicts_the_same_day_is_shown_and_confirmed(season_app, season):
    contradicted(season_app, season)
    for key, results in (
        ("record_none", [1, 1, 1, 1]),
        ("leave_out", [1, 1, 1, 1, 0]),
        ("confirm", [1, 1, 1, 1, 0, 0, 0, 0, 0]),
    ):
        if key != "record_none":
            said_clean(season_app, 4)
        season_app.button(key=key).click().run()
        assert not season_app.exception
        assert not season_app.warning
        assert season().history.inspections.result.tolist() == results


def test_what_was_left_out_of_a_file_is_said_once_what_contradicts_is_settled(season_app, season):
    plant, day = np.array([plant_at(season().plot.grid, 1, 1)]), np.datetime64("2026-11-16")
    season().record(Inspections.of(plant, np.array([CLEAN]), day), "file")
    go(season_app, "record")
    for key, result, n in (("leave_out", 1, 2), ("holds", 1, 2), ("confirm", 0, 3)):
        rows = b"row,number,found\n1,1,%d\n4,1,0\n4,2,maybe\n9999,1,1\n" % result
        boxed(season_app.file_uploader, "findings_file").upload("contra.csv", rows).run()
        season_app.button(key="record_file").click().run()
        assert "1 result from contra.csv contradicts" in season_app.warning[0].value
        season_app.button(key=key).click().run()
        assert len(season().history.inspections) == n
        (said,) = (one.value for one in season_app.warning)
        assert "recorded" in said
        assert "maybe" in said
        assert "9999" in said


def test_the_new_results_hold_as_corrections_until_these_are_undone(season_app, season):
    contradicted(season_app, season)
    assert season_app.button(key="holds").label == "The new ones hold"
    season_app.button(key="holds").click().run()
    assert not season_app.exception
    assert "4 corrections taken" in season_app.success[0].value
    assert season().history.inspections.result.tolist() == [0] * 5
    assert season().verify() == ()
    corrections = next(one for one in season().batches() if one.kind == "corrections")
    season_app.button(key=f"undo {corrections.number}").click().run()
    assert sorted(season().history.inspections.result.tolist()) == [0, 1, 1, 1, 1]
    season_app.button(key=f"redo {corrections.number}").click().run()
    assert season().history.inspections.result.tolist() == [0] * 5


def test_one_contradiction_is_asked_about_as_one_and_where_it_is_all_there_are_no_others(
    season_app, season
):
    season().plan(date(2026, 11, 16))
    plant, day = season().kept_route(date(2026, 11, 16))[:1], np.datetime64("2026-11-16")
    season().record(Inspections.of(plant, np.array([1]), day), "file")
    go(season_app, "record")
    boxed(season_app.number_input, "stops_done").set_value(1)
    send(season_app, "route")
    assert season_app.button(key="holds").label == "The new one holds"
    assert season_app.button(key="confirm").label == "Record this too, both hold"
    # a day is said as everywhere on the page
    assert "on Mon 16 Nov: recorded as found, now clean" in texts_of(season_app)
    assert season_app.warning[0].value.endswith("Nothing is recorded yet. Which holds?")
    assert "leave_out" not in [button.key for button in season_app.button]


def test_what_waits_is_asked_about_neither_on_another_day_nor_in_another_season(season_app, season):
    contradicted(season_app, season)
    shutil.copy(season().path, season().path.with_name("Other.gpkg"))
    for day, asked in ((17, 0), (16, 1)):
        season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, day)).run()
        said = [one.value for one in season_app.warning if "contradict" in one.value]
        assert len(said) == asked
    season_app.selectbox(key="season").set_value("Other").run()
    assert plot_name(season_app) == "Gate"
    assert not season_app.warning


def test_what_contradicts_nothing_any_more_can_be_recorded(season_app, season):
    contradicted(season_app, season)
    season().undo()
    season_app.run()
    assert "5 results from route table are not recorded yet" in season_app.warning[0].value
    assert not [one for one in season_app.button if one.key in ("leave_out", "confirm")]
    season_app.button(key="record_these").click().run()
    assert not season_app.warning
    assert season().history.inspections.result.tolist() == [0] * 5


def test_those_that_are_known_are_none_of_the_others_to_record(season_app, season):
    route = season().kept_route(date(2026, 11, 16))
    plants = route if len(route) else np.arange(8)
    on = np.datetime64("2026-11-16")
    season().record(Inspections.of(plants[:5], [1, 0, 0, 0, 1], on, count=[4, 0, 0, 0, 7]), "file")
    brought = Inspections.of(plants[:7], [0, 0, 0, 0, 1, 0, 0], on, count=[np.nan] * 4 + [7, 0, 0])
    for taken, label in ((7, "Leave these out, record 2 others"), (5, "Leave these out")):
        kept = Unconfirmed(season().key, "2026-11-16", brought.take(slice(taken)), "copy", "", ())
        season_app.session_state[unconfirmed._KEY] = kept
        go(season_app, "record")
        assert season_app.button(key="leave_out").label == label


def test_a_file_that_says_both_of_a_plant_leaves_out_both_and_neither_is_the_new_one(
    season_app, season
):
    go(season_app, "record")
    rows = b"date,row,number,result\n" + b"".join(
        b"2026-11-16,%s\n" % row for row in (b"7,1,clean", b"7,2,clean", b"7,2,found")
    )
    boxed(season_app.file_uploader, "findings_file").upload("both.csv", rows).run()
    season_app.button(key="record_file").click().run()
    assert "brought as clean and as found" in texts_of(season_app)
    assert "holds" not in [button.key for button in season_app.button]
    label = season_app.button(key="leave_out").label
    assert label == "Leave these out, record the other one"
    season_app.button(key="leave_out").click().run()
    assert season().inspections.plant.tolist() == [plant_at(season().plot.grid, 7, 1)]
    said = [one.value for one in (*season_app.success, *season_app.warning)]
    assert any("2 contradicting results left out." in one for one in said)


def test_each_plant_that_contradicts_is_answered_by_itself_and_the_rest_waits_on(
    season_app, season
):
    contradicted(season_app, season)
    plants = season().kept_route(date(2026, 11, 16))[:5].tolist()
    for which, plant in zip(("new", "both", "leave"), plants, strict=False):
        season_app.button(key=f"{which} {plant} 2026-11-16").click().run()
        assert not season_app.exception
    held = season().history.inspections
    said = {plant: sorted(held.result[held.plant == plant].tolist()) for plant in plants}
    assert said == dict(zip(plants, ([0], [0, 1], [1], [1], []), strict=True))
    (asked,) = (one.value for one in season_app.warning)
    assert "1 result from route table contradicts" in asked
    season_app.button(key="leave_out").click().run()
    held = season().history.inspections
    assert held.result[held.plant == plants[3]].tolist() == [1]
    assert held.result[held.plant == plants[4]].tolist() == [0]


def test_what_waited_when_the_page_was_loaded_anew_is_said_not_to_be_recorded(season_app, season):
    contradicted(season_app, season)
    again = reloaded(season_app, season="Gate 2026")
    for _ in range(2):  # until somebody reads it
        go(again, "record")
        (said,) = (one.value for one in again.warning)
        assert "5 results from route table were not recorded" in said
        again = reloaded(again, season="Gate 2026")
    go(again, "record").button(key="record_none").click().run()
    assert not again.warning
