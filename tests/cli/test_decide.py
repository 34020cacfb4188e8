"""`fieldmon decide`: spray or not, and where."""

from datetime import date, timedelta

import geopandas as gpd
import numpy as np
import pytest

from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.estimates.treatment_effect import learnt_efficacy
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from tests.cli.estate import BEGINS

CHEAP = ["--per-ha", "1", "--per-zone", "0", "--least-on", "0", "--section-rows", "1"]
ALMOND = ["--leaves", "40", "--counted", "1"]


def _inspected(season):
    """Record one clean plant: before, nobody is told anything but to inspect."""
    clean = Inspections.of(np.zeros(1), np.zeros(1), np.datetime64(BEGINS))
    Season(season).record(clean, "x")


def test_before_anybody_has_inspected_there_is_no_verdict(run, season):
    out = run("decide", season, "--threshold", "30%", "--date", BEGINS)[1]
    assert "Keep inspecting before you decide: nobody has inspected yet." in out.splitlines()


def test_the_answer_is_the_headline_of_the_app_and_what_is_assumed_is_said(run, season):
    _inspected(season)
    code, out, err, _ = run("decide", season, "--threshold", "30%", "--date", BEGINS)
    assert code == 0, err
    kept = Season(season)
    on = date.fromisoformat(BEGINS)
    advice = kept.advice(on, AdviceSettings(0.3))
    assert out.splitlines()[:4] == [
        f"{BEGINS}, after the day's work.",
        "Treat from 30 % of the plants infested on (your own).",
        advice.headline(),
        advice.plot.believed(),
    ]
    assert advice.headline().startswith("Do not treat by the threshold; by these costs alone ")
    assumed = (
        "Assumed: finds are treated at once, to treat 1 ha costs 100, a zone costs 0.5, an inf"
    )
    assert assumed in out
    assert kept.log()[-1].what["said"] == advice.in_short()


def test_zones_that_only_pay_are_told_from_what_the_threshold_asks_for(run, season):
    _inspected(season)
    cheap = ["--date", BEGINS, *CHEAP]
    below = run("decide", season, "--threshold", "99%", *cheap)[1].splitlines()
    said = next(k for k, line in enumerate(below) if line.startswith("The zones are below the"))
    assert below[2].startswith("Do not treat by the threshold; by these costs alone ")
    assert below[said + 1].startswith("To treat ")
    of_leaves = run("decide", season, "--threshold", "almond", *cheap, *ALMOND)[1].splitlines()
    assert "do not treat" in of_leaves[2]
    assert of_leaves[3].endswith("whatever the threshold says.")
    assert of_leaves[4].startswith("To treat ")


def test_the_zones_are_written_for_the_sprayer(run, season):
    words = ["decide", season, "--threshold", "0.1%", *CHEAP, "--product", "soap"]
    code, out, err, made = run(*words, "-o", "z.gpkg", "-o", "z.xml.zip", "-o", "z.tif",
                               "--rate", "250")  # fmt: skip
    assert code == 0, err
    assert {path.name for path in made} == {"z.gpkg", "z.xml.zip", "z.tif"}
    zones = gpd.read_file(season.parent / "z.gpkg")
    assert set(zones["RATE"]) <= {0.0, 250.0}
    assert (zones["PRODUCT"] == "soap").all()
    assert "Zones written to z.xml.zip\nZones written to z.tif\nCells of 1.00 m spray " in out


def test_a_treatment_is_taken_to_work_as_the_season_learnt(run, season):
    """As `fieldmon treat` takes it; of no product it is the last one of which anything is told."""
    kept, on = Season(season), date.fromisoformat(BEGINS)
    plants = np.arange(60)
    for day in (0, 4):  # found again, all of them
        seen = np.datetime64(on + timedelta(days=day))
        kept.record(Inspections.of(plants, np.full(60, FOUND), seen), "x")
    kept.treat(on + timedelta(days=1), 0.8, product="Soap")
    words = ["decide", season, "--threshold", "5%", "--date", on + timedelta(days=4)]
    works = learnt_efficacy(kept.effects(on + timedelta(days=4)), "soap").efficacy
    assert works < 0.1
    learnt = f"As this season learnt of Soap: treating cleans {works:.0%}.".replace("%.", " %.")
    for more in ([], ["--product", "soap"]):
        assert learnt in run(*words, *more)[1]
    for more, said in ((["--product", "oil"], "treating cleans 90 %."),
                       (["--works", "0.8"], "As you said: treating cleans 80 %.")):  # fmt: skip
        out = run(*words, *more)[1]
        assert said in out
        assert "season learnt" not in out
    words[-1] = on
    assert "treating cleans 90 %." in run(*words)[1], "it had not learnt it then"


def test_a_threshold_of_leaves_asks_for_leaves_and_then_answers(run, season):
    words = ["decide", season, "--threshold", "almond"]
    code, out, _, _ = run(*words)
    assert code == 0
    assert "this threshold is of leaves: look at" in out
    assert "40 leaves, 20 counted: treat" in run(*words, "--leaves", "40", "--counted", "20")[1]
    assert (
        "40 leaves, 1 counted: do not treat" in run(*words, "--leaves", "40", "--counted", "1")[1]
    )
    assert "more you can decide" in run(*words, "--leaves", "5", "--counted", "1")[1]


def test_a_threshold_for_another_pest_than_the_season_s_is_warned_of(run, season):
    words = ["decide", season, "--threshold", "almond"]
    assert "is for" not in run(*words)[2], "nobody named a pest"
    for pest, doubted in (("whitefly", True), ("spider-mite", False)):
        assert run("change", season, "--pest", pest)[0] == 0
        code, _, said, *_ = run(*words)
        assert code == 0
        assert (f"but the season's pest is {pest}: take one for it" in said) == doubted


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--threshold", "rose"], "must be a share of the plants"),
        (["--threshold", "5%", "--sure", "0.4"], "between 0.5 and 1"),
        (["--threshold", "5%", "--works", "0"], "--works must be above 0"),
        (["--threshold", "5%", "--per-ha", "1e9", "-o", "z.gpkg"], "pays nowhere"),
        (["--threshold", "5%", *CHEAP, "-o", "z.txt"], "must be called"),
        (["--threshold", "5%", "--thresholds", "none.csv"], "none.csv"),
        (["--threshold", "5%", "--leaves", "40", "--counted", "20"], "5% is a share of the plants"),
        (["--threshold", "5%", "--presence"], "name a threshold of leaves"),
        (["--threshold", "almond", "--counted", "20"], "give --leaves N too"),
        (["--threshold", "5%", "--sections", "4"], "give --boom METRES too"),
        (["--threshold", "5%", "--ring", "1"], "give --section-rows 0 too"),
    ],
)
def test_what_cannot_be_is_a_sentence_and_nothing_is_written(run, season, words, said):
    code, _, err, made = run("decide", season, *words)
    assert code == 2
    assert said in err
    assert not made


def test_where_no_zone_pays_the_page_is_written_and_the_zones_are_refused(run, season):
    words = ["decide", season, "--threshold", "5%", "--per-ha", "1e9"]
    code, out, err, made = run(*words, "-o", "z.gpkg", "-o", "z.html")
    assert (code, {path.name for path in made}) == (2, {"z.html"})
    assert "Advice written to z.html" in out
    assert "pays nowhere. No zones are written." in err
    assert Season(season).log()[-1].kind == "advised"


@pytest.mark.parametrize(
    ("wrong", "says"),
    [("z.png", "advice to print ends in .pdf or .html"), ("none/z.gpkg", "folder none must exist")],
)
def test_nothing_is_written_or_kept_where_one_of_the_files_cannot_be(run, season, wrong, says):
    before = season.read_bytes()
    words = ["decide", season, "--threshold", "0.1%", *CHEAP]
    code, _, err, made = run(*words, "-o", "z.pdf", "-o", wrong)
    assert (code, made) == (2, set())
    assert says in err
    assert season.read_bytes() == before


def test_what_the_label_says_of_a_product_is_told_before_it_is_sprayed(run, season):
    kept, on = Season(season), date.fromisoformat(BEGINS)
    kept.keep_labels([ProductLabel("Borneo", irac_groups=("10B",), max_uses=1, waiting_days=3)])
    words = ["decide", season, "--threshold", "5%", "--product", "borneo "]
    assert "warning: " not in run(*words, "--date", BEGINS)[2]
    kept.treat(on, 0.8, application=Application("Borneo"))
    tomorrow = on + timedelta(days=1)
    err = run(*words, "--date", tomorrow)[2]
    zones = kept.advice(tomorrow, AdviceSettings(0.05)).sprayed
    said = f"Use 2 in this season on {zones.sum()} plants: borneo on {tomorrow}."
    assert f"warning: {said} Its label allows 1." in err
    assert len(kept.treatments()) == 1
    done = kept.treat(tomorrow, 0.8, application=Application("borneo"), plants=zones)
    told = [one.sentence for one in kept.cautions(tomorrow, because_of=done.batch)]
    assert f"{said} Its label allows 1." in told
    assert "No label of Oil stands" in run(*words[:-1], "Oil", "--date", tomorrow)[2]
    assert "warning: " not in run(*words[:-2], "--date", tomorrow)[2]
