"""A person gets a code once; who has it may record until it is taken back."""

import re
from urllib.parse import parse_qs, urlsplit

import pytest

from app.actions import inviting
from app.words import texts
from fieldmon.errors import AccessError
from fieldmon.monitoring import scouts
from tests.app.driving import go, press


@pytest.fixture
def scout(season_app):
    return go(season_app, "scout")


def made(app, name="Ann", **rows):
    app.text_input(key="invite_name").set_value(name)
    for key, value in rows.items():
        app.number_input(key=f"invite_{key}").set_value(value)
    press(app, texts.INVITE_BUTTON)
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
    monkeypatch.setenv(inviting.ADDRESS, "https://192.168.1.5:8501")
    made(scout)
    assert scout.code[0].value.startswith("https://192.168.1.5:8501/scouting/#")
    assert not any("--lan" in one.value for one in scout.info)


def test_a_code_is_a_picture_of_its_own():
    picture = inviting.code("https://192.168.1.5:8501/scouting/#season=x&key=y")
    assert re.fullmatch(r"data:image/svg\+xml;base64,[A-Za-z0-9+/=]+", picture)
