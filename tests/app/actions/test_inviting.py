"""A person gets a code once; who has it may record until it is taken back."""

from dataclasses import replace
from datetime import timedelta
from urllib.parse import parse_qs, urlsplit

import pytest

from app.show import qr_code
from app.state import last_heard, scout_page
from app.words import texts
from fieldmon.errors import AccessError
from fieldmon.monitoring.days.day_ahead import WorkPart, route_ahead
from fieldmon.monitoring.phones import scouts
from fieldmon.planning.members import team_of
from tests.app.driving import go, opened, press, tap


@pytest.fixture
def scout(season_app):
    return go(season_app, "scout")


def made(app, name="Ann", **rows):
    """Make a code; return what its address says."""
    ask_for(app, name, **rows)
    return said_by(app)


def ask_for(app, name, **rows):
    app.text_input(key="invite_name").set_value(name)
    for key, value in rows.items():
        boxes = app.text_input if isinstance(value, str) else app.number_input
        boxes(key=f"invite_{key}").set_value(value)
    press(app, texts.INVITE_BUTTON)


def said_by(app):
    return parse_qs(urlsplit(app.code[0].value).fragment)


def test_a_code_opens_the_season_for_one_person_until_it_is_taken_back(scout, season):
    fold = lambda: next(one for one in scout.expander if one.label == texts.INVITE)  # noqa: E731
    assert not fold().proto.expanded
    scout.text_input(key="invite_name").set_value(" ")
    press(scout, texts.INVITE_BUTTON)
    assert "must have a name" in scout.error[0].value
    assert scouts.scouts_of(season()) == ()
    said = made(scout, first=2, last=9)
    assert fold().proto.expanded
    shown = list(scout.main)
    code, name = scout.code[0], scout.text_input(key="invite_name")
    assert shown.index(code) < shown.index(name), "it stands above the boxes that it was made by"
    assert said["season"] == ["Gate 2026"]
    who = scouts.key_owner(season(), said["key"][0])
    assert (who.name, who.rows) == ("Ann", (2, 9))
    scout.button(key="take back Ann").click().run()
    with pytest.raises(AccessError):
        scouts.key_owner(season(), said["key"][0])
    assert len(scout.code) == 0
    assert not fold().proto.expanded


def test_it_says_where_phones_cannot_come(scout, monkeypatch):
    assert any("--lan" in one.value for one in scout.info)
    monkeypatch.setenv(scout_page.ADDRESS, "https://192.168.1.5:8501")
    made(scout)
    assert scout.code[0].value.startswith("https://192.168.1.5:8501/scouting/#")
    assert not any("--lan" in one.value for one in scout.info)


def test_the_morning_sends_a_link_with_a_key_of_that_person(season_app, season, monkeypatch):
    monkeypatch.setenv(scout_page.ADDRESS, "https://192.168.1.5:8501")
    tap(season_app, "do_send")
    ask_for(season_app, "Ben", first=1, last=3)
    tap(season_app, "do_send")  # a browser keeps the window open, this one draws the page anew
    said, address = said_by(season_app), season_app.code[0].value
    assert address.startswith("https://192.168.1.5:8501/scouting/#season=Gate+2026&key=")
    assert scouts.key_owner(season(), said["key"][0]).name == "Ben"
    pictures = [one.value for one in season_app.get("html") if 'class="qr"' in str(one.value)]
    assert pictures == [qr_code.image(address, texts.INVITE_ALT)]


def test_a_second_code_says_that_the_earlier_one_is_over_or_that_plants_are_shared(scout, season):
    said = made(scout)
    assert not scout.success
    made(scout)
    assert "earlier code of \u2068Ann\u2069 no longer holds" in scout.success[0].value
    with pytest.raises(AccessError):
        scouts.key_owner(season(), said["key"][0])
    made(scout, "Ben")
    assert "shares these plants with \u2068Ann\u2069" in scout.success[0].value
    ask_for(scout, "Cem", first=1, last=2)
    assert "overlap" in scout.error[0].value


def test_where_several_are_out_today_says_that_the_route_shown_is_nobodys(season_app, season):
    on = season_app.date_input[0].value
    for name in ("Ann", "Dan"):
        assert not any(one.value == texts.ROUTE_OF_NOBODY for one in season_app.run().info)
        scouts.let_in(season(), name)
        route_ahead(season(), on, WorkPart(None, name))
    assert any(one.value == texts.ROUTE_OF_NOBODY for one in season_app.run().info)
    assert any(" in all" in one.value for one in season_app.markdown)


def test_the_names_of_the_team_are_offered_and_any_other_needs_rows(season_app, season):
    before = season().settings
    season().change(replace(before, team=team_of(2)), before)
    scout = go(season_app, "scout")
    box = scout.selectbox(key="invite_name")
    assert box.options == ["robot-1", "robot-2"]
    box.set_value("robot-2")
    press(scout, texts.INVITE_BUTTON)
    assert scouts.key_owner(season(), said_by(scout)["key"][0]).name == "robot-2"
    assert not scout.error


def test_who_is_out_stands_in_the_scout_room_with_what_each_did(scout, season):
    made(scout, first=2, last=9)
    (title,) = (one.value for one in scout.markdown if "rows 2 to 9" in one.value)
    assert "Ann" in title
    said = next(one.value for one in scout.caption if "code made" in one.value)
    assert texts.OUT_SILENT in said
    ann = scouts.scouts_of(season())[0]
    last_heard.note(season().path, ann.name, season().settings.begins - timedelta(days=1))
    said = next(one.value for one in scout.run().caption if "code made" in one.value)
    assert texts.OUT_SILENT not in said
    assert any("Has the plan of" in one.value for one in scout.markdown)


def test_rows_of_a_code_that_may_be_others_by_their_names_are_refused(season_named):
    app = go(opened(season_named.path.stem), "scout")
    for rows in ({"first": "2"}, {"first": "1", "last": "2"}):
        ask_for(app, "Ann", **rows)
        assert "2 may be any of rows 2–3 here" in app.error[0].value
    assert not scouts.scouts_of(season_named)
    ask_for(app, "Ann", first="5A", last="c")
    (one,) = scouts.scouts_of(season_named)
    assert one.rows == (1, 2)
