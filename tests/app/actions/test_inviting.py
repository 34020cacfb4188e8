"""A person gets a code once; who has it may record until it is taken back."""

from urllib.parse import parse_qs, urlsplit

import pytest

from app.show import qr_code
from app.state import scout_page
from app.words import texts
from fieldmon.errors import AccessError
from fieldmon.monitoring import scouts
from tests.app.driving import go, press, tap


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
        app.number_input(key=f"invite_{key}").set_value(value)
    press(app, texts.INVITE_BUTTON)


def said_by(app):
    return parse_qs(urlsplit(app.code[0].value).fragment)


def test_a_code_opens_the_season_for_one_person_until_it_is_taken_back(scout, season):
    said = made(scout, first=2, last=9)
    assert said["season"] == ["Gate 2026"]
    who = scouts.who(season(), said["key"][0])
    assert (who.name, who.rows) == ("Ann", (2, 9))
    scout.button(key="take back Ann").click().run()
    with pytest.raises(AccessError):
        scouts.who(season(), said["key"][0])
    assert len(scout.code) == 0


def test_a_code_without_a_name_is_none(scout, season):
    scout.text_input(key="invite_name").set_value(" ")
    press(scout, texts.INVITE_BUTTON)
    assert "must have a name" in scout.error[0].value
    assert scouts.scouts_of(season()) == ()


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
    assert scouts.who(season(), said["key"][0]).name == "Ben"
    pictures = [one.value for one in season_app.get("html") if 'class="qr"' in str(one.value)]
    assert pictures == [qr_code.image(address, texts.INVITE_ALT)]
