"""The report of chapter 5: published and ours, every measure, in a page that needs nothing."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.mapped_plots import MapMeasure
from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
from fieldmon.studies.thesis.chapter5.report import charts, maps_html, report_html
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial
from fieldmon.studies.thesis.chapter5.study import OWN, PriorStudy, StudyPart
from fieldmon.studies.thesis.chapter5.verdicts import AGREES, DIFFERS, Compared
from tests.pages import HOSTILE, Page, held

COMPARED = Compared("A", "Naive: visited a day, %", "67", True, 61.04, 60.5, 61.6, 4, -5.96, "near")


def runs_of(trial, seed=0, n=4, days=25):
    """Return seasons of drawn figures: of 100 insects on 1000 plants, some found every day."""
    rng = np.random.default_rng(seed)
    tables = np.zeros((n, days, 9))
    tables[..., 0] = rng.integers(100, 400, (n, days))
    tables[..., 1] = rng.integers(0, 4, (n, days))
    tables[:, 0, 3] = 100
    return PriorRuns(trial, 1000, tables)


@pytest.fixture(scope="module")
def study():
    scenario = [PriorTrial(name, CALIBRATED, 1.0) for name in ("dynamic", "naive", "bouncy")]
    times = [PriorTrial("dynamic", CALIBRATED, 6.0, look_s) for look_s in (20.0, 40.0)]
    sizes = [
        PriorTrial(name, CALIBRATED, ha)
        for ha in (1.0, 2.0)
        for name in ("dynamic", "naive", "bouncy")
    ]
    parts = [
        StudyPart(
            name, f"Title of {name}", tuple(runs_of(trial, k) for k, trial in enumerate(trials))
        )
        for name, trials in (("A", scenario), ("time", times), ("size", sizes))
    ]
    found = replace(COMPARED, verdict=AGREES, fitted=False, difference=0.25)
    parts[0] = replace(parts[0], compared=(COMPARED, found))
    return PriorStudy(CALIBRATED, 4, 9, tuple(parts))


@pytest.fixture(scope="module")
def page(study):
    return Page(report_html(study))


def test_published_and_ours_stand_side_by_side(page):
    heads, one, other = page.tables[0]
    assert heads == ["figure", "published", "ours", "difference", "verdict", "in the fit"]
    name, ours = "A: Naive: visited a day, %", "61.0 60.5 to 61.6"
    assert one == [name, "67", ours, "-6.0", "near", ""]
    assert other == [name, "67", ours, "+0.2", "agrees", "looked at only"]


@pytest.mark.parametrize(
    ("verdict", "kind"),
    [(AGREES, "agrees"), ("holds", "agrees"), ("near", "near"), ("open", "near"),
     (DIFFERS, "differs"), ("fails", "differs")],
)  # fmt: skip
def test_a_verdict_has_its_colour(study, verdict, kind):
    part = replace(study.parts[0], compared=(replace(COMPARED, verdict=verdict),))
    page = Page(report_html(replace(study, parts=(part,))))
    assert page.tables[0][1][4] == verdict
    assert len(page.all("td", kind)) == 1


def test_every_configuration_has_every_measure_with_its_interval(page, study):
    for (heads, *rows), part in zip(page.tables[1:], study.parts, strict=True):
        assert heads[:3] == ["configuration", "detected at the end, %", "visited a day, %"]
        assert len(rows) == len(part.runs)
        for row, runs in zip(rows, part.runs, strict=True):
            measured = runs.measures()
            assert len(row) == len(heads) == 1 + len(measured)
            for cell, values in zip(row[1:], measured.values(), strict=True):
                mean = np.nanmean(values)
                assert cell.split()[0] == (f"{mean:.1f}" if abs(mean) < 1000 else f"{mean:.0f}")
                assert cell.split()[2] == "to"


def test_configurations_are_called_by_what_tells_them_apart(page):
    names = [[row[0] for row in table[1:]] for table in page.tables[1:]]
    assert names[0] == ["Dynamic", "Naive", "Bouncy"]
    assert names[1] == ["20 s", "40 s"]
    assert names[2][:2] == ["Dynamic, 1 ha", "Naive, 1 ha"]


def test_plots_stand_where_the_text_has_its_figures(page):
    captions = [drawing["aria-label"] for drawing in page.all("svg")]
    assert captions == [
        "Figure 20: detected so far",
        "Figure 21: visited a day",
        "Figure 28: detected so far",
        "Figure 26: detected at the end, by field size",
    ]
    assert len(page.all("polygon", "band")) == 3 + 3 + 2 + 3


def test_a_line_of_means_ends_at_the_mean_of_the_last_day(study):
    (detected, _) = (Page(chart) for chart in charts(study.parts[0]))
    ends = [float(line["points"].split()[-1].split(",")[1]) for line in detected.all("polyline")]
    means = [runs.detection_pct[:, -1].mean() for runs in study.parts[0].runs]
    assert np.argsort(ends).tolist() == np.argsort(means)[::-1].tolist()  # y runs down
    assert len(detected.all("polyline")[0]["points"].split()) == 25


def test_open_choices_are_listed_as_chosen(page, study):
    assert page.items == list(study.choices.sentences())
    assert "4 paired seeds a configuration, from seed 9" in page.text


def test_the_page_is_whole_and_asks_for_nothing(page):
    assert page.asks_for == page.runs == []
    assert "Stopped" not in page.text


def test_a_study_that_was_stopped_says_so(study):
    page = Page(report_html(replace(study, stopped=True, parts=())))
    assert "Stopped before the end: what was done by then." in page.text
    assert page.tables == []


def test_a_plot_s_own_name_is_text():
    text = " ".join(HOSTILE)
    part = StudyPart(OWN, text, (runs_of(PriorTrial("dynamic", CALIBRATED)),))
    page = held(report_html(PriorStudy(CALIBRATED, 4, 1, (part,))))
    assert page.headings[-1] == text


def test_what_is_compared_is_text(study):
    text = " ".join(HOSTILE)
    part = replace(study.parts[0], compared=(replace(COMPARED, what=text, published=text),))
    page = held(report_html(replace(study, parts=(part,))))
    assert page.tables[0][1][:2] == [f"A: {text}", text]


def map_rows(name="pepper", date="3 May", seeds=4):
    return [
        MapMeasure(name, date, 40, sampler, pct, pct / 2, pct / 2 - 1, pct / 2 + 1, seeds)
        for sampler in ("dynamic", "naive", "bouncy")
        for pct in (0.0, 5.0, 10.0)
    ]


def test_each_map_and_date_has_its_chart():
    page = Page(maps_html([*map_rows(), *map_rows(date="9 May", seeds=1)]))
    drawings = [drawing["aria-label"] for drawing in page.all("svg")]
    # of a single seed nothing is drawn
    assert drawings == ["pepper 3 May: found of 40 infested plants"]
    assert [len(line["points"].split()) for line in page.all("polyline")] == [3, 3, 3]
    assert page.asks_for == page.runs == []


def test_names_and_dates_of_maps_are_texts():
    text = " ".join(HOSTILE)
    held(maps_html(map_rows(name=text, date=text)))
