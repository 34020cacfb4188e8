"""`fieldmon treat`: a plot or a part of it was sprayed."""

from datetime import date, timedelta

import geopandas as gpd
import numpy as np
import pytest
import shapely

from fieldmon.monitoring import Season
from fieldmon.plot.local_clock import local_clock
from tests.cli.estate import BEGINS

ON = date.fromisoformat(BEGINS)


def test_the_chance_falls_by_the_efficacy_and_a_treatment_counts_once(run, season):
    before = Season(season).evening(ON)
    code, out, err, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert code == 0, err
    assert "Treatment noted as batch" in out
    assert Season(season).evening(ON) == pytest.approx(before / 2)
    _, out, _, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert "nothing changed" in out
    assert Season(season).evening(ON) == pytest.approx(before / 2)


def test_only_the_area_that_was_treated_is_cleaner(run, season, tmp_path):
    kept = Season(season)
    west, south, east, north = kept.plot.field.boundary.bounds
    half = shapely.box(west - 1e-4, south - 1e-4, (west + east) / 2, north + 1e-4)
    gpd.GeoDataFrame(geometry=[half], crs=4326).to_file(tmp_path / "half.geojson")
    before = kept.evening(ON)
    words = ["--efficacy", "0.8", "--area", "half.geojson", "--product", "soap"]
    code, _, err, _ = run("treat", season, *words, "--date", BEGINS)
    assert code == 0, err
    after = Season(season).evening(ON)
    inside = shapely.contains_xy(half, kept.plot.grid.lonlat())
    assert inside.any()
    assert not inside.all()
    assert after[inside] == pytest.approx(0.2 * before[inside])
    # clean neighbours may be taken for cleaner, never for less clean
    assert (after[~inside] <= before[~inside] + 1e-12).all()
    assert np.median(after[~inside] / before[~inside]) == pytest.approx(1.0, abs=0.01)


def test_what_was_applied_is_kept_and_what_to_beware_of_is_said(run, season, tmp_path):
    (tmp_path / "labels.csv").write_text(
        "product,max dose,unit,waiting days,re-entry hours,IRAC\nAcarol,0.5,l/ha,7,12,6\n"
    )
    run("labels", season, "labels.csv")
    run("change", season, "--harvest", "2026-11-05", "--who", "Ann")
    words = ["--efficacy", "0.8", "--rows", "1-2", "--product", "Acarol", "--dose", "0.6 l/ha"]
    words += ["--ended", "09:30", "--operator", "Ann", "--reason", "mites", "--date", BEGINS]
    code, out, err, _ = run("treat", season, *words)
    assert code == 0, err
    assert "Enter there from 2026-11-02 21:30 on (Asia/Jerusalem)." in out
    assert "Harvest there from 2026-11-10 on." in out
    assert "warning: Harvest on 2026-11-05 is too soon after Acarol" in err
    assert "warning: The dose of Acarol on 2026-11-02, 0.6 l/ha, is more than its label" in err
    (one,) = Season(season).treatments()
    _, listed, _, _ = run("status", season, "--batches")
    assert f"  {int(one.place.plants.sum())} plants, 2026-11-0" in listed
    lines = Season(season).plant_numbers.line
    assert np.array_equal(one.place.plants, np.isin(lines, [1, 2]))
    _, out, _, _ = run("status", season, "--date", BEGINS)
    assert "harvest                from 2026-11-10 on, after the treatment of 2026-11-02" in out
    assert "warning                Harvest on 2026-11-05 is too soon" in out


def test_one_entered_late_warns_of_the_later_use_that_it_makes_one_too_many(run, season, tmp_path):
    (tmp_path / "labels.csv").write_text("product,max uses\nAcarol,1\n")
    run("labels", season, "labels.csv")
    words = ["treat", season, "--efficacy", "0.8", "--product", "Acarol", "--date"]
    later = "warning: Use 2 in this season on"
    assert later not in run(*words, "2026-11-05")[2]
    _, _, err, _ = run(*words, BEGINS)
    assert later in err
    assert "Acarol on 2026-11-05. Its label allows 1." in err
    _, _, err, _ = run(*words, "2026-11-04", "--rows", "1")
    assert "Acarol on 2026-11-05. Its label allows 1." in err
    _, _, err, _ = run(*(word.replace("Acarol", "soap") for word in map(str, words)), BEGINS)
    assert "Acarol" not in err


def test_a_label_that_asks_for_longer_than_was_entered_counts(run, season, tmp_path):
    (tmp_path / "labels.csv").write_text("product,waiting days,re-entry hours\nAcarol,21,48\n")
    run("labels", season, "labels.csv")
    words = ["--efficacy", "0.8", "--product", "Acarol", "--ended", "09:30", "--date", BEGINS]
    code, out, err, _ = run("treat", season, *words, "--reentry-hours", "12", "--waiting-days", "3")
    assert code == 0, err
    assert "Enter there from 2026-11-04 09:30 on" in out
    assert "Harvest there from 2026-11-24 on." in out


def test_zones_of_a_decision_are_the_area_without_the_rest_of_the_plot(run, season):
    code, _, err, _ = run("decide", season, "--threshold", "5%", "--per-ha", "200", "-o", "z.gpkg")
    assert code == 0, err
    run("treat", season, "--efficacy", "0.8", "--area", "z.gpkg", "--date", BEGINS)
    (one,) = Season(season).treatments()
    _, listed, _, _ = run("status", season, "--batches")
    assert f"  {int(one.place.plants.sum())} plants, 2026-11-0" in listed
    zones = gpd.read_file("z.gpkg")
    sprayed = shapely.union_all(zones[zones["RATE"] > 0].geometry)
    inside = shapely.contains_xy(sprayed, Season(season).plot.grid.lonlat())
    assert 0 < inside.sum() < len(inside)
    assert np.array_equal(one.place.plants, inside)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--dose", "much"], "--dose must be a number with its unit"),
        (["--dose", "1,500 ml/ha"], "--dose is 1,500: is that 1500 or 1.5?"),
        (["--dose", "1,5,5 ml/ha"], "--dose must be a number, but it is '1,5,5'"),
        (["--dose", "2 buckets"], "The unit of a dose must be"),
        (["--rows", "three"], "Rows must be such as 3-5,8"),
        (["--rows", "999"], "but row 999 is named"),
        (["--rows", "1-999999999999"], "but row 999999999999 is named"),
        (["--rows", "²"], "Rows must be such as 3-5,8"),
        (["--rows", "1", "--area", "a.geojson"], "not both"),
        (["--irac", "sulphur"], "must be one of IRAC"),
        (["--ended", "9"], "--ended must be a time"),
        (["--waiting-days", "-2"], "--waiting-days must be 0 days or more"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_noted(run, season, words, said):
    code, _, err, _ = run("treat", season, "--efficacy", "0.8", "--date", BEGINS, *words)
    assert code == 2
    assert said in " ".join(err.split())
    assert Season(season).treatments() == ()


def test_without_an_efficacy_it_is_what_the_season_learnt_or_asked_for(run, season):
    code, _, err, _ = run("treat", season, "--product", "soap", "--date", BEGINS)
    assert code == 2
    assert "How well a treatment works must be said" in " ".join(err.split())


def test_a_treatment_of_a_day_that_has_not_come_is_noted_and_doubted(run, season):
    today = local_clock(Season(season).plot.field).today()
    ahead = max(today, ON) + timedelta(days=30)
    for on, doubted in ((ON, today < ON), (ahead, True)):
        code, _, err, _ = run("treat", season, "--efficacy", "0.5", "--date", str(on))
        assert code == 0
        assert (f"the day of the treatment, {on}, has not come" in err) == doubted


def test_rows_are_a_range_from_either_end(run, season):
    code, _, err, _ = run("treat", season, "--efficacy", "1", "--rows", "5-3,8", "--date", BEGINS)
    assert code == 0, err
    (treated,) = Season(season).treatments()
    rows = Season(season).plant_numbers.line[treated.place.plants]
    assert sorted(set(rows.tolist())) == [3, 4, 5, 8]


def test_a_treatment_that_ends_before_it_begins_is_said_to_end_the_day_after(run, season):
    words = ("treat", season, "--efficacy", "0.8", "--date", BEGINS, "--waiting-days", "1")
    code, out, err, _ = run(*words, "--began", "10:00", "--ended", "09:00")
    assert code == 0, err
    assert "Taken as over midnight: it ended on 2026-11-03 at 09:00." in out
    assert "Harvest there from 2026-11-05 on." in out
    for ended in ("10:00", "11:00"):
        code, out, err, _ = run(*words, "--began", "10:00", "--ended", ended)
        assert code == 0, err
        assert "midnight" not in out


def test_no_day_of_harvest_is_named_while_nobody_said_how_long_a_later_treatment_waits(run, season):
    first = ["--product", "Acarol", "--waiting-days", "3", "--ended", "09:30", "--date", BEGINS]
    _, out, _, _ = run("treat", season, "--efficacy", "0.8", *first)
    assert "Harvest there from 2026-11-06 on." in out
    later = ["--efficacy", "0.8", "--product", "Oil", "--date", "2026-11-03"]
    _, out, err, _ = run("treat", season, *later)
    asked = "warning: How long to wait from Oil on 2026-11-03 until harvest was not said."
    assert asked in err
    _, out, _, _ = run("status", season)
    assert "harvest                From when on harvest is allowed is not known: how long" in out
    assert asked.replace(": ", "                ", 1) in out
    assert "2026-11-06" not in out
    _, out, _, _ = run("treat", season, *first[:-1], "2026-11-04", "--efficacy", "0.7")
    assert "Harvest there from" not in out
    assert "how long to wait from Oil on 2026-11-03 was not said." in out
