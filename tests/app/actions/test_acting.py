"""What was changed a moment before a button is pressed counts already."""

from datetime import date

from tests.app.driving import boxed, go


def hours(app):
    return next(one for one in app.slider if one.label == "Working hours")


def test_a_season_begins_with_the_hours_chosen_just_before(app, season):
    hours(app).set_value(4.0)
    app.button(key="do_begin").click().run()
    assert not app.exception
    assert "has begun" in app.success[0].value
    assert season().settings.robot.hours == 4.0


def test_a_find_said_of_a_day_is_none_of_the_day_chosen_just_before(season_app, season):
    go(season_app, "record")
    boxed(season_app.number_input, "one_row").set_value(1)
    boxed(season_app.number_input, "one_plant").set_value(1)
    boxed(season_app.segmented_control, "one_result").set_value(1)
    day = next(box for box in season_app.date_input if box.key.startswith("day "))
    day.set_value(date(2026, 11, 17))
    season_app.button(key="record_one").click().run()
    assert not season_app.exception
    assert "must be said" in season_app.error[0].value
    assert not len(season().history.inspections)
