"""The report of chapter 4: every cell with its verdicts, in one page that needs nothing else."""

import re
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.studies.thesis.chapter4.measures import NoPriorMeasure
from fieldmon.studies.thesis.chapter4.report import report_html
from fieldmon.studies.thesis.chapter4.study import NoPriorStudy, NoPriorTable
from tests.pages import HOSTILE, Page, held

CELL = NoPriorMeasure(
    table="2",
    field="A",
    faces=500,
    algorithm=2,
    n="2",
    strategy="snake, every N",
    severity=0.3,
    viewpoints=3,
    rules="as published",
    measure="PCD_ED1",
    mean=50.04,
    low=48.26,
    high=51.82,
    sd=4.5,
    q05=43.0,
    q95=57.0,
    replicates=400,
    aborted=0.0,
)


@pytest.fixture(scope="module")
def page(everything):
    return Page(report_html(everything))


def shown(*cells, **more):
    """Return the page of a study that has one table of these cells."""
    table = NoPriorTable("2", "Table 2", "About it.", cells, ("A sentence.",), **more)
    return report_html(NoPriorStudy(400, 1, (table,)))


def test_the_page_is_whole_and_has_plots_and_tables(page, everything):
    assert page.headings[1:] == [table.title for table in everything.tables]
    assert len(page.tables) == len(everything.tables) == 10
    assert len(page.all("svg")) >= 3 * 4 + 6


def test_the_page_asks_for_nothing_from_outside(page):
    assert page.asks_for == page.runs == []
    assert not re.search(r"https?://", page.source)


def test_no_number_is_missing_its_value(page):
    assert "nan" not in page.text.lower().split()


def test_every_cell_is_shown_once_with_its_mean_and_the_printed_value(page, everything):
    for (heads, *rows), table in zip(page.tables, everything.tables, strict=True):
        assert {len(row) for row in rows} == {len(heads)}
        filled = [cell.split() for row in rows for cell in row[1:] if cell]
        means = [f"{c.mean:.1f}" if abs(c.mean) >= 10 else f"{c.mean:.2f}" for c in table.cells]
        wanted = [mean if c.replicates else "-" for mean, c in zip(means, table.cells, strict=True)]
        assert sorted(words[0] for words in filled) == sorted(wanted)
        printed = [words[words.index("thesis") + 1] for words in filled if "thesis" in words]
        assert sorted(printed) == sorted(f"{c.thesis:g}" for c in table.cells if c.thesis_verdict)


def test_verdicts_and_misprints_can_be_read_without_colour(page):
    shown = {cell for table in page.tables for row in table for cell in row}
    for words in ("thesis 53 =", "thesis 82 !", "reference 53.0 ✓"):
        assert any(words in cell for cell in shown)
    assert any("its first digit is lost: 266 + 193 = 459" in item for item in page.items)


def test_a_cell_says_mean_interval_thesis_and_reference():
    cell = replace(
        CELL,
        thesis=50.5,
        thesis_verdict="near",
        reference=53.6554,
        reference_verdict="differs",
        note="a note",
    )
    page = Page(shown(cell))
    assert page.tables == [
        [
            ["configuration", "detected day 1, %"],
            [
                "A: 2 snake, every N, N = 2",
                "50.0 48.3 to 51.8 thesis 50.5 ≈ reference 53.7 ✗",
            ],
        ]
    ]
    assert page.all("td")[0]["title"] == "a note"
    assert [small.get("class") for small in page.all("small")] == [None, "near", "differs"]


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"sd": 0.0}, "50.0"),
        ({"low": float("nan")}, "50.0"),
        ({"replicates": 0}, "-"),
        ({"mean": 5.044, "low": 4.9, "high": 5.2}, "5.04 4.90 to 5.20"),
    ],
)
def test_an_interval_is_shown_where_there_is_one(changed, said):
    ((_, (_, cell)),) = Page(shown(replace(CELL, **changed))).tables
    assert cell == said


def test_a_configuration_without_a_measure_has_an_empty_cell():
    other = replace(CELL, n="3", measure="PVV_ED1")
    ((_, one, two),) = Page(shown(CELL, other)).tables
    assert [bool(text) for text in one[1:] + two[1:]] == [True, False, False, True]


def test_rows_say_what_differs_within_the_table():
    cells = [
        CELL,
        replace(CELL, severity=0.5, aborted=0.25),
        replace(CELL, viewpoints=1, rules="night corrected"),
    ]
    ((_, *rows),) = Page(shown(*cells)).tables
    start = "A: 2 snake, every N, N = 2, severity"
    assert [row[0] for row in rows] == [
        f"{start} 0.3, 3 viewpoints, as published",
        f"{start} 0.5, 3 viewpoints, as published, 25% aborted",
        f"{start} 0.3, 1 viewpoint, night corrected",
    ]


@pytest.mark.parametrize(("n", "folded"), [(60, False), (61, True)])
def test_a_long_table_is_folded_away(n, folded):
    cells = [replace(CELL, field=f"F{k}") for k in range(n)]
    page = Page(shown(*cells))
    assert (f"All {n} configurations" in page.text) == folded
    assert ("details" in page.tags) == folded
    assert len(page.tables[0]) == 1 + n


def test_a_misprint_is_said_once_below_the_table():
    wrong = replace(CELL, thesis=5.0, thesis_verdict="misprint", note="a digit is lost")
    page = Page(shown(wrong))
    assert "A: 2 snake, every N, N = 2, detected day 1, %: a digit is lost." in page.items
    assert page.tables[0][1][1].endswith("thesis 5 !")


def test_every_text_of_a_study_is_text():
    text = " ".join(HOSTILE)
    cell = replace(
        CELL, field=text, strategy=text, measure=text, note=text, thesis=1.0,
        thesis_verdict="misprint",
    )  # fmt: skip
    hours = np.array([0.0, 1.0])
    table = NoPriorTable("x", text, text, (cell,), (text,), ((text, hours, hours),))
    page = held(report_html(NoPriorStudy(2, 1, (table,))))
    assert page.text.count(text) >= 7
    assert page.headings[1] == text
