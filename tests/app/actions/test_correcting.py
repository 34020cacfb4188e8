"""The day or time of one inspection is corrected."""

from datetime import date, time

import numpy as np

from app.words import texts
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.plot.grid import plant_at
from tests.app.driving import boxed, go, press


def test_the_day_and_time_of_one_inspection_are_corrected_and_taken_back(season_app, season):
    def correct():
        season_app.button(key="correct_when").click().run()
        assert not season_app.exception

    plant = int(plant_at(season().plot.grid, 3, 4))
    told = Inspections.of([plant], [FOUND], date(2026, 11, 17), second=[22_000])
    season().record(told, "phone", "Dana")
    go(season_app, "record")
    assert texts.CORRECT_WHEN not in [one.label for one in season_app.expander]
    boxed(season_app.number_input, "one_row").set_value(3)
    boxed(season_app.number_input, "one_plant").set_value(4).run()
    assert texts.CORRECT_WHEN in [one.label for one in season_app.expander]
    (said,) = boxed(season_app.selectbox, "when_which").options
    assert said.startswith("Tue 17 Nov 06:06: found · ")
    correct()
    assert season_app.error[0].value == texts.CORRECT_UNSAID
    boxed(season_app.date_input, "when_day").set_value(date(2026, 11, 15))
    correct()
    assert "must be of this season" in season_app.error[0].value
    boxed(season_app.date_input, "when_day").set_value(date(2026, 11, 16))
    boxed(season_app.time_input, "when_time").set_value(time(5, 45))
    correct()
    assert "1 correction taken" in season_app.success[0].value
    held = season().history.inspections
    assert (str(held.date[0]), held.second.tolist()) == ("2026-11-16", [5.75 * 3600])
    # the box shows it as it is now, and the list of recordings which one it was
    assert boxed(season_app.selectbox, "when_which").value.said.startswith("Mon 16 Nov 05:45")
    (line,) = [one.value for one in season_app.markdown if "corrections:" in one.value]
    assert "corrections: row 3, plant 4: found" in line
    press(season_app, "Undo")
    assert season().history.inspections.second.tolist() == [22_000]
    press(season_app, "Redo")
    assert season().history.inspections.second.tolist() == [5.75 * 3600]


def test_a_correction_that_contradicts_another_result_is_taken_only_when_both_hold(
    season_app, season
):
    plant = int(plant_at(season().plot.grid, 3, 4))
    days = np.array(["2026-11-16", "2026-11-17"], "datetime64[D]")
    season().record(Inspections.of([plant] * 2, [FOUND, CLEAN], days), "phone", "Dana")
    go(season_app, "record")
    boxed(season_app.number_input, "one_row").set_value(3)
    boxed(season_app.number_input, "one_plant").set_value(4).run()
    boxed(season_app.date_input, "when_day").set_value(date(2026, 11, 16)).run()
    season_app.button(key="correct_when").click().run()
    assert "recorded as found, now clean" in season_app.error[0].value
    assert str(season().history.inspections.date[1]) == "2026-11-17"
    season_app.button(key="correct_both").click().run()
    assert "1 correction taken" in season_app.success[0].value
    assert str(season().history.inspections.date[1]) == "2026-11-16"
    assert "correct_both" not in [one.key for one in season_app.button]
