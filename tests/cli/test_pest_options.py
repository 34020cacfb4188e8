"""A pest and its weather are named alike in every command that spreads insects."""

import csv
from dataclasses import replace
from datetime import date, timedelta

import pytest
from typer import main as typer_main

from fieldmon.cli.main import app
from fieldmon.cli.pest_options import PestName
from fieldmon.cli.status import lines
from fieldmon.io.packaged import pest_names
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import Season
from fieldmon.monitoring.settings.settings import MonitoringSettings
from tests.cli.estate import BEGINS, MITES, ZIP
from tests.monitoring.seasons import a_season

PLOT = (ZIP, "--feature", "Nursery", "--records", MITES)


@pytest.fixture
def station(tmp_path):
    """Write 40 warm days about the season's first: 10 degree-days a day above 12.5 °C."""
    path, first = tmp_path / "station.csv", date.fromisoformat(BEGINS) - timedelta(days=20)
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(["Date", "Tmin (F)", "Tmax (F)", "Wind (km/h)"])
        for day in range(40):
            table.writerow([first + timedelta(days=day), 72.5, 72.5, 9])
    return path


def test_a_season_believes_its_pests_nights_and_says_its_next_generation(run, tmp_path, station):
    words = ["init", "s.gpkg", *PLOT, "--begins", BEGINS, "--hours", "1"]
    code, _, err, _ = run(*words, "--pest", "spider-mite", "--weather", station)
    assert code == 0, err
    assert "pest: Two-spotted spider mite, by degree-days" in err
    assert "doubtful: movement" in err
    assert "Columns of weather: Tmin (F), Tmax (F), Wind (km/h)" in err
    # 146.48 degree-days of 10 a day
    assert "Records count half after 15 days" in err
    kept = Season(tmp_path / "s.gpkg")
    settings = kept.settings
    assert settings.pest.name == "spider-mite"
    assert len(settings.weather) == 40
    assert settings.prior.half_life_days == 15
    on = settings.begins + timedelta(days=2)
    said = "\n".join(lines(kept, kept.status(on)))
    comes = settings.begins + timedelta(days=14)
    assert f"30 degree-days above 12.5 °C since {BEGINS} of 146.48 a generation" in said
    assert f"the next around {comes}. (egg)" in said
    warm = kept.morning(on)
    code, _, err, _ = run("change", "s.gpkg", "--pest", "none")
    assert code == 0, err
    without = Season(tmp_path / "s.gpkg")
    assert without.settings.pest is None
    assert without.settings.prior.half_life_days == 14
    assert "Records count half after 14 days." in err
    assert "next around" not in "\n".join(lines(without, without.status(on)))
    # 22.5 °C is warmer than the settings of any pest
    assert warm.sum() > without.morning(on).sum()
    code, _, err, _ = run("undo", "s.gpkg", "--change")
    assert code == 0, err
    assert Season(tmp_path / "s.gpkg").settings.pest == settings.pest


def test_a_pest_whose_file_says_no_rate_spreads_as_usual_and_it_is_said(run, tmp_path):
    pest = tmp_path / "seen.toml"
    pest.write_text('name = "seen"\ncount_means = "mites"\n', encoding="utf-8")
    usual = "assumed: chance a night to infest a neighbour 2 %"
    words = [*PLOT, "--begins", BEGINS, "--hours", "1"]
    code, _, err, _ = run("init", "s.gpkg", *words, "--pest", pest)
    assert (code, usual in err) == (0, True)
    season = Season(tmp_path / "s.gpkg")
    assert [one.value for one in season.assumed() if one.setting == "rate_per_day"] == [0.02]
    code, _, err, _ = run("change", "s.gpkg", "--spread", "0.1")
    assert (code, "stands in its file, under [movement]" in err) == (2, True)
    assert usual in "\n".join(lines(season, season.status(season.settings.begins)))
    code, _, err, _ = run("change", "s.gpkg", "--pest", "spider-mite")
    assert (code, usual in err) == (0, False)
    assert "rate_per_day" not in {one.setting for one in season.assumed()}


def test_insects_are_simulated_and_days_planned_by_the_pest(run, tmp_path, station):
    words = [*PLOT, "--pest", "whitefly", "--weather", station, "--date", BEGINS, "--hours", "1"]
    code, out, err, _ = run("simulate", *words, "--days", 2, "--sampler", "naive")
    assert code == 0, err
    assert "naive" in out
    code, _, err, _ = run("plan", *words, "--no-bound")
    assert code == 0, err
    assert "Records count half after" in err
    pest = tmp_path / "seen.toml"
    pest.write_text(
        'name = "seen"\n[detection]\nchance = 0.25\n[sources]\ndetection = "A test, 2026"\n',
        encoding="utf-8",
    )
    code, _, err, _ = run("plan", *PLOT, "--pest", pest, "--date", BEGINS, "--hours", "1")
    assert code == 0, err
    # its own chance of detection is no assumption
    assert "chance to find what is there" not in err


def test_a_robot_compared_with_others_has_the_season_that_simulate_shows(run, tmp_path, station):
    words = [*PLOT, "--pest", "spider-mite", "--weather", station, "--date", BEGINS]
    words += ["--hours", "0.4", "--days", 3, "--sampler", "naive"]
    code, _, err, _ = run("simulate", *words, "-o", "season.csv")
    assert code == 0, err
    code, out, err, _ = run("compare", *words, "--robots", "1-2", "--seeds", 2)
    assert code == 0, err
    assert "Nursery spider-mite (naive, sections): A second robot would save" in out
    alone = [one for one in table(tmp_path / "robots.csv") if one["robots"] == "1"]
    left = [int(one["infested_left"]) for one in table(tmp_path / "season.csv")]
    assert float(alone[0]["infested_plant_days"]) == sum(left)
    assert alone[0]["spread"] == "nan"
    first = (tmp_path / "robots.csv").read_text()
    code, again, err, _ = run("compare", *words, "--robots", "1-2", "--seeds", 2)
    assert (again, (tmp_path / "robots.csv").read_text()) == (out, first), "it goes on as it was"
    refused = "compare", *words, "--spread", 0.1, "--to", "one"
    assert "--spread and --to go without --pest" in run(*refused)[2]


def test_square_plots_are_compared_by_a_pest_in_one_line_of_the_chart(run, tmp_path):
    words = ["--hectares", 0.05, "--hectares", 0.1, "--pest", "whitefly", "--hours", "0.3"]
    code, _, err, _ = run("compare", *words, "--days", 2, "--seeds", 2, "--robots", "1-2")
    assert code == 0, err
    assert err.count("pest: ") == 1
    assert "as the pest spreads" in (tmp_path / "robots.html").read_text()


def table(path):
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--pest", "mote"], "A pest must be a file, or one of thesis, spider-mite"),
        (["--weather", "STATION"], "--weather goes with --pest"),
        (["--pest", "thesis", "--weather-option", "zone=UTC"], "--weather-option goes with"),
        (["--pest", "thesis", "--spread", "0.1"], "--spread goes without --pest"),
        (["--pest", "thesis", "--weather", "STATION", "--weather-option", "zone=Mars"],
         "A time zone must be named"),
    ],
)  # fmt: skip
def test_what_does_not_go_together_is_a_sentence_and_no_file(run, station, words, says):
    told = [str(station) if word == "STATION" else word for word in words]
    code, _, err, made = run("init", "s.gpkg", *PLOT, *told)
    assert (code, made) == (2, set())
    assert says in err


def test_what_the_weather_leaves_open_is_asked_with_the_option_that_answers(run, tmp_path):
    (tmp_path / "w.csv").write_text("date,temp (C)\n03/04/2026,20\n04/04/2026,21\n")
    code, _, err, made = run("init", "s.gpkg", *PLOT, "--pest", "thesis", "--weather", "w.csv")
    assert (code, made) == (2, set())
    assert '--weather-option date_order="dmy"' in err


def test_weather_of_a_season_without_a_pest_is_refused(run, season, station):
    code, _, err, _ = run("change", season, "--weather", station)
    assert (code, "this season has none" in err) == (2, True)
    code, _, err, _ = run("change", season, "--spread", "0.1", "--pest", "thesis")
    assert (code, "--spread goes without a pest" in err) == (2, True)
    code, _, err, _ = run("change", season, "--no-trace", "--pest", "thesis")
    assert (code, "needs its finds traced" in err) == (2, True)


def test_the_help_names_every_pest_that_comes_along():
    (told,) = PestName.__metadata__
    assert all(name in told.help for name in pest_names())


def test_every_command_that_believes_or_simulates_nights_takes_a_pest():
    commands = typer_main.get_command(app).commands
    for name in ("plan", "init", "change", "simulate"):
        flags = {flag for one in commands[name].params for flag in one.opts}
        assert {"--pest", "--weather"} <= flags, name


def test_a_season_begun_before_it_took_its_pests_values_says_so_in_plan_and_status(
    run, tmp_path, monkeypatch
):
    file = tmp_path / "season.gpkg"
    with monkeypatch.context() as before:
        before.setattr(MonitoringSettings, "of_its_pest", lambda self, _=None: self)
        a_season(file, pest=replace(shipped_pest("spider-mite"), detection=0.6))
    (said,) = Season(file).verify()
    assert "an inspection finds 60 % of what is there, not 84 %." in said
    for command in ("plan", "status"):
        code, _, err, _ = run(command, file)
        assert (code, err.count(f"doubtful: {said}")) == (0, 1), err
