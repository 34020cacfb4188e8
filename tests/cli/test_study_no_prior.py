"""`fieldmon study no-prior`: the thesis's tables, and exact runs row for row."""

import csv
import re

import pytest

from tests.paths import SHARED

HEADS = {"golden.csv": 240, "golden_fix1.csv": 120, "golden_row.csv": 72}


@pytest.fixture
def reference():

    folder = SHARED / "reference" / "no_prior"
    if not folder.is_dir():
        pytest.skip(f"the reference runs {folder} are not on this machine")
    return folder


def test_a_table_is_made_again_with_a_report(run, tmp_path):
    code, out, err, made = run("study", "no-prior", "--table", "2", "--replicates", 20)
    assert code == 0, err
    assert {path.name for path in made} == {"no_prior_2.csv", "no_prior_2.html"}
    assert "Table 2" in out
    with (tmp_path / "no_prior_2.csv").open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) > 100
    report = (tmp_path / "no_prior_2.html").read_text(encoding="utf-8")
    assert "<svg" in report
    assert not re.search(r'(src|href)="https?:', report)


@pytest.mark.parametrize("name", HEADS)
def test_exact_runs_are_equal_row_for_row(run, reference, name):
    code, out, _, _ = run("study", "no-prior", "--golden", reference / name)
    assert code == 0
    assert f"All {HEADS[name]} rows" in out


def test_a_row_that_differs_is_shown_with_exit_code_1(run, reference, tmp_path):
    head, first, *rest = (reference / "golden.csv").read_text(encoding="utf-8").splitlines()
    column = head.split(",").index("endPos1")
    cells = first.split(",")
    cells[column] = str(int(float(cells[column])) + 1)
    (tmp_path / "changed.csv").write_text("\n".join([head, ",".join(cells), *rest[:9]]) + "\n")
    code, out, _, _ = run("study", "no-prior", "--golden", "changed.csv")
    assert code == 1
    assert "endPos1" in out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--table", "9"], "9"),
        (["--replicates", "1"], "1"),
        (["-o", __file__], "must be a folder"),
        (["--golden", "none.csv"], "none.csv"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "no-prior", *words)
    assert (code, made) == (2, set())
    assert says in err
