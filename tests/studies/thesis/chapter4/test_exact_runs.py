"""Our listings are the thesis's listings: every exact run is repeated to the digit printed."""

import csv
import io

import pytest

from fieldmon.errors import FileProblem, SettingError
from fieldmon.studies.thesis.chapter4.exact_runs import compare_golden, golden_columns, portable_run
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED, NIGHT_CORRECTED
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

FUNCTIONS = {"snake": 2, "neighbor": 4, "randomsnake": 3, "neighborrandom": 5}


def row(function="snake", seed=1, severity=0.3, slips=AS_PUBLISHED, **key):
    """Return a row of a file of exact runs, as our own run fills it."""
    key = {"func": function, "scenario": "A", "n": 1, "vp": 2} | key
    algorithm = FUNCTIONS[function.removesuffix("_row")]
    strategy = ThesisStrategy(algorithm, key["n"] if algorithm in (2, 4) else 1)
    if function.endswith("_row"):
        slips = slips.without("draw_every_stop")
    trial = NoPriorTrial(SCENARIOS[key["scenario"]], strategy, key["vp"], severity)
    values = portable_run(trial, slips, seed)
    key |= {"severity": severity, "seed": seed, "crash": 0 if values else 1}
    return {column: key.get(column, (values or {}).get(column, "")) for column in golden_columns()}


def text(*rows):
    out = io.StringIO()
    writer = csv.DictWriter(out, golden_columns())
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


@pytest.mark.parametrize("name", ["golden.csv", "golden_fix1.csv", "golden_row.csv"])
def test_every_exact_run_is_repeated(no_prior, name):
    comparison = compare_golden((no_prior / name).read_text(encoding="utf-8"), name)
    assert comparison.rows > 0
    assert [str(difference) for difference in comparison.differences] == []


def test_the_files_of_the_other_night_differ(no_prior):
    published = (no_prior / "golden.csv").read_text(encoding="utf-8")
    assert not compare_golden(published, "golden.csv", "corrected").equal
    corrected = (no_prior / "golden_fix1.csv").read_text(encoding="utf-8")
    assert not compare_golden(corrected, "golden_fix1.csv", "published").equal


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_faces_snake_visits_in_scenario_a_are_those_of_table_2(seed):
    run = row(vp=3, seed=seed)
    assert [round(run[f"PVV{day}"], 1) for day in (1, 2, 3)] == [53.0, 47.0, 52.8]


def test_a_file_of_other_configurations_can_be_compared():
    rows = [
        row(function, vp=vp, scenario=scenario, n=n, seed=77, severity=0.7)
        for function in ("snake", "neighbor", "randomsnake_row", "neighborrandom")
        for vp, scenario, n in ((1, "B", 3), (2, "C", 5), (3, "A", 1))
    ]
    comparison = compare_golden(text(*rows), "more.csv")
    assert comparison.equal
    assert str(comparison) == "All 12 rows of more.csv, night published are equal."


@pytest.mark.parametrize(
    ("column", "value"),
    [("det2", 0), ("PVV1", 53.1), ("endTime3", 1.0), ("curvelast", "NaN"), ("crash", 1)],
)
def test_a_row_that_differs_is_told_with_its_line_and_column(column, value):
    good, bad = row(), row(seed=5)
    was = bad[column]
    bad[column] = value
    comparison = compare_golden(text(good, bad), "mine.csv")
    (difference,) = comparison.differences
    assert (difference.line, difference.column) == (3, column)
    assert str(difference).startswith(f"line 3 (snake A 1 2 0.3 5): {column} must be {value}")
    assert float(difference.found) == pytest.approx(float(was))
    assert str(comparison) == "1 of the 2 rows of mine.csv, night published differ."


def test_a_crash_that_did_not_happen_differs_too():
    crashing = next(
        found for seed in range(200) if (found := row("neighbor", seed=seed, severity=0.9))["crash"]
    )
    assert compare_golden(text(crashing), "crash.csv").equal
    assert compare_golden(text(crashing), "crash.csv", "corrected").differences[0].column == "crash"


def test_the_night_goes_by_the_name_of_the_file():
    fixed = text(row("neighbor", slips=NIGHT_CORRECTED, severity=0.9))
    assert compare_golden(fixed, "golden_fix1.csv").equal
    assert not compare_golden(fixed, "golden.csv").equal
    assert compare_golden(fixed, "golden.csv", "corrected").equal


def test_an_unknown_night_is_refused():
    with pytest.raises(SettingError, match="published or corrected, but it is 'mended'"):
        compare_golden(text(row()), "golden.csv", "mended")


def test_a_missing_column_is_named():
    lines = text(row()).replace("curvelast", "last")
    with pytest.raises(FileProblem, match=r"golden\.csv lacks curvelast"):
        compare_golden(lines, "golden.csv")


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"func": "bee"}, "func must be one of .* but it is 'bee' in line 2 of golden.csv"),
        ({"func": "snake_row"}, "func must be one of"),
        ({"scenario": "D"}, "scenario must be A, B or C, but it is 'D' in line 2"),
        ({"crash": "yes"}, "crash must be 0 or 1, but it is 'yes'"),
        ({"seed": "one"}, "seed must be numbers in line 2"),
    ],
)
def test_a_value_that_cannot_be_is_refused_with_a_sentence(change, sentence):
    with pytest.raises(FileProblem, match=sentence):
        compare_golden(text(row() | change), "golden.csv")


@pytest.mark.parametrize(
    ("change", "sentence"), [({"vp": 4}, "Viewpoints must be 1, 2 or 3"), ({"n": 0}, "N must be 1")]
)
def test_a_setting_that_cannot_be_is_refused_with_a_sentence(change, sentence):
    with pytest.raises(SettingError, match=sentence):
        compare_golden(text(row() | change), "golden.csv")


def test_rows_of_another_length_and_files_without_rows_are_refused():
    lines = text(row()).splitlines()
    with pytest.raises(FileProblem, match=r"line 2 of golden\.csv has too few"):
        compare_golden("\n".join([lines[0], lines[1].rsplit(",", 2)[0]]), "golden.csv")
    with pytest.raises(FileProblem, match=r"line 2 of golden\.csv has too many"):
        compare_golden("\n".join([lines[0], lines[1] + ",1,2"]), "golden.csv")
    with pytest.raises(FileProblem, match=r"golden\.csv has none"):
        compare_golden(lines[0], "golden.csv")
