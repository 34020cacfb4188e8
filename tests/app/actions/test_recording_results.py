"""What is said once results are recorded: of which days they are."""

from datetime import UTC, date, datetime

from app.words import texts
from fieldmon.infestation.inspections import FOUND
from fieldmon.plot import local_clock
from tests.app.actions.test_recording import key_of, send
from tests.app.driving import boxed, go


def test_a_file_of_another_day_says_of_which_day_it_was_recorded(season_app, season):
    go(season_app, "record")
    season_app.date_input[0].set_value(date(2026, 11, 17)).run()
    rows = b"row,number,found,date\n1,1,1,2026-11-16\n4,1,0,2026-11-16\n"
    boxed(season_app.file_uploader, "findings_file").upload("day16.csv", rows).run()
    season_app.button(key="record_file").click().run()
    assert season().history.inspections.date.astype(str).tolist() == ["2026-11-16"] * 2
    shown = [*season_app.success, *season_app.warning]
    assert any(
        "Recorded for Mon 16 Nov; this page is about Tue 17 Nov." in one.value for one in shown
    )


def test_what_is_recorded_of_a_day_that_has_not_come_is_said_on_the_pages_of_today(
    season_app, season
):
    go(season_app, "record")
    season_app.date_input[0].set_value(date(2026, 11, 19)).run()
    for name, value in {"one_row": 3, "one_plant": 4, "one_result": FOUND}.items():
        season_app.session_state[key_of(season_app, name)] = value
    season_app.run()
    send(season_app, "one")
    said = "of **Thu 19 Nov**, which has not come: it is Mon 16 Nov."
    assert any("1 recorded" in one.value and said in one.value for one in season_app.warning)
    season_app.date_input[0].set_value(date(2026, 11, 16)).run()
    for page in ("today", "season"):
        go(season_app, page)
        (told,) = (one.value for one in season_app.warning if said in one.value)
        assert "undo it in *Record*" in told
        assert f"corrected there, too: choose its plant, then *{texts.CORRECT_WHEN}*." in told
    season().undo()
    assert not any(said in one.value for one in go(season_app, "today").warning)


def test_past_midnight_the_answer_names_the_day_that_a_find_was_kept_for(
    season_app, season, monkeypatch
):
    go(season_app, "record")
    for name, value in {"one_row": 3, "one_plant": 4, "one_result": FOUND}.items():
        season_app.session_state[key_of(season_app, name)] = value
    season_app.run()
    late = datetime(2026, 11, 17, 0, 5, tzinfo=UTC)
    monkeypatch.setattr(local_clock, "utc_now", lambda: late)
    season_app.button(key="record_one").click().run()
    assert season().history.inspections.date.astype(str).tolist() == ["2026-11-16"]
    assert "Recorded for Mon 16 Nov; this page is about Tue 17 Nov." in season_app.success[0].value
