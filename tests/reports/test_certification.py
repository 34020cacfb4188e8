"""The record for a certifier: complete, and honest about what nobody said."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import time, timedelta

import numpy as np
import pytest

from fieldmon.cli.report_languages import spoken
from fieldmon.compute.units import Units
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.days.advised import advise
from fieldmon.monitoring.season.salvage import salvage
from fieldmon.reports import words
from fieldmon.reports.certification import certification_report, times_said
from fieldmon.reports.content import Listing, Table
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.season import season_report
from tests.monitoring.changes.test_season_log import by_hand
from tests.monitoring.seasons import BEGINS, a_season, some_results
from tests.reports.reading import texts

REASON = "Spider mites on 6 % of the plants, above the threshold of 5 %; no predators on 30 leaves"
FULL = Application(
    "Acarol", Dose(0.6, "l/ha"), 800.0, "Ann Cohen", REASON, 3, 12.0, ("6",), time(7), time(9, 30),
    "boom sprayer 12 m", "tomato", "spider mites", "Dr Levi",
)  # fmt: skip


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    """Make a season with six treatments, one of them of which little was said."""
    made = a_season(tmp_path_factory.mktemp("certified") / "season.gpkg")
    made.record(some_results(made, n=12, found=[2, 3]), "monday.csv", "Ann")
    made.keep_labels([ProductLabel("Acarol", max_dose=Dose(0.5, "l/ha"), waiting_days=7)])
    advise(made, BEGINS, "Treat: 6 % of the plants are believed infested.", "Ben")
    for day in range(5):
        said = FULL if not day else replace(FULL, product="Oil", dose=None)
        made.treat(BEGINS + timedelta(day), 0.8, application=said)
    made.treat(BEGINS + timedelta(5), 0.5, product="soap")
    made.keep_labels([*made.labels(), ProductLabel("soap", irac_groups=("28",))])
    return made


@pytest.fixture(scope="module")
def made(season):
    return certification_report([season], Units())


def cards(report):
    """Return what each application says, by name."""
    return [
        dict(block.rows)
        for sheet in report.sheets
        if sheet.heading == "Applications"
        for block in sheet.blocks
        if isinstance(block, Table)
    ]


def test_every_field_that_globalgap_asks_for_stands_there(made):
    first, *_, last = cards(made)
    assert first["Product"] == "Acarol"
    assert (first["Dose"], first["Water"], first["Area"]) == ("0.6 l/ha", "800 l/ha", "0.526 ha")
    assert (first["Operator"], first["Authorised by"]) == ("Ann Cohen", "Dr Levi")
    assert (first["Began and ended"], first["Time zone"]) == ("07:00–09:30", "Asia/Jerusalem")
    assert (first["Machinery"], first["Crop"]) == ("boom sprayer 12 m", "tomato")
    assert (first["Waiting period"], first["Harvest from"]) == (
        "7 days",
        "not known, see 2026-04-11",
    )
    assert first["Entry from"] == "2026-04-06 21:30"
    assert last["Harvest from"] == "not said"
    assert last["Operator"] == last["Dose"] == last["Waiting period"] == "not said"
    assert (first["Mode of action (IRAC)"], last["Mode of action (IRAC)"]) == ("6", "28")
    said = " ".join(made.words())
    assert f"Reason: {REASON}" in said
    assert "Advised: Treat: 6 % of the plants are believed infested. (2026-04-06)" in said


def test_no_card_names_a_day_of_harvest_while_nobody_said_how_long_a_treatment_waits(made, season):
    assert {card["Harvest from"] for card in cards(made)} == {
        "not known, see 2026-04-11",
        "not said",
    }
    asked = "How long to wait from soap on 2026-04-11 until harvest was not said."
    assert " ".join(made.words()).count(asked) == 2  # in the summary, and on its card
    before = certification_report([season], Units(), BEGINS + timedelta(4))
    assert cards(before)[0]["Harvest from"] == "2026-04-14"


def test_it_says_what_to_beware_of_what_is_missing_and_the_last_digest(made, season):
    said = " ".join(made.words())
    assert "The dose of Acarol on 2026-04-06, 0.6 l/ha, is more than its label allows" in said
    unsaid = "Active ingredient, Dose, Crop, Operator, Authorised by, Machinery, Weather then"
    assert f"2026-04-11: {unsaid}, Waiting period" in said
    assert f"The last digest is {season.log()[-1].digest}" in said


def test_paper_holds_every_application_and_no_page_runs_over(made, season):
    pages = texts(pdf_bytes(made))
    assert len(pages) == len(made.sheets)
    text = " ".join(pages)
    for number in range(1, 7):
        assert f"{number}. Treatment of" in text
    assert "more rows" not in text
    assert season.log()[-1].digest in text
    assert html_text(made).count("<h2>") >= 6


def test_several_seasons_are_one_record(season, tmp_path):
    other = Season(shutil.copy(season.path, tmp_path / "other.gpkg"))
    other.treat(BEGINS + timedelta(6), 0.5, product="water")
    both = certification_report([season, other], Units())
    assert len(cards(both)) == 13
    said = " ".join(both.words())
    # one plot is no two, and stands among what to beware of
    assert "13 treatments on 1 plot; 24 inspections" in said
    beware = next(
        block
        for block in both.sheets[0].blocks
        if isinstance(block, Listing) and block.title == words.CERT_CAUTIONS
    )
    assert "are 2 seasons of one plot: each counts." in beware.sentences[0]
    name = season.plot.field.name
    for file in ("other", season.path.stem):
        assert f"{name} ({file})" in said
    assert f"{name} (" not in " ".join(certification_report([season], Units()).words())
    plots = next(b for s in both.sheets for b in s.blocks if isinstance(b, Table))
    assert [row[4:] for row in plots.rows] == [("6", "12", "2"), ("7", "12", "2")]
    before = certification_report([season], Units(), BEGINS + timedelta(1))
    assert len(cards(before)) == 2


def test_what_was_inspected_on_several_plots_shares_a_page_and_no_entry_is_forbidden_any_more(
    season, tmp_path
):
    other = a_season(tmp_path / "other.gpkg")
    other.record(some_results(other, n=4), "monday.csv", "Ann")
    other.treat(BEGINS, 0.8, application=replace(FULL, reentry_hours=12.0))
    assert any(one.kind == "entry" for one in other.cautions(BEGINS))
    report = certification_report([season, other], Units(), BEGINS)
    assert [sheet.heading for sheet in report.sheets].count(words.CERT_SHEETS[2]) == 1
    assert len(days_of(report)) == 2
    assert "Do not enter before" not in " ".join(report.words())


def test_a_file_that_does_not_hold_to_its_log_says_so_in_the_record(season, tmp_path):
    path = shutil.copy(season.path, tmp_path / "changed.gpkg")
    by_hand(path, "UPDATE treatments SET product = 'water' WHERE fid = 1")
    report = certification_report([Season(path)], Units())
    logs = [
        b for s in report.sheets for b in s.blocks if isinstance(b, Listing) and b.title == "Log"
    ]
    assert "Row 1 of the layer treatments is not what was recorded." in logs[0].sentences[0]
    assert "the chain holds" not in " ".join(report.words())
    by_hand(path, "UPDATE log SET entry = '{}' WHERE fid = 3")
    changed = " ".join(certification_report([Season(path)], Units()).words())
    assert "entry 3 is not what was written" in changed


def test_a_record_is_of_a_season_or_more():
    with pytest.raises(SettingError, match="of a season or more"):
        certification_report([], Units())


def test_what_was_advised_stands_with_the_first_treatment_after_it_and_with_no_later_one(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    advise(season, BEGINS, "Treat the zones.")
    season.treat(BEGINS, 0.5, product="Acarol", application=FULL)
    season.treat(BEGINS + timedelta(3), 0.5, product="Soap")
    advise(season, BEGINS + timedelta(3), "Treat the rest.")
    season.treat(BEGINS + timedelta(4), 0.5, product="Oil")
    report = certification_report([season], Units())
    said = [texts_of.get("Advised") for texts_of in cards(report)]
    assert said == ["Treat the zones. (2026-04-06)", "not said", "Treat the rest. (2026-04-09)"]


@pytest.mark.parametrize(
    ("began", "ended", "said"),
    [
        (time(7), time(18, 30), "07:00–18:30"),
        (time(7), None, "began 07:00"),
        (None, time(18, 30), "ended 18:30"),  # a sign for what nobody said has no side of its own
        (None, None, ""),
    ],
)
def test_one_time_alone_says_which_it_is(began, ended, said):
    assert times_said(Application("Oil", began=began, ended=ended)) == said


def test_who_was_where_before_entry_was_allowed_stands_in_the_record(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    said = Application("Oil", began=time(0), ended=time(0, 10), waiting_days=1, reentry_hours=72.0)
    season.treat(BEGINS, 0.8, application=said)
    ann = np.full(12, "Ann", object)
    seen = Inspections.of(
        np.arange(12), np.full(12, CLEAN), np.datetime64(BEGINS + timedelta(1)), who=ann
    )
    season.record(seen, "monday.csv", "Ann")
    report = certification_report([season], Units(), BEGINS + timedelta(days=6))
    told = [
        sentence
        for sheet in report.sheets
        for block in sheet.blocks
        if isinstance(block, Listing)
        for sentence in block.sentences
    ]
    assert any("Ann was at 12 plants in" in one and "entry was allowed" in one for one in told)
    assert words.CERT_CAUTIONS_NONE not in told


def test_what_was_advised_and_the_pest_s_name_are_in_the_record_s_language(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    season.change(replace(season.settings, pest=shipped_pest("spider-mite")), season.settings)
    advice = season.advice(BEGINS)
    advise(season, BEGINS, advice.in_short())
    season.treat(BEGINS, 0.8, application=FULL)
    language, units = spoken("es", "")
    record = " ".join(certification_report([season], units).said_in(language).words())
    advised = record.partition("Aconsejado: ")[2]
    assert advised.startswith(spoken("es", "")[0].say(advice.headline()))
    assert "Se cree infestado el" in advised
    assert "believed" not in record
    of_season = season_report(season, BEGINS, units).said_in(language)
    said = " ".join(of_season.words())
    assert "Araña roja, por grados-día" in said
    assert "Two-spotted" not in said


def test_who_inspected_is_said_with_how_many_and_so_is_that_nobody_was_named(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    day = np.datetime64(BEGINS)
    for on, named in ((0, ["Ben"] * 3 + [""] * 6 + ["Ann"] * 4), (1, ["Ben"] * 2), (2, [""] * 5)):
        seen = Inspections.of(
            np.arange(len(named)), np.full(len(named), CLEAN), day + on,
            who=np.array(named, object),
        )  # fmt: skip
        season.record(seen, "phone")
    report = certification_report([season], Units(), BEGINS + timedelta(3))
    plain = ["Ann 4, Ben 3, not said 6", "Ben", "not said"]
    assert [row[3] for row in days_of(report)] == plain
    asked = "Who made the inspections (11 of 20)."
    assert any(asked in sentence for sentence in listed(report, words.CERT_UNSAID))
    said = {
        code: [row[3] for row in days_of(report.said_in(spoken(code, "")[0]))]
        for code in ("he", "ar", "es")
    }
    assert said == {
        "he": ["Ann 4, Ben 3, לא נאמר 6", "Ben", "לא נאמר"],
        "ar": ["Ann 4، Ben 3، لم يُذكر 6", "Ben", "لم يُذكر"],
        "es": ["Ann 4, Ben 3, no se dijo 6", "Ben", "no se dijo"],
    }


def test_all_who_recorded_the_same_plants_of_a_day_are_named(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    for who, n in (("Ann", 4), ("Ben", 3), ("ann ", 4), ("", 2), ("Ben", 2)):
        seen = Inspections.of(
            np.arange(n), np.full(n, CLEAN), np.datetime64(BEGINS), who=np.full(n, who, object)
        )
        season.record(seen, "phone")
    report = certification_report([season], Units(), BEGINS + timedelta(3))
    assert [(row[1], row[3]) for row in days_of(report)] == [("4", "Ann 4, Ben 3")]


def test_who_corrected_is_said_beside_a_name_that_is_no_english(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    season.record(some_results(season, n=3), "monday.csv", "Ben")
    season.correct_time(1, time(8), "Eva")
    report = certification_report([season], Units()).said_in(spoken("es", "")[0])
    assert [row[3] for row in days_of(report)] == ["Ben, corregido por Eva"]


def test_a_warning_stands_once_to_beware_of_and_with_each_treatment(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    half = np.arange(len(season.plot.grid)) < 10
    season.treat(BEGINS, 0.5, product="soap", plants=half)
    season.treat(BEGINS, 0.5, product="soap", plants=~half)
    report = certification_report([season], Units())
    beware = listed(report, words.CERT_CAUTIONS)
    assert len(beware) == 1
    said = " ".join(report.words())
    assert said.count(beware[0]) == 3
    assert f"{words.CERT_CAUTIONS} 1 " in said


def listed(report, title):
    """Return the sentences under a title."""
    blocks = [block for sheet in report.sheets for block in sheet.blocks]
    of = [b.sentences for b in blocks if isinstance(b, Listing) and b.title == title]
    return [sentence for sentences in of for sentence in sentences]


def days_of(report):
    """Return the days on which was inspected, each with names as they are read."""
    tables = [block for block in report.sheets[-1].blocks if isinstance(block, Table)]
    return [
        tuple(cell.translate({0x2068: None, 0x2069: None}) for cell in row)
        for table in tables
        for row in table.rows
    ]


@pytest.mark.parametrize("language", ["he", "es"])
def test_on_a_phone_no_table_and_no_digest_is_wider_than_the_page(
    browser, season, language, tmp_path
):
    said, units = spoken(language, "")
    path = tmp_path / "record.html"
    path.write_text(html_text(certification_report([season], units).said_in(said)), "utf-8")
    page = browser.new_page(viewport={"width": 360, "height": 800})
    page.goto(path.as_uri())
    wide = page.evaluate("document.documentElement.scrollWidth")
    names = page.locator(".many td").first.evaluate(
        "one => getComputedStyle(one, '::before').content"
    )
    page.close()
    assert wide == 360
    assert said.say(words.CERT_PLOT_COLUMNS[0]) in names


def test_a_season_that_lost_inspections_is_not_said_to_be_complete(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    season.record(Inspections.of([1, 2], [CLEAN, CLEAN], np.datetime64(BEGINS)), "a.csv", "Ann")
    with closing(sqlite3.connect(season.path)) as db:
        db.execute("UPDATE fieldmon SET value = '1' WHERE key = 'open'")  # nobody notes it
        db.execute("DELETE FROM inspections WHERE fid = 1")
        db.execute("UPDATE fieldmon SET value = '0' WHERE key = 'open'")
        db.commit()
    salvage(season.path, tmp_path / "rescued.gpkg")
    report = certification_report([Season(tmp_path / "rescued.gpkg")], Units(), BEGINS)
    assert any("1 of 2 rows of batch" in said for said in listed(report, words.CERT_UNSAID))
    assert words.CERT_UNSAID_NONE not in listed(report, words.CERT_UNSAID)
