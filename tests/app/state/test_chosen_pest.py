"""The pest and the weather of a session come from its box and its files."""

from datetime import date

import pytest

import fieldmon as fm
from app.state import brought_files, chosen_pest
from app.state.brought_files import File
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.options import Upload
from fieldmon.io.packaged import pest_names

TODAY = date(2026, 11, 18)
TOML = b'name = "own"\n[movement]\nper_day = 0.3\n[sources]\nmovement = "A test, 2026"\n'


@pytest.fixture(scope="module")
def plot():
    return fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")


def choose(session, which):
    session[chosen_pest.WHICH] = which


def bring(kind, name, data):
    brought_files.brought()[kind] = File(f"{name} {len(data)}", Upload(name, data), kind)


def test_a_pest_is_none_one_that_comes_along_or_ones_own(session):
    assert chosen_pest.options() == (chosen_pest.NONE, *pest_names(), chosen_pest.OWN)
    assert chosen_pest.pest() is None
    choose(session, "whitefly")
    assert chosen_pest.pest().name == "whitefly"
    choose(session, chosen_pest.OWN)
    assert chosen_pest.pest() is None
    bring(chosen_pest.PEST, "own.toml", TOML)
    assert chosen_pest.pest().name == "own"
    assert chosen_pest.problem(chosen_pest.PEST) is None
    bring(chosen_pest.PEST, "own.toml", TOML.replace(b"0.3", b"3"))
    assert chosen_pest.pest() is None
    assert "own.toml, line 3" in str(chosen_pest.problem(chosen_pest.PEST))


def test_weather_is_read_by_the_plots_clock_and_its_problems_kept(session, plot):
    assert session == {}
    assert chosen_pest.weather(plot, TODAY) is None
    bring(
        chosen_pest.WEATHER, "w.csv", b"date,temp (C)\n2026-11-17,20\n2026-11-18,21\n2026-11-19,22"
    )
    read = chosen_pest.weather(plot, TODAY).value
    assert read.zone == "Asia/Jerusalem"
    assert read.forecast.tolist() == [False, False, True]
    assert len(chosen_pest.messages(plot, TODAY)) == 2
    bring(chosen_pest.WEATHER, "rain.csv", b"date,rain (mm)\n2026-11-17,2\n2026-11-18,1")
    assert chosen_pest.weather(plot, TODAY) is None
    assert "must hold temperatures" in str(chosen_pest.problem(chosen_pest.WEATHER))


def test_records_count_half_after_the_last_generation_where_both_are_known(session, plot):
    usual = PriorSettings()
    assert chosen_pest.prior(usual, plot, TODAY, TODAY) is usual
    choose(session, "spider-mite")
    assert chosen_pest.prior(usual, plot, TODAY, TODAY) is usual
    days = "\n".join(f"2026-10-{day:02d},22.5" for day in range(1, 32))
    bring(chosen_pest.WEATHER, "warm.csv", f"date,temp (C)\n{days}".encode())
    # 146.48 degree-days of 10 a day
    assert chosen_pest.prior(usual, plot, TODAY, TODAY).half_life_days == 15
