"""The pest and its weather are chosen on Plot & data, with their figures and sources."""

from datetime import date, timedelta

from app.state import chosen_pest
from app.words import texts
from tests.app.driving import begun, go, press, texts_of

TODAY = date(2026, 11, 16)
OWN = b'name = "mite"\n[movement]\nper_day = -1\n[sources]\nmovement = "A test, 2026"\n'


def station(low=22.5, high=22.5, days=40):
    """Return days of a station about today: 10 degree-days a day above 12.5 °C."""
    first = TODAY - timedelta(days=20)
    rows = [f"{first + timedelta(days=day)},{low},{high}" for day in range(days)]
    return ("\n".join(["Date,Tmin (C),Tmax (C)", *rows])).encode()


def bring(app, kind, name, data):
    app.file_uploader(key=f"{kind}_file").upload(name, data).run()
    assert not app.exception


def test_a_pest_has_its_figures_and_sources_ages_records_and_a_season_says_its_next_generation(app):
    go(app, "plot")
    assert texts.PEST_NOTE in texts_of(app)
    app.selectbox(key=chosen_pest.WHICH).set_value("spider-mite").run()
    assert not app.exception
    said = texts_of(app)
    assert "Bounfour & Tanigoshi 2001" in said
    assert "146.48 degree-days above" in said
    assert "Nobody measured how plants infest plants." in said
    assert "0.02 a day" in said
    bring(app, chosen_pest.WEATHER, "station.csv", station())
    assert "Columns of weather" in texts_of(app)
    # one generation of 15 days: records count half after that
    assert "taken as forecast" in texts_of(app)
    begun(app)
    go(app, "season")
    assert not app.exception
    said = texts_of(app)
    # 146.48 degree-days of 10 a day, today's the first
    assert "Next generation around 30 Nov." in said
    assert "Those of that day: egg." in said
    go(app, "plot")
    assert "Pest of this season: Two-spotted spider mite, by degree-days." in texts_of(app)


def test_a_pest_of_ones_own_that_is_wrong_is_refused_with_its_line(app):
    go(app, "plot")
    app.selectbox(key=chosen_pest.WHICH).set_value(chosen_pest.OWN).run()
    bring(app, chosen_pest.PEST, "mite.toml", OWN)
    assert any("mite.toml, line 3" in one.value for one in app.error)


def test_a_season_takes_a_pest_later_and_weather_alone_is_refused(season_app, season):
    go(season_app, "plot")
    season_app.selectbox(key=chosen_pest.WHICH).set_value("whitefly").run()
    press(season_app, texts.PEST_USE)
    assert not season_app.exception
    assert season().settings.pest.name == "whitefly"
    go(season_app, "season")
    assert texts.NEEDS_WEATHER in texts_of(season_app)
    go(season_app, "plot")
    season_app.selectbox(key=chosen_pest.WHICH).set_value(chosen_pest.NONE).run()
    bring(season_app, chosen_pest.WEATHER, "station.csv", station())
    press(season_app, texts.PEST_USE)
    assert any(texts.WEATHER_NEEDS_PEST in one.value for one in season_app.error)
