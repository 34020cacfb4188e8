"""The language of a session: its box, the address, the browser."""

from app.state import chosen_language
from tests.app.driving import map_of, opened, texts_of


def test_the_language_is_chosen_in_its_box_and_kept_in_the_address(speaking):
    app = opened()
    app.selectbox(key=chosen_language.KEY).set_value("he").run()
    speaking("he")
    assert not app.exception
    assert "משק לדוגמה" in app.selectbox(key="season").options
    assert app.query_params["lang"] == "he"
    sent = map_of(app)
    assert (sent["language"], sent["direction"]) == ("he", "rtl")
    assert app.selectbox(key="date_like").value == "16.11.2026"
    app.selectbox(key=chosen_language.KEY).set_value("en").run()
    speaking("en")
    assert "lang" not in app.query_params
    assert app.selectbox(key="date_like").value == "2026-11-16"
    assert map_of(app)["direction"] == "ltr"


def test_an_address_in_a_language_nobody_speaks_is_english():
    app = opened(lang="xx")
    assert not app.exception
    assert "Plan" in texts_of(app) or app.selectbox(key=chosen_language.KEY).value == "en"


def test_two_sessions_speak_two_languages(speaking):
    first, second = opened(lang="he"), opened(lang="es")
    for code, app in (("he", first), ("es", second), ("he", first)):
        speaking(code)
        app.run()
    assert "משק לדוגמה" in first.selectbox(key="season").options
    assert "Finca de muestra" in second.selectbox(key="season").options
